// Reading ELF programs: what is found in a good one, and one clear message for each kind of bad one.
#include "systemc/cpu/elf_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "systemc/cpu/cpu.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Bytes = std::vector<char>;

const std::string kProgram = BRICK_CPU_PROGRAMS "sort.elf";

Bytes read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(Bytes& bytes, std::size_t at, std::uint32_t v, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes.at(at + i) = static_cast<char>(v >> (8 * i));
}

// Place of the first program header that is loaded: 32 bytes with type 0, file offset 4, run address 8, stored address
// 12, bytes in the file 16 and in memory 20.
std::size_t load_header(const Bytes& bytes) {
  std::size_t at = 52;
  while (bytes.at(at) != 1) at += 32;
  return at;
}

// A copy of a good program after `change`, removed at the end.
class Changed {
 public:
  explicit Changed(const std::function<void(Bytes&)>& change)
      : path_(std::filesystem::temp_directory_path() / ("brick_elf_" + std::to_string(getpid()) + ".elf")) {
    Bytes bytes = read(kProgram);
    change(bytes);
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~Changed() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string error_of(const std::string& path) {
  try {
    const ElfFile elf(path);
  } catch (const std::runtime_error& e) { return e.what(); }
  return "no error";
}

std::string error_after(const std::function<void(Bytes&)>& change) {
  const Changed file(change);
  std::string message = error_of(file.path());
  EXPECT_THAT(message, AllOf(HasSubstr(file.path()), HasSubstr("expected"))) << "names the file and what was expected";
  EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
  return message;
}

// Fields of the ELF header: type 16, machine 18, program headers at 28, their size 42 and number 44.
TEST(ElfFile, FindsSegmentsSymbolsAndEntry) {
  const ElfFile elf(kProgram);
  EXPECT_EQ(elf.entry(), 0x8000'0000u);
  ASSERT_EQ(elf.segments().size(), 2u);
  EXPECT_EQ(elf.segments()[0].address, 0x8000'0000u);
  EXPECT_EQ(elf.segments()[0].data.size(), elf.segments()[0].memory_size);
  EXPECT_GE(elf.segments()[1].memory_size, 16384u + 2000u) << "stack and results are in .bss";
  EXPECT_EQ(elf.symbol("_start"), 0x8000'0000u);
  ASSERT_TRUE(elf.symbol("results").has_value());
  EXPECT_EQ(*elf.symbol("tohost") % 4096, 0u);
  EXPECT_FALSE(elf.symbol("nonsense").has_value());
}

TEST(ElfFile, NamesTheFunctionThatHoldsAnAddress) {
  const ElfFile elf(kProgram);
  EXPECT_EQ(elf.symbol_at(0x8000'0000), "_start");
  EXPECT_EQ(elf.symbol_at(0x8000'0004), "_start");
  EXPECT_EQ(elf.symbol_at(*elf.symbol("main")), "main");
  EXPECT_EQ(elf.symbol_at(*elf.symbol("main") + 2), "main");
  EXPECT_EQ(elf.symbol_at(0x7FFF'FFFE), "");
  EXPECT_EQ(elf.symbol_at(0xFFFF'FFFE), "");
  EXPECT_EQ(elf.symbol_at(*elf.symbol("results")), "") << "data is no function";
}

TEST(ElfFile, LoadsAndClearsWhatLiesBehindTheData) {
  const ElfFile elf(kProgram);
  Cpu cpu;
  std::uint8_t* const memory = cpu.map(0x8000'0000, 1 << 20, {});
  std::fill(memory, memory + (1 << 20), std::uint8_t{0xEE});
  elf.load(cpu);
  const auto& code = elf.segments()[0];
  EXPECT_TRUE(std::equal(code.data.begin(), code.data.end(), memory));
  EXPECT_EQ(memory[*elf.symbol("results") - 0x8000'0000], 0u);
  EXPECT_EQ(memory[(1 << 20) - 1], 0xEEu);
}

TEST(ElfFile, InitialisedDataLiesAtItsStoredAddress) {
  // The first program header gets a run address that differs from the stored one.
  const Changed file([](Bytes& b) {
    put(b, load_header(b) + 8, 0x2000'0000, 4);
    put(b, load_header(b) + 12, 0x1000'0000, 4);
  });
  const ElfFile elf(file.path());
  EXPECT_EQ(elf.segments()[0].address, 0x1000'0000u);
  EXPECT_EQ(elf.ranges()[0].address, 0x2000'0000u);
  EXPECT_EQ(elf.ranges()[1].address, 0x1000'0000u);
}

TEST(ElfFile, SegmentOutsideMemory) {
  const ElfFile elf(kProgram);
  Cpu cpu;
  cpu.map(0x8000'0000, 0x2000, {});
  try {
    elf.load(cpu);
    FAIL() << "loaded";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(kProgram), HasSubstr("lies outside memory"),
                                HasSubstr("expected it within 0x80000000..0x80001fff")));
  }
}

// In the ELF header at 24.
TEST(ElfFile, EntryPointThatIsNone) {
  const auto error_with = [](std::uint32_t entry) -> std::string {
    const Changed file([entry](Bytes& b) { put(b, 24, entry, 4); });
    Cpu cpu;
    cpu.map(0x8000'0000, 1 << 20, {});
    try {
      ElfFile(file.path()).load(cpu);
    } catch (const std::runtime_error& e) { return e.what(); }
    return "no error";
  };
  EXPECT_EQ(error_with(0x8000'0002), "no error");
  EXPECT_THAT(error_with(0x8000'0001), HasSubstr("entry point 0x80000001 is odd; expected"));
  EXPECT_THAT(error_with(0x7FFF'FFFE), HasSubstr("entry point 0x7ffffffe lies outside memory; expected it in a"));
  EXPECT_THAT(error_with(0x800F'FFF0), HasSubstr("lies outside memory")) << "mapped, but nothing is loaded there";
}

TEST(ElfFile, UnreadableFiles) {
  EXPECT_THAT(error_of("/nowhere/x.elf"), AllOf(HasSubstr("/nowhere/x.elf: cannot be read"), HasSubstr("expected")));
  EXPECT_THAT(error_of("/tmp"), HasSubstr("/tmp: cannot be read"));
}

TEST(ElfFile, WrongKindsOfFile) {
  EXPECT_THAT(error_after([](Bytes& b) { b.clear(); }), HasSubstr("is not an ELF file"));
  EXPECT_THAT(error_after([](Bytes& b) { b[0] = 'M'; }), HasSubstr("is not an ELF file"));
  EXPECT_THAT(error_after([](Bytes& b) { b[4] = 2; }), HasSubstr("class 2; expected class 1 (32-bit)"));
  EXPECT_THAT(error_after([](Bytes& b) { b[5] = 2; }), HasSubstr("data encoding 2; expected 1 (little-endian)"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 18, 40, 2); }), HasSubstr("is for machine 40; expected 243 (RISC-V)"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 16, 1, 2); }), HasSubstr("type 1; expected 2 (executable"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 42, 56, 2); }), HasSubstr("program headers of 56 bytes; expected 32"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 44, 0, 2); }), HasSubstr("has nothing to load"));
}

TEST(ElfFile, TruncatedAtAnyLengthIsAnErrorNotACrash) {
  const std::size_t size = read(kProgram).size();
  for (std::size_t length = 4; length < size; length += 97) {
    const std::string message = error_after([&](Bytes& b) { b.resize(length); });
    EXPECT_THAT(message, HasSubstr("is truncated")) << length;
  }
}

TEST(ElfFile, NonsenseOffsetsAreErrors) {
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 28, 0xFFFF'FFF0, 4); }), HasSubstr("for the table of program headers"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, 32, 0xFFFF'FFF0, 4); }), HasSubstr("for the table of section headers"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, load_header(b) + 4, 0xFFFF'FFF0, 4); }), HasSubstr("for a segment"));
  EXPECT_THAT(error_after([](Bytes& b) { put(b, load_header(b) + 20, 4, 4); }),
              HasSubstr("more bytes in the file than in memory"));
}

// Bytes overwritten at random: an error or a program, never a crash (the sanitizer build looks closer).
TEST(ElfFile, RandomDamageNeverCrashes) {
  std::uint32_t seed = 7;
  for (int round = 0; round < 200; ++round) {
    const Changed file([&](Bytes& b) {
      for (int n = 0; n < 4; ++n) {
        seed = seed * 1664525u + 1013904223u;
        const std::size_t tail = std::min<std::size_t>(b.size(), 2000);
        const std::size_t at = n < 2 ? (seed >> 8) % 116 : b.size() - 1 - (seed >> 8) % tail;
        b[at] = static_cast<char>(seed >> 4);
      }
    });
    error_of(file.path());
  }
}

}  // namespace
}  // namespace brick
