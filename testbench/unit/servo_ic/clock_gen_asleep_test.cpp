// The clock chain of the model sleeps until an edge of a pin that it drives, or of its direction: one that executes
// each edge shows no other before (systemc/core/model_block.h). Settings, pins and short triangles of chance.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "systemc/servo_ic/clock_gen.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

// What is outside of it: PHASE, SERVO, where they are driven, and that.
unsigned pins(const ClockGen& g) {
  return (g.phase_oe() ? 1u : 0u) | (g.servo_oe() ? 2u : 0u) | (g.phase_oe() && g.phase() ? 4u : 0u) |
         (g.servo_oe() && g.servo() ? 8u : 0u);
}

// Its own pins come back to it, as on the board, now and then those of another.
class Life {
 public:
  explicit Life(std::uint32_t seed) : random_(seed) {}

  std::string run(Tick end) {
    for (ClockGen* g : {&asleep_, &awake_}) g->reset(0);
    unsigned shown = pins(asleep_);
    Tick next = asleep_.next_event();
    for (Tick now = 0; now < end; ++now) {
      if (change(now)) {
        asleep_.advance(now);
        asleep_.in = awake_.in;
        next = asleep_.next_event();
      }
      if (next <= now) return "an event that is over at tick " + std::to_string(now);
      awake_.advance(now + 1);
      if (next == now + 1) {
        asleep_.advance(next);
        next = asleep_.next_event();
        shown = pins(asleep_);
      }
      if (pins(awake_) != shown) return "tick " + std::to_string(now + 1);
      changes += pins(awake_) != before_;
      before_ = pins(awake_);
    }
    return "";
  }
  unsigned changes = 0;

 private:
  bool one_in(std::uint32_t n) { return random_() % n == 0; }
  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }

  bool change(Tick now) {
    const ClockGen::Inputs before = awake_.in;
    ClockGen::Inputs& in = awake_.in;
    if (now == again_) {
      in.phase_ext = !in.phase_ext;
      in.servo_ext = one_in(2);
    } else if (now % kTicksPerRef == 0 && one_in(100)) {
      in.phase_ext = one_in(2);
      in.servo_ext = one_in(2);
      if (one_in(3)) in.phase_div = one_in(2) ? 0 : pick(one_in(2) ? 3 : 16);
      if (one_in(3)) in.servo_div = pick(one_in(2) ? 3 : 16);
      if (one_in(3)) in.max_count = one_in(2) ? pick(3) : pick(100);
      again_ = now + kTicksPerRef * (1 + pick(6));
    }
    if (one_in(5000)) others_ = !others_;
    if (others_) {
      in.phase = in.phase != one_in(50);
      in.servo = in.servo != one_in(100);
    } else {
      in.phase = awake_.phase();
      in.servo = awake_.servo();
    }
    return !(in == before);
  }

  std::mt19937 random_;
  ClockGen asleep_{sc_core::sc_gen_unique_name("asleep")}, awake_{sc_core::sc_gen_unique_name("awake")};
  bool others_ = false;
  Tick again_ = 0;
  unsigned before_ = 0;
};

TEST(ClockGenAsleep, WakesForEachEdgeThatItDrives) {
  unsigned changes = 0;
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    Life life(random_seed(seed));
    ASSERT_EQ(life.run(50'000), "") << "seed " << seed;
    changes += life.changes;
  }
  EXPECT_GT(changes, 10'000u);
}

// And for nothing else: once it drives, each event is an edge of PHASE or of SERVO. One that drives nothing has none.
TEST(ClockGenAsleep, WakesForNothingElse) {
  for (const unsigned max_count : {0u, 1u, 5u, 100u})
    for (unsigned phase_div = 0; phase_div < 16; ++phase_div)
      for (const bool servo_ext : {false, true}) {
        SCOPED_TRACE(::testing::Message() << max_count << ", " << phase_div << ", " << servo_ext);
        ClockGen g(sc_core::sc_gen_unique_name("gen"));
        g.reset(0);
        EXPECT_EQ(g.next_event(), kNever);
        g.in.max_count = max_count;
        g.in.phase_div = phase_div;
        g.in.servo_div = phase_div / 3;
        g.in.phase_ext = false;
        g.in.servo_ext = servo_ext;
        const auto follow = [&g] {
          g.in.phase = !g.phase_oe() || g.phase();
          g.in.servo = !g.servo_oe() || g.servo();
        };
        Tick now = 0;
        for (int n = 0; n < 60 && !(g.phase_oe() && g.servo_oe() == !servo_ext); ++n) {
          g.advance(now = g.next_event());
          follow();
        }
        ASSERT_TRUE(g.phase_oe());
        for (int n = 0; n < 20; ++n) {
          const unsigned before = pins(g);
          const Tick next = g.next_event();
          ASSERT_GT(next, now);
          g.advance(now = next);
          follow();
          ASSERT_NE(pins(g), before) << "tick " << now;
        }
        g.in.phase_ext = g.in.servo_ext = true;
        for (int n = 0; n < 80 && (g.phase_oe() || g.servo_oe()); ++n) g.advance(now = g.next_event());
        g.in.phase = g.in.servo = false;
        EXPECT_EQ(g.next_event(), kNever);
      }
}

// One that takes another shows from then on what that one shows. What it says of its state: where it repeats the one
// that is marked, it goes on as it went on from there; and each period of clocks that are left alone is such a place.
TEST(ClockGenAsleep, GoesOnFromAStateThatItTakesOrMarks) {
  std::mt19937 random(random_seed(1));
  const auto pick = [&random](unsigned below) { return static_cast<unsigned>(random() % below); };
  const auto settle = [&](ClockGen& g) {
    g.in.max_count = pick(8);
    g.in.phase_div = pick(4);
    g.in.servo_div = pick(3);
    g.in.phase_ext = pick(3) == 0;
    g.in.servo_ext = pick(3) == 0;
  };
  unsigned repeating = 0, whole = 0;
  for (int life = 0; life < 300; ++life) {
    ClockGen g(sc_core::sc_gen_unique_name("gen"));
    g.reset(0);
    settle(g);
    const bool alone = life % 3 == 0;  // no pins move and no settings
    Tick now = 0;
    const Tick period = 2 * (2 * Tick{g.in.max_count} + 3) * (g.in.phase_div + 1) * (g.in.servo_div + 1);
    const auto step = [&](const std::vector<ClockGen*>& all) {
      if (!alone && pick(30) == 0) g.in.phase = !g.in.phase;
      if (!alone && pick(40) == 0) g.in.servo = !g.in.servo;
      if (!alone && pick(400) == 0) settle(g);
      ++now;
      for (ClockGen* one : all) {
        one->in = g.in;
        one->advance(now);
      }
    };
    for (unsigned n = 30'000 / (alone ? 1 : 100); n > 0; --n) step({&g});
    for (int round = 0; round < 20; ++round) {
      ClockGen taken(sc_core::sc_gen_unique_name("taken")), marked(sc_core::sc_gen_unique_name("marked"));
      taken.take(g);
      marked.take(g);
      g.mark();
      ASSERT_TRUE(g.repeats());
      const Tick from = now, way = pick(2) == 0 ? period : 1 + pick(60);
      while (now < from + way) {
        step({&g, &taken});
        ASSERT_EQ(pins(taken), pins(g)) << "tick " << now;
        ASSERT_EQ(taken.next_event(), g.next_event()) << "tick " << now;
        ASSERT_EQ(taken.next_special_edge(), g.next_special_edge()) << "tick " << now;
      }
      const bool is_whole = alone && way == period;
      ASSERT_TRUE(g.repeats() || !is_whole) << "life " << life << ", tick " << now;
      whole += is_whole;
      if (!g.repeats()) continue;
      ++repeating;
      marked.jump(now - from);
      for (int n = 0; n < 200; ++n) {
        ASSERT_EQ(pins(marked), pins(g)) << "tick " << now;
        ASSERT_EQ(marked.cnt(), g.cnt()) << "tick " << now;
        ASSERT_EQ(marked.next_special_edge(), g.next_special_edge()) << "tick " << now;
        step({&g, &marked});
      }
    }
  }
  EXPECT_GT(whole, 500u);
  EXPECT_GT(repeating, whole + 20);
}

}  // namespace
}  // namespace brick
