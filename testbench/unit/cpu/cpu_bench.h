// A CPU with a little memory and a recording device, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "systemc/cpu/cpu.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/cpu/assembler.h"

namespace brick {

constexpr std::uint32_t kCode = 0x1000'0000, kData = 0x2000'0000, kDevice = 0xC03C'0000;
constexpr std::uint32_t kCodeBytes = 0x4000, kDataBytes = 0x4000;

// Answers reads with `answer`, takes `duration` cycles, refuses addresses from 0xD0000000 on.
class RecordingDevice : public DeviceBus {
 public:
  struct Access {
    std::uint32_t address;
    unsigned bytes;
    bool write;
    std::uint32_t data;
    Cycle now;
  };
  Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) override {
    accesses.push_back({address, bytes, write, data, now});
    if (retries > 0) {
      --retries;
      return {false, 0, now, true};
    }
    return {address >= 0xD000'0000, answer, now + duration, false};
  }
  std::vector<Access> accesses;
  std::uint32_t answer = 0x89ABCDEF;
  Cycle duration = 10;
  int retries = 0;
};

class CpuBench : public ::testing::Test {
 protected:
  CpuBench() : cpu(&device) {
    cpu.map(kCode, kCodeBytes, {});
    cpu.map(kData, kDataBytes, {});
    cpu.reset(kCode);
  }

  void put(std::uint32_t address, const std::vector<rv::Word>& program) {
    std::memcpy(cpu.memory(address, static_cast<std::uint32_t>(4 * program.size())), program.data(),
                4 * program.size());
    cpu.invalidate_code();
  }
  void put_half(std::uint32_t address, std::uint16_t h) {
    std::memcpy(cpu.memory(address, 2), &h, 2);
    cpu.invalidate_code();
  }
  std::uint32_t word(std::uint32_t address) {
    std::uint32_t v = 0;
    std::memcpy(&v, cpu.memory(address, 4), 4);
    return v;
  }
  void set_word(std::uint32_t address, std::uint32_t v) { std::memcpy(cpu.memory(address, 4), &v, 4); }

  // Exactly one instruction, or one trap.
  Cpu::Stop step() { return cpu.run(cpu.cycle() + 1); }
  void steps(int n) {
    while (n-- > 0) step();
  }
  // Runs one instruction placed at the program counter's present place; returns the cycles it took.
  Cycle execute(rv::Word instruction) {
    put(cpu.pc(), {instruction});
    const Cycle before = cpu.cycle();
    step();
    return cpu.cycle() - before;
  }
  std::uint32_t csr(unsigned n) const { return cpu.csr(n); }
  // These two run an instruction of their own and leave memory as it was.
  void set_csr(unsigned n, std::uint32_t v) { aside(31, v, rv::csrrw(0, n, 31), true); }
  void jump(std::uint32_t pc) { aside(30, pc, rv::jalr(0, 30, 0), false); }

 private:
  void aside(unsigned helper, std::uint32_t v, rv::Word instruction, bool come_back) {
    const std::uint32_t pc = cpu.pc(), code = word(pc), old = cpu.reg(helper);
    cpu.set_reg(helper, v);
    execute(instruction);
    cpu.set_reg(helper, old);
    put(pc, {code});
    if (come_back) jump(pc);
  }

 protected:
  RecordingDevice device;
  Cpu cpu;
};

}  // namespace brick
