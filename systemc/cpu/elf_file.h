// 32-bit RISC-V ELF executables: checks and loads them, finds symbols. Errors are std::runtime_error with one line that
// says file, what is wrong and what was expected.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace brick {

class Cpu;

class ElfFile {
 public:
  explicit ElfFile(const std::string& path);
  struct Segment {
    std::uint32_t address;
    std::uint32_t memory_size;
    std::vector<std::uint8_t> data;
  };
  const std::vector<Segment>& segments() const { return segments_; }
  struct Range {
    std::uint32_t address, bytes;
  };
  const std::vector<Range>& ranges() const {
    return ranges_;
  }  // what the program occupies when stored and when running
  std::uint32_t entry() const { return entry_; }
  std::optional<std::uint32_t> symbol(const std::string& name) const;
  const std::string& symbol_at(std::uint32_t address) const;  // name of the function that holds the address, "" if none
  bool begins_function(std::uint32_t address) const { return functions_.count(address) != 0; }
  void load(Cpu& cpu) const;  // every segment must lie in mapped memory, and the entry point in a segment
 private:
  void check_entry() const;
  std::string path_;
  std::vector<Segment> segments_;
  std::uint32_t entry_ = 0;
  std::map<std::string, std::uint32_t> symbols_;
  struct Function {
    std::string name;
    std::uint32_t end;
  };
  std::map<std::uint32_t, Function> functions_;  // by their first address
  std::vector<Range> ranges_;
};

}  // namespace brick
