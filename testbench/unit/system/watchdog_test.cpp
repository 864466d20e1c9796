// The watchdog with the real image: tasks that take more CPU time than the servo period gives them, and what does not
// trip it. Trip times are arithmetic of testbench/checkers/watchdog_scoreboard.h; the load is that of the tasks
// themselves.
#include "testbench/benches/watchdog_probe.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class WatchdogTrip : public Controller {
 protected:
  bool tripped() { return machine().outputs().get(pin::kWdTripped) != 0; }
  // 4,095 servo periods of 18 us and 25 ms are 100 ms; it is judged by the scoreboard.
  void run_to_trip() { bus().wait_pin(pin::kWdTripped, 1, ms_to_ticks(200)); }
  std::string first(const WatchdogScoreboard& s) { return s.violations().empty() ? "" : s.violations().front(); }
  long number(const std::string& line) { return std::strtol(ask(line).c_str(), nullptr, 10); }
  void reset_command() {
    link().command("$$$");
    ASSERT_TRUE(link().connect(ms_to_ticks(100)));
  }

  // Starves the background from a running state and judges the trip.
  void starve(unsigned i8, unsigned i40) {
    SCOPED_TRACE("I8=" + std::to_string(i8) + " I40=" + std::to_string(i40));
    start();
    WatchdogScoreboard scoreboard;
    WatchdogProbe probe(bus(), scoreboard);
    const unsigned i7000 = watchdog_load(link()).starving_i7000(i8);
    ask("I8=" + std::to_string(i8) + " I40=" + std::to_string(i40) + " I7002=0");
    wait(ms_to_ticks(2));
    probe.expect_starvation(2 * static_cast<Tick>(i7000) + 3, WatchdogScoreboard::counter_of(i40));
    link().send("I7000=" + std::to_string(i7000));
    run_to_trip();
    scoreboard.judge(true);
    EXPECT_TRUE(scoreboard.violations().empty()) << first(scoreboard) << ", I7000=" << i7000;
  }
};

TEST_P(WatchdogTrip, ComesWhenI40RunsOutAnd25MillisecondsAfterTheLastStrobe) {
  BRICK_COVERS("WDT-1");
  starve(0, 0);
  if (GetParam() != Engine::kSystemC) return;
  starve(0, 200);
  starve(0, 2000);
  starve(2, 0);
  starve(2, 500);
}

TEST_P(WatchdogTrip, ComesAtOnceWhenEvenTheRealTimeTaskStarves) {
  BRICK_COVERS("WDT-1");
  for (const unsigned i40 : {0u, 65535u}) {
    start();
    WatchdogScoreboard scoreboard;
    WatchdogProbe probe(bus(), scoreboard);
    ask("I8=0 I7002=0 I40=" + std::to_string(i40));
    wait(ms_to_ticks(2));
    // 43 ticks are 28 CPU cycles: the phase interrupt alone takes more.
    probe.expect_starvation(43, WatchdogScoreboard::counter_of(i40));
    link().send("I7000=20");
    run_to_trip();
    scoreboard.judge(false);
    EXPECT_TRUE(scoreboard.violations().empty()) << first(scoreboard);
  }
}

TEST_P(WatchdogTrip, ComesAgainAfterEveryResetWithTheSameSavedSettings) {
  BRICK_COVERS("WDT-1 WDT-2");
  start();
  ask("I8=0 I7100=20 I7101=0 I7102=0 I19=7107 SAVE");
  for (int i = 0; i < (GetParam() == Engine::kSystemC || night() ? 2 : 1); ++i) {
    machine().reset();
    wait(ms_to_ticks(1));
    EXPECT_FALSE(tripped());
    EXPECT_FALSE(link().connect(ms_to_ticks(100)));
    EXPECT_TRUE(tripped());
  }
  machine().power_cycle();
  EXPECT_FALSE(link().connect(ms_to_ticks(100))) << "the flash keeps them";
  machine().set_jumper_e3(true);
  machine().power_cycle();
  ASSERT_TRUE(link().connect(ms_to_ticks(50)));
  EXPECT_EQ(ask("I8 I19 I7100 I7102"), "2|7007|6527|3");
  EXPECT_EQ(ask("SAVE"), "");
  machine().set_jumper_e3(false);
  machine().power_cycle();
  ASSERT_TRUE(link().connect(ms_to_ticks(50))) << "the defaults are SAVEd";
  EXPECT_EQ(ask("I19"), "7007");
}

BRICK_ON_ENGINES(WatchdogTrip, Engine::kSystemC, Engine::kLockstep);

class WatchdogLoadOf : public WatchdogTrip {};

// The same servo clock: too much for 78.6 MHz, little for 314.6 MHz. Nothing but CPU time makes the difference.
TEST_P(WatchdogLoadOf, ServoClockIsBearableForAFasterCpu) {
  BRICK_COVERS("WDT-1");
  start();
  const std::string i7000 = "I7000=" + std::to_string(watchdog_load(link()).starving_i7000(0));
  ask("I52=31 SAVE");
  reset_command();
  ask("I8=0 I7002=0 I40=200");
  EXPECT_EQ(ask(i7000), "");
  wait(ms_to_ticks(40));
  EXPECT_FALSE(tripped());
  EXPECT_EQ(ask("VERSION"), "1.947");
  EXPECT_GT(number("RX$25"), 0);
}

// I37 adds wait states to main memory and the default area, where the servo task keeps its words: about one access each
// to X:$0, Y:$25, X:$25, Y:$37, three clocks each.
TEST_P(WatchdogLoadOf, WaitStatesAreCpuTimeToo) {
  BRICK_COVERS("WDT-1");
  start();
  const long before = number("RY$37");
  ask("I37=$30003 SAVE");
  reset_command();
  wait(ms_to_ticks(2));
  EXPECT_GT(number("RY$37"), before);
}

TEST_P(WatchdogLoadOf, LongCommandShowsInTheLowestValue) {
  start();
  wait(ms_to_ticks(2));
  EXPECT_GE(number("RX$25"), 4095 - 6);
  unsigned falls = 0;
  bus().watch(select_pins(pin::kServo),
              [&](Tick, const BoardOutputs&, const BoardOutputs& after) { falls += after.get(pin::kServo) == 0; });
  ask("DEFINE TBUF 800");
  bus().watch({}, nullptr);
  ASSERT_GT(falls, 10u);
  const long fallen = 4095 - number("RX$25");
  EXPECT_LE(fallen, falls + 4);
  EXPECT_GE(fallen, falls - 4);
}

// Below zero the strobes pause; what ends within 25 ms is forgiven.
TEST_P(WatchdogLoadOf, ShortfallOfLessThan25MillisecondsIsForgiven) {
  start();
  WatchdogScoreboard scoreboard;
  WatchdogProbe probe(bus(), scoreboard);
  ask("I40=5");
  wait(ms_to_ticks(2));
  probe.reset();
  ask("DEFINE TBUF 800");  // one pass of some 35 servo cycles
  const unsigned during = scoreboard.strobes();
  EXPECT_LE(during, 5u) << "of one in three servo cycles";
  wait(ms_to_ticks(40));
  EXPECT_GE(scoreboard.strobes() - during, 25u) << "2.26 kHz / 3";
  EXPECT_FALSE(tripped());
}

// Between two variables of a run the counter is reloaded every 5 ms, 12 servo cycles: 143 ms would take 323.
TEST_P(WatchdogLoadOf, RunsOfAssignmentsReloadTheCounter) {
  start();
  ask("I40=200");
  for (const char* line : {"I8000..8191=$78000", "M0..8191->*", "P0..8191=1.5"}) ask(line);
  EXPECT_FALSE(tripped());
  EXPECT_GE(number("RX$25"), 200 - 18);
}

TEST_P(WatchdogLoadOf, SaveReloadsTheCounterItself) {
  start();
  ask("P0..8191=1.5");
  EXPECT_EQ(ask("I40=2 I7002=0 I8=0 SAVE"), "");
  EXPECT_FALSE(tripped());
}

BRICK_ON_ENGINES(WatchdogLoadOf, Engine::kSystemC);

}  // namespace
}  // namespace brick
