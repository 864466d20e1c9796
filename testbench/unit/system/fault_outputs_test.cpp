// What a user's machine sees of a fault of the firmware: the pins of every servo IC go off at once (firmware:8.4/9).
// What the image writes, and when, is in testbench/unit/firmware_platform/fault_test.cpp.
#include <cstring>

#include "systemc/machine/board_file.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr std::uint32_t kPlace = 0x200F0000, kIllegal = 0xFFFFFFFF;  // unused RAM of the CPU

class FaultOutputs : public Controller {
 protected:
  void start_board(const std::string& name) {
    MachineConfig config;
    config.board = read_board_file("boards/" + name + ".toml");
    start(config);
  }
  // Servo ICs with a channel whose AENA or EQU shows `level`.
  std::uint32_t ics(bool level) {
    std::uint32_t found = 0;
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      for (unsigned n = 0; n < kChannels; ++n)
        for (const MotorField& pin : {motor_pin::kAena, motor_pin::kEqu})
          if ((machine().motor_outputs(ic).get(pin, n) != 0) == level) found |= 1u << ic;
    return found;
  }
};

TEST_P(FaultOutputs, OfEveryServoIcGoOff) {
  start_board("all-ics");
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    for (unsigned n = 0; n < kChannels; ++n) {
      char line[64];  // AENA, EQU by hand
      std::snprintf(line, sizeof line, "WX$%X,$5800", regs::kGateIcs[ic].base + 8 * n + 5);
      ASSERT_EQ(ask(line), "");
    }
  ask("WX$70012,3");
  ASSERT_EQ(ics(false), 0u);
  ASSERT_EQ(machine().outputs().get(pin::kCtrl0) + machine().outputs().get(pin::kCtrl1), 2u);

  std::memcpy(machine().cpu().memory(kPlace, 4), &kIllegal, 4);
  machine().cpu().invalidate_code();
  machine().cpu().set_pc(kPlace);
  wait(ms_to_ticks(1));  // a servo period until the CPU is awake, and what turns them off
  EXPECT_EQ(ics(true), 0u);
  EXPECT_EQ(machine().outputs().get(pin::kCtrl0) + machine().outputs().get(pin::kCtrl1), 0u);
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(100))) << "it starts anew";
  EXPECT_EQ(ask("RX$70"), "2");
  EXPECT_THAT(machine().take_run_errors(), ::testing::ElementsAre(::testing::HasSubstr(
                                               "illegal instruction 0xffffffff, pc 0x200f0000, return address 0x1")));
  EXPECT_EQ(ics(true), 0u);
}

BRICK_ON_ENGINES(FaultOutputs, Engine::kSystemC);

}  // namespace
}  // namespace brick
