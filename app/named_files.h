// The files that a command line names: what is written has a file of its own, which nothing else writes or reads.
#pragma once

#include <string>
#include <vector>

namespace brick {

class NamedFiles {
 public:
  // `option` begins the message; "" and "-" are no files.
  void reads(const std::string& option, const std::string& file) { add(option, file, false); }
  void writes(const std::string& option, const std::string& file) { add(option, file, true); }

  // Throws UsageError when an output is another output or an input, whatever their names. Devices and pipes may stand
  // for several outputs.
  void check() const;

 private:
  struct Named {
    std::string option, file;
    bool written;
    std::string text() const { return option.empty() ? file : option + " " + file; }
  };
  void add(const std::string& option, const std::string& file, bool written);

  std::vector<Named> files_;
};

// Throws UsageError when the file cannot be written. It keeps its content, and is not made.
void need_writable(const std::string& option, const std::string& file);

}  // namespace brick
