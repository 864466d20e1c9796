// A clock pin that is released may take its own next fall with it, but then nothing inside may have happened at that
// fall: the position words change with falls of the nets only. The pin is released at every tick around its own fall,
// on both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {
namespace {

constexpr unsigned kControl = 0x05, kPhasePosition = 0x01, kServoPosition = 0x02;
constexpr Tick kStep = 48;  // of the encoder: four SCLK periods

void set_encoder(RtlRig& rig, unsigned pins) { rig.ic().in.pins[0] = pins; }
void set_encoder(ModelRig& rig, unsigned pins) {
  rig.change([pins](ServoIc& ic) { ic.set_channel_pins(0, pins); });
}

// The board around one IC: a net that nobody drives is high. The encoder of channel 1 never stops.
template <class Rig>
class ReleaseOn : public ::testing::Test {
 protected:
  struct Falls {
    unsigned phase = 0, servo = 0;
  };

  void start(unsigned max_count) {
    rig = std::make_unique<Rig>();
    rig->power_up();
    phase_net = servo_net = true;
    rig->write(true, kControl, 3);  // quadrature, four counts a line
    rig->write(true, kPwmWord, pwm_word(max_count));
    rig->write(true, kClockWord, clock_word(0, 0, 0));  // SERVO as fast as PHASE
  }
  // One tick; counts the falls of the nets.
  void tick() {
    rig->tick();
    settle();
  }
  void settle() {
    const bool phase = !rig->phase_oe() || rig->phase(), servo = !rig->servo_oe() || rig->servo();
    falls.phase += phase_net && !phase;
    falls.servo += servo_net && !servo;
    if (phase != phase_net || servo != servo_net) rig->pins(phase, servo);
    phase_net = phase;
    servo_net = servo;
    if (rig->now() % kStep == 0) set_encoder(*rig, kForward[rig->now() / kStep % 4]);
  }
  void run_to_fall() {
    const Tick end = rig->now() + 4 * 13057;  // twice the period that a reset leaves
    const unsigned before = falls.phase;
    while (falls.phase == before && rig->now() < end) tick();
    ASSERT_NE(falls.phase, before) << "PHASE does not fall";
  }
  void write_direction(unsigned direction) {
    while (rig->now() % kTicksPerRef != kTicksPerRef - 1) tick();
    rig->write(true, kClockWord, clock_word(0, 0, direction));  // ends with the next tick
    settle();
  }

  static constexpr unsigned kForward[4] = {0, 1, 3, 2};
  std::unique_ptr<Rig> rig;
  bool phase_net = true, servo_net = true;
  Falls falls;
};

using Engines = ::testing::Types<RtlRig, ModelRig>;
TYPED_TEST_SUITE(ReleaseOn, Engines, EngineNames);

TYPED_TEST(ReleaseOn, NothingIsLatchedByAFallThatStaysAwayFromTheNet) {
  std::array<unsigned, 4> at_the_fall{}, before_it{}, after_it{};  // by direction
  for (const unsigned max_count : {300u, 301u, 302u}) {
    const Tick period = 2 * static_cast<Tick>(max_count) + 3;
    for (const unsigned direction : {1u, 2u, 3u}) {
      for (Tick lead = -3; lead <= 12; ++lead) {
        this->start(max_count);
        for (int i = 0; i < 5; ++i) this->run_to_fall();
        const Tick own_fall = this->rig->now() + period;
        while (this->rig->now() < own_fall - period / 4) this->tick();
        const std::uint32_t phase_before = this->rig->read(true, kPhasePosition),
                            servo_before = this->rig->read(true, kServoPosition);
        this->falls = {};
        while (this->rig->now() < own_fall - lead) this->tick();
        this->write_direction(direction);
        const auto driven = [&] { return direction == 2 ? this->rig->servo_oe() : this->rig->phase_oe(); };
        while (driven() && this->rig->now() < own_fall + 2 * period) this->tick();
        const Tick released = this->rig->now();
        ASSERT_LT(released, own_fall + period) << "never released";
        (released < own_fall ? before_it : released == own_fall ? at_the_fall : after_it)[direction] += 1;
        // With 1 SERVO stays; with 2 PHASE does: then only until its fall is latched.
        const Tick end = direction == 3   ? released + 2 * period
                         : direction == 2 ? std::max(released, own_fall) + 2 * kTicksPerRef
                                          : released;
        while (this->rig->now() < end) this->tick();
        const auto fell = this->falls;
        SCOPED_TRACE("released " + std::to_string(released - own_fall) + " ticks after its own fall, I7m00 " +
                     std::to_string(max_count) + ", direction " + std::to_string(direction));
        EXPECT_EQ(this->rig->read(true, kPhasePosition) != phase_before, fell.phase != 0);
        EXPECT_EQ(this->rig->read(true, kServoPosition) != servo_before, fell.servo != 0);
      }
    }
  }
  for (const unsigned direction : {1u, 2u, 3u}) {
    EXPECT_GT(before_it[direction], 0u) << direction;
    EXPECT_GT(at_the_fall[direction], 0u) << "the case that this test is about, direction " << direction;
    EXPECT_GT(after_it[direction], 0u) << direction;
  }
}

}  // namespace
}  // namespace brick
