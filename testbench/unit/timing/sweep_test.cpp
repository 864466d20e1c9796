// The sweep against arithmetic: the least wait states of each region at each clock of I52, worked out here from
// docs/port-a.md and docs/dpram.md over all phases that the CPU clock can have, and the rule that one less breaks. A
// tick is a period of clk_pwm, TC = 12 ticks / n; a clock begins anew at any tick, so cycles begin at e + 12 k / n.
#include "testbench/checkers/timing_sweep.h"

#include <gmock/gmock.h>

#include <set>

#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr double kTickNs = 1e9 / 117'964'800;

struct Cell {
  unsigned n, ws;
  double tc() const { return 12 * kTickNs / n; }
  unsigned form() const { return ws <= 3 ? 0 : ws <= 7 ? 1 : 2; }
  unsigned write_low() const { return ws <= 1 ? 1 : ws <= 3 ? 3 : 5; }  // quarters of TC from address to /WR
};

// Every time, in nanoseconds, from the fall of a strobe, `quarter` quarters into a cycle, to the edge that takes it,
// the longest first. In parts of a tick by n everything is whole.
std::vector<double> times_to_edge(unsigned n, unsigned quarter, unsigned period) {
  std::set<unsigned> parts;
  for (unsigned e = 0; e < period; ++e)
    for (unsigned k = 0; k < n; ++k)
      parts.insert((period * n - (e * n + 12 * k + 3 * quarter) % (period * n)) % (period * n));
  std::vector<double> times;
  for (auto p = parts.rbegin(); p != parts.rend(); ++p) times.push_back(*p * kTickNs / n);
  return times;
}

// Gate ICs and latches: the word stands two periods of clk_ref after the edge that takes /RD.
std::string broken_of_gates(const Cell& c) {
  const double data = times_to_edge(c.n, 2, 3).front() + 6 * kTickNs;
  if (data > (c.ws + 0.25) * c.tc() - 5) return "104 105";
  if ((4.0 - c.write_low()) / 4 * c.tc() > 3 * kTickNs - 1) return "w1";
  return "";
}

// The RAM: /TA shows at the edge that takes the strobe, and the CPU must see it when it first looks, TC / 4 + 2 ns
// before the strobe may end. If /TA comes between, that is row 119; if the strobe has ended by then, the word is not
// there.
std::string broken_of_dpram(const Cell& c) {
  if ((4.0 - c.write_low()) / 4 * c.tc() > 2 * kTickNs - 1) return "w1";
  std::string broken;
  for (const unsigned low : {2u, c.write_low()}) {
    const double end = (4 * c.ws + 3.0 - low) / 4 * c.tc(), look = end - c.tc() / 4 - 2;
    for (const double ta : times_to_edge(c.n, low, 1)) {
      if (ta <= look) continue;
      if (ta <= end) return "119";
      broken = "104 105";
    }
  }
  return broken;
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
