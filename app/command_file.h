// Reads command files as host programs do before they download them: comments `; ...`, `// ...` and `/* ... */` are
// left out, #include brings other files in, macros are replaced, #ifdef chooses. A line such as `#1->1000X` is no
// directive. Lines end with LF, CR LF or CR. What remains are the lines to be sent and the @ lines of a host script,
// each with its place for messages. Errors are UsageErrors that begin with file and line.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace brick {

constexpr std::size_t kControllerLine = 255;  // characters, firmware:6.1/2

struct SourceLine {
  std::string place;     // file:line
  std::string included;  // for the end of a message: " (included at file:line)", or nothing
  std::string text;      // without spaces before and behind; not empty
};

// `file` is the name in messages; what it includes is looked for from its folder on.
std::vector<SourceLine> read_command_file(std::istream& in, const std::string& file);

}  // namespace brick
