// The CPU model alone: a hand-assembled checksum loop over RAM, the mix that firmware has.
#include <cstring>

#include "systemc/cpu/cpu.h"
#include "testbench/benchmark/benchmark.h"

namespace brick {

namespace {
// a0 address, a1 end, a2 sum; eight instructions a word, then from the start again.
constexpr std::uint32_t kProgram[] = {
    0x20000537,  // lui   a0, 0x20000
    0x200015B7,  // lui   a1, 0x20001
    0x00052283,  // lw    t0, 0(a0)
    0x00560633,  // add   a2, a2, t0
    0x00361313,  // slli  t1, a2, 3
    0x00664633,  // xor   a2, a2, t1
    0x01D65313,  // srli  t1, a2, 29
    0x00C52023,  // sw    a2, 0(a0)
    0x00450513,  // addi  a0, a0, 4
    0xFEB542E3,  // blt   a0, a1, -28
    0xFD9FF06F,  // jal   zero, -40
};
constexpr std::uint32_t kCode = 0x1000'0000, kRam = 0x2000'0000;
}  // namespace

std::uint64_t run_cpu_alone(std::uint64_t instructions) {
  Cpu cpu;
  std::memcpy(cpu.map(kCode, 4096, {true, false, 0}), kProgram, sizeof kProgram);
  cpu.map(kRam, 4096, {});
  cpu.reset(kCode);
  while (cpu.instructions() < instructions)
    cpu.run(cpu.cycle() + static_cast<Cycle>(instructions - cpu.instructions()));
  return cpu.instructions();
}

}  // namespace brick
