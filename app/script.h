// Host scripts and command files: the controller's own command lines and lines that begin with `@` (docs/scripts.md),
// after comments, includes and macros (app/command_file.h). The whole of it is read and checked before anything runs;
// errors are UsageErrors that begin with file and line.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"
#include "systemc/core/usage_error.h"

namespace brick {

struct ScriptLine {
  enum class Kind {
    kCommand,
    kControl,
    kWait,
    kUntil,
    kSignal,
    kPicRead,
    kPicWrite,
    kPicClear,
    kDpramRead,
    kDpramWrite,
    kJumper,
    kInput,
    kEncoder,
    kJpan,
    kReset,
    kPower,
    kExpect,
    kTime
  };
  Kind kind = Kind::kCommand;
  std::string place, included;     // file:line and who included that file, for messages
  std::string text;                // command line, control characters, expected text, or the whole @ line for messages
  std::string name;                // signal, input pin
  std::string value;               // @until
  TimeFs time = 0;                 // @wait, limit of @until
  int mask = -1, edge_level = -1;  // @pic MSK= ELR=, -1: leave
  std::uint32_t offset = 0, count = 0;   // @dpram
  std::vector<std::uint16_t> words;      // @dpram, to write
  bool on = false;                       // @jumper, @input
  unsigned motor = 0;                    // @encoder
  std::uint16_t inputs = 0, levels = 0;  // @jpan: inputs named, and their levels
  std::optional<bool> init;              // @jpan INIT: level
  std::int64_t counts = 0, rate = 0;     // @encoder, rate in counts per second

  UsageError wrong(const std::string& what) const;  // that this @ line is; `what` was expected
};

// `file` is the name in messages.
std::vector<ScriptLine> read_script(std::istream& in, const std::string& file);

}  // namespace brick
