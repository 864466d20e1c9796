// Verilated servo IC and model side by side, compared at every tick on random stimulus: writes at any tick, direction
// changes, external clocks with jitter, resets in the middle. The last test plants a difference and must see it found.
#include <gtest/gtest.h>

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"
#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

class Stimulus {
 public:
  Stimulus(LockstepRig& rig, std::uint32_t seed) : rig_(rig), random_(seed) {}

  void run(Tick ticks) {
    rig_.power_up();
    const Tick end = rig_.now() + ticks;
    Tick next_write = 0, next_phase = 0, next_servo = 0, next_reset = rig_.now() + between(ticks / 3, ticks);
    bool phase = true, servo = true;
    while (rig_.now() < end && rig_.difference.empty()) {
      if (rig_.now() >= next_write && !rig_.writing()) {
        write();
        next_write = rig_.now() + (chance(4) ? between(1, 9) : between(10, 3000));
      }
      if (rig_.now() >= next_phase || rig_.now() >= next_servo) {
        if (rig_.now() >= next_phase) {
          phase = !phase;
          next_phase = rig_.now() + (chance(20) ? between(1, 4) : half_ + between(-3, 3));
        }
        if (rig_.now() >= next_servo) {
          servo = !servo;
          next_servo = rig_.now() + between(1, 2000);
        }
        rig_.pins(phase, servo);
      }
      if (rig_.now() >= next_reset) {
        rig_.reset(true);
        rig_.run(between(1, 7));
        rig_.reset(false);
        next_reset = rig_.now() + between(ticks / 5, ticks);
      }
      rig_.tick();
    }
  }

 private:
  Tick between(Tick low, Tick high) { return std::uniform_int_distribution<Tick>(low, high)(random_); }
  bool chance(int one_in) { return between(1, one_in) == 1; }
  unsigned value(unsigned limit) { return static_cast<unsigned>(between(0, limit)); }

  void write() {
    const unsigned max_count = chance(3) ? value(6) : value(300);
    const unsigned divider = chance(2) ? value(2) : value(15);
    switch (value(5)) {
      case 0:
        rig_.start_write(true, kPwmWord, pwm_word(max_count));
        break;
      case 1:
        rig_.start_write(true, kClockWord, clock_word(divider, value(15), 0));
        break;
      case 2:
        rig_.start_write(true, kClockWord, clock_word(divider, value(3), value(3)));
        break;
      case 3:
        rig_.start_write(true, kClockWord, clock_word(value(1), value(1), 3));
        break;
      case 4:
        rig_.start_write(chance(2), value(31), value(0xFFFFFF));
        break;
      default:
        rig_.start_write(true, kPwmWord, pwm_word(half_ > 600 ? 303 : static_cast<unsigned>(half_)));
        break;
    }
    if (chance(10)) half_ = between(4, 700);
  }

  LockstepRig& rig_;
  std::mt19937 random_;
  Tick half_ = 100;
};

class ServoIcLockstep : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(ServoIcLockstep, EnginesAgreeAtEveryTickOnRandomStimulus) {
  BRICK_COVERS("CLK-6");
  LockstepRig rig;
  Stimulus(rig, random_seed(GetParam())).run(400'000);
  EXPECT_EQ(rig.difference, "") << "seed " << GetParam();
  for (unsigned offset = 0; offset < 32; ++offset) {
    rig.read(true, offset);
    rig.read(false, offset);
  }
  EXPECT_EQ(rig.difference, "") << "seed " << GetParam();
}
INSTANTIATE_TEST_SUITE_P(Seeds, ServoIcLockstep, ::testing::Range(1u, 13u));

// The worst tick: every write is tried at every distance from a turnaround of a short triangle.
TEST(ServoIcLockstepDirected, WritesAtEveryTickOfATriangle) {
  for (unsigned delay = 0; delay < 60; ++delay) {
    LockstepRig rig;
    rig.power_up();
    rig.write(true, kPwmWord, pwm_word(4));
    rig.write(true, kClockWord, clock_word(1, 1, 0));
    rig.run(2 * 13057 + delay);
    rig.start_write(true, kClockWord, clock_word(2, 0, 0));
    rig.run(50 + delay % 7);
    rig.start_write(true, kPwmWord, pwm_word(9));
    rig.run(101);
    rig.start_write(true, kClockWord, clock_word(2, 0, 3));
    rig.run(40 + delay);
    rig.start_write(true, kClockWord, clock_word(0, 5, 0));
    rig.run(300);
    ASSERT_EQ(rig.difference, "") << "delay " << delay;
  }
}

TEST(ServoIcLockstepDirected, NegativeControlAWrongLevelForOneTickIsFound) {
  LockstepRig rig;
  rig.power_up();
  rig.write(true, kClockWord, clock_word(0, 3, 0));
  rig.seeded_bug_at = rig.now() + 77'777;
  rig.run(100'000);
  EXPECT_EQ(rig.difference, "SERVO differs at tick " + std::to_string(rig.seeded_bug_at));
}

}  // namespace
}  // namespace brick
