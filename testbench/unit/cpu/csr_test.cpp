// Control and status registers: the six instructions, what each register keeps, and which do not exist.
#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

class CpuCsr : public CpuBench {
 protected:
  CpuCsr() { set_csr(rv::mtvec, kCode + 0x3000); }
  bool legal(rv::Word w) {
    jump(kCode);
    execute(w);
    if (cpu.pc() == kCode + 4) return true;
    EXPECT_EQ(csr(rv::mcause), 2u);
    EXPECT_EQ(csr(rv::mtval), w);
    EXPECT_EQ(csr(rv::mepc), kCode);
    return false;
  }
};

TEST_F(CpuCsr, WriteSetAndClearReturnTheOldValue) {
  cpu.set_reg(rv::a0, 0xF0F0'1234);
  execute(rv::csrrw(rv::a1, rv::mscratch, rv::a0));
  EXPECT_EQ(cpu.reg(rv::a1), 0u);
  cpu.set_reg(rv::a0, 0x0000'000F);
  execute(rv::csrrs(rv::a1, rv::mscratch, rv::a0));
  EXPECT_EQ(cpu.reg(rv::a1), 0xF0F0'1234u);
  execute(rv::csrrc(rv::a1, rv::mscratch, rv::a0));
  EXPECT_EQ(cpu.reg(rv::a1), 0xF0F0'123Fu);
  execute(rv::csrrwi(rv::a1, rv::mscratch, 0x1F));
  EXPECT_EQ(cpu.reg(rv::a1), 0xF0F0'1230u);
  execute(rv::csrrci(rv::a1, rv::mscratch, 0x11));
  EXPECT_EQ(cpu.reg(rv::a1), 0x1Fu);
  execute(rv::csrrsi(rv::a1, rv::mscratch, 0x10));
  EXPECT_EQ(cpu.reg(rv::a1), 0x0Eu);
  EXPECT_EQ(csr(rv::mscratch), 0x1Eu);
  cpu.set_reg(rv::a0, 5);
  execute(rv::csrrw(rv::a0, rv::mscratch, rv::a0));
  EXPECT_EQ(cpu.reg(rv::a0), 0x1Eu) << "swap with itself";
  EXPECT_EQ(csr(rv::mscratch), 5u);
}

TEST_F(CpuCsr, RegistersKeepTheBitsTheyHave) {
  struct {
    unsigned number;
    std::uint32_t kept;
  } const list[] = {{rv::mstatus, 0x0000'1888},
                    {rv::mtvec, 0xFFFF'FFFD},
                    {rv::mepc, 0xFFFF'FFFE},
                    {rv::mcause, ~0u},
                    {rv::mtval, ~0u},
                    {rv::mscratch, ~0u},
                    {rv::misa, 0x4000'1104},
                    {0x310, 0},
                    {0x320, 0},
                    {0xB03, 0},
                    {0xB9F, 0},
                    {0x323, 0}};
  for (const auto& entry : list) {
    set_csr(entry.number, ~0u);
    EXPECT_EQ(csr(entry.number), entry.kept) << std::hex << entry.number;
  }
  set_csr(rv::mstatus, 0);
  EXPECT_EQ(csr(rv::mstatus), 0x1800u) << "MPP is always machine mode";
}

TEST_F(CpuCsr, ReadOnlyRegistersRefuseWrites) {
  for (const unsigned n : {0xC00u, 0xC02u, 0xC80u, 0xC82u, 0xF11u, 0xF12u, 0xF13u, 0xF14u, 0xF15u}) {
    EXPECT_TRUE(legal(rv::csrrs(rv::a0, n, 0))) << std::hex << n;
    EXPECT_TRUE(legal(rv::csrrci(rv::a0, n, 0))) << std::hex << n;
    EXPECT_FALSE(legal(rv::csrrw(rv::a0, n, 0))) << std::hex << n;
    EXPECT_FALSE(legal(rv::csrrs(rv::a0, n, rv::a1))) << std::hex << n << ": also with a zero in the register";
    EXPECT_FALSE(legal(rv::csrrsi(rv::a0, n, 1))) << std::hex << n;
  }
  for (const unsigned n : {0xF11u, 0xF12u, 0xF13u, 0xF14u, 0xF15u}) EXPECT_EQ(csr(n), 0u);
}

TEST_F(CpuCsr, UnknownRegistersAreIllegal) {
  for (const unsigned n : {0x000u, 0x001u, 0x100u, 0x180u, 0x302u, 0x303u, 0x306u, 0x345u, 0x3A0u, 0x7A0u, 0x7B0u,
                           0xB01u, 0xC01u, 0xFFFu}) {
    cpu.set_reg(rv::a0, 0x1111);
    EXPECT_FALSE(legal(rv::csrrs(rv::a0, n, 0))) << std::hex << n;
    EXPECT_FALSE(legal(rv::csrrw(0, n, rv::a1))) << std::hex << n;
    EXPECT_EQ(cpu.reg(rv::a0), 0x1111u);
  }
}

TEST_F(CpuCsr, CycleAndInstructionCountersCount) {
  jump(kCode);
  // nop 1, mcycle read 2, div 20, cycle read 2, instret reads
  put(kCode, {rv::nop(), rv::csrrs(rv::a0, rv::mcycle, 0), rv::r(1, 4, rv::t0, rv::t1, rv::t1),
              rv::csrrs(rv::a1, rv::cycle, 0), rv::csrrs(rv::a2, rv::minstret, 0), rv::ecall(),
              rv::csrrs(rv::a3, rv::instret, 0)});
  steps(5);
  EXPECT_EQ(cpu.reg(rv::a1) - cpu.reg(rv::a0), 22u);
  steps(1);  // the ecall does not count
  put(kCode + 0x3000, {rv::csrrs(rv::a3, rv::instret, 0)});
  steps(1);
  EXPECT_EQ(cpu.reg(rv::a3) - cpu.reg(rv::a2), 1u) << "only the read of minstret in between";
}

TEST_F(CpuCsr, CountersCanBeWrittenAndCarry) {
  jump(kCode);
  cpu.set_reg(rv::a0, 0xFFFF'FFFF);
  put(kCode,
      {rv::csrrwi(0, rv::mcycleh, 3), rv::csrrw(0, rv::mcycle, rv::a0), rv::csrrs(rv::a1, rv::mcycle, 0),
       rv::csrrs(rv::a2, rv::cycleh, 0), rv::csrrwi(0, rv::minstreth, 9), rv::csrrw(0, rv::minstret, rv::a0),
       rv::csrrs(rv::a3, rv::minstret, 0), rv::csrrs(rv::a4, rv::minstret, 0), rv::csrrs(rv::a5, rv::instreth, 0)});
  steps(9);
  EXPECT_EQ(cpu.reg(rv::a1), 1u) << "0xFFFFFFFF plus the two cycles of the write";
  EXPECT_EQ(cpu.reg(rv::a2), 4u);
  EXPECT_EQ(cpu.reg(rv::a3), 0xFFFF'FFFFu) << "the write does not count itself";
  EXPECT_EQ(cpu.reg(rv::a4), 0u);
  EXPECT_EQ(cpu.reg(rv::a5), 10u);
}

TEST_F(CpuCsr, CycleCounterRunsOnWhileAsleep) {
  const std::uint32_t before = csr(rv::mcycle);
  cpu.set_cycle(cpu.cycle() + 12345);
  EXPECT_EQ(csr(rv::mcycle), before + 12345);
}

}  // namespace
}  // namespace brick
