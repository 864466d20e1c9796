// The host's bus cycles against the table of host-bus:3.4. Times are taken from the edges that first see a change, so
// they are known to one tick (8.5 ns).
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "testbench/host/host_bus.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {
namespace {

constexpr double kTickNs = 78'125.0 / 9216.0;

class HostBusTest : public ::testing::Test {
 protected:
  Machine machine{"machine", {}};
  HostBus bus{machine};
  FakeMachine& fake = FakeMachine::last();

  // Time in ns of the n-th change for which `is` holds.
  template <class Predicate>
  double when(Predicate is, int n = 1) {
    for (const auto& c : fake.changes)
      if (is(c) && --n == 0) return static_cast<double>(c.seen) * kTickNs;
    ADD_FAILURE() << "no such change";
    return 0;
  }
};

using Change = FakeMachine::Change;
bool address(const Change& c) { return c.before.isa_sa != c.after.isa_sa; }
bool data(const Change& c) { return c.before.isa_sd != c.after.isa_sd; }
bool write_low(const Change& c) { return c.before.isa_iow_n && !c.after.isa_iow_n; }
bool write_high(const Change& c) { return !c.before.isa_iow_n && c.after.isa_iow_n; }
bool read_low(const Change& c) { return c.before.isa_ior_n && !c.after.isa_ior_n; }
bool read_high(const Change& c) { return !c.before.isa_ior_n && c.after.isa_ior_n; }

TEST_F(HostBusTest, WriteCycleKeepsTheTimesOfTheTable) {
  bus.io_write(7, 0x41);
  bus.io_write(3, 0x42);
  EXPECT_GE(when(write_low) - when(address), 91 - kTickNs) << "t1";
  EXPECT_GE(when(write_high) - when(write_low), 530 - kTickNs) << "t2";
  EXPECT_GE(when(address, 2) - when(write_high), 25 - kTickNs) << "t3";
  EXPECT_LE(when(data), when(write_low) + 22 + kTickNs) << "t6";
  EXPECT_GE(when(data, 2) - when(write_high), 25 - kTickNs) << "t7";
  EXPECT_GE(when(write_low, 2) - when(write_high), 170 - kTickNs) << "t11";
  EXPECT_NEAR(when(write_low, 2) - when(write_low), 840, kTickNs) << "six BCLK and one of recovery";
  EXPECT_EQ(fake.io[7], 0x41);
  EXPECT_EQ(fake.io[3], 0x42);
}

TEST_F(HostBusTest, ReadTakesTheLowByteBeforeTheCommandEnds) {
  fake.io[9] = 0x5A;
  EXPECT_EQ(bus.io_read(9), 0x5A);
  EXPECT_GE(when(read_high) - when(read_low), 530 - kTickNs) << "t2";
}

// Low before the command, or only once it is under way.
TEST_F(HostBusTest, CommandWaitsOneBclkAfterReady) {
  for (const Tick low : {20, 60}) {
    const double begin = static_cast<double>(bus.now()) * kTickNs;
    fake.changes.clear();
    fake.ready_low_from = bus.now() + low;
    fake.ready_low_to = bus.now() + ns_to_ticks(2'000);
    bus.io_read(9);
    EXPECT_GE(when(read_high) - begin, 2'000 + 120 - kTickNs) << "t9";
    EXPECT_LE(when(read_high) - begin, 2'000 + 2 * 120 + kTickNs) << "no longer than needed";
  }
}

TEST_F(HostBusTest, ReadyThatNeverComesIsAnError) {
  fake.ready_low_from = 20;
  try {
    bus.io_read(9);
    FAIL() << "no error";
  } catch (const HostBusError& e) { EXPECT_NE(std::string(e.what()).find("t10"), std::string::npos) << e.what(); }
}

TEST_F(HostBusTest, MemoryCycleIsSixteenBitsWide) {
  bus.dpram_write(0x1050, 0xBEEF);
  EXPECT_EQ(fake.memory[0x1050], 0xBEEF);
  EXPECT_EQ(bus.dpram_read(0x1050), 0xBEEF);
  const auto low = [](const Change& c) { return c.before.isa_memr_n && !c.after.isa_memr_n; };
  const auto high = [](const Change& c) { return !c.before.isa_memr_n && c.after.isa_memr_n; };
  EXPECT_GE(when(high) - when(low), 219 - kTickNs) << "MEMR# low";
}

// A sixteenth of the wait so far, but twelve clocks of the bus at least, 1.44 us, and 50 us at most: ten looks in the
// first 23 us, then each a seventeenth later than the one before, 59 up to 0.8 ms, then 378 in 19.2 ms.
TEST_F(HostBusTest, ALongWaitCostsFewLooksAndAddsASixteenth) {
  constexpr double kCycleUs = 0.84, kShortestUs = 1.44, kLongestUs = 50, kTickUs = kTickNs / 1000;
  EXPECT_FALSE(bus.get_char(ns_to_ticks(20'000'000)));
  std::vector<double> looks;
  for (const Change& c : fake.changes)
    if (read_low(c)) looks.push_back(static_cast<double>(c.seen) * kTickUs);
  for (std::size_t n = 1; n < looks.size(); ++n) {
    const double waited = looks[n - 1] + kCycleUs;
    const double pause = std::clamp(waited / 16, kShortestUs, kLongestUs);
    EXPECT_NEAR(looks[n] - looks[n - 1], pause + kCycleUs, 0.3) << "behind " << waited << " us";
  }
  EXPECT_GE(looks.size(), 20'000 / (kLongestUs + kCycleUs + kTickUs));
  EXPECT_LE(looks.size(), 10u + 59u + 378u + 3u);
}

TEST_F(HostBusTest, WatchSeesEveryEdgeDuringACycle) {
  BoardOutputs high, low;
  for (auto* o : {&high, &low}) o->set(pin::kIsaIochrdy, 1);
  high.set(pin::kBreq, 1);
  fake.planned = {{30, high}, {35, low}, {36, high}};
  std::vector<Tick> edges;
  bus.watch(select_pins(pin::kBreq), [&](Tick t, const BoardOutputs&, const BoardOutputs&) { edges.push_back(t); });
  bus.io_read(9);
  EXPECT_EQ(edges, (std::vector<Tick>{30, 35, 36}));
}

TEST_F(HostBusTest, WaitPinStopsAtTheEdge) {
  BoardOutputs high;
  high.set(pin::kIsaIochrdy, 1);
  high.set(pin::kIsaIrq, 1);
  fake.planned = {{5000, high}};
  EXPECT_TRUE(bus.wait_pin(pin::kIsaIrq, 1, 10'000));
  EXPECT_EQ(bus.now(), 5000);
  EXPECT_FALSE(bus.wait_pin(pin::kIsaIrq, 0, 100));
  EXPECT_EQ(bus.now(), 5100);
}

}  // namespace
}  // namespace brick
