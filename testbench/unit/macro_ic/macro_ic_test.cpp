// Registers and clock outputs of both kinds of MACRO IC, the same expectations on both engines. Expected periods are
// arithmetic on servo-ic:6.1: phase (2 v + 3)(I6801 + 1) ticks, servo (I6802 + 1) phase periods.
#include <gtest/gtest.h>

#include <set>
#include <tuple>
#include <utility>

#include "testbench/unit/covers.h"
#include "testbench/unit/macro_ic/macro_ic_rig.h"

namespace brick {
namespace {

template <class Rig>
class MacroIcOn : public ::testing::Test {
 protected:
  MacroIcOn() { rig.power_up(); }

  void drive(unsigned max_count, unsigned phase_div, unsigned servo_div, unsigned direction = 0) {
    rig.write(true, macro::kPwm, pwm_word(max_count));
    rig.write(true, macro::kClock, clock_word(phase_div, servo_div, direction));
  }

  Rig rig;
};

using Engines = ::testing::Types<RtlMacroRig, ModelMacroRig>;
TYPED_TEST_SUITE(MacroIcOn, Engines, EngineNames);

TYPED_TEST(MacroIcOn, RegistersHaveTheirResetValuesWithBothClocksAsInputs) {
  EXPECT_EQ(this->rig.read(true, macro::kClock), 0x3038D2u);
  EXPECT_EQ(this->rig.read(true, macro::kPwm), 0x197F0Fu);
  EXPECT_EQ(this->rig.read(true, macro::kAdcStrobe), 0xFFFFFEu);
  for (const unsigned offset : {macro::kJio, macro::kMultiplexer, macro::kNodes})
    EXPECT_EQ(this->rig.read(false, offset), 0u);
  for (const unsigned offset : {macro::kRing, macro::kSupplementary[0], macro::kSupplementary[1]})
    EXPECT_EQ(this->rig.read(true, offset), 0u);
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_FALSE(this->rig.servo_oe());
}

// Every word: which bits can be written. All others read 0.
TYPED_TEST(MacroIcOn, WordsHoldTheBitsThatExistAndNoOthers) {
  const auto bits = [](bool x, unsigned offset) -> std::uint32_t {
    if (x && offset == macro::kClock) return 0xFF3FFF;  // 15..14 do not exist
    if (x && (offset == 0x15 || offset == 0x1D)) return 0xFFFFFF & ~(3u << 17) & ~(3u << 22);
    if (x && offset == macro::kPwm) return 0x7FFFFF;  // nor does 23
    if (x) return offset == macro::kAdcStrobe || offset == macro::kRing ? 0xFFFFFF : 0;
    return offset == 0x00 || offset == 0x02 || offset == 0x0F ? 0xFFFFFF : 0;
  };
  for (const std::uint32_t value : {0xFFFFFFu, 0x5A3CA5u, 0xA5C35Au, 0x000000u}) {
    for (unsigned offset = 0; offset < 64; ++offset)
      for (const bool x : {false, true}) this->rig.write(x, offset, value);
    for (unsigned offset = 0; offset < 64; ++offset)
      for (const bool x : {false, true})
        EXPECT_EQ(this->rig.read(x, offset), value & bits(x, offset))
            << (x ? "X:+" : "Y:+") << offset << " written " << value;
  }
}

TYPED_TEST(MacroIcOn, WordsAreIndependent) {
  const std::pair<bool, unsigned> words[] = {
      {true, macro::kClock}, {true, macro::kPwm},  {true, macro::kAdcStrobe},    {true, macro::kRing},  {true, 0x15},
      {true, 0x1D},          {false, macro::kJio}, {false, macro::kMultiplexer}, {false, macro::kNodes}};
  std::uint32_t value = 1;
  for (const auto& [x, offset] : words) this->rig.write(x, offset, value++);
  value = 1;
  for (const auto& [x, offset] : words) EXPECT_EQ(this->rig.read(x, offset), value++) << (x ? "X:+" : "Y:+") << offset;
}

// The bus of the RTL, whose select and strobe the model's calls do not have.
TEST(MacroIcBus, AWriteTakesSelectAndStrobeAndARegisterShowsOnlySelected) {
  RtlMacroRig rig;
  rig.power_up();
  const std::pair<bool, unsigned> words[] = {
      {true, macro::kClock}, {true, macro::kPwm},  {true, macro::kAdcStrobe},    {true, macro::kRing},  {true, 0x15},
      {true, 0x1D},          {false, macro::kJio}, {false, macro::kMultiplexer}, {false, macro::kNodes}};
  for (const auto& [x, offset] : words) {
    SCOPED_TRACE(::testing::Message() << (x ? "X:+" : "Y:+") << offset);
    rig.write(x, offset, 0x010203);
    MacroIcInputs& in = rig.ic().in;
    for (const bool selected : {false, true}) {  // each without the other
      rig.begin_write(x, offset, 0x080104);
      in.sel = selected;
      in.we = !selected;
      rig.run(2 * kTicksPerRef);
      EXPECT_EQ(rig.ic().rdata(), selected ? 0x010203u : 0u);
    }
    rig.end_write();
    EXPECT_EQ(rig.read(x, offset), 0x010203u);
  }
}

TYPED_TEST(MacroIcOn, PhaseAndServoPeriodsAreExactToTheTick) {
  BRICK_COVERS("CLK-1 CLK-3");
  const std::tuple<unsigned, unsigned, unsigned> settings[] = {
      {6527, 0, 3},  // factory: 9.0346 kHz, 2.2587 kHz
      {1473, 3, 1}, {100, 2, 2}, {7, 4, 15}, {6, 15, 0}, {0, 1, 3},
  };
  for (const auto& [max_count, phase_div, servo_div] : settings) {
    SCOPED_TRACE(::testing::Message() << "I6800=" << max_count << " I6801=" << phase_div << " I6802=" << servo_div);
    this->drive(max_count, phase_div, servo_div);
    this->rig.run(3 * (2 * 6527 + 3) * 16);  // past everything that still ran with the setting before
    ASSERT_TRUE(this->rig.phase_oe()) << "no edge would come";
    ASSERT_TRUE(this->rig.servo_oe());
    const Tick phase = Tick{2 * max_count + 3} * (phase_div + 1);
    const Tick fall = this->rig.edge_of(&ServoIcRig::phase, false);
    EXPECT_EQ(this->rig.edge_of(&ServoIcRig::phase, false) - fall, phase);
    const Tick servo_fall = this->rig.edge_of(&ServoIcRig::servo, false);
    EXPECT_EQ(this->rig.edge_of(&ServoIcRig::servo, false) - servo_fall, phase * (servo_div + 1));
    EXPECT_EQ((servo_fall - fall) % phase, 0) << "SERVO falls with a fall of PHASE";
  }
}

// The document's example, 6.67 kHz phase and 3.33 kHz servo: I6800 = floor(117964.8 / 13.333 - 1) = 8846 for a PHASE of
// 117964.8 / (2 * 8846 + 3) = 6.6665 kHz, and I6802 = 6.67 / 3.33 - 1 = 1.
TYPED_TEST(MacroIcOn, ServoIsHalfOfPhaseWithADividerOfOne) {
  BRICK_COVERS("CLK-5 CLK-1");
  this->drive(8846, 0, 1);
  this->rig.run(200'000);
  const Tick rise = this->rig.edge_of(&ServoIcRig::phase, true);
  const Tick phase = this->rig.edge_of(&ServoIcRig::phase, true) - rise;
  EXPECT_EQ(phase, 17695);
  EXPECT_NEAR(static_cast<double>(kPwmClockHz) / static_cast<double>(phase), 6670, 4);
  const Tick fall = this->rig.edge_of(&ServoIcRig::servo, false);
  EXPECT_EQ(this->rig.edge_of(&ServoIcRig::servo, false) - fall, 2 * phase);
}

TYPED_TEST(MacroIcOn, DirectionBitsStopDrivingEachClockAlone) {
  BRICK_COVERS("CLK-2");
  for (unsigned direction = 0; direction < 4; ++direction) {
    this->drive(6527, 0, 3, direction);
    this->rig.run(2 * 4 * 13057);  // two SERVO periods: pins are released while high, taken with rising edges
    EXPECT_EQ(this->rig.phase_oe(), (direction & 1) == 0);
    EXPECT_EQ(this->rig.servo_oe(), (direction & 2) == 0);
  }
}

TYPED_TEST(MacroIcOn, EachPinIsTakenWhileItsNetIsHigh) {
  for (const bool phase : {false, true}) {
    SCOPED_TRACE(phase ? "PHASE" : "SERVO");
    this->rig.power_up();
    this->rig.pins(!phase, phase);
    this->drive(20, 0, 0);
    this->rig.run(3 * 13057);  // past the period of the reset values
    EXPECT_EQ(this->rig.phase_oe(), !phase);
    EXPECT_EQ(this->rig.servo_oe(), phase);
    this->rig.pins(true, true);
    this->rig.run(3 * 43);
    EXPECT_TRUE(this->rig.phase_oe());
    EXPECT_TRUE(this->rig.servo_oe());
  }
}

TYPED_TEST(MacroIcOn, AMacroGateHasOneDirectionBitAndNoServoClock) {
  this->rig.set_gate(true);
  EXPECT_EQ(this->rig.read(true, macro::kClock), 0x3018D2u) << "reset value without bit 13";
  for (unsigned direction = 0; direction < 4; ++direction) {
    this->drive(20, 0, 0, direction);
    EXPECT_EQ(this->rig.read(true, macro::kClock), clock_word(0, 0, direction & 1));
    this->rig.run(3 * 13057);
    EXPECT_EQ(this->rig.phase_oe(), (direction & 1) == 0);
    EXPECT_FALSE(this->rig.servo_oe());
  }
  this->drive(20, 0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    this->rig.tick();
    ASSERT_TRUE(this->rig.servo());
  }
}

TYPED_TEST(MacroIcOn, AMacroGateHasNoSupplementaryChannels) {
  this->rig.write(true, 0x15, 0x123);
  this->rig.set_gate(true);
  for (const unsigned offset : macro::kSupplementary) {
    this->rig.write(true, offset, 0x39FFFF);
    EXPECT_EQ(this->rig.read(true, offset), 0u);
  }
  this->rig.write(true, macro::kAdcStrobe, 0x5A3C96);
  EXPECT_EQ(this->rig.read(true, macro::kAdcStrobe), 0x5A3C96u) << "its other words are there";
}

TYPED_TEST(MacroIcOn, ResetStopsDrivingAndRestoresTheRegisters) {
  this->drive(20, 0, 0);
  this->rig.write(false, macro::kJio, 0x123456);
  this->rig.run(30'000);
  this->rig.reset(true);
  this->rig.tick();
  EXPECT_FALSE(this->rig.phase_oe());
  EXPECT_FALSE(this->rig.servo_oe());
  this->rig.reset(false);
  this->rig.tick();
  EXPECT_EQ(this->rig.read(true, macro::kClock), 0x3038D2u);
  EXPECT_EQ(this->rig.read(false, macro::kJio), 0u);
  this->rig.run(3 * 4 * 13057);  // PHASE and SERVO periods of the reset values
  EXPECT_FALSE(this->rig.phase_oe()) << "nor later";
  EXPECT_FALSE(this->rig.servo_oe());
}

// The kind is a strap: it acts without a write.
TYPED_TEST(MacroIcOn, AnIcThatBecomesAMacroGateLetsGoOfServoAndBack) {
  this->drive(20, 0, 0, 0);
  this->rig.run(3 * 13057);
  ASSERT_TRUE(this->rig.servo_oe());
  for (const bool gate : {true, false}) {
    this->rig.set_gate(gate);
    this->rig.run(3 * 13057);
    EXPECT_TRUE(this->rig.phase_oe());
    EXPECT_EQ(this->rig.servo_oe(), !gate);
  }
}

}  // namespace
}  // namespace brick
