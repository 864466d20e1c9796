// The file that keeps the flash store between runs. It is replaced as a whole, by a rename: whoever is killed while it
// is written leaves the old content or the new, and a file beside it, FILE.new-PROCESS, which the next run takes away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace brick {

class FlashFile {
 public:
  explicit FlashFile(std::string file) : file_(std::move(file)) {}  // "": there is none

  // Each throws std::runtime_error with one clear line, load() also when the file could not be written later. A file
  // that is not there is made from `data`.
  void load(std::uint8_t* data, std::size_t bytes);
  // Writes only what differs from what was loaded or written last: what another process has written since stays.
  void save(const std::uint8_t* data, std::size_t bytes);

 private:
  void write(const std::uint8_t* data, std::size_t bytes);

  std::string file_;
  std::vector<std::uint8_t> known_;
};

}  // namespace brick
