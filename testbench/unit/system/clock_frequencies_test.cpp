// The clocks that I7000, I7001 and I7002 select, measured on the pins to the tick: phase period (2*I7000+3)*(I7001+1)
// ticks, servo period (I7002+1) phase periods (servo-ic:3.1, servo-ic:3.2).
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

struct Setting {
  int i7000, i7001, i7002;
};

class ClockFrequencies : public Controller {
 protected:
  void check(const Setting& s) {
    SCOPED_TRACE("I7000=" + std::to_string(s.i7000) + " I7001=" + std::to_string(s.i7001) +
                 " I7002=" + std::to_string(s.i7002));
    ask("I7000=" + std::to_string(s.i7000) + " I7001=" + std::to_string(s.i7001) + " I7002=" + std::to_string(s.i7002));
    wait(ms_to_ticks(2));  // the new values act at the next turnaround and terminal counts
    const Tick phase_period = static_cast<Tick>(2 * s.i7000 + 3) * (s.i7001 + 1);
    const auto phase = falling_edges(pin::kPhase, 4, 6 * phase_period);
    ASSERT_EQ(phase.size(), 4u);
    for (unsigned i = 1; i < phase.size(); ++i) EXPECT_EQ(phase[i] - phase[i - 1], phase_period);
    const Tick servo_period = phase_period * (s.i7002 + 1);
    const auto servo = falling_edges(pin::kServo, 3, 4 * servo_period);
    ASSERT_EQ(servo.size(), 3u);
    for (unsigned i = 1; i < servo.size(); ++i) EXPECT_EQ(servo[i] - servo[i - 1], servo_period);
  }
};

TEST_P(ClockFrequencies, FollowTheVariablesToTheTick) {
  BRICK_COVERS("CLK-6 I19-2");
  start();
  check({6527, 0, 3});  // defaults: 13057 ticks, 9.0346 kHz; 52228 ticks, 2.2587 kHz
  check({1473, 3, 1});  // 20 kHz PWM, phase 10.0004 kHz, servo 5.0002 kHz
  check({2948, 1, 3});
  check({5897, 0, 0});  // servo equals phase, 10.0004 kHz
  check({6527, 1, 15});
}

TEST_P(ClockFrequencies, VariablesOfAnIcThatIsNotTheSourceHaveNoEffect) {
  BRICK_COVERS("I19-2");
  start();
  ask("I7101=5 I7102=7");
  check({6527, 0, 3});
}

TEST_P(ClockFrequencies, DirectionVariablesOfOneLineMoveTheSource) {
  BRICK_COVERS("I19-2 CLK-6");
  start();
  ask("I7100=2948 I7101=1 I7102=1");
  ask("I7107=0 I7007=3");
  wait(ms_to_ticks(3));
  EXPECT_EQ(machine().signals().value(*machine().signals().find("clock.source")), 7107u);
  const Tick period = (2 * 2948 + 3) * 2;
  const auto phase = falling_edges(pin::kPhase, 4, 8 * period);
  ASSERT_EQ(phase.size(), 4u);
  for (unsigned i = 1; i < phase.size(); ++i) EXPECT_EQ(phase[i] - phase[i - 1], period);
  EXPECT_EQ(ask("VERSION"), "1.947");
}

// Nobody types I10: whatever it and the clocks were, a re-initialisation leaves both so that they agree. 8388608 / kHz
// of a period of T ticks is 8388608 T / 117964.8 = 640 T / 9.
TEST_P(ClockFrequencies, FactoryServoPeriodIsTheMeasuredOne) {
  BRICK_COVERS("CLK-4");
  const auto agrees = [this](const std::string& when) {
    SCOPED_TRACE(when);
    const auto servo = falling_edges(pin::kServo, 3, ms_to_ticks(20));
    ASSERT_EQ(servo.size(), 3u);
    const Tick period = servo[2] - servo[1];
    EXPECT_EQ(period, servo[1] - servo[0]);
    EXPECT_NEAR(std::stod(ask("I10")), 640.0 * static_cast<double>(period) / 9.0, 1.0);
  };
  start();
  agrees("as it comes");
  ask("I7000=2948 I7001=1 I7002=1 I10=5");
  link().command("$$$***");
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(100)));
  wait(ms_to_ticks(2));
  agrees("after other clocks");
}

BRICK_ON_ENGINES(ClockFrequencies, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
