// What the rules of motion do not speak of makes no difference: the direction of a motor, its number and that of its
// system, what other motors and systems did before. Each program runs twice, and each servo interrupt is compared.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

// X and Y of a system; `sign` turns both round.
struct Machine {
  unsigned cs, x, y;
  int sign;
};

constexpr Machine kPlain = {1, 1, 2, 1}, kMirrored = {1, 1, 2, -1}, kElsewhere = {5, 12, 7, 1};

using Positions = std::vector<std::pair<std::int64_t, std::int64_t>>;

class OtherMotors : public MovingMotors {
 protected:
  static std::string of_motor(unsigned motor, const std::string& variable) {
    return "I" + std::to_string(motor) + variable + " ";
  }
  static std::string of_system(unsigned cs, const std::string& variable) {
    return "I" + std::to_string(50 + cs) + variable + " ";
  }
  static void close(unsigned motor) {
    motors[motor - 1] = {};
    motors[motor - 1].loop = LOOP_CLOSED;
    motors[motor - 1].position_scale = 96;
  }
  // 50 counts/ms, 1 count/ms^2; limits of desired positions 9,000 counts from 0, at which a motor is held.
  static void fit_machine(const Machine& m) {
    const std::string select = "&" + std::to_string(m.cs), scale = m.sign < 0 ? "-1000" : "1000";
    for (const unsigned motor : {m.x, m.y}) {
      ASSERT_EQ(
          host(of_motor(motor, "00=1") + of_motor(motor, "16=50") + of_motor(motor, "17=1") + of_motor(motor, "11=0") +
               of_motor(motor, "12=0") + of_motor(motor, "15=1") + of_motor(motor, "22=40") + of_motor(motor, "19=1") +
               of_motor(motor, "20=20") + of_motor(motor, "21=5") + of_motor(motor, "13=9000") +
               of_motor(motor, "14=-9000") + of_motor(motor, "41=0") + of_motor(motor, "24=*")),
          "");
      const std::string axis = motor == m.x ? "X" : "Y";
      ASSERT_EQ(host(select + "#" + std::to_string(motor) + "->" + scale + axis), "");
      close(motor);
    }
    std::string settings;
    for (const char* variable : {"13=*", "20=*", "82=*", "83=*", "90=*"}) settings += of_system(m.cs, variable);
    ASSERT_EQ(host(settings), "");
    ASSERT_EQ(host("DELETE GATHER"), "");
    (void)host(select + "DELETE LOOKAHEAD");
    ASSERT_EQ(host(select + "DEFINE LOOKAHEAD 300,10"), "");
  }
  // Where both are, from the interrupt on that begins the first move.
  static void record(const Machine& m, const std::string& settings, const Lines& lines, Positions* found) {
    fit_machine(m);
    std::string all;
    for (std::size_t begin = 0; begin < settings.size();) {  // `13=5` of the system, `x24=$1` of the motors
      const std::size_t end = std::min(settings.find(' ', begin), settings.size());
      const std::string word = settings.substr(begin, end - begin);
      all += word[0] == 'x' ? of_motor(m.x, word.substr(1)) + of_motor(m.y, word.substr(1)) : of_system(m.cs, word);
      begin = end + 1;
    }
    ASSERT_EQ(host(all), "");
    Lines all_lines = {"LINEAR ABS NORMAL K-1 FRAX(X,Y,Z)"};
    all_lines.insert(all_lines.end(), lines.begin(), lines.end());
    store(all_lines);
    ASSERT_EQ(host("&" + std::to_string(m.cs) + "B1R"), "");
    const unsigned cs = m.cs - 1;
    for (int i = 0; i < 1000 && !coordinate_systems[cs].active; ++i) platform::servo_ticks(1);
    ASSERT_TRUE(coordinate_systems[cs].active);
    for (unsigned tick = 0; run_is_running(cs) && tick < 20000; ++tick) {
      found->emplace_back(motors[m.x - 1].trajectory * m.sign, motors[m.y - 1].trajectory * m.sign);
      platform::servo_ticks(1);
    }
    EXPECT_FALSE(run_is_running(cs)) << "it does not end";
    EXPECT_EQ(coordinate_systems[cs].error, RUN_TIME_NONE);
    found->emplace_back(motors[m.x - 1].trajectory * m.sign, motors[m.y - 1].trajectory * m.sign);
  }
  // It moves by more than a quarter of a unit in both axes, and ends at these.
  static void expect_moves_to(const Positions& found, double x, double y) {
    ASSERT_FALSE(found.empty());
    std::int64_t most_x = 0, most_y = 0;
    for (const auto& [at_x, at_y] : found) {
      most_x = std::max(most_x, std::abs(at_x - found.front().first));
      most_y = std::max(most_y, std::abs(at_y - found.front().second));
    }
    EXPECT_GT(most_x, 250 * kUnit);
    EXPECT_GT(most_y, 250 * kUnit);
    EXPECT_NEAR(static_cast<double>(found.back().first), x * 1000 * kUnit, 10);
    EXPECT_NEAR(static_cast<double>(found.back().second), y * 1000 * kUnit, 10);
  }
  static void expect_same(const Positions& a, const Positions& b, std::int64_t tolerance) {
    ASSERT_FALSE(a.empty() || b.empty());
    ASSERT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()), tolerance < 1000 ? 0.0 : 1.0);
    std::int64_t worst = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      worst = std::max({worst, std::abs(a[i].first - b[i].first), std::abs(a[i].second - b[i].second)});
    EXPECT_LE(worst, tolerance) << "units of position";
    EXPECT_EQ(a.back(), b.back());
  }
};

struct Case {
  const char *name, *settings;
  Lines lines;
  double y = 0;  // where it ends; X at 0
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"Linear", "", {"TM100 TA40 TS10 X1 Y-.5", "X-2 Y.3", "TA20 TS0 F30 X1 Y2", "DELAY30", "X0"}, 2},
      {"Rapid", "", {"RAPID X1 Y-3", "X-1 Y1", "DWELL10", "X0 Y0"}},
      {"Pvt", "90=1000", {"PVT100", "X1:10 Y-1:-5", "X.5:-8 Y-2:0", "X0:0 Y0:0"}},
      {"Spline", "", {"SPLINE1 TM60", "X1 Y-1", "X1.5 Y-3", "SPLINE2 TM40 X-1 Y-2", "X0 Y0"}},
      {"Segments", "13=5", {"TM100 TA40 TS10 X1 Y-.5", "CIRCLE1 X-1 I-1 J0", "CIRCLE2 X1 Y.5 R2", "LINEAR X0"}, .5},
      {"Corners", "13=5 83=.7 82=20", {"TM60 TA20 TS0 X1", "Y1", "X1.5 Y1.1", "X0 Y0"}},
      {"Lookahead", "13=5 20=40 83=0", {"F100 TA10 TS0 X6", "Y5", "CIRCLE1 X0 Y-1 R8", "X-3 Y-3 R-4", "LINEAR X0 Y0"}},
      {"Stored", "13=5 20=1", {"F20 TA10 TS0 X1", "Y-1", "X0 Y0"}},
      {"Held", "13=5 20=40 x24=$C001", {"F40 TA10 TS0 X8 Y1", "X12 Y2", "X-11 Y-10", "X4 Y-9.5", "X0 Y0"}},
      {"BeyondTheRange", "13=5 20=40 x17=.01 x16=7", {"F1000 TA10 TS0 X6 Y.5", "X0 Y0"}},
  };
  return all;
}

class SameMotion : public OtherMotors, public ::testing::WithParamInterface<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Programs, SameMotion, ::testing::Range(std::size_t{0}, cases().size()),
                         [](const auto& at) { return std::string(cases()[at.param].name); });

// Positions and rates are rounded downwards: at 50 counts/ms 10,000 units are 0.07 ms.
TEST_P(SameMotion, InTheOtherDirection) {
  const Case& c = cases()[GetParam()];
  Positions plain, mirrored;
  record(kPlain, c.settings, c.lines, &plain);
  platform::power_up();
  record(kMirrored, c.settings, c.lines, &mirrored);
  expect_moves_to(plain, 0, c.y);
  const bool looks = std::string(c.settings).find("20=") != std::string::npos;
  expect_same(plain, mirrored, looks ? 10000 : 10);
}

// Behind the program of another system that used more motors, the same ones, and left them at their limits.
TEST_P(SameMotion, OfOtherMotorsBehindWhatOthersDid) {
  const Case& c = cases()[GetParam()];
  Positions plain, elsewhere;
  record(kPlain, c.settings, c.lines, &plain);
  platform::power_up();
  const Machine before = {3, 7, 12, -1};
  for (const Case& other : cases()) {
    Positions unused;
    if (std::string(other.name) == "Held") record(before, other.settings, {"F40 TA10 TS0 X12 Y11"}, &unused);
    if (std::string(other.name) == "Rapid") record(before, other.settings, other.lines, &unused);
  }
  ASSERT_EQ(host("UNDEFINE ALL"), "");
  ASSERT_EQ(host("&3DELETE LOOKAHEAD"), "");
  record(kElsewhere, c.settings, c.lines, &elsewhere);
  expect_moves_to(elsewhere, 0, c.y);
  expect_same(plain, elsewhere, 0);
}

}  // namespace
