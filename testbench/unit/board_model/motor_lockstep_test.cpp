// Both engines under random life on the motor side, every pin and counter compared at every tick by lock-step.
#include <gtest/gtest.h>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class MotorLockstep : public ::testing::TestWithParam<std::uint64_t> {};

constexpr std::uint32_t kTwo = 0x3;

void play_both(MotorTraffic traffic, Tick end) {
  auto board = make_lockstep_board(make_rtl_board(kTwo), make_model_board(kTwo));
  ASSERT_NO_THROW(traffic.run(*board, end, 65'536));
  EXPECT_EQ(board->now(), end);
}

TEST_P(MotorLockstep, TwoIcsAreEqualAtEveryTick) {
  BRICK_COVERS("CARD-6");
  play_both(MotorTraffic(GetParam(), {kTwo, 3'000, 400}), 600'000);
}

TEST_P(MotorLockstep, IsEqualWithClocksThatAreLeftAlone) {
  BRICK_COVERS("CARD-6");
  play_both(MotorTraffic(GetParam(), {kTwo, 20'000, 2'000, false, 0}), 1'500'000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotorLockstep, ::testing::Range<std::uint64_t>(1, 5));

}  // namespace
}  // namespace brick
