// The registers of a MACRO IC (servo-ic:6.2) bit by bit: what each does, or that it is kept, and that a check notices
// it stuck at 0 or at 1. Both kinds of IC, both engines. The words of its clock part act as those of a servo IC.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/macro_ic/macro_ic_rig.h"
#include "testbench/unit/register_bits/bits_rig.h"

namespace brick {
namespace {

// An IC with a stuck bit between it and the bus.
template <class Rig>
class StuckIc {
 public:
  std::optional<StuckBit> stuck;

  void start(bool gate) {
    rig_.set_gate(gate);
    rig_.pins(true, true);
    rig_.power_up();
  }
  void write(bool x, unsigned offset, std::uint32_t word) {
    rig_.write(x, offset, stuck ? stuck->apply(Side::kWritten, x, offset, word) : word);
  }
  bool bit(bool x, unsigned offset, unsigned n) {
    const std::uint32_t word = rig_.read(x, offset);
    return ((stuck ? stuck->apply(Side::kRead, x, offset, word) : word) >> n & 1) != 0;
  }
  ServoIcRig& pins() { return rig_; }

  // A new PWM word at once: see start_triangle() in bits_stimulus.h.
  void start_triangle(bool gate, std::uint32_t pwm_word) {
    start(gate);
    write(true, macro::kPwm, pwm_word);
    const auto edges = [&](int n) {
      for (; n > 0; --n) {
        for (bool level : {false, true}) {
          rig_.pins(level, true);
          rig_.run(12);
        }
      }
    };
    edges(4);
    rig_.run(6540);
    edges(5);
  }
  // Distance of rising edges of PHASE, falling edges of SERVO; `limit` ends a search that has no hope.
  Tick period(bool servo, Tick limit) {
    const auto until = [&](bool level) {
      for (Tick n = 0; n < limit && (servo ? !rig_.servo() : rig_.phase()) != level; ++n) rig_.tick();
    };
    Tick last = 0, distance = 0;
    for (int i = 0; i < 3; ++i) {
      until(false);
      until(true);
      distance = rig_.now() - last;
      last = rig_.now();
    }
    return distance;
  }

 private:
  Rig rig_;
};

template <class Rig>
struct Row {
  const char* name;
  Side side;
  bool x;
  unsigned offset, bit;
  bool always_0;
  std::function<bool(StuckIc<Rig>&)> check;
};

template <class Rig>
class MacroTable {
 public:
  explicit MacroTable(bool gate) : gate_(gate) {
    const std::uint32_t channel = gate ? 0 : 0xFFFFFF & ~(3u << 17) & ~(3u << 22);
    keeps("JIO data", false, macro::kJio, 0xFFFFFF);
    keeps("multiplexer data", false, macro::kMultiplexer, 0xFFFFFF);
    keeps("clock control", true, macro::kClock, gate ? 0xFF1FFF : 0xFF3FFF);
    keeps("PWM control", true, macro::kPwm, 0x7FFFFF);
    keeps("ADC strobe", true, macro::kAdcStrobe, 0xFFFFFF);
    keeps("ring control", true, macro::kRing, 0xFFFFFF);
    keeps("node activation", false, macro::kNodes, 0xFFFFFF);
    keeps("supplementary channel 1*", true, macro::kSupplementary[0], channel);
    keeps("supplementary channel 2*", true, macro::kSupplementary[1], channel);

    acts("phase direction", macro::kClock, 12,
         [gate](StuckIc<Rig>& ic) { return drives(ic, gate, 12, &ServoIcRig::phase_oe); });
    if (!gate)
      acts("servo direction", macro::kClock, 13,
           [](StuckIc<Rig>& ic) { return drives(ic, false, 13, &ServoIcRig::servo_oe); });
    for (unsigned bit = 0; bit < 4; ++bit) {
      acts("phase divider", macro::kClock, 16 + bit, [=](StuckIc<Rig>& ic) { return divides(ic, gate, bit, false); });
      if (!gate)
        acts("servo divider", macro::kClock, 20 + bit, [=](StuckIc<Rig>& ic) { return divides(ic, false, bit, true); });
    }
    for (unsigned bit = 0; bit < 15; ++bit)
      acts("maximum count", macro::kPwm, 8 + bit, [=](StuckIc<Rig>& ic) { return counts(ic, gate, bit); });
  }
  const std::vector<Row<Rig>>& rows() const { return rows_; }

 private:
  void acts(const char* name, unsigned offset, unsigned bit, std::function<bool(StuckIc<Rig>&)> check) {
    rows_.push_back({name, Side::kWritten, true, offset, bit, false, std::move(check)});
  }
  void keeps(const char* name, bool x, unsigned offset, std::uint32_t bits) {
    for (unsigned bit = 0; bit < 24; ++bit) {
      const bool kept = (bits >> bit & 1) != 0;
      for (Side side : {Side::kRead, Side::kWritten}) {
        if (side == Side::kWritten && !kept) continue;
        rows_.push_back({name, side, x, offset, bit, !kept, [this, x, offset, bit, kept](StuckIc<Rig>& ic) {
                           ic.start(gate_);
                           for (bool level : {true, false}) {
                             ic.write(x, offset, level ? 1u << bit : 0xFFFFFF & ~(1u << bit));
                             if (ic.bit(x, offset, bit) != (level && kept)) return false;
                           }
                           return true;
                         }});
      }
    }
  }

  // A pin is released while both clocks are high and taken with a rising edge: the factory setting's running period of
  // PHASE at most, then a period of SERVO (here as fast as PHASE).
  static bool drives(StuckIc<Rig>& ic, bool gate, unsigned bit, bool (ServoIcRig::*driven)()) {
    constexpr Tick kPhase = 2 * 6527 + 3;
    ic.start(gate);
    for (bool input : {true, false, true}) {
      ic.write(true, macro::kClock, input ? 1u << bit : 0);
      ic.pins().run(3 * kPhase);
      if ((ic.pins().*driven)() == input) return false;
    }
    return true;
  }
  static bool divides(StuckIc<Rig>& ic, bool gate, unsigned bit, bool servo) {
    ic.start_triangle(gate, 1 << 8);
    for (unsigned n : {0u, 1u << bit}) {
      ic.write(true, macro::kClock, n << (servo ? 20 : 16));
      ic.pins().run(100);
      if (ic.period(servo, 100) != 5 * (static_cast<Tick>(n) + 1)) return false;
    }
    return true;
  }
  static bool counts(StuckIc<Rig>& ic, bool gate, unsigned bit) {
    ic.start_triangle(gate, 0);
    ic.write(true, macro::kClock, 0);
    ic.pins().run(20);
    if (ic.period(false, 20) != 3) return false;
    ic.write(true, macro::kPwm, 1u << (8 + bit));
    ic.pins().run(10);
    const Tick expected = (Tick{2} << bit) + 3;
    return ic.period(false, expected) == expected;
  }

  bool gate_;
  std::vector<Row<Rig>> rows_;
};

template <class Rig>
class MacroBits : public ::testing::Test {};
using Engines = ::testing::Types<RtlMacroRig, ModelMacroRig>;
TYPED_TEST_SUITE(MacroBits, Engines, EngineNames);

TYPED_TEST(MacroBits, EachBitDoesWhatTheMapSaysAndEachStuckBitIsFound) {
  BRICK_COVERS("CLK-1 CLK-2");
  for (bool gate : {false, true}) {
    const MacroTable<TypeParam> table(gate);
    StuckIc<TypeParam> ic;
    for (const Row<TypeParam>& row : table.rows()) {
      SCOPED_TRACE(::testing::Message() << row.name << ", " << (row.x ? "X:+" : "Y:+") << row.offset << " bit "
                                        << row.bit << (gate ? ", MACROGATE" : ", DSPGATE2"));
      for (bool level : {false, true}) {
        if (row.always_0 && !level) continue;  // what is always 0 may be stuck there
        ic.stuck = StuckBit{row.side, row.x, row.offset, row.bit, level};
        EXPECT_FALSE(row.check(ic)) << "stuck at " << level;
      }
      ic.stuck.reset();
      EXPECT_TRUE(row.check(ic));
    }
  }
}

}  // namespace
}  // namespace brick
