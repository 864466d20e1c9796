// BREQ and the Rotary Buffer Full bits against a scoreboard that is written from the rules of firmware:4.5 and
// host-bus:5.7 alone.
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::breq;
using platform::edges;
using platform::host;

// What the host should see of one coordinate system.
struct Scoreboard {
  int on, off;  // I16, I17
  int lines = 0;
  bool full = false;

  void stored() {
    ++lines;
    if (lines >= off) full = true;  // else Full keeps its value: hysteresis
  }
  void calculated() {
    --lines;
    if (lines < on) full = false;
  }
  bool pin() const { return !full; }
};

bool full_bit(unsigned cs) { return (motion_cs_status(cs, 1) >> 16) & 1u; }

class BufferRequest : public FirmwareTest {
 protected:
  static void limits(int on, int off) {
    ASSERT_EQ(host("I16=" + std::to_string(on) + " I17=" + std::to_string(off)), "");
  }
  static void open(const std::string& set_up = "&1DEF ROT 500") {
    ASSERT_EQ(host(set_up), "");
    ASSERT_EQ(host("&1B0 OPEN ROT"), "");
    platform::clear_edges();
  }
  static void store(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      ASSERT_EQ(host("P1=1"), "");
      platform::pass_us(20);
    }
  }
  static void calculate_one() {  // as the real-time task does at the end of a line
    word48_t word = 0;
    ASSERT_TRUE(rotary_peek(session.cs, 0, &word));
    ASSERT_TRUE(rotary_consume(session.cs, 1));
  }
};

TEST_F(BufferRequest, IdleIsLow) {
  EXPECT_FALSE(breq());
  ASSERT_EQ(host("DEF ROT 20"), "");
  EXPECT_FALSE(breq()) << "defined, not opened yet";
  ASSERT_EQ(host("OPEN ROT"), "");
  EXPECT_TRUE(breq());
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_TRUE(breq()) << "CLOSE changes nothing while the buffer exists";
  ASSERT_EQ(host("DEL ROT"), "");
  EXPECT_FALSE(breq());
}

TEST_F(BufferRequest, EachLinePulsesLowAtLeastOneMicrosecond) {
  BRICK_COVERS("BREQ-1 BREQ-2");
  open();
  for (int line = 1; line < 10; ++line) {
    platform::clear_edges();
    store(1);
    ASSERT_EQ(edges().size(), 2u) << "line " << line;
    EXPECT_FALSE(edges()[0].high);
    EXPECT_TRUE(edges()[1].high);
    const double low = edges()[1].us - edges()[0].us;
    EXPECT_GE(low, 1.0);
    EXPECT_LE(low, 50.0);
    EXPECT_FALSE(full_bit(0));
  }
}

TEST_F(BufferRequest, StaysLowAtI17Lines) {
  BRICK_COVERS("BREQ-3 I17-1");
  open();
  store(9);
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full_bit(0));
  platform::clear_edges();
  store(1);  // the tenth: PR = I17
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full_bit(0));
  EXPECT_EQ(edges().size(), 1u);
  store(5);  // the host may go on
  EXPECT_EQ(host("PR"), "15");
  EXPECT_FALSE(breq());
  EXPECT_EQ(edges().size(), 1u);
  ASSERT_EQ(host("X1Y2Z3"), "");
  EXPECT_EQ(host("PR"), "16") << "lines, not words";
}

TEST_F(BufferRequest, RisesWhenFewerThanI16LinesAreLeft) {
  BRICK_COVERS("BREQ-4");
  open();
  store(10);
  for (int left = 9; left >= 5; --left) {
    calculate_one();
    EXPECT_FALSE(breq()) << left;
    EXPECT_TRUE(full_bit(0)) << left;
  }
  platform::clear_edges();
  calculate_one();  // 4 < I16
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full_bit(0));
  ASSERT_EQ(edges().size(), 1u);
}

TEST_F(BufferRequest, HysteresisBetweenThePoints) {
  BRICK_COVERS("BREQ-4");
  open();
  store(10);
  calculate_one();
  calculate_one();
  calculate_one();  // 7 lines, Full = 1
  platform::clear_edges();
  store(1);  // 8 < I17, yet it stays low
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full_bit(0));
  EXPECT_TRUE(edges().empty());
}

TEST_F(BufferRequest, AgreesWithTheScoreboardOverRandomTraffic) {
  BRICK_COVERS("BREQ-1 BREQ-2 BREQ-3 BREQ-4 I17-1");
  const int settings[][2] = {{5, 10}, {5, 5}, {0, 0}, {0, 1}, {1, 1}, {3, 4}, {0, 10}, {8, 3}, {1, 100}, {5, 0}};
  std::mt19937 random(brick::random_seed(5));
  for (const auto& setting : settings) {
    platform::power_up();
    limits(setting[0], setting[1]);
    open();
    Scoreboard expected{setting[0], setting[1]};
    if (setting[1] == 0) expected.full = true;  // 0 lines are not fewer than 0
    for (int step = 0; step < 1500; ++step) {
      const bool was = expected.pin();
      platform::clear_edges();
      if (random() % 100 < (expected.lines < 15 ? 55u : 40u)) {
        store(1);
        expected.stored();
        // A line always takes the pin low; it comes back unless the buffer is full.
        ASSERT_EQ(edges().size(), (was ? 1u : 0u) + (expected.pin() ? 1u : 0u))
            << "I16=" << setting[0] << " I17=" << setting[1];
        if (!edges().empty()) { ASSERT_EQ(edges().front().high, !was); }
      } else if (expected.lines > 0) {
        calculate_one();
        expected.calculated();
        ASSERT_EQ(edges().size(), was == expected.pin() ? 0u : 1u);
      }
      ASSERT_EQ(breq(), expected.pin()) << "I16=" << setting[0] << " I17=" << setting[1] << " lines " << expected.lines;
      ASSERT_EQ(full_bit(0), expected.full);
      ASSERT_EQ(host("PR"), std::to_string(expected.lines));
    }
  }
}

TEST_F(BufferRequest, ZeroPointsKeepItLowUntilTheyChange) {
  BRICK_COVERS("I17-1");
  limits(0, 0);
  open();
  store(2);
  EXPECT_FALSE(breq());
  calculate_one();
  calculate_one();
  EXPECT_FALSE(breq()) << "0 < I16 = 0 never holds";
  EXPECT_TRUE(full_bit(0));
  ASSERT_EQ(host("CLOSE I17=10"), "");
  EXPECT_FALSE(breq());
  ASSERT_EQ(host("I16=5"), "");
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full_bit(0));
}

TEST_F(BufferRequest, ABufferThatWasNotOpenedIsNotFullByAChangedPoint) {
  limits(5, 10);
  ASSERT_EQ(host("DEF ROT 50"), "");
  for (const char* line : {"I17=0", "I16=3", "I17=10"}) {
    ASSERT_EQ(host(line), "");
    EXPECT_FALSE(full_bit(0)) << line;
    EXPECT_FALSE(breq());
  }
  open("&1");
  EXPECT_TRUE(breq());
}

TEST_F(BufferRequest, AChangedPointThatNobodyReportedIsNoticedByTheRealTimeTask) {
  open();
  store(8);
  platform::set_i(17, 6);
  platform::real_time();
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full_bit(0));
  platform::set_i(16, 9);
  platform::real_time();
  EXPECT_TRUE(breq());
}

TEST_F(BufferRequest, PinFollowsTheAddressedCoordinateSystem) {
  BRICK_COVERS("BREQ-7");
  open("&16DEF ROT 50 &3DEF ROT 50 &1DEF ROT 50");
  store(10);
  EXPECT_FALSE(breq());
  platform::clear_edges();
  ASSERT_EQ(host("&3"), "");
  EXPECT_TRUE(breq()) << "empty";
  ASSERT_EQ(host("&2"), "");
  EXPECT_FALSE(breq()) << "no rotary buffer";
  ASSERT_EQ(host("&16"), "");
  EXPECT_TRUE(breq());
  ASSERT_EQ(host("&1"), "");
  EXPECT_FALSE(breq()) << "its state was kept";
  EXPECT_EQ(edges().size(), 4u);
  EXPECT_TRUE(full_bit(0));
  EXPECT_FALSE(full_bit(2));
}

TEST_F(BufferRequest, AnotherCoordinateSystemsLinesDoNotMoveThePin) {
  BRICK_COVERS("BREQ-7");
  open("&2DEF ROT 50 &1DEF ROT 50");
  const instruction in{OP_AXIS, 0, AXIS_X, 1.0};
  const word48_t word = word_encode(&in);
  for (int i = 0; i < 12; ++i) ASSERT_EQ(rotary_store(1, &word, 1), ERR_NONE);
  EXPECT_TRUE(edges().empty());
  EXPECT_TRUE(full_bit(1));
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(rotary_consume(1, 1));
  EXPECT_TRUE(edges().empty());
  EXPECT_FALSE(full_bit(1));
}

TEST_F(BufferRequest, AnotherCoordinateSystemThatEmptiesDoesNotRaiseThePin) {
  BRICK_COVERS("BREQ-7");
  open("&2DEF ROT 50 &1DEF ROT 50");
  ASSERT_EQ(host("&2"), "");
  store(10);
  ASSERT_EQ(host("&1"), "");
  store(10);
  ASSERT_FALSE(breq());
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(rotary_consume(1, 1));
  EXPECT_FALSE(full_bit(1));
  EXPECT_FALSE(breq()) << "&1 is addressed and full";
}

TEST_F(BufferRequest, ClearAndDeleteReset) {
  open();
  store(12);
  EXPECT_FALSE(breq());
  ASSERT_EQ(host("CLEAR"), "");
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full_bit(0));
  store(12);
  ASSERT_EQ(host("CLOSE DEL ROT"), "");
  EXPECT_FALSE(breq());
  EXPECT_FALSE(full_bit(0));
}

TEST_F(BufferRequest, RefusedLineLeavesThePinAlone) {
  open("&1DEF ROT 3");
  store(3);
  platform::clear_edges();
  EXPECT_EQ(host("P1=1"), "ERR006");
  EXPECT_EQ(host("P1=1 GOTO5"), "ERR003");
  EXPECT_TRUE(edges().empty());
  EXPECT_TRUE(breq());
}

TEST_F(BufferRequest, HighAtLeastOneMicrosecondBetweenPulses) {
  open();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(host("P1=1"), "");  // no time passes between the lines
  ASSERT_EQ(edges().size(), 10u);
  for (std::size_t i = 2; i < edges().size(); i += 2) EXPECT_GE(edges()[i].us - edges()[i - 1].us, 0.9999);
}

// host-bus:5.7/16: the other signals of the latch are others'.
TEST_F(BufferRequest, OnlyItsOwnSignalMoves) {
  constexpr std::uint32_t kOthers = HAL_SIGNAL_IPOS | HAL_SIGNAL_EROR | HAL_SIGNAL_F1ER;
  for (const std::uint32_t others : {kOthers, 0u}) {
    open("DEL ROT DEF ROT 50");
    hal_host_signals(others, kOthers & ~others);
    for (const unsigned lines : {1u, 9u}) {
      store(lines);
      EXPECT_EQ(fake_hal_signals() & kOthers, others);
    }
    ASSERT_FALSE(breq());
    ASSERT_EQ(host("CLEAR"), "");
    ASSERT_TRUE(breq());
    EXPECT_EQ(fake_hal_signals() & kOthers, others);
    buffer_request_initialize();
    EXPECT_FALSE(breq());
    EXPECT_EQ(fake_hal_signals() & kOthers, others);
    EXPECT_EQ(buffer_request_selected(), 0u) << "of the host; no panel";
    ASSERT_EQ(host("CLOSE"), "");
  }
}

// host-bus:5.7/7 is about pulses: while the pin is low there is nothing to wait for.
TEST_F(BufferRequest, LinesOfAFullBufferTakeNoTime) {
  limits(0, 1);
  open();
  ASSERT_EQ(host("P1=1"), "");
  ASSERT_FALSE(breq());
  const std::uint64_t then = hal_long_cycles();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(host("P1=1"), "");
  EXPECT_EQ(hal_long_cycles(), then);
}

TEST_F(BufferRequest, RealTimeTaskIsHeldOffForMicrosecondsOnly) {
  open();
  store(30);
  EXPECT_LE(platform::longest_mask_us(), 5.0);
}

}  // namespace
