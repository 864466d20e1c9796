#include "systemc/cpu/elf_file.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "systemc/core/input_file.h"
#include "systemc/cpu/cpu.h"

namespace brick {
namespace {

// The fields of the ELF format that are needed, at their offsets in 32-bit files.
constexpr std::size_t kHeaderBytes = 52, kProgramHeaderBytes = 32, kSectionHeaderBytes = 40, kSymbolBytes = 16;
constexpr std::uint32_t kTypeExecutable = 2, kMachineRiscV = 243, kSegmentLoad = 1, kSectionSymbols = 2;
constexpr std::uint32_t kSectionNoBits = 8, kSectionExecutable = 4;
constexpr unsigned kSymbolNone = 0, kSymbolFunction = 2;

std::string hex(std::uint32_t v) {
  std::ostringstream text;
  text << "0x" << std::hex << v;
  return text.str();
}

// Reads little-endian fields; every access is checked, so a truncated file ends in one clear message.
class Image {
 public:
  explicit Image(const std::string& path) : path_(path) {
    const std::string bytes = read_input_file(path, "an ELF program");
    bytes_.assign(bytes.begin(), bytes.end());
  }
  [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }
  std::size_t size() const { return bytes_.size(); }
  void need(std::uint64_t offset, std::uint64_t count, const char* part) const {
    if (offset + count > bytes_.size()) {
      fail("is truncated: " + std::to_string(bytes_.size()) + " bytes; expected " + std::to_string(offset + count) +
           " for " + part);
    }
  }
  std::uint32_t u8(std::size_t offset) const { return static_cast<std::uint8_t>(bytes_.at(offset)); }
  std::uint32_t u16(std::size_t offset) const { return u8(offset) | u8(offset + 1) << 8; }
  std::uint32_t u32(std::size_t offset) const { return u16(offset) | u16(offset + 2) << 16; }
  std::vector<std::uint8_t> slice(std::size_t offset, std::size_t count) const {
    return {bytes_.begin() + static_cast<std::ptrdiff_t>(offset),
            bytes_.begin() + static_cast<std::ptrdiff_t>(offset + count)};
  }
  std::string text(std::size_t offset, std::size_t end) const {
    std::string s;
    for (; offset < end && u8(offset) != 0; ++offset) s += bytes_[offset];
    return s;
  }

 private:
  std::string path_;
  std::vector<char> bytes_;
};

void check_header(const Image& f) {
  static constexpr char kMagic[4] = {0x7F, 'E', 'L', 'F'};
  for (std::size_t i = 0; i < 4; ++i) {
    if (f.size() < 4 || static_cast<char>(f.u8(i)) != kMagic[i])
      f.fail("is not an ELF file; expected a 32-bit RISC-V ELF executable");
  }
  f.need(0, kHeaderBytes, "the ELF header");
  if (f.u8(4) != 1) f.fail("is an ELF file of class " + std::to_string(f.u8(4)) + "; expected class 1 (32-bit)");
  if (f.u8(5) != 1)
    f.fail("is an ELF file with data encoding " + std::to_string(f.u8(5)) + "; expected 1 (little-endian)");
  if (f.u16(18) != kMachineRiscV) f.fail("is for machine " + std::to_string(f.u16(18)) + "; expected 243 (RISC-V)");
  if (f.u16(16) != kTypeExecutable)
    f.fail("is an ELF file of type " + std::to_string(f.u16(16)) + "; expected 2 (executable, fully linked)");
  if (f.u16(44) != 0 && f.u16(42) != kProgramHeaderBytes) {
    f.fail("has program headers of " + std::to_string(f.u16(42)) + " bytes; expected " +
           std::to_string(kProgramHeaderBytes));
  }
}

}  // namespace

ElfFile::ElfFile(const std::string& path) : path_(path) {
  const Image f(path);
  check_header(f);
  entry_ = f.u32(24);

  const std::size_t headers = f.u32(28), count = f.u16(44);
  f.need(headers, count * kProgramHeaderBytes, "the table of program headers");
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = headers + i * kProgramHeaderBytes;
    if (f.u32(at) != kSegmentLoad) continue;
    const std::uint32_t offset = f.u32(at + 4), run = f.u32(at + 8), stored = f.u32(at + 12), in_file = f.u32(at + 16),
                        in_memory = f.u32(at + 20);
    if (in_memory == 0) continue;
    if (in_file > in_memory)
      f.fail("has a segment at " + hex(stored) + " with more bytes in the file than in memory; expected no more");
    f.need(offset, in_file, "a segment");
    // Initialised data that the start-up code copies lies at its stored address; what it clears itself, at its run
    // address.
    if (in_file == 0) {
      segments_.push_back({run, in_memory, {}});
    } else {
      segments_.push_back({stored, run == stored ? in_memory : in_file, f.slice(offset, in_file)});
    }
    ranges_.push_back({run, in_memory});
    if (run != stored && in_file != 0) ranges_.push_back({stored, in_file});
  }
  if (segments_.empty()) f.fail("has nothing to load; expected at least one loadable segment");

  const std::size_t sections = f.u32(32), section_count = f.u16(48);
  if (sections == 0 || section_count == 0) return;  // stripped of everything but the program
  if (f.u16(46) != kSectionHeaderBytes) {
    f.fail("has section headers of " + std::to_string(f.u16(46)) + " bytes; expected " +
           std::to_string(kSectionHeaderBytes));
  }
  f.need(sections, section_count * kSectionHeaderBytes, "the table of section headers");
  const auto section = [&](std::size_t index) { return sections + index * kSectionHeaderBytes; };
  for (std::size_t i = 0; i < section_count; ++i) {
    if (f.u32(section(i) + 4) != kSectionSymbols) continue;
    const std::size_t table = f.u32(section(i) + 16), table_bytes = f.u32(section(i) + 20),
                      link = f.u32(section(i) + 24);
    f.need(table, table_bytes, "the symbol table");
    if (link >= section_count) f.fail("has a symbol table without names; expected a string table");
    const std::size_t names = f.u32(section(link) + 16), names_end = names + f.u32(section(link) + 20);
    f.need(names, names_end - names, "the table of symbol names");
    for (std::size_t at = table; at + kSymbolBytes <= table + table_bytes; at += kSymbolBytes) {
      const std::string name = f.text(names + f.u32(at), names_end);
      const std::uint32_t value = f.u32(at + 4), bytes = f.u32(at + 8), home = f.u16(at + 14);
      const unsigned type = f.u8(at + 12) & 15;
      if (name.empty() || home == 0 || (type != kSymbolNone && type != 1 && type != kSymbolFunction)) continue;
      symbols_[name] = value;
      const bool in_code = home < section_count && (f.u32(section(home) + 8) & kSectionExecutable) != 0;
      if (!in_code || name[0] == '$' || name[0] == '.' || (type != kSymbolNone && type != kSymbolFunction)) continue;
      const std::uint32_t section_end = f.u32(section(home) + 12) + f.u32(section(home) + 20);
      if (functions_.count(value) != 0 && type != kSymbolFunction) continue;  // a label at a function's start
      functions_[value] = {name, bytes != 0 ? value + bytes : section_end};   // without a size: up to the next one
    }
  }
}

std::optional<std::uint32_t> ElfFile::symbol(const std::string& name) const {
  const auto found = symbols_.find(name);
  return found == symbols_.end() ? std::nullopt : std::optional<std::uint32_t>(found->second);
}

const std::string& ElfFile::symbol_at(std::uint32_t address) const {
  static const std::string kNone;
  const auto next = functions_.upper_bound(address);
  if (next == functions_.begin()) return kNone;
  const Function& function = std::prev(next)->second;
  return address < function.end ? function.name : kNone;
}

void ElfFile::load(Cpu& cpu) const {
  for (const Segment& s : segments_) {
    std::uint8_t* const place = cpu.memory(s.address, s.memory_size);
    if (place == nullptr) {
      std::string expected;
      for (const Cpu::Mapping& m : cpu.mappings())
        expected += (expected.empty() ? "" : ", ") + hex(m.base) + ".." + hex(m.base + m.bytes - 1);
      throw std::runtime_error(path_ + ": segment " + hex(s.address) + ".." + hex(s.address + s.memory_size - 1) +
                               " lies outside memory; expected it within " +
                               (expected.empty() ? "mapped memory" : expected));
    }
    std::copy(s.data.begin(), s.data.end(), place);
    std::fill(place + s.data.size(), place + s.memory_size, std::uint8_t{0});
  }
  cpu.invalidate_code();
  check_entry();
}

void ElfFile::check_entry() const {
  const auto wrong = [this](const char* what) {
    throw std::runtime_error(path_ + ": entry point " + hex(entry_) + " " + what);
  };
  if (entry_ % 2 != 0) wrong("is odd; expected the address of an instruction");
  const bool loaded = std::any_of(segments_.begin(), segments_.end(), [this](const Segment& s) {
    return entry_ >= s.address && entry_ - s.address < s.memory_size;
  });
  if (!loaded) wrong("lies outside memory; expected it in a loaded segment");
}

}  // namespace brick
