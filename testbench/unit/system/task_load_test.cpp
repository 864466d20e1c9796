// Task durations and over-run bits on the whole controller (firmware:1.10, firmware:8.1, firmware:8.2). What the words
// should say is taken from the CPU: the cycles from each trap to its return.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr std::uint32_t kInterrupt = 0x8000'0000;
constexpr Tick kServo = 4 * 13057;  // I7000 = 6527, I7001 = 0, I7002 = 3
constexpr double kServoCycles = kServo * 8.0 / 12.0;
constexpr Cycle kSlack = 12;  // of the entry and return that the firmware adds

// Follows traps and returns. Words and traps agree while no task is at work.
class TaskClock {
 public:
  explicit TaskClock(Cpu& cpu) : cpu_(cpu), trap_(cpu.on_trap), mret_(cpu.on_mret) {
    cpu_.on_trap = [this](std::uint32_t cause, std::uint32_t pc, Cycle now) {
      trap_(cause, pc, now);
      open_.push_back({cause & ~kInterrupt, now, 0});
    };
    cpu_.on_mret = [this](std::uint32_t pc, Cycle now) {
      mret_(pc, now);
      if (!open_.empty()) leave(now);
    };
  }
  ~TaskClock() {
    cpu_.on_trap = trap_;
    cpu_.on_mret = mret_;
  }
  TaskClock(const TaskClock&) = delete;
  TaskClock& operator=(const TaskClock&) = delete;

  struct Task {
    Cycle last = 0;  // with the tasks that interrupted it
    Cycle own = 0;   // all of them, without those
    unsigned count = 0;
  };
  bool idle() const { return open_.empty(); }
  const Task& of(CpuInterrupt line) const { return tasks_.at(line); }
  void forget() { tasks_ = {}; }

 private:
  struct Open {
    std::uint32_t line;
    Cycle entered, inside;
  };
  void leave(Cycle now) {
    const Open done = open_.back();
    open_.pop_back();
    Task& task = tasks_.at(done.line);
    task.last = now - done.entered;
    task.own += task.last - done.inside;
    ++task.count;
    if (!open_.empty()) open_.back().inside += task.last;
  }

  Cpu& cpu_;
  decltype(Cpu::on_trap) trap_;
  decltype(Cpu::on_mret) mret_;
  std::vector<Open> open_;
  std::array<Task, 20> tasks_{};
};

struct Duty {
  double phase, servo, real_time;
  double all() const { return phase + servo + real_time; }
};

class TaskLoad : public Controller {
 protected:
  void load_plc0(const std::vector<std::string>& lines) {
    ASSERT_EQ(ask("OPEN PLC 0 CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(ask(line), "") << line;
    ASSERT_EQ(ask("CLOSE I5=1"), "");
  }
  long word(bool x, std::uint32_t address) {
    std::uint32_t value;
    std::memcpy(&value, machine().cpu().memory(0xC0000000 + 8 * address + (x ? 4 : 0), 4), 4);
    return static_cast<long>(value);
  }
  // One interrupt above it may have come behind the last look at the cycle counter, during the return.
  static void expect_duration(long word, const TaskClock& clock, CpuInterrupt line) {
    Cycle took = clock.of(line).last;
    if (line != kIrqPhase && took > 2 * word + kSlack) took -= clock.of(kIrqPhase).last;
    EXPECT_NEAR(2 * word, took, kSlack) << "interrupt " << line;
  }
  // The words of the last tasks against the CPU, at many instants.
  void expect_words(const std::string& what) {
    SCOPED_TRACE(what);
    TaskClock clock(machine().cpu());
    wait(6 * kServo);
    unsigned looks = 0;
    for (int i = 0; i < 200 && !HasFailure(); ++i) {
      wait(kServo / 7 + 11);
      if (!clock.idle()) continue;
      ++looks;
      expect_duration(word(true, 0x37), clock, kIrqPhase);
      expect_duration(word(false, 0x37), clock, kIrqServo);
      expect_duration(word(true, 0x0B), clock, kIrqRealTime);
    }
    EXPECT_GT(looks, 50u);
    EXPECT_GE(word(false, 0x0B), word(true, 0x0B)) << "the longest";
    for (const auto& [line, name] : {std::pair{kIrqPhase, "phase"}, {kIrqServo, "servo"}, {kIrqRealTime, "real-time"}})
      RecordProperty(what + ", " + name, static_cast<int>(clock.of(line).last));
  }
  // As the vendor publishes it [TU239, TU240, EPX]: each duration less the tasks above that came in its time.
  // The host's own characters interrupt all of them, and what takes turns makes one interrupt longer than the next:
  // each word is the mean of the middle half of 24.
  Duty published_duty() {
    const auto number = [this](const char* question) {
      std::array<double, 24> told{};
      for (double& one : told) one = std::stod(ask(question));
      std::sort(told.begin(), told.end());
      return std::accumulate(told.begin() + 6, told.end() - 6, 0.0) / 12;
    };
    const double period = number("M70"), phase = number("M71"), servo = number("M72"), real_time = number("M73");
    const double phases = number("I7002") + 1, servos = number("I8") + 1;
    const double servo_own = servo - std::floor(servo / period) * phase;
    const double real_time_own =
        real_time - std::floor(real_time / period) * phase - std::floor(real_time / (period * phases)) * servo_own;
    return {phase / period, servo_own / (period * phases), real_time_own / (period * phases * servos)};
  }
  Duty measured_duty(unsigned servo_periods) {
    TaskClock clock(machine().cpu());
    wait(servo_periods * kServo);
    EXPECT_NEAR(clock.of(kIrqServo).count, servo_periods, 1);
    EXPECT_NEAR(clock.of(kIrqPhase).count, 4 * servo_periods, 2);
    const double window = servo_periods * kServoCycles;
    return {clock.of(kIrqPhase).own / window, clock.of(kIrqServo).own / window, clock.of(kIrqRealTime).own / window};
  }
};

TEST_P(TaskLoad, WordsAreTheCyclesFromTrapToReturn) {
  start();
  expect_words("idle");
  ask("I101=1");
  expect_words("one commutated motor");
  ask("I200=1 I201=1");
  expect_words("two commutated motors");
  load_plc0({"P9=0", "WHILE(P9<3)", "P9=P9+1", "ENDWHILE"});
  ask("ENABLE PLC 0");
  expect_words("PLC 0");
  ask("I101=0 I201=0 I5=0");
  ask("#1->1000X &1 OPEN PROG 1 CLEAR INC TM200 LINEAR X1 CLOSE");
  ask("B1R");
  expect_words("a move");
  EXPECT_EQ(ask("???"), "000000000800");
}

// The load that a host works out from the words is that of the CPU; three times as many real-time interrupts cost three
// times as much.
TEST_P(TaskLoad, PublishedFormulaGivesTheLoad) {
  start();
  ask("M70->X:$FFFF8C,0,24 M71->X:$37,0,24 M72->Y:$37,0,24 M73->X:$B,0,24 I101=1 I200=1 I201=1");
  load_plc0({"P9=0", "WHILE(P9<3)", "P9=P9+1", "ENDWHILE"});
  ask("ENABLE PLC 0");
  double real_time[2];
  for (const int i8 : {0, 2}) {
    SCOPED_TRACE(i8);
    ask("I8=" + std::to_string(i8));
    wait(10 * kServo);
    const Duty told = published_duty(), measured = measured_duty(120);
    EXPECT_NEAR(told.phase, measured.phase, 0.05 * measured.phase);
    EXPECT_NEAR(told.servo, measured.servo, 0.05 * measured.servo);
    EXPECT_NEAR(told.real_time, measured.real_time, 0.05 * measured.real_time);
    EXPECT_NEAR(told.all(), measured.all(), 0.03 * measured.all());
    EXPECT_LT(told.all(), 1.0);
    RecordProperty("percent_i8_" + std::to_string(i8), static_cast<int>(100 * told.all()));
    real_time[i8 / 2] = told.real_time;
  }
  EXPECT_GT(real_time[0], 0.1);
  EXPECT_NEAR(real_time[0], 3 * real_time[1], 0.05 * real_time[0]);
}

class TaskOverRun : public TaskLoad {};

// The third scan is too long: bit 22 tells it for ever, bit 9 until one was in time.
TEST_P(TaskOverRun, PlcZeroThatOverRunsSetsBits22And9) {
  start();
  ask("M9->X:$6,9 M22->X:$6,22 P1=0 I8=0");
  std::vector<std::string> lines = {"P1=P1+1", "IF(P1=3)", "P9=0", "WHILE(P9<60)", "P9=P9+1", "ENDWHILE", "ENDIF"};
  for (const int scan : {3, 4, 7}) {
    const std::string n = std::to_string(scan);
    lines.insert(lines.end(), {"IF(P1=" + n + ")", "P1" + n + "=M9", "P2" + n + "=M22", "ENDIF"});
  }
  load_plc0(lines);
  ASSERT_EQ(ask("P13=9 P14=9 P17=9 ENABLE PLC 0"), "");
  wait(20 * kServo);
  EXPECT_GT(std::stod(ask("P1")), 7.0);
  EXPECT_EQ(ask("P13 P23"), "1|1") << "at the end of that scan";
  EXPECT_EQ(ask("P14 P24"), "1|1") << "until the next has been in time";
  EXPECT_EQ(ask("P17 P27"), "0|1");
  EXPECT_GT(word(false, 0x0B), kServoCycles / 2) << "the longest, half cycles";
  EXPECT_EQ(ask("???"), "400000000800");
  ask("M22=0");
  EXPECT_EQ(ask("???"), "000000000800");
}

BRICK_ON_ENGINES(TaskLoad, Engine::kSystemC);
BRICK_ON_ENGINES(TaskOverRun, Engine::kRtl, Engine::kSystemC);

}  // namespace
}  // namespace brick
