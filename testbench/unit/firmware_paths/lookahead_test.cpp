// Lookahead (motion:7.3, motion:7.4): what is executed keeps the limits, and the path.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class Lookahead : public MovingMotors {
 protected:
  // Largest of the first and second differences (counts a ms, a ms^2) of a motor at any interrupt.
  struct Extremes {
    double velocity = 0, acceleration = 0;
  };
  static std::vector<Extremes> extremes(unsigned count, double* end, const std::string& start = "&1B1R") {
    std::vector<Extremes> found(count);
    std::vector<std::vector<double>> samples(count);
    constexpr unsigned kSpan = 8;  // interrupts
    *end = run(
        [&](double) {
          for (unsigned i = 0; i < count; ++i) {
            auto& s = samples[i];
            s.push_back(at(i + 1));
            const std::size_t n = s.size();
            if (n < 2 * kSpan + 1) continue;
            const double span = kSpan * kTickMs, v1 = (s[n - 1] - s[n - 1 - kSpan]) / span;
            const double v0 = (s[n - 1 - kSpan] - s[n - 1 - 2 * kSpan]) / span;
            found[i].velocity = std::max(found[i].velocity, std::abs(s[n - 1] - s[n - 2]) / kTickMs);
            found[i].acceleration = std::max(found[i].acceleration, std::abs(v1 - v0) / span);
          }
        },
        start);
    return found;
  }
};

// X 0 to 100 000 counts at 100 counts/ms asked for, 50 allowed; 1 count/ms^2: 50 ms up and down.
TEST_F(Lookahead, ALineIsLimited) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F100 TA10 TS0", "X100"});
  double end = 0;
  const auto found = extremes(1, &end);
  EXPECT_EQ(motors[0].trajectory, 100000 * 3072LL);
  EXPECT_LE(found[0].velocity, 50 * 1.005);
  EXPECT_LE(found[0].acceleration, 1.02);
  EXPECT_GE(found[0].velocity, 49.5);
  EXPECT_LE(end, 1.1 * (2000 + 50));
}

TEST_F(Lookahead, CornersAreSlowedDown) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=0.5"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F40 TA10 TS0", "X20", "Y20", "X0", "Y0", "X10 Y10", "CIRCLE1 X10 Y10 I5 J0"});
  double end = 0;
  const auto found = extremes(2, &end);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072LL);
  EXPECT_EQ(motors[1].trajectory, 10000 * 3072LL);
  EXPECT_LE(found[0].acceleration, 1.02);
  EXPECT_LE(found[1].acceleration, 0.51);
  EXPECT_LE(found[0].velocity, 40 * 1.005);
  EXPECT_GT(found[0].velocity, 39.5);
  RecordProperty("ms", static_cast<int>(end));
}

}  // namespace
