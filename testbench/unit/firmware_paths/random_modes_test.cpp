// Random programs of all modes, with stops, holds and starts at random times (motion:5.4, motion:5.6, motion:7.1,
// motion:7.5): no motor ever leaps, and all come to the end of the program. BRICK_RANDOM_MODES: how many.
#include <cstdio>
#include <cstdlib>
#include <random>

#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/moving_motors.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/segment.h"
}

namespace {

using namespace moving_motors;

// Every place is in a square of 1000 counts, every move takes 50 ms or more: 20 counts a ms, wherever it begins. A
// spline of unequal times takes up to three times that, an arc of half a turn pi / 2, PVT 3/2 and twice the 5 counts a
// ms of its ends; two moves that blend may add up. RAPID goes 20.
constexpr double kFastest = 70;

class RandomModes : public MovingMotors {
 protected:
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  std::string of(const std::vector<std::string>& from) { return from[below(static_cast<unsigned>(from.size()))]; }
  std::string place(const char* axis) { return std::string(axis) + std::to_string(below(5) * 0.25); }
  std::string time() { return std::to_string(50 + 10 * below(10)); }
  std::string both() { return place("X") + " " + place("Y"); }

  // As `mode` has it; the velocity of PVT is 5 counts a ms at most.
  std::string axes(const std::string& mode) {
    if (mode == "PVT") {
      const auto end = [&] { return ":" + of({"0", "5", "-5", "3"}); };
      return place("X") + end() + " " + place("Y") + end();
    }
    if (mode.substr(0, 6) == "CIRCLE") return both() + " R" + of({"0.75", "1", "2"});
    return below(3) == 0 ? place("X") : both();
  }
  Lines program() {
    Lines lines = {"ABS TA20 TS" + of({"0", "5"}) + " TM100 LINEAR X0 Y0"};
    for (unsigned i = 4 + below(6); i > 0; --i) {
      const std::string mode = of({"LINEAR", "LINEAR", "CIRCLE1", "CIRCLE2", "SPLINE1", "SPLINE2", "PVT", "RAPID"});
      if (below(6) == 0) lines.push_back("I5113=" + of({"0", "1", "5", "10"}));
      lines.push_back(mode == "PVT" ? mode + time() : mode + " TM" + time());
      for (unsigned k = 1 + below(4); k > 0; --k) {
        if (mode != "PVT" && below(4) == 0) lines.push_back("TM" + time());
        lines.push_back(axes(mode));
      }
      if (below(4) == 0) lines.push_back(of({"DWELL20", "DELAY60", "DWELL0", "P2=P2+1"}));
    }
    lines.insert(lines.end(), {"LINEAR TM100 X1 Y0.5", "P1=1"});
    return lines;
  }
  void begin() {
    platform::power_up();
    fit({"1000X", "1000Y"});
    for (const char* i : {"I1", "I2"}) {
      const std::string n = i;
      ASSERT_EQ(host(n + "15=1 " + n + "19=1 " + n + "20=20 " + n + "21=0 " + n + "22=20 " + n + "92=1"), "");
      ASSERT_EQ(host(n + "28=8000000"), "");
      if (below(3) == 0) { ASSERT_EQ(host(n + "16=40 " + n + "17=2"), ""); }
    }
    ASSERT_EQ(host("I5190=1000 I5195=200000 I5194=200000 DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,30"), "");
    ASSERT_EQ(host("I5113=" + of({"0", "2", "5", "10"}) + " I5120=" + of({"0", "0", "1", "2", "20"})), "");
    ASSERT_EQ(host("I5182=" + of({"0", "0", "0", "5"}) + " I5183=" + of({"0", "0", "0.9"})), "");
    ASSERT_EQ(host("I5192=" + of({"0", "0", "0", "1"}) + " P1=0"), "");
    store(program());
    last_[0] = last_[1] = 0;
    lost_ = false;
    slow_ = below(3) == 0 ? 20 + below(200) : 0;
  }
  void servo() {
    fake_task_run_servo();
    for (unsigned i = 0; i < 2; ++i) {
      const double now = at(i + 1), speed = std::abs(now - last_[i]) / kTickMs;
      fastest_ = std::max(fastest_, speed);
      ASSERT_LE(speed, kFastest) << "#" << i + 1 << " from " << last_[i] << " to " << now << " in one interrupt";
      last_[i] = now;
    }
  }
  // Slow: each so many places at which the real-time task can be left, three times at most.
  void go(double ms) {
    for (unsigned n = ticks_of(ms); n > 0 && !HasFatalFailure(); --n) {
      servo();
      if (!hal_real_time_pending()) continue;
      unsigned pauses = 0;
      platform::real_time_in_slices([&] {
        if (slow_ != 0 && ++pauses % slow_ == 0 && pauses <= 3 * slow_) servo();
      });
    }
  }
  static bool stands() {
    return !run_is_running(0) && !cs().active && !cs().settling && !jog_is_moving(0) && !jog_is_moving(1);
  }
  // Calculated moves are lost: the program is begun anew.
  void abort() {
    ASSERT_EQ(host("&1A"), "");
    go(100);
    ASSERT_EQ(host("P1=0 &1B1"), "");
  }
  // To the end of the program, whatever it has been stopped by. Motors may have ramped away from PVT in motion, and
  // stand in a ramp that is held.
  void finish() {
    ASSERT_EQ(host("&1%100"), "");
    if (lost_) abort();
    for (unsigned i = 0; i < 60 && !(stands() && host("P1") == "1" && !segment_is_left(0) && !cs().next_valid); ++i) {
      if (cs().error == RUN_TIME_LATE) abort();
      const std::string told = host("&1R");
      if (told == "ERR017" || (told == "ERR011" && cs().held)) {
        ++away_;
        abort();
      } else {
        ASSERT_TRUE(told.empty() || told == "ERR011") << told;
      }
      go(300);
      ASSERT_FALSE(HasFatalFailure());
    }
    for (unsigned i = 0; i < 60 && !stands(); ++i) go(100);
    ASSERT_TRUE(stands());
    EXPECT_EQ(motors[0].trajectory, 1000 * 3072);
    EXPECT_EQ(motors[1].trajectory, 500 * 3072);
  }

  std::mt19937 random_;
  double last_[2] = {}, fastest_ = 0;
  bool lost_ = false;
  unsigned slow_ = 0, left_ = 0, away_ = 0, late_ = 0;
};

TEST_F(RandomModes, NoMotorLeaps) {
  const char* const wanted = std::getenv("BRICK_RANDOM_MODES");
  const unsigned count = wanted == nullptr ? 200 : static_cast<unsigned>(std::atoi(wanted));
  const std::uint32_t first = brick::random_seed(1);
  for (unsigned i = 0; i < count && !HasFailure(); ++i) {
    SCOPED_TRACE("seed " + std::to_string(first + i));
    random_.seed(first + i);
    begin();
    ASSERT_EQ(host("&1B1R"), "");
    for (unsigned k = 2 + below(12); k > 0 && !HasFatalFailure(); --k) {
      go(1 + below(below(2) == 0 ? 30 : 200));
      const std::string order = of({"Q", "/", "S", "H", "\\", "R", "R", ">", "<", "A", "%40", "%100"});
      (void)host("&1" + order);
      left_ += !run_is_running(0) && segment_is_left(0);
      late_ += cs().error == RUN_TIME_LATE;
      lost_ |= order == "A" || cs().error == RUN_TIME_LATE;
    }
    if (!HasFatalFailure()) finish();
    if (!HasFailure()) continue;
    for (const std::string& line : platform::host_lines("LIST PROG 1")) std::printf("%s\n", line.c_str());
  }
  std::printf("%u programs from seed %u, fastest %.1f counts a ms; %u stops left moves, %u aside, %u late\n", count,
              first, fastest_, left_, away_, late_);
}

}  // namespace
