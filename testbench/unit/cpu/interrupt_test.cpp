// Interrupt lines: enabling, priority, vectors, nesting by masks, latches and the level, and sleep.
#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

constexpr std::uint32_t kHandler = kCode + 0x1000;
constexpr std::uint32_t bit(unsigned n) { return 1u << n; }
constexpr std::uint32_t kAll = bit(kIrqPhase) | bit(kIrqServo) | bit(kIrqHostPort) | bit(kIrqRealTime);

class CpuInterrupts : public CpuBench {
 protected:
  CpuInterrupts() {
    set_csr(rv::mtvec, kHandler);
    put(kCode, std::vector<rv::Word>(64, rv::nop()));
    put(kHandler, std::vector<rv::Word>(64, rv::nop()));
  }
  void enable(std::uint32_t lines) {
    set_csr(rv::mie, lines);
    set_csr(rv::mstatus, 8);
  }
};

TEST_F(CpuInterrupts, TakenAtTheNextBoundaryWhenEnabled) {
  enable(bit(kIrqServo));
  steps(3);
  const Cycle before = cpu.cycle();
  const std::uint64_t retired = cpu.instructions();
  cpu.set_interrupt(kIrqServo, true);
  EXPECT_EQ(cpu.pc(), kCode + 12) << "nothing moves before run()";
  step();
  EXPECT_EQ(cpu.pc(), kHandler);
  EXPECT_EQ(csr(rv::mcause), 0x8000'0011u);
  EXPECT_EQ(csr(rv::mepc), kCode + 12);
  EXPECT_EQ(csr(rv::mtval), 0u);
  EXPECT_EQ(csr(rv::mstatus), 0x1880u);
  EXPECT_EQ(cpu.cycle() - before, 4) << "trap entry";
  EXPECT_EQ(cpu.instructions(), retired);
}

TEST_F(CpuInterrupts, HeldOffByMieAndByMstatus) {
  set_csr(rv::mie, bit(kIrqServo));
  put(kCode, {rv::nop(), rv::nop(), rv::csrrsi(0, rv::mstatus, 8), rv::nop()});
  cpu.set_interrupt(kIrqPhase, true);
  cpu.set_interrupt(kIrqServo, true);
  steps(3);
  EXPECT_EQ(cpu.pc(), kCode + 12) << "mstatus.MIE was off";
  step();
  EXPECT_EQ(csr(rv::mcause), 0x8000'0011u) << "phase is not enabled, servo is";
  EXPECT_EQ(csr(rv::mepc), kCode + 12) << "right after the instruction that set MIE";
}

TEST_F(CpuInterrupts, WritingMieOrMipTakesEffectAtTheNextInstruction) {
  set_csr(rv::mstatus, 8);
  cpu.set_reg(rv::a0, bit(kIrqRealTime));
  put(kCode, {rv::csrrs(0, rv::mip, rv::a0), rv::csrrs(0, rv::mie, rv::a0), rv::nop()});
  cpu.run(cpu.cycle() + 5);  // csr 2, csr 2, then the trap
  EXPECT_EQ(cpu.pc(), kHandler);
  EXPECT_EQ(csr(rv::mcause), 0x8000'0013u);
  EXPECT_EQ(csr(rv::mepc), kCode + 8);
}

TEST_F(CpuInterrupts, PriorityIsHostPortPhaseServoRealTime) {
  enable(kAll);
  for (const CpuInterrupt line : {kIrqRealTime, kIrqServo, kIrqPhase, kIrqHostPort}) cpu.set_interrupt(line, true);
  for (const CpuInterrupt line : {kIrqHostPort, kIrqPhase, kIrqServo, kIrqRealTime}) {
    step();
    EXPECT_EQ(csr(rv::mcause), 0x8000'0000u | line);
    cpu.set_interrupt(line, false);
    execute(rv::csrrsi(0, rv::mstatus, 8));
  }
}

TEST_F(CpuInterrupts, VectoredModeAddsFourTimesTheNumber) {
  set_csr(rv::mtvec, kHandler | 1);
  enable(kAll);
  for (const CpuInterrupt line : {kIrqPhase, kIrqServo, kIrqHostPort, kIrqRealTime}) {
    cpu.set_interrupt(line, true);
    step();
    EXPECT_EQ(cpu.pc(), kHandler + 4 * line);
    cpu.set_interrupt(line, false);
    execute(rv::csrrsi(0, rv::mstatus, 8));
  }
}

TEST_F(CpuInterrupts, LatchesAreClearedBySoftwareAndTheLevelIsNot) {
  for (const CpuInterrupt line : {kIrqPhase, kIrqServo, kIrqHostPort, kIrqRealTime}) cpu.set_interrupt(line, true);
  EXPECT_EQ(csr(rv::mip), kAll);
  cpu.set_reg(rv::a0, kAll);
  execute(rv::csrrc(0, rv::mip, rv::a0));
  EXPECT_EQ(csr(rv::mip), bit(kIrqHostPort));
  cpu.set_interrupt(kIrqHostPort, false);
  EXPECT_EQ(csr(rv::mip), 0u);
  execute(rv::csrrs(0, rv::mip, rv::a0));
  EXPECT_EQ(csr(rv::mip), kAll & ~bit(kIrqHostPort));
  set_csr(rv::mip, ~0u);
  EXPECT_EQ(csr(rv::mip), kAll & ~bit(kIrqHostPort)) << "other bits do not exist";
  set_csr(rv::mie, ~0u);
  EXPECT_EQ(csr(rv::mie), kAll);
}

TEST_F(CpuInterrupts, NestByMask) {
  // Servo handler: saves mepc, lets phase in, is interrupted by it, comes back and returns to the background.
  const std::uint32_t phase_handler = kCode + 0x2000;
  set_csr(rv::mtvec, kHandler | 1);
  put(kHandler + 4 * kIrqServo, {rv::jal(0, 0x200)});
  put(kHandler + 4 * kIrqPhase, {rv::jal(0, static_cast<int>(phase_handler - (kHandler + 4 * kIrqPhase)))});
  cpu.set_reg(rv::s0, bit(kIrqPhase));
  cpu.set_reg(rv::s1, bit(kIrqServo));
  const std::uint32_t body = kHandler + 4 * kIrqServo + 0x200;
  put(body, {rv::csrrs(rv::a0, rv::mepc, 0), rv::csrrc(0, rv::mip, rv::s1), rv::csrrc(0, rv::mie, rv::s1),
             rv::csrrsi(0, rv::mstatus, 8), rv::nop(), rv::nop(), rv::addi(rv::a3, rv::a3, 1),
             rv::csrrci(0, rv::mstatus, 8), rv::csrrs(0, rv::mie, rv::s1), rv::csrrw(0, rv::mepc, rv::a0), rv::mret()});
  put(phase_handler, {rv::csrrc(0, rv::mip, rv::s0), rv::addi(rv::a4, rv::a4, 1), rv::mret()});
  enable(bit(kIrqPhase) | bit(kIrqServo));

  std::vector<std::pair<std::uint32_t, std::uint32_t>> traps;
  cpu.on_trap = [&](std::uint32_t cause, std::uint32_t pc, Cycle) { traps.emplace_back(cause & 0xFF, pc); };
  cpu.set_interrupt(kIrqServo, true);
  while (cpu.pc() != body + 20) step();  // in the servo handler, behind the first nop
  cpu.set_interrupt(kIrqServo, true);    // a further servo interrupt has to wait
  cpu.set_interrupt(kIrqPhase, true);    // phase has not
  while (cpu.reg(rv::a3) == 0) step();
  EXPECT_EQ(cpu.reg(rv::a4), 1u) << "the phase handler ran inside";
  while (cpu.reg(rv::a3) == 1) step();  // the waiting servo interrupt follows after the return
  ASSERT_EQ(traps.size(), 3u);
  EXPECT_EQ(traps[0], std::make_pair(std::uint32_t{kIrqServo}, kCode));
  EXPECT_EQ(traps[1], std::make_pair(std::uint32_t{kIrqPhase}, body + 20));
  EXPECT_EQ(traps[2], std::make_pair(std::uint32_t{kIrqServo}, kCode)) << "right after mret";
}

// Sleep --------------------------------------------------------------------------------------------------------------

TEST_F(CpuInterrupts, WfiSleepsUntilAnEnabledLineRises) {
  set_csr(rv::mie, bit(kIrqPhase));
  put(kCode, {rv::wfi(), rv::addi(rv::a0, 0, 7)});
  const Cycle before = cpu.cycle();
  EXPECT_EQ(cpu.run(before + 1000), Cpu::Stop::kSleep);
  EXPECT_TRUE(cpu.asleep());
  EXPECT_EQ(cpu.cycle(), before + 1);
  EXPECT_EQ(cpu.run(before + 1000), Cpu::Stop::kSleep) << "still";
  EXPECT_EQ(cpu.cycle(), before + 1);
  cpu.set_interrupt(kIrqServo, true);
  EXPECT_TRUE(cpu.asleep()) << "servo is not enabled in mie";
  cpu.set_interrupt(kIrqPhase, true);
  EXPECT_FALSE(cpu.asleep()) << "mstatus.MIE does not matter";
  cpu.set_cycle(before + 500);
  EXPECT_EQ(cpu.run(before + 501), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.reg(rv::a0), 7u) << "goes on behind wfi, no trap with MIE off";
  EXPECT_EQ(cpu.cycle(), before + 501);
}

TEST_F(CpuInterrupts, WakesIntoTheHandlerWhenMieIsOn) {
  enable(bit(kIrqHostPort));
  put(kCode, {rv::wfi(), rv::nop()});
  EXPECT_EQ(cpu.run(cpu.cycle() + 100), Cpu::Stop::kSleep);
  cpu.set_interrupt(kIrqHostPort, true);
  step();
  EXPECT_EQ(cpu.pc(), kHandler);
  EXPECT_EQ(csr(rv::mepc), kCode + 4) << "behind wfi";
}

TEST_F(CpuInterrupts, WfiDoesNothingWhenSomethingIsPending) {
  set_csr(rv::mie, bit(kIrqPhase));
  put(kCode, {rv::wfi(), rv::addi(rv::a0, 0, 7)});
  cpu.set_interrupt(kIrqPhase, true);
  EXPECT_EQ(cpu.run(cpu.cycle() + 2), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.reg(rv::a0), 7u);
  EXPECT_FALSE(cpu.asleep());
}

TEST_F(CpuInterrupts, ResetWakesAndTurnsInterruptsOff) {
  enable(kAll);
  put(kCode, {rv::wfi()});
  cpu.run(cpu.cycle() + 10);
  const Cycle now = cpu.cycle();
  cpu.reset(kCode + 0x80);
  EXPECT_FALSE(cpu.asleep());
  EXPECT_EQ(cpu.pc(), kCode + 0x80);
  EXPECT_EQ(csr(rv::mie), 0u);
  EXPECT_EQ(csr(rv::mstatus), 0x1800u);
  EXPECT_EQ(cpu.cycle(), now) << "local time goes on";
  EXPECT_EQ(csr(rv::mcycle), 0u) << "the counter starts again";
}

TEST_F(CpuInterrupts, NoInterruptComesBetweenADeviceAccessAndItsAnswer) {
  enable(bit(kIrqPhase));
  put(kCode, {rv::lw(rv::a0, rv::a1, 0), rv::nop()});
  cpu.set_reg(rv::a1, kDevice);
  device.retries = 2;
  const Cycle before = cpu.cycle();
  const std::uint64_t retired = cpu.instructions();
  EXPECT_EQ(cpu.run(before + 100), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.pc(), kCode);
  EXPECT_EQ(cpu.instructions(), retired);
  cpu.set_interrupt(kIrqPhase, true);
  EXPECT_EQ(cpu.run(before + 100), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.run(before + 100), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.reg(rv::a0), device.answer);
  EXPECT_EQ(cpu.pc(), kCode + 4);
  EXPECT_EQ(cpu.instructions(), retired + 1);
  ASSERT_EQ(device.accesses.size(), 3u);
  EXPECT_EQ(device.accesses[2].now, before);
  step();
  EXPECT_EQ(csr(rv::mepc), kCode + 4);
  EXPECT_EQ(csr(rv::mcause), 0x8000'0010u);
}

}  // namespace
}  // namespace brick
