// Times of BREQ's pulses to the cycle, and its state behind each change of I16 and I17 (host-bus:5.7, firmware:4.5).
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::edges;
using platform::host;

class RequestTimes : public FirmwareTest {
 protected:
  // Lines one right behind the other: low for T_PULSE, high for a microsecond before the next.
  static void expect_pulses() {
    platform::pass_us(20);
    platform::clear_edges();
    for (int i = 0; i < 4; ++i) ASSERT_EQ(host("P1=1"), "");
    ASSERT_EQ(edges().size(), 8u);
    for (std::size_t i = 1; i < edges().size(); ++i)
      EXPECT_NEAR(edges()[i].us - edges()[i - 1].us, i % 2 == 1 ? 2.0 : 1.0, 0.02) << i;
  }
};

TEST_F(RequestTimes, APulseLastsTwoMicroseconds) {
  ASSERT_EQ(host("DEF ROT 100 OPEN ROT"), "");
  expect_pulses();
  ASSERT_EQ(host("CLOSE DEL ROT"), "");
  for (const char* buffer : {"PROG 1", "PLC 1", "FORWARD"}) {
    ASSERT_EQ(host(std::string("OPEN ") + buffer), "");
    expect_pulses();
    ASSERT_EQ(host("CLOSE"), "");
  }
}

// Full stays so with I16 lines or more, else it becomes so with I17 or more: of each buffer that was opened.
TEST_F(RequestTimes, ChangedPointsAreThoseOfTheStateBefore) {
  ASSERT_EQ(host("&3DEF ROT 60 &2DEF ROT 60 I16=5 I17=10 OPEN ROT"), "");
  for (int i = 0; i < 8; ++i) ASSERT_EQ(host("DWELL0"), "");  // &2: 8 lines
  ASSERT_EQ(host("CLOSE &1DEF ROT 50 &2"), "");
  const struct {
    int on, off;
    bool full;
  } steps[] = {{5, 9, false},   {5, 8, true}, {8, 8, true},   {8, 100, true}, {9, 100, false},
               {0, 100, false}, {0, 8, true}, {0, 100, true}, {20, 0, false}, {19, 0, true}};
  for (const auto& step : steps) {
    SCOPED_TRACE(::testing::Message() << step.on << ", " << step.off);
    platform::set_i(16, step.on);
    platform::set_i(17, step.off);
    platform::real_time();
    EXPECT_EQ(motion_cs_status(1, 1) >> 16 & 1u, step.full);
    EXPECT_EQ(platform::breq(), !step.full);
    EXPECT_EQ(motion_cs_status(0, 1) >> 16 & 1u, 0u) << "never opened";
    EXPECT_EQ(motion_cs_status(2, 1) >> 16 & 1u, step.on == 20) << "no line, which are as many as I17 there";
  }
}

}  // namespace
