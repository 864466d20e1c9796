// RTL and model of the serial encoder inputs side by side, compared at every tick on random stimulus: control words,
// nets and data lines that move at any tick, reads and writes at any edge of clk_ref, resets.
#include <gtest/gtest.h>

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"
#include "testbench/unit/ssi/ssi_rig.h"

namespace brick {
namespace {

template <class Rig>
class Stimulus {
 public:
  Stimulus(Rig& rig, std::uint32_t seed) : rig_(rig), random_(seed), geo_(one_in(4)) {}

  void run(Tick ticks) {
    rig_.reset(geo_);
    const Tick end = rig_.now() + ticks;
    Tick next_access = 0, next_net = 0, next_data = 0, next_reset = rig_.now() + between(ticks / 3, ticks), busy = 0;
    unsigned data = 0xFF;
    bool phase = true, servo = true;
    while (rig_.now() < end && rig_.difference.empty()) {
      const Tick now = rig_.now();
      if (now >= next_access && now >= busy) {
        rig_.begin(access());
        busy = (now / 3 + 1) * 3;
        next_access = now + (one_in(4) ? between(1, 9) : between(10, 1000));
      }
      if (now >= next_net) {
        if (one_in(2)) phase = !phase;
        if (one_in(2)) servo = !servo;
        rig_.nets(phase, servo);
        next_net = now + (one_in(6) ? between(1, 4) : between(5, 4000));
      }
      if (now >= next_data) {
        data = value(0xFF);
        rig_.data(data);
        next_data = now + (one_in(3) ? between(1, 4) : between(1, 60));
      }
      if (now >= next_reset && now >= busy) {
        rig_.reset(geo_ = one_in(4));
        phase = servo = true;
        next_reset = now + between(ticks / 4, ticks);
      }
      rig_.tick();
      clocks_ += rig_.clk() != last_ ? 1u : 0u;
      last_ = rig_.clk();
    }
  }
  unsigned clocks() const { return clocks_; }

 private:
  Tick between(Tick low, Tick high) { return std::uniform_int_distribution<Tick>(low, high)(random_); }
  bool one_in(int n) { return between(1, n) == 1; }
  unsigned value(unsigned limit) { return static_cast<unsigned>(between(0, limit)); }

  SsiAccess access() {
    if (geo_) {
      constexpr unsigned kWords[] = {0x14, 0x15, 0x16, 0x34, 0x35, 0x36};
      const unsigned address = one_in(20) ? value(63) : kWords[value(5)];
      return {one_in(3), one_in(2), address, one_in(3) ? value(15) : 2 | value(1) | value(3) << 2};
    }
    const unsigned address = one_in(20) ? value(63) : 0x20 + value(31);
    if (one_in(6)) return {true, true, one_in(2) ? 0x2Fu : 0x3Fu, timing()};
    if (one_in(3)) return {true, true, 0x20 + 4 * value(7), control()};
    return {one_in(3) && address % 16 != 15, one_in(2), address, value(0xFFFFFF)};
  }
  // Mostly short periods and protocol 2.
  std::uint32_t timing() {
    return value(one_in(4) ? 40 : 3) << 16 | value(one_in(10) ? 4 : 1) << 12 | value(3) << 8 |
           (one_in(2) ? 0 : value(15)) << 4 | (one_in(8) ? value(15) : 2);
  }
  std::uint32_t control() {
    return value(3) << 14 | (one_in(4) ? 1u : 0u) << 13 | (one_in(6) ? 0u : 1u) << 12 | value(1) << 11 |
           (one_in(8) ? 0u : 1u) << 10 | (one_in(5) ? value(63) : 12 + value(20));
  }

  Rig& rig_;
  std::mt19937 random_;
  bool geo_;
  unsigned clocks_ = 0, last_ = 0xFF;
};

class SsiLockstep : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(SsiLockstep, EnginesAgreeAtEveryTickOnRandomStimulus) {
  BRICK_COVERS("SSI-1");
  LockstepSsiRig rig;
  const std::uint32_t seed = random_seed(GetParam());
  Stimulus stimulus(rig, seed);
  stimulus.run(300'000);
  EXPECT_EQ(rig.difference, "") << "seed " << seed;
  EXPECT_GT(stimulus.clocks(), 500u);
}
INSTANTIATE_TEST_SUITE_P(Seeds, SsiLockstep, ::testing::Range(1u, 13u));

// systemc/core/model_block.h: left alone until an edge that it asks for, the model shows what one shows that executes
// every edge.
TEST(SsiAsleep, ShowsWhatOneShowsThatIsAwake) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    SsiPair<AwakeSsiRig> rig;
    Stimulus stimulus(rig, random_seed(seed));
    stimulus.run(200'000);
    EXPECT_EQ(rig.difference, "") << "seed " << seed;
    EXPECT_GT(stimulus.clocks(), 300u);
  }
}

TEST(SsiLockstepControl, AWrongClockForOneTickIsFound) {
  LockstepSsiRig rig;
  rig.seeded_bug_at = 77'777;
  Stimulus(rig, 1).run(100'000);
  EXPECT_EQ(rig.difference, "clocks differ at tick 77777");
}

}  // namespace
}  // namespace brick
