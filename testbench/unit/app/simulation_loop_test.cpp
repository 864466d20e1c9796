// Simulated time beside wall time, and a simulation that works for other threads.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/pacing.h"
#include "app/simulation_loop.h"
#include "testbench/host/host_bus.h"

namespace brick {
namespace {

using std::chrono::milliseconds;
using Wall = Pacing::Clock::time_point;

constexpr Tick kMs = ns_to_ticks(1'000'000);

Tick after(std::int64_t ms) { return ns_to_ticks(ms * 1'000'000); }
bool near(Tick a, Tick b) { return std::abs(a - b) <= 1; }

TEST(Pacing, WhatIsDueFollowsTheWall) {
  Pacing pacing(1000);
  const Wall begin = pacing.when(1000);
  for (const int ms : {0, 1, 20, 450}) EXPECT_TRUE(near(pacing.due(1000, begin + milliseconds(ms)), 1000 + after(ms)));
  EXPECT_TRUE(near(pacing.due(1000 + after(3000), begin + milliseconds(3400)), 1000 + after(3400))) << "no drift";
  EXPECT_EQ(pacing.when(1000 + 16 * kMs) - begin, std::chrono::nanoseconds(fs_to_ns(tick_to_fs(16 * kMs))));
}

// An hour in which the process slept is not made up for, nor is what a slow engine cannot do.
TEST(Pacing, WhatCannotBeMadeUpForIsForgotten) {
  Pacing pacing(0);
  const Wall begin = pacing.when(0);
  EXPECT_EQ(pacing.due(10 * kMs, begin + std::chrono::hours(1)), 10 * kMs);
  const Wall later = begin + std::chrono::hours(1) + milliseconds(30);
  EXPECT_TRUE(near(pacing.due(10 * kMs, later), 10 * kMs + after(30))) << "from there on as before";
}

TEST(Pacing, TellsHowMuchASlowEngineKeepsUpWith) {
  Pacing pacing(0);
  EXPECT_EQ(pacing.speed(), 1);
  for (int i = 0; i < 50; ++i) pacing.ran(kMs, milliseconds(20));
  EXPECT_NEAR(pacing.speed(), 0.05, 0.005);
  for (int i = 0; i < 50; ++i) pacing.ran(20 * kMs, milliseconds(10));
  EXPECT_NEAR(pacing.speed(), 1, 0.01) << "never more";
  pacing.ran(kMs, milliseconds(3));
  EXPECT_GT(pacing.speed(), 0.9) << "one piece says little";
}

// Years of the wall, a look at it every 400 ms or as long as time was kept up with.
TEST(Pacing, KeepsPaceForYears) {
  Pacing pacing(0);
  const Wall begin = pacing.when(0);
  for (const std::int64_t hours : {1, 3, 6, 48, 24 * 107, 24 * 366 * 10}) {
    const Tick then = Tick{3600} * hours * kPwmClockHz;
    const Wall wall = begin + std::chrono::hours(hours);
    EXPECT_EQ(pacing.when(then), wall) << hours << " h";
    EXPECT_TRUE(near(pacing.due(then, wall + milliseconds(400)), then + after(400))) << hours << " h";
  }
}

class SimulationLoopTest : public ::testing::Test {
 protected:
  struct Over {};

  // Until `end` says so, on this thread.
  void run(bool free, const std::function<bool()>& busy, const std::function<bool()>& end) {
    SimulationLoop loop(bus_, free);
    loop_ = &loop;
    bus_.set_heartbeat([&] {
      if (end()) throw Over();
    });
    EXPECT_THROW(loop.run(busy,
                          [this](Tick limit) {
                            ++pieces_;
                            bus_.advance_to(limit);
                          }),
                 Over);
  }

  Machine machine_{sc_core::sc_gen_unique_name("machine"), MachineConfig{}};
  HostBus bus_{machine_};
  SimulationLoop* loop_ = nullptr;
  int pieces_ = 0;
};

// However slow this machine is: in steps of 5 ms, which are ten pieces each, and no more pieces than time.
TEST_F(SimulationLoopTest, SleepsWhileNobodyWaitsAndTimeKeepsPace) {
  const Wall begin = Pacing::Clock::now();
  run(
      false, [] { return false; }, [&] { return Pacing::Clock::now() - begin > milliseconds(60) && bus_.now() > 0; });
  const auto wall = std::chrono::duration_cast<milliseconds>(Pacing::Clock::now() - begin).count();
  EXPECT_LE(bus_.now(), (wall + 1) * kMs);
  EXPECT_LE(pieces_, 2 * wall + 40) << wall << " ms";
}

TEST_F(SimulationLoopTest, FreeTimeStandsStillWhileNobodyWaits) {
  const Wall begin = Pacing::Clock::now();
  run(
      true, [] { return false; }, [&] { return Pacing::Clock::now() - begin > milliseconds(20); });
  EXPECT_EQ(bus_.now(), 0);
}

TEST_F(SimulationLoopTest, FreeTimePassesAsFastAsItCanWhileSomebodyWaits) {
  run(
      true, [] { return true; }, [&] { return bus_.now() > 1000'000 * kMs; });  // a quarter of an hour, at once
  EXPECT_GT(bus_.now(), 1000'000 * kMs);
}

// By 20 ms, however long it is busy.
TEST_F(SimulationLoopTest, WorkRunsAheadOfTheWallALittle) {
  const Wall begin = Pacing::Clock::now();
  run(
      false, [] { return true; }, [&] { return Pacing::Clock::now() - begin > milliseconds(40); });
  const auto wall = std::chrono::duration_cast<milliseconds>(Pacing::Clock::now() - begin).count();
  EXPECT_LE(bus_.now(), (wall + 22) * kMs);
}

TEST_F(SimulationLoopTest, DoesWhatOtherThreadsPost) {
  std::vector<int> order;
  std::thread other;
  bool begun = false;
  run(
      true, [] { return false; },
      [&] {
        if (!begun)
          other = std::thread([&] {
            for (int n = 0; n < 100; ++n) loop_->post([&order, n] { order.push_back(n); });
          });
        begun = true;
        return order.size() == 100;
      });
  other.join();
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

// Times of 64 bits would end after 2.5 hours of femtoseconds, and after 106 days of picoseconds.
TEST_F(SimulationLoopTest, TimeHasNoEnd) {
  constexpr Tick kYear = Tick{366} * 24 * 3600 * kPwmClockHz;
  run(
      true, [] { return true; },
      [this] {
        bus_.machine().run_until(bus_.now() + 3600 * kPwmClockHz);  // of this machine at once
        return bus_.now() > kYear;
      });
  EXPECT_GT(bus_.now(), kYear);
}

}  // namespace
}  // namespace brick
