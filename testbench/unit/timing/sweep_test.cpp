// The sweep against arithmetic: the least wait states of each region at each clock of I52, worked out here from
// host-bus:2.6 and host-bus:6.9/8 over all phases that the CPU clock can have, and the rule that one less breaks. A
// tick is a period of clk_pwm, TC = 12 ticks / n; a clock begins anew at any tick, so cycles begin at e + 12 k / n.
// A flip-flop may miss what moves less than a nanosecond before its edge.
#include "testbench/checkers/timing_sweep.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr double kTickNs = 1e9 / 117'964'800, kApertureNs = 1;

struct Cell {
  unsigned n, ws;
  double tc() const { return 12 * kTickNs / n; }
  unsigned form() const { return ws <= 3 ? 0 : ws <= 7 ? 1 : 2; }
  unsigned write_low() const { return ws <= 1 ? 1 : ws <= 3 ? 3 : 5; }          // quarters of TC from address to /WR
  unsigned low() const { return ws <= 1 ? 6 : ws <= 3 ? 4 * ws : 4 * ws - 2; }  // of /WR, the shorter of the strobes
};

// The longest time, in nanoseconds, from the fall of a strobe, `quarter` quarters into a cycle, to the edge of clk_ref,
// three ticks apart, that takes it. In parts of a tick by n everything is whole.
double longest_to_edge(unsigned n, unsigned quarter) {
  const unsigned period = kTicksPerRef * n;
  double longest = 0;
  for (unsigned e = 0; e < kTicksPerRef; ++e)
    for (unsigned k = 0; k < n; ++k) {
      const double time = (period - (e * n + 12 * k + 3 * quarter) % period) % period * kTickNs / n;
      longest = std::max(longest, time < kApertureNs ? time + kTicksPerRef * kTickNs : time);
    }
  return longest;
}

// Gate ICs and latches: the word stands two periods of clk_ref after the edge that takes /RD. Of writes the rules leave
// room for pins that are a tick late, those of this board are not.
std::string broken_of_gates(const Cell& c) {
  const double data = longest_to_edge(c.n, 2) + 6 * kTickNs;
  if (data > (c.ws + 0.25) * c.tc() - 5) return "104 105";
  if ((4.0 - c.write_low()) / 4 * c.tc() > 2 * kTickNs - kApertureNs) return "w1";
  if (c.low() / 4.0 * c.tc() < 6 * kTickNs + kApertureNs) return "s1";
  return "";
}

// The RAM: /TA comes with the strobe, and the CPU must see it when it first looks, TC / 4 + 2 ns before the strobe may
// end; once it waits, it does until the word has stood for a clock of the RAM's, longer than row 104 asks for.
std::string broken_of_dpram(const Cell& c) {
  if ((4.0 - c.write_low()) / 4 * c.tc() > kTickNs - kApertureNs) return "w1";
  if (c.n >= 16 && c.ws == 1) return "f";  // host-bus:2.2/5
  for (const unsigned low : {2u, c.write_low()})
    if ((4 * c.ws + 3.0 - low) / 4 * c.tc() - c.tc() / 4 - 2 < 0) return "119";
  return "";
}

TEST(TimingSweep, TheLeastWaitStatesOfEachClockAreThoseOfTheArithmetic) {
  BRICK_COVERS("CARD-5");
  std::vector<SweepCell> first;
  for (const std::uint64_t seed : {1, 7, 4711}) {
    MachineConfig config;
    config.seed = seed;
    Machine machine(sc_core::sc_gen_unique_name("brick"), config);
    const std::vector<SweepCell> cells = timing_sweep(machine, seed);
    ASSERT_EQ(cells.size(), 96u);
    for (const SweepCell& cell : cells) {
      const bool dpram = cell.region == PortATiming::kDpram;
      SCOPED_TRACE(::testing::Message() << "I52 = " << cell.i52 << ", region " << cell.region << ", seed " << seed);
      const auto broken = [&](unsigned ws) {
        const Cell at{cell.i52 + 1, ws};
        return dpram ? broken_of_dpram(at) : broken_of_gates(at);
      };
      unsigned least = BusTraffic::most_wait_states(cell.region);
      while (least > 1 && broken(least - 1).empty()) --least;
      ASSERT_TRUE(cell.least.has_value());
      EXPECT_EQ(*cell.least, least);
      if (least == 1) {
        EXPECT_EQ(cell.below, "-");
        continue;
      }
      EXPECT_THAT(" " + cell.below, ::testing::HasSubstr(" " + broken(least - 1)));
      EXPECT_THAT(cell.address,
                  ::testing::MatchesRegex(dpram                                      ? "[XY]:.060C0[0-2]"
                                          : cell.region == PortATiming::kDefaultArea ? "X:.07001[01]"
                                                                                     : "X:.0780[01][6E]"));
    }
    if (first.empty()) first = cells;
    for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i].below, first[i].below) << "seed " << seed;
  }
}

}  // namespace
}  // namespace brick
