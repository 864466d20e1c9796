// Programs built by the cross compiler, compared with the same computation done here.
#include <algorithm>
#include <cstring>
#include <vector>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

// Runs a program of programs/ in RAM to its end.
class Program {
 public:
  explicit Program(const std::string& name) : elf_(BRICK_CPU_PROGRAMS + name + ".elf") {
    cpu.map(0x8000'0000, 1 << 20, {});
    elf_.load(cpu);
    cpu.reset(elf_.entry());
    cpu.watch_store(*elf_.symbol("tohost"));
    cpu.on_store_watch = [this](std::uint32_t, std::uint32_t value) {
      tohost = value;
      return true;
    };
    stop = cpu.run(200'000'000);
  }
  template <typename T>
  T result(std::size_t index) {
    T value;
    std::memcpy(&value, cpu.memory(*elf_.symbol("results") + static_cast<std::uint32_t>(index * sizeof(T)), sizeof(T)),
                sizeof(T));
    return value;
  }
  Cpu cpu;
  std::uint32_t tohost = 0;
  Cpu::Stop stop = Cpu::Stop::kLimit;

 private:
  ElfFile elf_;
};

TEST(CpuPrograms, Checksum) {
  std::vector<std::uint8_t> text(3000);
  std::uint32_t seed = 12345;
  for (auto& c : text) c = static_cast<std::uint8_t>((seed = seed * 1103515245u + 12345u) >> 16);
  std::uint32_t crc = 0xFFFF'FFFF;
  for (const std::uint8_t c : text) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      const bool one = ((crc ^ (c >> bit)) & 1) != 0;
      crc = (crc >> 1) ^ (one ? 0xEDB8'8320 : 0);
    }
  }
  Program program("checksum");
  EXPECT_EQ(program.stop, Cpu::Stop::kHalt);
  EXPECT_EQ(program.tohost, 1u);
  EXPECT_EQ(program.result<std::uint32_t>(0), ~crc);
  EXPECT_EQ(program.result<std::uint32_t>(1), ~crc);
}

TEST(CpuPrograms, RecursiveSort) {
  std::vector<std::int16_t> list(1000);
  std::uint32_t seed = 99;
  for (auto& v : list) v = static_cast<std::int16_t>((seed = seed * 1664525u + 1013904223u) >> 16);
  std::sort(list.begin(), list.end());
  Program program("sort");
  EXPECT_EQ(program.tohost, 1u);
  for (std::size_t i = 0; i < list.size(); ++i) ASSERT_EQ(program.result<std::int16_t>(i), list[i]) << i;
}

TEST(CpuPrograms, SixtyFourBitAndFloatingPointArithmetic) {
  struct Row {
    std::uint64_t a, b, product, quotient, remainder;
    std::int64_t signed_quotient, signed_remainder, shifted;
    double x, y, sum, product_d, quotient_d, root;
    float narrow;
    std::int32_t whole;
  };
  std::uint64_t state = 88172645463325252u;
  const auto next = [&] {
    state ^= state << 13;
    state ^= state >> 7;
    return state ^= state << 17;
  };
  Program program("arithmetic64");
  ASSERT_EQ(program.tohost, 1u);
  for (std::size_t i = 0; i < 200; ++i) {
    const Row row = program.result<Row>(i);
    const std::uint64_t a = next(), width = next(), b = width >> (next() & 63) | 1;
    ASSERT_EQ(row.a, a) << i;
    ASSERT_EQ(row.b, b) << i;
    const auto sa = static_cast<std::int64_t>(a), sb = static_cast<std::int64_t>(b);
    EXPECT_EQ(row.product, static_cast<std::uint64_t>(static_cast<unsigned __int128>(a) * b)) << i;
    EXPECT_EQ(row.quotient, a / b) << i;
    EXPECT_EQ(row.remainder, a % b) << i;
    EXPECT_EQ(row.signed_quotient, sa / sb) << i;
    EXPECT_EQ(row.signed_remainder, sa % sb) << i;
    EXPECT_EQ(row.shifted, sa >> (b & 63)) << i;
    const double x = static_cast<double>(sa) / 65536.0, y = static_cast<double>(b) * 1e-3;
    double root = y > 1.0 ? y : 1.0;
    for (int n = 0; n < 60; ++n) root = 0.5 * (root + y / root);
    EXPECT_EQ(row.x, x) << i;
    EXPECT_EQ(row.y, y) << i;
    EXPECT_EQ(row.sum, x + y) << i;
    EXPECT_EQ(row.product_d, x * y) << i;
    EXPECT_EQ(row.quotient_d, x / y) << i;
    EXPECT_EQ(row.root, root) << i;
    EXPECT_EQ(row.narrow, static_cast<float>(x / y)) << i;
    EXPECT_EQ(row.whole, static_cast<std::int32_t>(a >> 40) / 7 * (i % 2 != 0 ? -1 : 1)) << i;
  }
}

}  // namespace
}  // namespace brick
