// The commands of `brick`. Each returns the exit status 0 or 1 and throws UsageError for bad usage or input.
#pragma once

#include <string>

#include "app/options.h"

namespace brick {

int list_command(bool json);
int boards_command(const std::string& name_or_file, bool json);  // "": all boards of the boards folder
int exec_command(const RunOptions& options, const std::string& script, bool raw);
int console_command(const RunOptions& options, const std::string& history);  // history: file, "" = none
struct ServeOptions {
  RunOptions run;
  std::string listen = "127.0.0.1:1025";
  bool free = false;             // simulated time does not follow the clock on the wall
  bool save_takes_long = false;  // SAVE is answered before it is over
};
int serve_command(const ServeOptions& options);
struct TimingOptions {
  RunOptions run;
  std::string bench;  // "" with sweep only
  std::string wavedrom;
  bool sweep = false;
};
int timing_command(const TimingOptions& options);

}  // namespace brick
