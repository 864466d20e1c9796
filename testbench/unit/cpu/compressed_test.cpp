// Every form of RV32C: encoded here bit by bit from the manual's tables, executed, and judged by its effect.
#include <string>

#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

using Half = std::uint16_t;

// Scatters bits of `v`: "5|4:2" style lists as pairs (source bit, target bit).
Half scatter(unsigned v, std::initializer_list<std::pair<unsigned, unsigned>> bits) {
  unsigned h = 0;
  for (const auto& [from, to] : bits) h |= (v >> from & 1u) << to;
  return static_cast<Half>(h);
}
unsigned c(unsigned reg) { return reg - 8; }  // the three-bit name of x8..x15

Half ci(unsigned f3, unsigned op, unsigned rd, int imm) {
  return static_cast<Half>(f3 << 13 | rd << 7 | op |
                           scatter(static_cast<unsigned>(imm), {{5, 12}, {4, 6}, {3, 5}, {2, 4}, {1, 3}, {0, 2}}));
}
Half c_addi(unsigned rd, int imm) { return ci(0, 1, rd, imm); }
Half c_li(unsigned rd, int imm) { return ci(2, 1, rd, imm); }
Half c_lui(unsigned rd, int imm) { return ci(3, 1, rd, imm); }
Half c_slli(unsigned rd, int n) { return ci(0, 2, rd, n); }
Half c_addi16sp(int imm) {
  return static_cast<Half>(3u << 13 | 2u << 7 | 1u |
                           scatter(static_cast<unsigned>(imm), {{9, 12}, {4, 6}, {6, 5}, {8, 4}, {7, 3}, {5, 2}}));
}
Half c_addi4spn(unsigned rd, unsigned imm) {
  return static_cast<Half>(c(rd) << 2 |
                           scatter(imm, {{5, 12}, {4, 11}, {9, 10}, {8, 9}, {7, 8}, {6, 7}, {2, 6}, {3, 5}}));
}
Half c_mem(unsigned f3, unsigned reg, unsigned base, unsigned imm) {
  return static_cast<Half>(f3 << 13 | c(base) << 7 | c(reg) << 2 |
                           scatter(imm, {{5, 12}, {4, 11}, {3, 10}, {2, 6}, {6, 5}}));
}
Half c_lwsp(unsigned rd, unsigned imm) {
  return static_cast<Half>(2u << 13 | rd << 7 | 2u | scatter(imm, {{5, 12}, {4, 6}, {3, 5}, {2, 4}, {7, 3}, {6, 2}}));
}
Half c_swsp(unsigned rs2, unsigned imm) {
  return static_cast<Half>(6u << 13 | rs2 << 2 | 2u |
                           scatter(imm, {{5, 12}, {4, 11}, {3, 10}, {2, 9}, {7, 8}, {6, 7}}));
}
Half c_shift(unsigned kind, unsigned rd, int n) {
  return static_cast<Half>(ci(4, 1, 0, n) | kind << 10 | c(rd) << 7);
}  // srli srai andi
Half c_alu(unsigned kind, unsigned rd, unsigned rs2) {
  return static_cast<Half>(0x8C01 | c(rd) << 7 | kind << 5 | c(rs2) << 2);
}
Half c_jump(unsigned f3, int d) {
  return static_cast<Half>(
      f3 << 13 | 1u |
      scatter(static_cast<unsigned>(d),
              {{11, 12}, {4, 11}, {9, 10}, {8, 9}, {10, 8}, {6, 7}, {7, 6}, {3, 5}, {2, 4}, {1, 3}, {5, 2}}));
}
Half c_branch(unsigned f3, unsigned rs1, int d) {
  return static_cast<Half>(
      f3 << 13 | c(rs1) << 7 | 1u |
      scatter(static_cast<unsigned>(d), {{8, 12}, {4, 11}, {3, 10}, {7, 6}, {6, 5}, {2, 4}, {1, 3}, {5, 2}}));
}
Half c_register(unsigned bit12, unsigned rd, unsigned rs2) {
  return static_cast<Half>(4u << 13 | bit12 << 12 | rd << 7 | rs2 << 2 | 2u);
}

class CpuCompressed : public CpuBench {
 protected:
  static constexpr std::uint32_t kPlace = kCode + 0x1002;  // not a multiple of four
  // Runs one compressed instruction at kPlace; afterwards the program counter must be `distance` further.
  void run_half(Half h, int distance = 2) {
    jump(kPlace);
    put_half(kPlace, h);
    step();
    EXPECT_EQ(cpu.pc(), kPlace + static_cast<std::uint32_t>(distance)) << std::hex << h;
  }
  void expect_illegal(Half h, const std::string& what) {
    jump(kPlace);
    put_half(kPlace, h);
    const std::uint64_t before = cpu.instructions();
    step();
    EXPECT_EQ(csr(rv::mcause), 2u) << what;
    EXPECT_EQ(csr(rv::mtval), h) << what << ": mtval is the halfword alone";
    EXPECT_EQ(csr(rv::mepc), kPlace) << what;
    EXPECT_EQ(cpu.instructions(), before) << what << ": does not retire";
  }
  CpuCompressed() { set_csr(rv::mtvec, kCode + 0x3000); }
};

TEST_F(CpuCompressed, ImmediatesOfEverySize) {
  for (int imm = -32; imm < 32; ++imm) {
    cpu.set_reg(21, 1000);
    run_half(c_addi(21, imm));
    ASSERT_EQ(cpu.reg(21), static_cast<std::uint32_t>(1000 + imm));
    run_half(c_li(22, imm));
    ASSERT_EQ(cpu.reg(22), static_cast<std::uint32_t>(imm));
    cpu.set_reg(rv::a3, 0xFFFF'0FF5);
    run_half(c_shift(2, rv::a3, imm));
    ASSERT_EQ(cpu.reg(rv::a3), 0xFFFF'0FF5u & static_cast<std::uint32_t>(imm)) << "c.andi";
    if (imm == 0) continue;
    run_half(c_lui(23, imm));
    ASSERT_EQ(cpu.reg(23), static_cast<std::uint32_t>(imm * 4096));
  }
}

TEST_F(CpuCompressed, StackPointerAdjustments) {
  for (int imm = -512; imm < 512; imm += 16) {
    if (imm == 0) continue;
    cpu.set_reg(rv::sp, kData + 0x1000);
    run_half(c_addi16sp(imm));
    ASSERT_EQ(cpu.reg(rv::sp), kData + 0x1000 + static_cast<std::uint32_t>(imm));
  }
  cpu.set_reg(rv::sp, 0x1000);
  for (unsigned imm = 4; imm < 1024; imm += 4) {
    run_half(c_addi4spn(9, imm));
    ASSERT_EQ(cpu.reg(9), 0x1000 + imm);
  }
}

TEST_F(CpuCompressed, Shifts) {
  for (int n = 0; n < 32; ++n) {
    for (unsigned reg = 8; reg < 16; reg += 7) {
      cpu.set_reg(reg, 0x8000'0001);
      run_half(c_slli(reg, n));
      ASSERT_EQ(cpu.reg(reg), 0x8000'0001u << n);
      cpu.set_reg(reg, 0x8000'0001);
      run_half(c_shift(0, reg, n));
      ASSERT_EQ(cpu.reg(reg), 0x8000'0001u >> n);
      cpu.set_reg(reg, 0x8000'0001);
      run_half(c_shift(1, reg, n));
      ASSERT_EQ(cpu.reg(reg), n == 0 ? 0x8000'0001u : ~0u << (31 - n)) << n;
    }
  }
}

TEST_F(CpuCompressed, RegisterArithmetic) {
  const auto result = [&](Half h, unsigned rd, std::uint32_t x, unsigned rs2, std::uint32_t y) {
    cpu.set_reg(rd, x);
    cpu.set_reg(rs2, y);
    run_half(h);
    return cpu.reg(rd);
  };
  EXPECT_EQ(result(c_alu(0, 8, 15), 8, 5, 15, 7), 0xFFFF'FFFEu) << "c.sub";
  EXPECT_EQ(result(c_alu(1, 9, 14), 9, 0b1100, 14, 0b1010), 0b0110u) << "c.xor";
  EXPECT_EQ(result(c_alu(2, 10, 13), 10, 0b1100, 13, 0b1010), 0b1110u) << "c.or";
  EXPECT_EQ(result(c_alu(3, 11, 12), 11, 0b1100, 12, 0b1010), 0b1000u) << "c.and";
  EXPECT_EQ(result(c_register(0, 20, 27), 20, 1, 27, 42), 42u) << "c.mv";
  EXPECT_EQ(result(c_register(1, 20, 27), 20, 1, 27, 42), 43u) << "c.add";
}

TEST_F(CpuCompressed, LoadsAndStoresReachTheirWholeRange) {
  for (unsigned imm = 0; imm < 128; imm += 4) {
    cpu.set_reg(8, kData);
    cpu.set_reg(15, 0xA000'0000 + imm);
    run_half(c_mem(6, 15, 8, imm));  // c.sw
    ASSERT_EQ(word(kData + imm), 0xA000'0000 + imm);
    run_half(c_mem(2, 9, 8, imm));  // c.lw
    ASSERT_EQ(cpu.reg(9), 0xA000'0000 + imm);
  }
  for (unsigned imm = 0; imm < 256; imm += 4) {
    cpu.set_reg(rv::sp, kData + 0x400);
    cpu.set_reg(29, 0xB000'0000 + imm);
    run_half(c_swsp(29, imm));
    ASSERT_EQ(word(kData + 0x400 + imm), 0xB000'0000 + imm);
    run_half(c_lwsp(17, imm));
    ASSERT_EQ(cpu.reg(17), 0xB000'0000 + imm);
  }
}

TEST_F(CpuCompressed, JumpsAndBranches) {
  for (int d = -2048; d < 2048; d += 2) {
    if (d == 0) continue;
    run_half(c_jump(5, d), d);
    cpu.set_reg(rv::ra, 0);
    run_half(c_jump(1, d), d);  // c.jal
    ASSERT_EQ(cpu.reg(rv::ra), kPlace + 2) << "the link is two bytes on";
  }
  for (int d = -256; d < 256; d += 2) {
    if (d == 0) continue;
    cpu.set_reg(12, 0);
    run_half(c_branch(6, 12, d), d);  // c.beqz
    run_half(c_branch(7, 12, d));     // c.bnez
    cpu.set_reg(12, 0x100);
    run_half(c_branch(6, 12, d));
    run_half(c_branch(7, 12, d), d);
  }
  cpu.set_reg(26, kPlace + 0x41);
  cpu.set_reg(rv::ra, 0);
  run_half(c_register(0, 26, 0), 0x40);  // c.jr
  EXPECT_EQ(cpu.reg(rv::ra), 0u);
  run_half(c_register(1, 26, 0), 0x40);  // c.jalr
  EXPECT_EQ(cpu.reg(rv::ra), kPlace + 2);
  cpu.set_reg(rv::ra, kPlace + 0x20);
  run_half(c_register(1, rv::ra, 0), 0x20);  // c.jalr ra: target before link
  EXPECT_EQ(cpu.reg(rv::ra), kPlace + 2);
}

TEST_F(CpuCompressed, HintsDoNothing) {
  for (const Half h : {c_addi(0, 0), c_addi(0, 5), c_addi(9, 0), c_li(0, 3), c_lui(0, 3), c_slli(0, 4), c_slli(9, 0),
                       c_register(0, 0, 9), c_register(1, 0, 9)}) {
    cpu.set_reg(9, 123);
    run_half(h);
    EXPECT_EQ(cpu.reg(0), 0u);
    EXPECT_EQ(cpu.reg(9), 123u);
  }
}

TEST_F(CpuCompressed, BreakpointIsTheOneOfTheFullForm) {
  jump(kPlace);
  put_half(kPlace, 0x9002);
  step();
  EXPECT_EQ(csr(rv::mcause), 3u);
  EXPECT_EQ(csr(rv::mepc), kPlace);
}

TEST_F(CpuCompressed, ReservedFormsAreIllegal) {
  expect_illegal(0x0000, "all zero");
  expect_illegal(0x0004, "c.addi4spn of 0");
  expect_illegal(0x6101, "c.addi16sp of 0");
  expect_illegal(0x6081, "c.lui of 0");
  expect_illegal(static_cast<Half>(c_slli(9, 0) | 1u << 12), "c.slli by 32");
  expect_illegal(static_cast<Half>(c_shift(0, 9, 0) | 1u << 12), "c.srli by 32");
  expect_illegal(static_cast<Half>(c_shift(1, 9, 0) | 1u << 12), "c.srai by 32");
  expect_illegal(c_lwsp(0, 4), "c.lwsp to x0");
  expect_illegal(c_register(0, 0, 0), "c.jr x0");
  for (unsigned kind = 0; kind < 4; ++kind) {
    expect_illegal(static_cast<Half>(c_alu(kind, 9, 10) | 1u << 12), "64-bit register arithmetic");
  }
  for (const unsigned f3 : {1u, 3u, 4u, 5u, 7u})
    expect_illegal(static_cast<Half>(f3 << 13), "quadrant 0, floating point or reserved");
  for (const unsigned f3 : {1u, 3u, 5u, 7u})
    expect_illegal(static_cast<Half>(f3 << 13 | 2u), "quadrant 2, floating point");
}

}  // namespace
}  // namespace brick
