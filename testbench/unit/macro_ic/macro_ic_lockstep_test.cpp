// Verilated MACRO IC and model side by side, compared at every tick on random stimulus: writes at any tick, directions,
// external clocks with jitter, the kind switched, resets. The last test plants a difference and must see it found.
#include <gtest/gtest.h>

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/macro_ic/macro_ic_rig.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

class Stimulus {
 public:
  Stimulus(LockstepMacroRig& rig, std::uint32_t seed) : rig_(rig), random_(seed) {}

  void run(Tick ticks) {
    rig_.power_up();
    const Tick end = rig_.now() + ticks;
    Tick next_write = 0, next_pin = 0, next_gate = 0, next_reset = rig_.now() + between(ticks / 3, ticks);
    bool phase = true, servo = true;
    while (rig_.now() < end && rig_.difference.empty()) {
      if (rig_.now() >= next_write && !rig_.writing()) {
        write();
        next_write = rig_.now() + (one_in(4) ? between(1, 9) : between(10, 2000));
      }
      if (rig_.now() >= next_pin) {
        phase = one_in(4) ? phase : !phase;
        servo = one_in(4) ? !servo : servo;
        rig_.pins(phase, servo);
        next_pin = rig_.now() + (one_in(20) ? between(1, 4) : 2 * max_count_ / 2 + between(1, 5));
      }
      if (rig_.now() >= next_gate) {
        rig_.set_gate(one_in(3));
        next_gate = rig_.now() + between(1, 20'000);
      }
      if (rig_.now() >= next_reset) {
        rig_.reset(true);
        rig_.run(between(1, 7));
        rig_.reset(false);
        next_reset = rig_.now() + between(ticks / 5, ticks);
      }
      rig_.tick();
      if (!rig_.writing() && one_in(50)) rig_.read(one_in(2), static_cast<unsigned>(between(0, 63)));
    }
  }

 private:
  Tick between(Tick low, Tick high) { return std::uniform_int_distribution<Tick>(low, high)(random_); }
  bool one_in(int n) { return between(1, n) == 1; }
  unsigned value(unsigned limit) { return static_cast<unsigned>(between(0, limit)); }

  void write() {
    switch (value(3)) {
      case 0:
        max_count_ = value(one_in(3) ? 6 : 300);
        rig_.start_write(true, macro::kPwm, pwm_word(static_cast<unsigned>(max_count_)));
        break;
      case 1:
        rig_.start_write(true, macro::kClock,
                         clock_word(value(one_in(2) ? 2 : 15), value(3), one_in(2) ? 0 : value(3)));
        break;
      default:
        rig_.start_write(one_in(2), value(one_in(2) ? 15 : 63), value(0xFFFFFF));
    }
  }

  LockstepMacroRig& rig_;
  std::mt19937 random_;
  Tick max_count_ = 100;
};

class MacroIcLockstep : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(MacroIcLockstep, EnginesAgreeAtEveryTickOnRandomStimulus) {
  BRICK_COVERS("CARD-2 CLK-1");
  LockstepMacroRig rig;
  Stimulus(rig, random_seed(GetParam())).run(300'000);
  EXPECT_EQ(rig.difference, "") << "seed " << GetParam();
}
INSTANTIATE_TEST_SUITE_P(Seeds, MacroIcLockstep, ::testing::Range(1u, 13u));

TEST(MacroIcLockstepControl, AWrongLevelForOneTickIsFound) {
  LockstepMacroRig rig;
  rig.power_up();
  rig.write(true, macro::kClock, clock_word(0, 3, 0));
  rig.seeded_bug_at = rig.now() + 77'777;
  rig.run(100'000);
  EXPECT_EQ(rig.difference, "SERVO differs at tick " + std::to_string(rig.seeded_bug_at));
}

}  // namespace
}  // namespace brick
