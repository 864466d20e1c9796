// What the data sheet leaves open stands behind one parameter of a block and one constant of the model each:
// EquOnLeave, ALeadsUp, Latency. Here they are built with other values too (Latency 0, 4, 6): each does what it says,
// RTL and model agree, compare and decode at every edge, the ADC in every word.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <variant>
#include <vector>

#include "systemc/servo_ic/channel_decode.h"
#include "systemc/servo_ic/channel_serial.h"
#include "testbench/unit/channel_choices/rtl_choices.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

enum : unsigned { kWriteA = 1, kWriteB = 2, kWriteInc = 4, kWriteFractionA = 8, kWriteFractionB = 16, kWriteEqu = 32 };

// One compare in both engines: edges of SCLK with the position of a counter.
class CompareRig {
 public:
  explicit CompareRig(bool on_leave) : on_leave_(on_leave) {
    if (!on_leave) model_ = BasicChannelCompare<false>{};
  }

  // Between two edges of SCLK.
  void write(unsigned we, std::uint32_t value, bool still = false) {
    rtl_.in.ce = false;
    rtl_.in.position.still = still;
    rtl_.in.position.count = false;
    rtl_.in.we = we;
    rtl_.in.wdata = value;
    edge();
    rtl_.in.we = 0;
    rtl_.in.ce = true;
  }
  // The position before the edge, and what the edge does to the counter.
  void sclk(const ChannelPosition& p, bool fine = false, bool other = false) {
    rtl_.in.position = p;
    rtl_.in.fine = fine;
    rtl_.in.other = other;
    edge();
  }
  // Counts from `from` to `to`; returns the counts after which EQU was not what it was before them.
  std::vector<int> walk(int from, int to) {
    std::vector<int> toggles;
    const int step = to > from ? 1 : -1;
    for (int at = from; at != to; at += step) {
      const bool before = equ();
      sclk({static_cast<std::uint32_t>(at) & 0xFFFFFF, 0, false, true, step < 0});
      if (equ() != before) toggles.push_back(at + step);
    }
    return toggles;
  }
  bool equ() const { return rtl_.compare(on_leave_).equ; }
  std::uint32_t a() const { return rtl_.compare(on_leave_).a; }
  std::uint32_t b() const { return rtl_.compare(on_leave_).b; }
  std::uint32_t edges_to_hit(std::uint32_t counter, bool fine) const {
    return std::visit([=](const auto& model) { return model.edges_to_hit(counter, fine); }, model_);
  }
  int differences = 0;

 private:
  void edge() {
    rtl_.edge();
    const RtlChoices::Compare model = std::visit([this](auto& m) { return edge_of(m); }, model_);
    if (!(model == rtl_.compare(on_leave_))) ++differences;
  }
  template <class Model>
  RtlChoices::Compare edge_of(Model& model) {
    const RtlChoices::Inputs& in = rtl_.in;
    const bool jump = in.position.still || in.other != before_.other || in.fine != before_.fine;
    before_ = in;
    if (jump || !in.fine) model.forget();
    if (in.ce) model.sclk(in.position, in.fine);
    if ((in.we & kWriteA) != 0) model.set_a(in.wdata);
    if ((in.we & kWriteB) != 0) model.set_b(in.wdata);
    if ((in.we & kWriteInc) != 0) model.set_inc(in.wdata);
    if ((in.we & kWriteFractionA) != 0) model.set_a_fraction(in.wdata);
    if ((in.we & kWriteFractionB) != 0) model.set_b_fraction(in.wdata);
    if ((in.we & kWriteEqu) != 0) model.set_equ((in.wdata >> 12 & 1) != 0);
    return {model.equ(), model.a(), model.b()};
  }

  bool on_leave_;
  RtlChoices rtl_;
  RtlChoices::Inputs before_;  // at the last edge
  std::variant<BasicChannelCompare<true>, BasicChannelCompare<false>> model_;
};

class CompareRule : public ::testing::TestWithParam<bool> {  // on leave
 protected:
  void TearDown() override { EXPECT_EQ(rig_.differences, 0) << "RTL and model"; }
  const bool leave_ = GetParam();
  CompareRig rig_{leave_};
};
INSTANTIATE_TEST_SUITE_P(Values, CompareRule, ::testing::Bool(),
                         [](const auto& value) { return std::string(value.param ? "OnLeave" : "OnArrival"); });

// Check vector 12 of the data sheet; with the other rule each toggle comes one count earlier.
TEST_P(CompareRule, UpwardsEquTogglesBehindTheCompareOrOnIt) {
  const int later = leave_ ? 1 : 0;
  rig_.write(kWriteA, 1000);
  rig_.write(kWriteB, (1010 - 2000) & 0xFFFFFF);
  rig_.write(kWriteInc, 2000);
  EXPECT_EQ(rig_.walk(100, 999 + later), std::vector<int>{});
  EXPECT_EQ(rig_.walk(999 + later, 1000 + later), std::vector<int>{1000 + later});
  EXPECT_EQ(rig_.b(), 1010u);
  EXPECT_EQ(rig_.walk(1000 + later, 3005), (std::vector<int>{1010 + later, 3000 + later}));
  EXPECT_EQ(rig_.a(), 3000u);
  EXPECT_EQ(rig_.b(), 3010u);
}

TEST_P(CompareRule, DownwardsEquTogglesBehindTheCompareOrOnIt) {
  const int later = leave_ ? -1 : 0;
  rig_.write(kWriteA, 50);
  rig_.write(kWriteB, 5000);
  rig_.write(kWriteInc, 4990);
  EXPECT_EQ(rig_.walk(100, 5), (std::vector<int>{50 + later, 10 + later}));
  EXPECT_EQ(rig_.b(), 10u);
  EXPECT_EQ(rig_.a(), (50 - 4990) & 0xFFFFFF);
}

TEST_P(CompareRule, ReversalAtTheCompareTogglesOnce) {
  rig_.write(kWriteA, 20);
  rig_.write(kWriteB, 0x400000);
  const auto there = rig_.walk(18, 20), back = rig_.walk(20, 18);
  EXPECT_EQ(there, leave_ ? std::vector<int>{} : std::vector<int>{20});
  EXPECT_EQ(back, leave_ ? std::vector<int>{19} : std::vector<int>{});
}

TEST_P(CompareRule, BothComparesAtOneCountCancel) {
  rig_.write(kWriteA, 7);
  rig_.write(kWriteB, 7);
  rig_.write(kWriteInc, 3);
  EXPECT_EQ(rig_.walk(5, 9), std::vector<int>{});
  EXPECT_EQ(rig_.a(), 10u);
  EXPECT_EQ(rig_.b(), 10u);
}

TEST_P(CompareRule, WithFractionsEquTogglesBeyondTheCompareOrOnIt) {
  rig_.write(kWriteA, 30);
  rig_.write(kWriteFractionA, 0x800);
  rig_.write(kWriteB, 0x400000);
  const auto stand = [this](unsigned fraction) {
    rig_.sclk({30, fraction, false, false, false}, true);
    return rig_.equ();
  };
  EXPECT_FALSE(stand(0x700));
  EXPECT_FALSE(stand(0x7FF));
  EXPECT_EQ(stand(0x800), !leave_);
  EXPECT_TRUE(stand(0x801));
  EXPECT_EQ(stand(0x800), leave_) << "on it again: arrived from above";
  EXPECT_FALSE(stand(0x7FF));
}

// A counter walks near its compares, which are written now and then; the model says in advance for how long EQU stays.
TEST_P(CompareRule, EnginesAgreeOnRandomWalksAndThePromiseHolds) {
  std::mt19937 random(random_seed(leave_ ? 1 : 2));
  const auto value = [&](std::uint32_t limit) {
    return std::uniform_int_distribution<std::uint32_t>(0, limit)(random);
  };
  std::uint32_t counter = 0, quiet = 0;
  unsigned fraction = 0;
  bool fine = false, other = false, down = false;
  int toggles = 0, broken = 0;
  for (int i = 0; i < 200'000; ++i) {
    if (value(39) == 0) {
      rig_.write(1u << value(5), (value(3) == 0 ? value(0xFFFFFF) : counter + value(12) - 6) & 0xFFFFFF, value(9) == 0);
      quiet = 0;
    }
    if (value(499) == 0) {
      fine = !fine;
      quiet = 0;
    }
    if (value(999) == 0) {
      other = !other;
      quiet = 0;
    }
    if (value(29) == 0) down = !down;
    const bool hold = value(4999) == 0, count = !hold && value(2) == 0, before = rig_.equ();
    rig_.sclk({counter, fine ? fraction : 0, hold, count, down}, fine, other);
    if (rig_.equ() != before) {
      ++toggles;
      if (quiet > 0) ++broken;
    }
    if (count) counter = (counter + (down ? 0xFFFFFF : 1)) & 0xFFFFFF;
    fraction = count  ? (down ? 4095 : 0)
               : down ? fraction - std::min(fraction, value(900))
                      : std::min(4095u, fraction + value(900));
    if (hold) counter = 0;
    quiet = hold ? 0 : std::max(quiet, rig_.edges_to_hit(counter, fine) + 1) - 1;
  }
  EXPECT_GT(toggles, 1000);
  EXPECT_EQ(broken, 0);
}

// One cycle of A and B in which A leads, from 00 on: {B, A}.
constexpr unsigned kALeads[4] = {1, 3, 2, 0};

template <bool ALeadsUp>
int counts_of_a_cycle(unsigned mode) {
  RtlChoices rtl;
  BasicChannelDecode<ALeadsUp> model;
  int counts = 0;
  rtl.in.mode = mode;
  rtl.edge();  // of the levels one SCLK ago, which ready_i promises
  for (unsigned abc : kALeads) {
    rtl.in.abc = abc;
    rtl.edge();
    const auto m = model.step(true, mode, false, abc, false, false);
    const RtlChoices::Decode r = rtl.decode(ALeadsUp);
    EXPECT_TRUE((r == RtlChoices::Decode{m.count, m.count && m.down, m.error})) << "mode " << mode;
    if (r.count) counts += r.down ? -1 : 1;
  }
  return counts;
}

TEST(DecodeSense, ALeadingCountsUpOrDownByTheParameter) {
  constexpr int kCounts[8] = {0, 1, 2, 4, 0, -1, -2, -4};  // modes 1..3 clockwise, 5..7 not
  for (unsigned mode : {1u, 2u, 3u, 5u, 6u, 7u}) {
    EXPECT_EQ(counts_of_a_cycle<true>(mode), kCounts[mode]) << "mode " << mode;
    EXPECT_EQ(counts_of_a_cycle<false>(mode), -kCounts[mode]) << "mode " << mode;
  }
}

TEST(DecodeSense, PulseAndDirectionAndHallDoNotDependOnIt) {
  for (unsigned mode : {0u, 4u, 8u, 11u, 15u}) {
    RtlChoices rtl;
    std::mt19937 random(random_seed(mode));
    int counted = 0;
    rtl.in.mode = mode;
    rtl.edge();
    for (int i = 0; i < 2000; ++i) {
      rtl.in.abc = random() % 8;
      rtl.in.pulse = random() % 3 == 0;
      rtl.in.pulse_down = random() % 2 == 0;
      rtl.edge();
      ASSERT_TRUE(rtl.decode(0) == rtl.decode(1)) << "mode " << mode;
      counted += rtl.decode(0).count;
    }
    EXPECT_GT(counted, 100) << "mode " << mode;
  }
}

template <bool ALeadsUp>
void random_decode(std::uint32_t seed) {
  RtlChoices rtl;
  BasicChannelDecode<ALeadsUp> model;
  std::mt19937 random(random_seed(seed));
  for (int i = 0; i < 50'000; ++i) {
    RtlChoices::Inputs& in = rtl.in;
    if (random() % 50 == 0) in.mode = random() % 16;
    in.ready = random() % 100 != 0;
    in.hold = random() % 100 == 0;
    if (random() % 2 == 0) in.abc ^= 1u << random() % 3;
    if (random() % 20 == 0) in.abc = random() % 8;
    in.pulse = random() % 4 == 0;
    in.pulse_down = random() % 2 == 0;
    rtl.edge();
    const auto m = model.step(in.ready, in.mode, in.hold, in.abc, in.pulse, in.pulse_down);
    ASSERT_TRUE((rtl.decode(ALeadsUp) == RtlChoices::Decode{m.count, m.count && m.down, m.error}))
        << "edge " << i << " mode " << in.mode;
  }
}

TEST(DecodeSense, EnginesAgreeWithEitherValue) {
  random_decode<true>(1);
  random_decode<false>(2);
}

template <unsigned Latency>
void adc_words(bool whole_runs) {
  RtlChoices rtl;
  BasicChannelAdc<Latency> model;
  for (std::uint32_t word : {0x000000u, 0xFFFFFFu, 0x800000u, 0x000001u, 0x020001u, 0x5A3C96u, 0xC00003u}) {
    for (unsigned bit = 0; bit < 24;) {
      const bool data = (word >> (23 - bit) & 1) != 0;
      unsigned run = 1;
      while (whole_runs && bit + run < 24 && ((word >> (23 - bit - run) & 1) != 0) == data) ++run;
      model.sample(bit, run, data);
      for (; run > 0; --run, ++bit) {
        rtl.in.sample = true;
        rtl.in.bit = bit;
        rtl.in.data = data;
        rtl.edge();
      }
    }
    rtl.in.sample = false;
    rtl.in.phase_fall = true;
    rtl.edge();
    rtl.in.phase_fall = false;
    model.transfer();
    const std::uint32_t expected = (word << Latency & 0xFFFFFF) >> 6 << 6;  // 18 bits behind the dropped ones
    EXPECT_EQ(rtl.adc(Latency), expected) << "latency " << Latency << " word " << std::hex << word;
    EXPECT_EQ(model.value(), expected) << "latency " << Latency << " word " << std::hex << word;
  }
}

TEST(AdcLatency, DropsSoManyBitsAndKeepsEighteen) {
  for (bool whole_runs : {false, true}) {
    adc_words<0>(whole_runs);
    adc_words<4>(whole_runs);
    adc_words<6>(whole_runs);
  }
}

}  // namespace
}  // namespace brick
