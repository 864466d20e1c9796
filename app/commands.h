// The commands of `brick`. Each returns the exit status 0 or 1 and throws UsageError for bad usage or input.
#pragma once

#include <string>
#include <vector>

#include "app/bench.h"
#include "app/options.h"

namespace brick {

// The benches that a command may run come from `main`: they stand above `app`.
int list_command(const std::vector<Bench>& benches, bool json);
int boards_command(const std::string& name_or_file, bool json);  // "": all boards of the boards folder
int exec_command(const RunOptions& options, const std::string& script, bool raw);
int console_command(const RunOptions& options, const std::string& history);  // history: file, "" = none
struct ServeOptions {
  RunOptions run;
  std::string listen = "127.0.0.1:1025";
  std::string page;  // where the page is, "" = there is none
  bool page_read_only = false;
  bool free = false;             // simulated time does not follow the clock on the wall
  bool save_takes_long = false;  // SAVE is answered before it is over
  int end_with = 0;              // process that it ends with, 0: none
};
int serve_command(const ServeOptions& options);
struct TimingOptions {
  RunOptions run;
  std::string bench;  // "" with sweep only
  std::string wavedrom;
  bool sweep = false;
};
int timing_command(const std::vector<Bench>& benches, const TimingOptions& options);
struct PlotOptions {
  std::string file, beside;         // records; the second one "" = none
  std::string output;               // "" = beside `file`, as SVG
  std::string columns, path;        // names or globs with blanks between; two of them make a path
  std::string from, to;             // "" = all
  std::string title;                // "" = the file's name
  std::vector<std::string> limits;  // KIND=VALUE
  bool script = false;              // print what gnuplot is told, draw nothing
};
int plot_command(const PlotOptions& options);

}  // namespace brick
