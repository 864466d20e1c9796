// Sequences of segments one behind the other, where moves do not blend, and a move of another kind behind them all
// (motion:5.3, motion:7.1).
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class Sequences : public MovingMotors {};

// Lines without blends are sequences of 100 + 20 + 2 x 5 ms. While the first is executed the others are calculated: a
// DWELL, RAPID, SPLINE or PVT move behind them comes last all the same.
TEST_F(Sequences, AnotherMoveDoesNotOvertakeThoseThatWait) {
  const struct {
    const char* line;
    double way, ms;  // 0: it takes what it takes
  } lasts[] = {
      {"DWELL300", 0, 300}, {"RAPID X1", 1000, 0}, {"SPLINE1 TM100 X1", 1000, 300}, {"PVT100 X1:0", 1000, 100}};
  for (const auto& last : lasts)
    for (const char* blends : {"I5192=1", "I5192=0 I5183=0.9 I5181=0"})
      for (const char* ahead : {"I5120=0", "I5120=40"}) {
        SCOPED_TRACE(std::string(last.line) + " " + blends + " " + ahead);
        platform::power_up();
        fit({"1000X", "1000Y"});
        ASSERT_EQ(host("I5113=5 I116=100 I216=100 I119=1 I120=20 I121=0 I122=20 I192=1 DELETE GATHER"), "");
        ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,10"), "");
        ASSERT_EQ(host(std::string(blends) + " " + ahead), "");
        store({"INC TM100 TA20 TS0 X1", "Y1", "X1", last.line, "P1=1"});
        double x = 0, y = 0, came = 0;
        const double end = run([&](double t) {
          ASSERT_LE(std::abs(at(1) - x) + std::abs(at(2) - y), 21 * kTickMs) << "at " << t;
          x = at(1), y = at(2);
          if (came == 0 && x == 2000 && y == 1000) came = t;
          if (x > 2000) { ASSERT_EQ(y, 1000); }
        });
        EXPECT_NEAR(came, 3 * 130, 3 * 10) << "up to ten servo interrupts from one to the next";
        EXPECT_EQ(motors[0].trajectory, std::llround((2000 + last.way) * kUnit));
        EXPECT_EQ(motors[1].trajectory, 1000 * 3072);
        if (last.ms != 0) { EXPECT_NEAR(end - came, last.ms, 10); }
        EXPECT_EQ(cs().error, RUN_TIME_NONE);
      }
}

}  // namespace
