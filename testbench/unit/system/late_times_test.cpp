// Controllers that are switched on shortly before a count of 64 or 32 bits would wrap around: femtoseconds after 2.5
// and 5.1 hours, picoseconds after 106 and 213 days, ticks after 18 and 36 seconds. What they do, and when, to the
// femtosecond, is what one does that is switched on at tick 0.
#include <vector>

#include "testbench/checkers/timing_book.h"
#include "testbench/unit/cosim/distorted_board.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

// The grids of all clocks have an edge at each multiple of it: 144 ticks are 5^13 fs, BCLK is 120 ns.
constexpr Tick kSame = 144 * 1536;
static_assert(tick_to_fs(kSame) % (120 * kFsPerNs) == 0 && tick_to_fs(kSame) * 144 == kSame * TimeFs{1'220'703'125});

constexpr TimeFs kOne = 1;
constexpr struct {
  const char* name;
  Tick tick;
} kInstants[] = {
    {"2^63 fs", fs_to_tick(kOne << 63)},
    {"2^64 fs", fs_to_tick(kOne << 64)},
    {"2^63 ps", fs_to_tick((kOne << 63) * 1000)},
    {"2^64 ps", fs_to_tick((kOne << 64) * 1000)},
    {"2^31 ticks", Tick{1} << 31},
    {"2^32 ticks", Tick{1} << 32},
};

class LateTimes : public Controller {
 protected:
  struct Event {
    std::int64_t fs;  // from the switch
    std::string what;
    bool operator==(const Event& other) const { return fs == other.fs && what == other.what; }
  };

  // 45 ms from the switch at tick `on`.
  std::vector<Event> session(Tick on) {
    std::vector<Event> events;
    const TimeFs begin = tick_to_fs(on);
    const auto seen = [&](TimeFs time, const std::string& what) {
      events.push_back({static_cast<std::int64_t>(time - begin), what});
    };
    MachineConfig config;
    config.rewire = [on](std::unique_ptr<Board> board) {
      return std::make_unique<DistortedBoard>(std::move(board), on);
    };
    start(config);
    TimingBook book(machine());
    machine().on_bus_cycle = [&](const PortACycle& cycle) {
      seen(cycle.start, "cycle at " + std::to_string(cycle.address));
      seen(cycle.end, "its end");
    };
    machine().on_task = [&](TimeFs time) { seen(time, "task " + std::to_string(machine().task())); };
    const Tick end = on + ms_to_ticks(45);
    for (int n = 0; machine().now() < end; ++n) {
      seen(machine().now_fs(), ask("P1=P1+1 P1 #1P V F ??"));
      bus().dpram_write(0x1200, static_cast<std::uint16_t>(n));
      seen(machine().now_fs(), std::to_string(bus().dpram_read(0x1200)));
      if (n == 20) wait(ms_to_ticks(1));
    }
    for (const TimingLedger* ledger : book.ledgers()) {
      EXPECT_EQ(ledger->violations().size(), 0u);
      std::uint64_t evaluations = 0;
      for (unsigned rule = 0; rule < ledger->rules().size(); ++rule)
        for (unsigned region = 0; region < ledger->regions().size(); ++region)
          evaluations += ledger->row(rule, region).evaluations;
      EXPECT_GT(evaluations, 1000u);
    }
    machine().on_bus_cycle = nullptr;
    machine().on_task = nullptr;
    return events;
  }
};

TEST_P(LateTimes, AreAsGoodAsEarlyOnes) {
  const std::vector<Event> expected = session(0);
  ASSERT_GT(expected.size(), 10'000u);
  for (const auto& instant : kInstants) {
    if (GetParam() != Engine::kSystemC && &instant != kInstants) break;  // the engines count ticks
    const Tick on = (instant.tick - ms_to_ticks(30)) / kSame * kSame;
    const std::vector<Event> found = session(on);
    ASSERT_EQ(found.size(), expected.size()) << instant.name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].fs, expected[i].fs) << instant.name << ": event " << i << ", " << found[i].what;
      ASSERT_EQ(found[i].what, expected[i].what) << instant.name << ": event " << i;
    }
    EXPECT_LT(on, instant.tick);
    EXPECT_GT(on + fs_to_tick(found.back().fs), instant.tick) << "the session goes on beyond the instant";
  }
}

BRICK_ON_ENGINES(LateTimes, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
