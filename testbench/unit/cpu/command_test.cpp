// `brick cpu`: verdicts, counts and messages.
#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "app/cpu_command.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Result {
  int status;
  std::string output;
};

Result run(const std::string& program, std::uint64_t max_instructions) {
  ::testing::internal::CaptureStdout();
  const int status = cpu_command(BRICK_CPU_PROGRAMS + program + ".elf", max_instructions);
  return {status, ::testing::internal::GetCapturedStdout()};
}

TEST(CpuCommand, PassedProgram) {
  const Result r = run("sort", 10'000'000);
  EXPECT_EQ(r.status, 0);
  EXPECT_THAT(r.output, AllOf(HasSubstr("sort.elf: passed\n"), HasSubstr("instructions "), HasSubstr("cycles "),
                              HasSubstr("ms at 78.643 MHz"), HasSubstr("M instructions/s")));
}

TEST(CpuCommand, StopsExactlyAtTheMaximum) {
  for (const std::uint64_t limit : {1u, 2u, 1234u}) {
    const Result r = run("sort", limit);
    EXPECT_EQ(r.status, 1);
    EXPECT_THAT(r.output, AllOf(HasSubstr(std::to_string(limit) + " instructions without a write to tohost"),
                                HasSubstr("instructions    " + std::to_string(limit) + "\n")));
  }
}

TEST(CpuCommand, SleepWithoutEndFails) {
  const Result r = run("interrupted", 10'000'000);
  EXPECT_EQ(r.status, 1);
  EXPECT_THAT(r.output, AllOf(HasSubstr("failed: sleeps at"), HasSubstr("(main)")));
}

// Small programs made here: an ELF file with one segment of code at `base` and a symbol table that knows tohost.
class Made {
 public:
  Made(std::uint32_t base, const std::vector<std::uint32_t>& code, const std::string& symbol = "tohost")
      : path_(std::filesystem::temp_directory_path() / ("brick_cpu_" + std::to_string(getpid()) + ".elf")) {
    const std::uint32_t code_bytes = static_cast<std::uint32_t>(4 * code.size()), at = 52 + 32;
    const std::string names = std::string(1, '\0') + symbol + std::string(16 - symbol.size() - 1, '\0');
    const std::uint32_t symbols = at + code_bytes, strings = symbols + 32, sections = strings + 16;
    word(0x464C457F), word(0x00010101), word(0), word(0);                          // class 1, little-endian, version 1
    word(2 | 243u << 16), word(1), word(base), word(52), word(sections), word(0);  // executable, RISC-V
    word(52 | 32u << 16), word(1 | 40u << 16), word(3);                            // one program header, three sections
    for (const std::uint32_t v : {1u, at, base, base, code_bytes, code_bytes, 7u, 4u}) word(v);
    for (const std::uint32_t v : code) word(v);
    for (const std::uint32_t v : {0u, 0u, 0u, 0u, 1u, base + 0x1000, 0u, 0xFFF1u << 16}) word(v);  // absolute symbol
    bytes_ += names;
    for (int i = 0; i < 10; ++i) word(0);
    for (const std::uint32_t v : {0u, 2u, 0u, 0u, symbols, 32u, 2u, 1u, 4u, 16u}) word(v);  // symbols
    for (const std::uint32_t v : {0u, 3u, 0u, 0u, strings, 16u, 0u, 0u, 1u, 0u}) word(v);   // names
    std::ofstream(path_, std::ios::binary) << bytes_;
  }
  ~Made() { std::filesystem::remove(path_); }
  Result run(std::uint64_t max_instructions = 1000) {
    ::testing::internal::CaptureStdout();
    int status = -1;
    try {
      status = cpu_command(path_.string(), max_instructions);
    } catch (...) {
      ::testing::internal::GetCapturedStdout();
      throw;
    }
    return {status, ::testing::internal::GetCapturedStdout()};
  }
  std::string path() const { return path_.string(); }

 private:
  void word(std::uint32_t v) {
    for (int i = 0; i < 4; ++i) bytes_ += static_cast<char>(v >> (8 * i));
  }
  std::filesystem::path path_;
  std::string bytes_;
};

// auipc t0, 1; addi a0, zero, value; sw a0, 0(t0); j .
std::vector<std::uint32_t> writes(std::uint32_t value) {
  return {0x00001297, value << 20 | 0x513, 0x00A2A023, 0x0000006F};
}

TEST(CpuCommand, VerdictIsWhatTheProgramWrote) {
  EXPECT_EQ(Made(0x8000'0000, writes(1)).run().status, 0);
  const Result seven = Made(0x8000'0000, writes(15)).run();
  EXPECT_EQ(seven.status, 1);
  EXPECT_THAT(seven.output, HasSubstr("failed with code 7"));
  const Result service = Made(0x8000'0000, writes(64)).run();
  EXPECT_EQ(service.status, 1);
  EXPECT_THAT(service.output, HasSubstr("wrote 0x40 to tohost"));
  EXPECT_THAT(Made(0x8000'0000, writes(0)).run().output, HasSubstr("1000 instructions without a write"))
      << "zero says nothing";
}

TEST(CpuCommand, CountsInstructionsAndCycles) {
  const Result r = Made(0x8000'0000, writes(1)).run();
  EXPECT_THAT(r.output, AllOf(HasSubstr("instructions    3\n"), HasSubstr("cycles          3\n")));
}

TEST(CpuCommand, RunsWhereTheElfFileSays) {
  for (const std::uint32_t base : {0u, 0x1000'0000u, 0x7FFF'F000u, 0xFFFF'E000u}) {
    EXPECT_EQ(Made(base, writes(1)).run().status, 0) << std::hex << base;
  }
}

TEST(CpuCommand, TrapWithoutAHandlerIsNamed) {
  for (const std::uint64_t limit : {2u, 1000u, 100'000'000u}) {
    const Result r = Made(0x8000'0000, {0x00000013, 0x00100073}).run(limit);
    EXPECT_EQ(r.status, 1);
    EXPECT_THAT(r.output, AllOf(HasSubstr("failed: trap 3 at 0x80000004 and its handler at 0x0 traps again"),
                                HasSubstr("instructions    1\n")));
  }
}

TEST(CpuCommand, BadInputIsARuntimeError) {
  EXPECT_THROW(cpu_command("/nowhere.elf", 1), std::runtime_error);
  Made nameless(0x8000'0000, writes(1), "elsewhere");
  try {
    nameless.run();
    FAIL() << "ran";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(nameless.path()), HasSubstr("no symbol `tohost`"), HasSubstr("expected")));
  }
}

}  // namespace
}  // namespace brick
