// The cost table of docs/cpu.md, the meaning of a run's limit, and that cutting a run into pieces changes nothing.
#include <algorithm>
#include <cstring>
#include <memory>

#include "systemc/cpu/elf_file.h"
#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

class CpuTiming : public CpuBench {};

TEST_F(CpuTiming, InstructionsCostWhatTheTableSays) {
  set_csr(rv::mtvec, kCode + 0x3000);
  const auto cost = [&](rv::Word w, std::uint32_t a = 0, std::uint32_t b = 0) {
    jump(kCode + 0x800);
    cpu.set_reg(rv::a0, a);
    cpu.set_reg(rv::a1, b);
    return execute(w);
  };
  for (unsigned f3 = 0; f3 < 8; ++f3) {
    EXPECT_EQ(cost(rv::r(0, f3, rv::a2, rv::a0, rv::a1), 5, 3), 1) << "arithmetic " << f3;
    EXPECT_EQ(cost(rv::r(0, f3, rv::a2, rv::a0, 3, 0x13), 5), 1) << "immediate arithmetic " << f3;
  }
  EXPECT_EQ(cost(rv::lui(rv::a2, 1)), 1);
  EXPECT_EQ(cost(rv::auipc(rv::a2, 1)), 1);
  EXPECT_EQ(cost(rv::fence()), 1);
  for (const auto op : {rv::lb, rv::lh, rv::lw, rv::lbu, rv::lhu})
    EXPECT_EQ(cost(op(rv::a2, rv::a0, 0), kData), 2) << "load";
  for (const auto op : {rv::sb, rv::sh, rv::sw}) EXPECT_EQ(cost(op(rv::a2, rv::a0, 0), kData), 1) << "store";
  EXPECT_EQ(cost(rv::beq(rv::a0, rv::a1, 8), 1, 2), 1) << "branch not taken";
  EXPECT_EQ(cost(rv::beq(rv::a0, rv::a1, 8), 2, 2), 2) << "branch taken";
  EXPECT_EQ(cost(rv::beq(rv::a0, rv::a1, 0x7F0), 2, 2), 2) << "the same, to another page";
  EXPECT_EQ(cost(rv::beq(rv::a0, rv::a1, 0x800), 2, 2), 2) << "the same, to another page";
  EXPECT_EQ(cost(rv::jal(rv::ra, 8)), 2);
  EXPECT_EQ(cost(rv::jal(0, 0x1000)), 2);
  EXPECT_EQ(cost(rv::jalr(rv::ra, rv::a0, 0), kCode), 2);
  EXPECT_EQ(cost(rv::r(1, 0, rv::a2, rv::a0, rv::a1), 5, 3), 2) << "mul";
  for (unsigned f3 = 1; f3 < 4; ++f3) EXPECT_EQ(cost(rv::r(1, f3, rv::a2, rv::a0, rv::a1), 5, 3), 3) << "high product";
  for (unsigned f3 = 4; f3 < 8; ++f3) {
    EXPECT_EQ(cost(rv::r(1, f3, rv::a2, rv::a0, rv::a1), 5, 3), 20) << "division";
    EXPECT_EQ(cost(rv::r(1, f3, rv::a2, rv::a0, rv::a1), 5, 0), 20) << "division by zero takes no less";
  }
  EXPECT_EQ(cost(rv::csrrs(rv::a2, rv::mscratch, 0)), 2);
  EXPECT_EQ(cost(rv::fence_i()), 4);
  set_csr(rv::mepc, kCode);
  EXPECT_EQ(cost(rv::mret()), 4);
  EXPECT_EQ(cost(rv::ecall()), 4) << "trap entry";
  EXPECT_EQ(cost(0xFFFF'FFFF), 4) << "trap entry";
  EXPECT_EQ(cost(rv::lw(rv::a2, rv::a0, 0), kData + 1), 4) << "trap entry";
  EXPECT_EQ(cost(rv::wfi()), 1);
}

TEST_F(CpuTiming, CompressedFormsCostTheSame) {
  put_half(kCode, 0x0505);  // c.addi a0, 1
  EXPECT_EQ(cpu.cycle(), 0);
  step();
  EXPECT_EQ(cpu.cycle(), 1);
  put_half(kCode + 2, 0xA011);  // c.j +4
  step();
  EXPECT_EQ(cpu.pc(), kCode + 6);
  EXPECT_EQ(cpu.cycle(), 3);
}

TEST_F(CpuTiming, NoInstructionStartsAtOrAfterTheLimit) {
  put(kCode, {rv::nop(), rv::r(1, 4, rv::a0, rv::a1, rv::a2), rv::nop(), rv::nop()});
  EXPECT_EQ(cpu.run(0), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.pc(), kCode);
  EXPECT_EQ(cpu.run(-5), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.pc(), kCode);
  cpu.run(1);
  EXPECT_EQ(cpu.pc(), kCode + 4);
  cpu.run(2);
  EXPECT_EQ(cpu.pc(), kCode + 8);
  EXPECT_EQ(cpu.cycle(), 21) << "an instruction that has begun is finished";
  cpu.run(21);
  EXPECT_EQ(cpu.pc(), kCode + 8);
  cpu.run(23);
  EXPECT_EQ(cpu.pc(), kCode + 16);
}

TEST_F(CpuTiming, InterruptAtTheLimitWaitsForTheNextRun) {
  set_csr(rv::mtvec, kCode + 0x1000);
  set_csr(rv::mie, 1u << kIrqPhase);
  set_csr(rv::mstatus, 8);
  cpu.set_interrupt(kIrqPhase, true);
  const Cycle now = cpu.cycle();
  EXPECT_EQ(cpu.run(now), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.pc(), kCode);
  cpu.run(now + 1);
  EXPECT_EQ(cpu.pc(), kCode + 0x1000);
}

// The interrupted program under phase interrupts every 997 cycles and servo interrupts 60 cycles before each fourth of
// them.
struct Recorder : DeviceBus {
  Result access(std::uint32_t address, unsigned, bool write, std::uint32_t data, Cycle now) override {
    checksum = checksum * 31 + address + data + static_cast<std::uint64_t>(now) + (write ? 1 : 0);
    ++count;
    return {false, static_cast<std::uint32_t>(now) * 7, now + 13 + static_cast<Cycle>(count % 3)};
  }
  std::uint64_t checksum = 0;
  int count = 0;
};

struct Outcome {
  std::vector<std::uint64_t> state;
  std::uint32_t phases, servos, real_times, sleeps;
  int nested = 0;
};

Outcome run_in_pieces(Cycle piece) {
  Recorder device;
  Cpu cpu(&device);
  const ElfFile elf(BRICK_CPU_PROGRAMS "interrupted.elf");
  const std::uint8_t* const memory = cpu.map(0x8000'0000, 0x10000, {});
  elf.load(cpu);
  cpu.reset(elf.entry());
  cpu.watch_store(*elf.symbol("tohost"));
  cpu.on_store_watch = [](std::uint32_t, std::uint32_t) { return true; };
  Outcome o;
  cpu.on_trap = [&](std::uint32_t, std::uint32_t pc, Cycle) { o.nested += elf.symbol_at(pc) == "handler" ? 1 : 0; };
  Cycle next_phase = 2000, next_servo = 2000 + 997 - 60;
  for (int guard = 0; guard < 10'000'000; ++guard) {
    const Cycle event = std::min(next_phase, next_servo);
    const Cpu::Stop stop = cpu.run(std::min(cpu.cycle() + piece, event));
    if (stop == Cpu::Stop::kHalt) break;
    if (stop == Cpu::Stop::kSleep && cpu.cycle() < event) cpu.set_cycle(event);
    if (cpu.cycle() < event) continue;
    cpu.set_interrupt(event == next_phase ? kIrqPhase : kIrqServo, true);
    (event == next_phase ? next_phase += 997 : next_servo += 4 * 997);
  }
  for (unsigned r = 0; r < 32; ++r) o.state.push_back(cpu.reg(r));
  for (const unsigned n : {rv::mstatus, rv::mepc, rv::mcause, rv::mip, rv::mie}) o.state.push_back(cpu.csr(n));
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < 0x10000; ++n) sum = sum * 1099511628211u + memory[n];
  for (const std::uint64_t v :
       {std::uint64_t{cpu.pc()}, static_cast<std::uint64_t>(cpu.cycle()), cpu.instructions(), sum, device.checksum}) {
    o.state.push_back(v);
  }
  const std::uint8_t* const results = cpu.memory(*elf.symbol("results"), 32);
  std::memcpy(&o.phases, results + 4, 16);
  return o;
}

TEST(CpuPieces, AnyPieceSizeGivesTheSameStateAndTime) {
  const Outcome whole = run_in_pieces(1'000'000'000);
  EXPECT_GE(whole.phases, 40u);
  EXPECT_LT(whole.phases, 50u);
  EXPECT_GT(whole.nested, 3) << "phase interrupts the servo handler";
  EXPECT_GE(whole.servos, 9u);
  EXPECT_EQ(whole.real_times, whole.servos) << "each servo interrupt raises one";
  EXPECT_GT(whole.sleeps, 3u);
  for (const Cycle piece : {1, 2, 3, 7, 19, 100, 1001, 12345}) {
    EXPECT_EQ(run_in_pieces(piece).state, whole.state) << "pieces of " << piece << " cycles";
  }
}

}  // namespace
}  // namespace brick
