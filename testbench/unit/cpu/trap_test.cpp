// Exceptions, their causes and mtval, and the encodings that must be illegal.
#include <string>

#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

constexpr std::uint32_t kHandler = kCode + 0x3000;

class CpuTrap : public CpuBench {
 protected:
  CpuTrap() { set_csr(rv::mtvec, kHandler); }
  // The instruction at the program counter must trap.
  void expect_trap(std::uint32_t cause, std::uint32_t tval, const std::string& what) {
    const std::uint32_t pc = cpu.pc();
    const std::uint64_t before = cpu.instructions();
    step();
    EXPECT_EQ(cpu.pc(), kHandler) << what;
    EXPECT_EQ(csr(rv::mcause), cause) << what;
    EXPECT_EQ(csr(rv::mtval), tval) << what;
    EXPECT_EQ(csr(rv::mepc), pc) << what;
    EXPECT_EQ(cpu.instructions(), before) << what << ": a trapped instruction does not retire";
  }
  void expect_illegal(rv::Word w, const std::string& what) {
    jump(kCode);
    put(kCode, {w});
    expect_trap(2, w, what);
  }
};

TEST_F(CpuTrap, ReservedEncodingsAreIllegalWithTheInstructionInMtval) {
  expect_illegal(0xFFFF'FFFF, "all ones");
  expect_illegal(rv::r(0x02, 0, 1, 2, 3), "funct7 of OP");
  expect_illegal(rv::r(0x20, 1, 1, 2, 3), "sll with the bit of sra");
  expect_illegal(rv::r(0x20, 7, 1, 2, 3), "and with the bit of sub");
  expect_illegal(rv::r(0x21, 0, 1, 2, 3), "mul with the bit of sub");
  expect_illegal(rv::r(0x01, 1, 1, 2, 3, 0x13), "slli by 32 and more");
  expect_illegal(rv::r(0x20, 1, 1, 2, 3, 0x13), "slli with the bit of srai");
  expect_illegal(rv::r(0x21, 5, 1, 2, 3, 0x13), "srai by 32 and more");
  expect_illegal(rv::i(0x67, 1, 1, 2, 0), "jalr with funct3");
  for (const unsigned f3 : {2u, 3u}) expect_illegal(rv::b(f3, 1, 2, 8), "branch");
  for (const unsigned f3 : {3u, 6u, 7u}) expect_illegal(rv::i(0x03, f3, 1, 2, 0), "load");
  for (const unsigned f3 : {3u, 4u, 5u, 6u, 7u}) expect_illegal(rv::s(f3, 1, 2, 0), "store");
  for (const unsigned f3 : {2u, 3u, 7u}) expect_illegal(rv::i(0x0F, f3, 0, 0, 0), "misc-mem");
  for (const unsigned opcode : {0x07u, 0x27u, 0x43u, 0x53u})
    expect_illegal(rv::i(opcode, 2, 1, 2, 0), "floating point");
  expect_illegal(rv::i(0x2F, 2, 1, 2, 0), "atomic");
  for (const unsigned opcode : {0x1Bu, 0x3Bu}) expect_illegal(rv::i(opcode, 0, 1, 2, 0), "64-bit arithmetic");
  for (const unsigned opcode : {0x1Fu, 0x3Fu, 0x5Fu, 0x7Fu})
    expect_illegal(rv::i(opcode, 0, 1, 2, 0), "longer than 32 bits");
  expect_illegal(0x1020'0073, "sret");
  expect_illegal(0x0020'0073, "uret");
  expect_illegal(0x1200'0073, "sfence.vma");
  expect_illegal(rv::ecall() | 1u << 7, "ecall with rd");
  expect_illegal(rv::mret() | 1u << 15, "mret with rs1");
  expect_illegal(rv::i(0x73, 4, 1, 2, 0x300), "csr with funct3 4");
}

TEST_F(CpuTrap, EnvironmentCallAndBreakpoint) {
  put(kCode, {rv::ecall()});
  expect_trap(11, 0, "ecall");
  jump(kCode + 8);
  put(kCode + 8, {rv::ebreak()});
  expect_trap(3, kCode + 8, "ebreak");
}

TEST_F(CpuTrap, MisalignedLoadsAndStoresTrapInMemoryAndAtDevices) {
  struct {
    rv::Word instruction;
    std::uint32_t offsets, cause;
    const char* name;
  } const list[] = {{rv::lw(rv::a1, rv::a0, 0), 0b1110, 4, "lw"},
                    {rv::lh(rv::a1, rv::a0, 0), 0b1010, 4, "lh"},
                    {rv::lhu(rv::a1, rv::a0, 0), 0b1010, 4, "lhu"},
                    {rv::sw(rv::a1, rv::a0, 0), 0b1110, 6, "sw"},
                    {rv::sh(rv::a1, rv::a0, 0), 0b1010, 6, "sh"}};
  for (const std::uint32_t base : {kData, kData + 0xFFC, kDevice}) {
    for (int round = 0; round < 2; ++round) {  // the second time the page is in the look-up tables
      for (const auto& entry : list) {
        for (std::uint32_t offset = 0; offset < 4; ++offset) {
          jump(kCode);
          cpu.set_reg(rv::a0, base + offset);
          cpu.set_reg(rv::a1, 0x55);
          put(kCode, {entry.instruction});
          if ((entry.offsets >> offset & 1) != 0) {
            const std::size_t accesses = device.accesses.size();
            expect_trap(entry.cause, base + offset, entry.name);
            EXPECT_EQ(cpu.reg(rv::a1), 0x55u);
            EXPECT_EQ(device.accesses.size(), accesses);
          } else {
            step();
            EXPECT_EQ(cpu.pc(), kCode + 4) << entry.name;
          }
        }
      }
    }
  }
}

TEST_F(CpuTrap, AccessFaultsOfADeviceThatRefuses) {
  cpu.set_reg(rv::a0, 0xD000'0000);
  cpu.set_reg(rv::a1, 0x1234'5678);
  put(kCode, {rv::lw(rv::a1, rv::a0, 8)});
  expect_trap(5, 0xD000'0008, "load");
  EXPECT_EQ(cpu.reg(rv::a1), 0x1234'5678u) << "the register keeps its value";
  jump(kCode);
  put(kCode, {rv::sb(rv::a1, rv::a0, -1)});
  cpu.set_reg(rv::a0, 0xD000'0002);
  expect_trap(7, 0xD000'0001, "store");
}

TEST_F(CpuTrap, AccessFaultsWithoutDevices) {
  Cpu alone;
  std::uint8_t* const memory = alone.map(kCode, 0x1000, {});
  const rv::Word program[] = {rv::lw(1, 0, 64), rv::sw(1, 0, 64)};
  std::memcpy(memory, program, sizeof program);
  alone.reset(kCode);
  EXPECT_EQ(alone.run(1), Cpu::Stop::kLimit);
  EXPECT_EQ(alone.csr(rv::mcause), 5u);
  EXPECT_EQ(alone.csr(rv::mtval), 64u);
  alone.reset(kCode + 4);
  alone.run(alone.cycle() + 1);
  EXPECT_EQ(alone.csr(rv::mcause), 7u);
}

TEST_F(CpuTrap, FetchOutsideMemory) {
  cpu.set_reg(rv::a0, 0x3000'0000);
  execute(rv::jalr(0, rv::a0, 0x10));
  ASSERT_EQ(cpu.pc(), 0x3000'0010u) << "the jump itself retires";
  expect_trap(1, 0x3000'0010, "fetch");
}

TEST_F(CpuTrap, InstructionThatPassesTheEndOfMemory) {
  constexpr std::uint32_t kLast = kCode + kCodeBytes - 2;
  jump(kLast);
  put_half(kLast, static_cast<std::uint16_t>(rv::addi(1, 0, 5)));  // the first half of a full instruction
  expect_trap(1, kLast + 2, "mtval names the half that is missing");
  EXPECT_EQ(csr(rv::mepc), kLast);
  jump(kLast);
  put_half(kLast, 0x4095);  // c.li ra, 5
  step();
  EXPECT_EQ(cpu.reg(1), 5u);
  EXPECT_EQ(cpu.pc(), kLast + 2);
  expect_trap(1, kLast + 2, "running off the end");
}

TEST_F(CpuTrap, EntrySavesStateAndMretBringsItBack) {
  set_csr(rv::mstatus, 0x8);
  EXPECT_EQ(csr(rv::mstatus), 0x1808u);
  jump(kCode + 0x40);
  put(kCode + 0x40, {rv::ecall()});
  step();
  EXPECT_EQ(csr(rv::mstatus), 0x1880u) << "MIE moves to MPIE";
  execute(rv::mret());
  EXPECT_EQ(cpu.pc(), kCode + 0x40) << "mepc is the ecall itself";
  EXPECT_EQ(csr(rv::mstatus), 0x1888u) << "MPIE moves to MIE and becomes 1";
  set_csr(rv::mstatus, 0x8);
  execute(rv::mret());
  EXPECT_EQ(csr(rv::mstatus), 0x1880u) << "MPIE was 0";
}

TEST_F(CpuTrap, ExceptionsIgnoreVectoredMode) {
  set_csr(rv::mtvec, kHandler | 1);
  put(kCode, {rv::ecall()});
  expect_trap(11, 0, "ecall goes to the base");
}

TEST_F(CpuTrap, HooksSeeTrapsReturnsCallsAndReturns) {
  std::vector<std::string> log;
  const auto note = [&](const char* what, std::uint32_t a, std::uint32_t b, Cycle at) {
    log.push_back(std::string(what) + ' ' + std::to_string(a) + ' ' + std::to_string(b - kCode) + ' ' +
                  std::to_string(at - 1000));
  };
  jump(kCode);
  put(kCode, {rv::jal(rv::ra, 0x100), rv::ecall()});               // 0: call, 4: ecall
  put(kCode + 0x100, {rv::jal(0, 8), 0, rv::jalr(0, rv::ra, 0)});  // plain jump, then return
  put(kHandler, {rv::mret()});
  cpu.set_cycle(1000);
  cpu.on_flow = [&](std::uint32_t pc, Cycle at) { note("flow", 0, pc, at); };
  cpu.on_trap = [&](std::uint32_t cause, std::uint32_t pc, Cycle at) { note("trap", cause, pc, at); };
  cpu.on_mret = [&](std::uint32_t pc, Cycle at) { note("mret", 0, pc, at); };
  steps(5);
  // Times: call 2, jump 2, return 2, trap entry 4, mret 4 cycles.
  EXPECT_EQ(log, (std::vector<std::string>{"flow 0 256 2", "flow 0 4 6", "trap 11 4 6", "mret 0 4 14"}));
}

}  // namespace
}  // namespace brick
