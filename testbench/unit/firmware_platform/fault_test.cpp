// A fault of the firmware itself: motors off, restart, and words that tell what happened (docs/firmware.md). The faults
// are planted: a program of the test in unused RAM, to which the CPU is sent.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <vector>

#include "rtl/regs/brick_regs.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/image_board.h"
#include "testbench/unit/firmware_platform/stack_room.h"

namespace brick {
namespace {

constexpr std::uint32_t kPlace = 0x200F0000, kNothing = 0x50000000;
constexpr unsigned kSp = 2, kA1 = 11;
constexpr std::uint32_t kControl = SERVO_IC_0_BASE + SERVO_CHANNEL_X_CONTROL, kFault = 0x70;

struct Planted {
  const char* name;
  std::uint32_t instruction, cause, address;
};
// RISC-V privileged architecture, mcause: 2 illegal instruction, 5 load, 7 store access fault.
constexpr Planted kFaults[] = {{"lw a0,0(a1)", 0x0005A503, 5, kNothing},
                               {"sw a0,0(a1)", 0x00A5A023, 7, kNothing},
                               {"illegal", 0xFFFFFFFF, 2, 0xFFFFFFFF}};

class Fault : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void plant(const Planted& fault) {
    std::memcpy(board.cpu().memory(kPlace, 4), &fault.instruction, 4);
    board.cpu().invalidate_code();
    board.cpu().set_reg(kA1, kNothing);
    board.cpu().set_pc(kPlace);
  }
  bool phase_may_come() {
    constexpr unsigned kMstatus = 0x300, kMie = 0x304, kEnabled = 3;
    const auto is_on = [this](unsigned csr, unsigned bit) { return (board.cpu().csr(csr) >> bit & 1) != 0; };
    return is_on(kMstatus, kEnabled) && is_on(kMie, kIrqPhase);
  }
  std::string ask(const std::string& line) {
    const std::string reply = board.send(line + "\r");
    return reply.substr(0, reply.find('\r'));
  }
  std::uint32_t long_word(std::uint32_t address) {
    return board.word(true, address) << 24 | board.word(false, address);
  }
  ImageBoard board{firmware_image(), 0x3};
};

TEST_F(Fault, TurnsOutputsOffAndRestartsAndTells) {
  unsigned count = 0;
  EXPECT_EQ(ask("RHX$70"), "0");
  for (const Planted& fault : kFaults) {
    SCOPED_TRACE(fault.name);
    ASSERT_EQ(board.send("P1=5 WX$78005,$4000 WY$78002,1000,1000,1000 WY$7811A,1000\r"), "\x06");
    ASSERT_EQ(board.word(true, kControl) & SERVO_CHANNEL_CONTROL_AENA_MASK, SERVO_CHANNEL_CONTROL_AENA_MASK);
    board.run_ms(1.0);
    plant(fault);
    board.run_ms(0.2);
    EXPECT_EQ(board.word(true, kControl) & SERVO_CHANNEL_CONTROL_AENA_MASK, 0u);
    for (const std::uint32_t output : {0x78002u, 0x78003u, 0x78004u, 0x7811Au})
      EXPECT_EQ(board.word(false, output), 0u);
    board.run_ms(30.0);
    EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
    EXPECT_EQ(ask("P1"), "0") << "a restart, as $$$";
    EXPECT_EQ(board.word(true, kFault), fault.cause);
    EXPECT_EQ(board.word(false, kFault), ++count);
    EXPECT_EQ(long_word(kFault + 1), kPlace);
    EXPECT_EQ(long_word(kFault + 2), fault.address);
    EXPECT_EQ(ask("RHX$70"), std::to_string(fault.cause));
  }
  board.reset();
  EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  EXPECT_EQ(ask("RY$70"), std::to_string(count)) << "the reset line keeps it";
}

// All 22 ICs, every channel with its amplifier enabled, EQU high and a command in each output: when the restart's first
// instruction is reached all have been turned off, not by what the start writes later. One IC is not there.
TEST(FaultOfAllIcs, TurnsOffEveryOutputBeforeTheRestart) {
  constexpr std::uint32_t kBases[] = GATE_IC_BASES;
  constexpr unsigned kMissing = 5, kServoIcs = 18;
  constexpr std::uint32_t kOn = SERVO_CHANNEL_CONTROL_AENA_MASK, kCommand = 0x123400;
  ImageBoard board{firmware_image(), 0x3FFFFF & ~(1u << kMissing)};
  ASSERT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  const auto write = [&](char space, std::uint32_t address, std::uint32_t value) {
    char line[40];
    std::snprintf(line, sizeof line, "W%c$%X,$%X\r", space, address, value);
    ASSERT_EQ(board.send(line), "\x06") << line;
  };
  struct Word {
    bool x;
    std::uint32_t address;
  };
  std::vector<Word> controls, commands;
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic)
    for (std::uint32_t channel = 0; channel < (ic < kServoIcs ? 4u : 2u); ++channel) {
      const std::uint32_t base = kBases[ic] + 8 * channel;
      controls.push_back({true, base + (ic < kServoIcs ? SERVO_CHANNEL_X_CONTROL : MACRO_IC_X_SUPPLEMENTARY_1)});
      if (ic == kMissing) controls.pop_back();
      if (ic == kMissing || ic >= kServoIcs) continue;
      for (const std::uint32_t out : {SERVO_CHANNEL_Y_OUT_A, SERVO_CHANNEL_Y_OUT_B, SERVO_CHANNEL_Y_OUT_C})
        commands.push_back({false, base + out});
    }
  ASSERT_EQ(controls.size(), 17u * 4 + 4 * 2);
  for (const Word& w : controls) write('X', w.address, kOn);
  for (const Word& w : commands) write('Y', w.address, kCommand);
  write('X', BOARD_LATCHES_X_CONTROL_OUTPUTS, 3);
  for (const Word& w : controls) ASSERT_EQ(board.word(w.x, w.address), kOn) << std::hex << w.address;
  for (const Word& w : commands) ASSERT_EQ(board.word(w.x, w.address), kCommand) << std::hex << w.address;

  std::memcpy(board.cpu().memory(kPlace, 4), &kFaults[0].instruction, 4);
  board.cpu().invalidate_code();
  board.cpu().set_reg(kA1, kNothing);
  board.cpu().set_pc(kPlace);
  const std::uint32_t start = ElfFile(firmware_image()).entry();
  bool judged = false;
  board.on_instruction = [&] {
    if (judged || board.cpu().pc() != start) return;
    judged = true;
    for (const Word& w : controls) {
      const std::uint32_t word = board.word(w.x, w.address);
      EXPECT_EQ(word & (SERVO_CHANNEL_CONTROL_AENA_MASK | SERVO_CHANNEL_CONTROL_EQU_STATE_MASK), 0u)
          << std::hex << w.address;
      const bool servo = (w.address & 7) == SERVO_CHANNEL_X_CONTROL && (w.address & 0x400) == 0;
      if (servo) {
        EXPECT_NE(word & SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK, 0u) << "EQU is made low, " << std::hex << w.address;
      }
    }
    for (const Word& w : commands) EXPECT_EQ(board.word(w.x, w.address), 0u) << std::hex << w.address;
    EXPECT_EQ(board.word(true, BOARD_LATCHES_X_CONTROL_OUTPUTS), 0u);
  };
  board.run_ms(5.0);
  EXPECT_TRUE(judged);
}

// A word of a guard is written: found by the next real-time task. Cause 3 is the breakpoint instruction, which the
// image has for that alone.
TEST_F(Fault, AStackThatHasUsedItsGuardIsOne) {
  const ElfFile elf(firmware_image());
  unsigned count = 0;
  for (const char* bottom : {"__stack_bottom", "__side_stack_bottom"}) {
    SCOPED_TRACE(bottom);
    ASSERT_EQ(board.send("P1=5 WX$78005,$4000 WY$78002,1000\r"), "\x06");
    std::memset(board.cpu().memory(elf.symbol(bottom).value(), 4), 0, 4);
    board.run_ms(2.0);
    EXPECT_EQ(board.word(false, 0x78002), 0u) << "outputs off";
    board.run_ms(30.0);
    EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
    EXPECT_EQ(ask("P1"), "0");
    EXPECT_EQ(board.word(true, kFault), 3u);
    EXPECT_EQ(board.word(false, kFault), ++count);
  }
}

// Below the stack of slices there is no memory. With the stack pointer there nothing can be kept: neither what is
// stored through it nor what an interrupt would save; the fault has another stack.
TEST_F(Fault, BelowTheStackOfSlicesIsOneAtOnce) {
  const ElfFile elf(firmware_image());
  const std::uint32_t bottom = elf.symbol("__side_stack_bottom").value();
  ASSERT_EQ(bottom, 0x20000000u);
  const struct {
    Planted planted;
    std::uint32_t sp;
    unsigned below; /* the access, at most */
  } cases[] = {{{"sw a0,0(sp)", 0x00A12023, 7, bottom - 4}, bottom - 4, 4},
               {{"j . until an interrupt saves registers", 0x0000006F, 7, 0}, bottom, 80}};
  unsigned count = 0;
  for (const auto& [planted, sp, below] : cases) {
    SCOPED_TRACE(planted.name);
    ASSERT_EQ(board.send("P1=5 WX$78005,$4000 WY$78002,1000\r"), "\x06");
    while (!phase_may_come()) board.run_ms(0.0005);
    plant(planted);
    board.cpu().set_reg(kSp, sp);
    board.run_ms(1.0);
    EXPECT_EQ(board.word(false, 0x78002), 0u) << "outputs off";
    board.run_ms(30.0);
    EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
    EXPECT_EQ(ask("P1"), "0") << "a restart";
    EXPECT_EQ(board.word(true, kFault), planted.cause);
    EXPECT_EQ(board.word(false, kFault), ++count);
    EXPECT_LT(long_word(kFault + 2), bottom);
    EXPECT_GE(long_word(kFault + 2), bottom - below);
  }
}

TEST_F(Fault, AgainWhileItStartsLeavesTheRestToTheWatchdog) {
  plant(kFaults[0]);
  board.run_ms(1.0);
  plant(kFaults[1]);
  board.run_ms(1.0);
  const auto strobes = board.strobes();
  board.run_ms(50.0);
  EXPECT_EQ(board.strobes(), strobes);
  board.reset();
  EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  EXPECT_EQ(board.word(true, kFault), kFaults[0].cause) << "the first one is the cause";
}

}  // namespace
}  // namespace brick
