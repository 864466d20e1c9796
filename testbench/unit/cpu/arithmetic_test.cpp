// Integer and M-extension instructions: corner cases with values from the RISC-V manual, then random operands against
// the same arithmetic in C++ on wider types.
#include <cstdint>
#include <functional>
#include <random>

#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

constexpr std::uint32_t kMin = 0x8000'0000, kMax = 0x7FFF'FFFF, kOnes = 0xFFFF'FFFF;
const std::uint32_t kCorners[] = {0,    1,        2,     31,        32,          33,          kMax,
                                  kMin, kMin + 1, kOnes, kOnes - 1, 0x0000'FFFF, 0xFFFF'0000, 0x5555'5555};

std::int64_t sx(std::uint32_t v) {
  return v < kMin ? std::int64_t{v} : std::int64_t{v} - (std::int64_t{1} << 32);
}  // value as signed

// Floor division by a power of two is what an arithmetic shift means.
std::uint32_t shift_right_arithmetic(std::uint32_t a, unsigned n) {
  const std::int64_t d = std::int64_t{1} << n, v = sx(a);
  return static_cast<std::uint32_t>(v >= 0 ? v / d : -((-v + d - 1) / d));
}

struct Operation {
  const char* name;
  unsigned f7, f3;
  std::function<std::uint32_t(std::uint32_t, std::uint32_t)> expected;
};

std::uint32_t low(__int128 v) { return static_cast<std::uint32_t>(v); }
std::uint32_t high(__int128 v) { return static_cast<std::uint32_t>(v >> 32); }

const Operation kOperations[] = {
    {"add", 0, 0, [](auto a, auto b) { return low(sx(a) + sx(b)); }},
    {"sub", 0x20, 0, [](auto a, auto b) { return low(sx(a) - sx(b)); }},
    {"sll", 0, 1, [](auto a, auto b) { return low(static_cast<__int128>(a) * (std::int64_t{1} << (b % 32))); }},
    {"slt", 0, 2, [](auto a, auto b) { return sx(a) < sx(b) ? 1u : 0u; }},
    {"sltu", 0, 3, [](auto a, auto b) { return a < b ? 1u : 0u; }},
    {"xor", 0, 4, [](auto a, auto b) { return (a | b) & ~(a & b); }},
    {"srl", 0, 5, [](auto a, auto b) { return low(std::int64_t{a} / (std::int64_t{1} << (b % 32))); }},
    {"sra", 0x20, 5, [](auto a, auto b) { return shift_right_arithmetic(a, b % 32); }},
    {"or", 0, 6, [](auto a, auto b) { return ~(~a & ~b); }},
    {"and", 0, 7, [](auto a, auto b) { return ~(~a | ~b); }},
    {"mul", 1, 0, [](auto a, auto b) { return low(static_cast<__int128>(sx(a)) * sx(b)); }},
    {"mulh", 1, 1, [](auto a, auto b) { return high(static_cast<__int128>(sx(a)) * sx(b)); }},
    {"mulhsu", 1, 2, [](auto a, auto b) { return high(static_cast<__int128>(sx(a)) * b); }},
    {"mulhu", 1, 3, [](auto a, auto b) { return high(static_cast<__int128>(a) * b); }},
    {"div", 1, 4, [](auto a, auto b) { return b == 0 ? kOnes : low(sx(a) / sx(b)); }},
    {"divu", 1, 5, [](auto a, auto b) { return b == 0 ? kOnes : a / b; }},
    {"rem", 1, 6, [](auto a, auto b) { return b == 0 ? a : low(sx(a) % sx(b)); }},
    {"remu", 1, 7, [](auto a, auto b) { return b == 0 ? a : a % b; }},
};

class CpuArithmetic : public CpuBench {
 protected:
  std::uint32_t result(rv::Word instruction, std::uint32_t a, std::uint32_t b = 0) {
    jump(kCode + 0x100);
    cpu.set_reg(rv::a0, a);
    cpu.set_reg(rv::a1, b);
    cpu.set_reg(rv::a2, 0xDEAD'BEEF);
    execute(instruction);
    EXPECT_EQ(cpu.pc(), kCode + 0x104);
    return cpu.reg(rv::a2);
  }
};

TEST_F(CpuArithmetic, RegisterOperationsAgreeWithWideArithmetic) {
  std::mt19937 random(1);
  for (const Operation& op : kOperations) {
    const rv::Word instruction = rv::r(op.f7, op.f3, rv::a2, rv::a0, rv::a1);
    for (const std::uint32_t a : kCorners) {
      for (const std::uint32_t b : kCorners) {
        ASSERT_EQ(result(instruction, a, b), op.expected(a, b)) << op.name << ' ' << std::hex << a << ' ' << b;
      }
    }
    for (int n = 0; n < 1000; ++n) {
      const std::uint32_t a = static_cast<std::uint32_t>(random()),
                          b = static_cast<std::uint32_t>(random()) >> (random() % 32);
      ASSERT_EQ(result(instruction, a, b), op.expected(a, b)) << op.name << ' ' << std::hex << a << ' ' << b;
    }
  }
}

TEST_F(CpuArithmetic, ImmediateOperationsSignExtendTheirImmediate) {
  struct {
    const char* name;
    unsigned f3, same_as;
  } const list[] = {{"addi", 0, 0}, {"slti", 2, 3}, {"sltiu", 3, 4}, {"xori", 4, 5}, {"ori", 6, 8}, {"andi", 7, 9}};
  std::mt19937 random(2);
  for (const auto& entry : list) {
    const Operation& op = kOperations[entry.same_as];
    for (int n = 0; n < 1500; ++n) {
      const int edge[] = {-2048, -1, 0, 1, 2047};
      const int imm = n < 5 ? edge[n] : static_cast<int>(random() % 4096) - 2048;
      const std::uint32_t a = n % 3 == 0 ? kCorners[random() % 14] : static_cast<std::uint32_t>(random());
      ASSERT_EQ(result(rv::i(0x13, entry.f3, rv::a2, rv::a0, imm), a), op.expected(a, static_cast<std::uint32_t>(imm)))
          << entry.name << ' ' << std::hex << a << ' ' << imm;
    }
  }
}

TEST_F(CpuArithmetic, ShiftsByConstant) {
  for (unsigned n = 0; n < 32; ++n) {
    for (const std::uint32_t a : kCorners) {
      ASSERT_EQ(result(rv::slli(rv::a2, rv::a0, n), a), low(static_cast<__int128>(a) << n));
      ASSERT_EQ(result(rv::srli(rv::a2, rv::a0, n), a), a / (std::uint64_t{1} << n));
      ASSERT_EQ(result(rv::srai(rv::a2, rv::a0, n), a), shift_right_arithmetic(a, n));
    }
  }
}

TEST_F(CpuArithmetic,
       DivisionEdgeValues) {  // RISC-V unprivileged manual, table "semantics for division by zero and overflow"
  const auto m = [](unsigned f3) { return rv::r(1, f3, rv::a2, rv::a0, rv::a1); };
  EXPECT_EQ(result(m(4), 7, 0), kOnes);
  EXPECT_EQ(result(m(5), 7, 0), kOnes);
  EXPECT_EQ(result(m(6), static_cast<std::uint32_t>(-7), 0), static_cast<std::uint32_t>(-7));
  EXPECT_EQ(result(m(7), 7, 0), 7u);
  EXPECT_EQ(result(m(4), kMin, kOnes), kMin);
  EXPECT_EQ(result(m(6), kMin, kOnes), 0u);
  EXPECT_EQ(result(m(4), static_cast<std::uint32_t>(-7), 2), static_cast<std::uint32_t>(-3));
  EXPECT_EQ(result(m(6), static_cast<std::uint32_t>(-7), 2), static_cast<std::uint32_t>(-1));
  EXPECT_EQ(result(m(6), 7, static_cast<std::uint32_t>(-2)), 1u);
}

TEST_F(CpuArithmetic, UpperImmediates) {
  EXPECT_EQ(result(rv::lui(rv::a2, 0xFFFFF), 0), 0xFFFF'F000u);
  EXPECT_EQ(result(rv::lui(rv::a2, 1), 0), 0x1000u);
  EXPECT_EQ(result(rv::auipc(rv::a2, 0), 0), kCode + 0x100);
  EXPECT_EQ(result(rv::auipc(rv::a2, 0x12345), 0), 0x1234'5000u + kCode + 0x100);
  EXPECT_EQ(result(rv::auipc(rv::a2, 0xF0000), 0), 0x100u) << "wraps at 2^32";
}

TEST_F(CpuArithmetic, RegisterZeroStaysZero) {
  cpu.set_reg(rv::a0, 5);
  set_word(kData, 77);
  cpu.set_reg(rv::a1, kData);
  for (const rv::Word w : {rv::addi(0, rv::a0, 1), rv::add(0, rv::a0, rv::a0), rv::lui(0, 1), rv::lw(0, rv::a1, 0),
                           rv::jal(0, 4), rv::csrrw(0, rv::mscratch, rv::a0), rv::r(1, 0, 0, rv::a0, rv::a0)}) {
    execute(w);
    EXPECT_EQ(cpu.reg(0), 0u) << std::hex << w;
  }
  cpu.set_reg(0, 9);
  EXPECT_EQ(cpu.reg(0), 0u);
}

TEST_F(CpuArithmetic, DestinationMayBeASource) {
  cpu.set_reg(rv::a0, 6);
  execute(rv::r(1, 0, rv::a0, rv::a0, rv::a0));
  EXPECT_EQ(cpu.reg(rv::a0), 36u);
}

// Control flow -------------------------------------------------------------------------------------------------------

TEST_F(CpuArithmetic, BranchesFollowTheirCondition) {
  struct {
    unsigned f3;
    std::function<bool(std::uint32_t, std::uint32_t)> taken;
  } const list[] = {
      {0, [](auto a, auto b) { return a == b; }},        {1, [](auto a, auto b) { return a != b; }},
      {4, [](auto a, auto b) { return sx(a) < sx(b); }}, {5, [](auto a, auto b) { return sx(a) >= sx(b); }},
      {6, [](auto a, auto b) { return a < b; }},         {7, [](auto a, auto b) { return a >= b; }}};
  for (const auto& entry : list) {
    for (const std::uint32_t a : kCorners) {
      for (const std::uint32_t b : kCorners) {
        for (const int distance : {-4096, -8, 2, 4094}) {
          jump(kCode + 0x2000);
          cpu.set_reg(rv::a0, a);
          cpu.set_reg(rv::a1, b);
          execute(rv::b(entry.f3, rv::a0, rv::a1, distance));
          const std::uint32_t offset = entry.taken(a, b) ? static_cast<std::uint32_t>(distance) : 4;
          ASSERT_EQ(cpu.pc(), kCode + 0x2000 + offset)
              << entry.f3 << std::hex << ' ' << a << ' ' << b << ' ' << distance;
        }
      }
    }
  }
}

TEST_F(CpuArithmetic, JumpsLinkToTheNextInstruction) {
  execute(rv::jal(rv::ra, 0x2000));
  EXPECT_EQ(cpu.pc(), kCode + 0x2000);
  EXPECT_EQ(cpu.reg(rv::ra), kCode + 4);
  execute(rv::jal(rv::a5, -0x1000));
  EXPECT_EQ(cpu.pc(), kCode + 0x1000);
  EXPECT_EQ(cpu.reg(rv::a5), kCode + 0x2004);
  cpu.set_reg(rv::a0, kCode + 0x801);
  execute(rv::jalr(rv::a0, rv::a0, -0x800));
  EXPECT_EQ(cpu.pc(), kCode) << "bit 0 of the target is dropped";
  EXPECT_EQ(cpu.reg(rv::a0), kCode + 0x1004) << "the link is written after the target was read";
}

}  // namespace
}  // namespace brick
