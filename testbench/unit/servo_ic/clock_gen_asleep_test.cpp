// The clock chain of the model sleeps until an edge of a pin that it drives, or of its direction: one that executes
// each edge shows no other before (systemc/core/model_block.h). Settings, pins and short triangles of chance.
#include <gtest/gtest.h>

#include <random>

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

}  // namespace
}  // namespace brick
