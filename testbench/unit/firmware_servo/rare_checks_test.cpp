// Motors are looked at in time where real-time interrupts are rare, natively: motion:6.6/1, motion:6.6/5. A servo
// interrupt is 0.44 ms: four of them and the pass behind are within 2 ms.
#include <functional>
#include <string>

#include "testbench/unit/firmware_servo/protection_rig.h"

namespace brick {
namespace {

class RareChecks : public ProtectionRig, public ::testing::WithParamInterface<int> {
 protected:
  static constexpr unsigned kMost = 4;
  RareChecks() {
    for (const char* motor : {"1", "2", "5"}) {
      const std::string i = std::string("I") + motor;
      c_.line(i + "11=0 " + i + "15=100 " + i + "19=10 " + i + "20=0 " + i + "21=0 " + i + "22=32 " + i + "92=1");
    }
    c_.line("I8=" + std::to_string(GetParam()));
    servo(256);  // whatever it was before is over
  }
  // Begins at each place between two real-time interrupts and counts servo interrupts until it shows.
  template <typename Begin, typename Seen>
  void expect_in_time(unsigned motor, const Begin& begin, const Seen& seen) {
    for (unsigned wait = 0; wait < 8; ++wait) {
      begin();
      follow(1 + wait);
      ASSERT_FALSE(seen()) << "motor " << motor;
      happens();
      unsigned took = 0;
      while (!seen() && took < 300) {
        servo();
        ++took;
      }
      EXPECT_LE(took, kMost) << "motor " << motor << ", wait " << wait;
      over();
      motor_kill(motor - 1);
      servo();
    }
  }
  std::function<void()> happens, over;
  // Real-time interrupts of so many servo interrupts.
  unsigned real_time(unsigned interrupts) {
    unsigned all = 0;
    for (unsigned n = 0; n < interrupts; ++n) {
      fake_task_run_servo();
      if (!hal_real_time_pending()) continue;
      ++all;
      fake_task_run_real_time();
    }
    return all;
  }
};

TEST_P(RareChecks, AFaultOrAFollowingErrorTrips) {
  c_.line("I303=$10F2 I304=$10F2 I403=$10F3 I404=$10F3 I311=0 I411=0 I300=1 I400=1");
  for (const unsigned motor : {1u, 2u, 3u, 4u, 5u}) {
    const auto begin = [motor] { ASSERT_TRUE(motor_close(motor - 1)); };
    const auto seen = [motor] { return !enabled(motor); };
    happens = [motor] { flags(motor, kFault); };
    over = [motor] { flags(motor, 0); };
    expect_in_time(motor, begin, seen);
    c_.line("I" + std::to_string(motor) + "11=160");
    happens = [motor] { counts(motor, at(motor) - 11); };
    over = [] {};
    expect_in_time(motor, begin, seen);
    c_.line("I" + std::to_string(motor) + "11=0");
  }
}

TEST_P(RareChecks, OverloadAndTheIntegralTrip) {
  c_.line("I157=1 I158=1 I163=-1600 I130=0 I133=8000000 I134=0");
  const auto seen = [] { return !enabled(1); };
  over = [] {};
  happens = [] { motors[0].open_output = 32767 << 8; };  // above 1 with the second servo interrupt
  for (unsigned wait = 0; wait < 4; ++wait) {
    ASSERT_TRUE(motor_open(0, 0));
    servo(1 + wait);
    happens();
    servo(2 + kMost);
    EXPECT_TRUE(seen()) << wait;
    EXPECT_TRUE(status2(1, 5)) << wait;
  }
  c_.line("I158=0");
  for (unsigned wait = 0; wait < 4; ++wait) {
    ASSERT_TRUE(motor_close(0));
    servo(1 + wait);
    counts(1, at(1) - 200);  // the integral is at 100 counts with the next interrupt
    servo(1 + kMost);
    EXPECT_TRUE(seen()) << wait;
    EXPECT_TRUE(status2(1, 6)) << wait;
  }
}

TEST_P(RareChecks, LimitsStopWhatMovesOn) {
  const auto seen = [] { return motors[0].found.on_limit || motors[0].found.on_desired_limit; };
  for (const int direction : {1, -1}) {
    const auto begin = [this, direction] {
      ASSERT_TRUE(motor_close(0));
      c_.line(direction > 0 ? "#1J+" : "#1J-");
      follow(270);
    };
    const bool up = direction > 0;
    happens = [up] { flags(1, up ? kPositive : kNegative); };
    over = [] { flags(1, 0); };
    expect_in_time(1, begin, seen);
    c_.line("I143=$78008");  // inputs of another channel
    happens = [up] { flags(2, up ? kPositive : kNegative); };
    over = [] { flags(2, 0); };
    expect_in_time(1, begin, seen);
    c_.line("I143=0");
    const std::string limit = up ? "I113" : "I114";
    const int here = up ? 1 : -1;
    happens = [this, limit, here] { c_.line(limit + "=" + std::to_string(std::lround(at(1)) - 20 * here)); };
    over = [this, limit] { c_.line(limit + "=0"); };
    expect_in_time(1, begin, seen);
    happens = [this, limit, here] {  // Ixx41 nearer: of the desired position alone
      c_.line(limit + "=" + std::to_string(std::lround(at(1)) + here * 2000) + " I141=2000 I124=$808001");
    };
    over = [this, limit] { c_.line(limit + "=0 I124=$800001"); };
    expect_in_time(1, begin, seen);
  }
}

// Nothing that lasts asks for more real-time interrupts than I8 does: a motor that stands in a limit, a killed one with
// a fault, a following error that only warns.
TEST_P(RareChecks, NothingIsAskedForInVain) {
  close_all();
  c_.line("I512=16 I111=0");
  flags(1, kPositive | kNegative);
  counts(5, at(5) + 2);
  motor_kill(1);
  flags(2, kFault);
  const unsigned period = static_cast<unsigned>(GetParam()) + 1;
  servo(3 * period);
  EXPECT_NEAR(real_time(8 * period), 8, 1);
}

// motion:6.2/2: software limits do not count for a search for home.
TEST_P(RareChecks, ASearchForHomeBeyondALimitAsksForNothing) {
  close_all();
  c_.line("I123=10 I111=0 I113=" + std::to_string(std::lround(at(1)) - 20));
  c_.line("#1HM");
  follow(270);
  const unsigned period = static_cast<unsigned>(GetParam()) + 1;
  EXPECT_NEAR(real_time(8 * period), 8, 1);
  EXPECT_TRUE(motors[0].status.home_search);
}

// While SAVE runs nothing is looked at (motion:6), nor is it asked for.
TEST_P(RareChecks, NothingIsSeenWhileChecksStand) {
  ASSERT_TRUE(motor_close(0));
  servo(1);
  protection_stand(true);
  flags(1, kFault);
  const unsigned period = static_cast<unsigned>(GetParam()) + 1;
  EXPECT_NEAR(real_time(3 * period), 3, 1);
  EXPECT_EQ(loop(1), LOOP_CLOSED);
  protection_stand(false);
  servo(kMost);
  EXPECT_EQ(loop(1), LOOP_KILLED);
}

INSTANTIATE_TEST_SUITE_P(I8, RareChecks, ::testing::Values(0, 2, 3, 4, 9, 255));

}  // namespace
}  // namespace brick
