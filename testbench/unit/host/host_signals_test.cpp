#include "systemc/host/host_signals.h"

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/host/lockstep.h"

namespace brick {
namespace {

class HostSignalsTest : public ::testing::Test {
 protected:
  HostSignals model_{"signals"};
  Lockstep<HostSignals> both_{make_rtl_host_signals(), model_, [](const HostSignals& m) {
                                return Outputs{{"rdata", m.rdata()}, {"ctrl", m.ctrl()}, {"ipos", m.ipos()},
                                               {"breq", m.breq()},   {"eror", m.eror()}, {"f1er", m.f1er()}};
                              }};
  void write(unsigned value) {
    both_.in = {true, false, static_cast<std::uint8_t>(value), both_.in.trip};
    both_.ref();
    both_.in.wr = false;
  }
  void write_ctrl(unsigned value) {
    both_.in = {false, true, static_cast<std::uint8_t>(value), both_.in.trip};
    both_.ref();
    both_.in.ctrl_wr = false;
  }
};

TEST_F(HostSignalsTest, EachBitDrivesItsLine) {
  BRICK_COVERS("BREQ-5");
  const char* names[] = {"ipos", "breq", "eror", "f1er"};
  for (unsigned value = 0; value < 16; ++value) {
    write(value);
    EXPECT_EQ(both_.get("rdata"), value);
    for (unsigned bit = 0; bit < 4; ++bit) EXPECT_EQ(both_.get(names[bit]), value >> bit & 1) << names[bit];
  }
  both_.in.wdata = 0;
  both_.ref(2);
  EXPECT_EQ(both_.get("rdata"), 15u) << "no strobe, no change";
  both_.reset();
  EXPECT_EQ(both_.get("rdata"), 0u);
  EXPECT_LOCKSTEP(both_);
}

// host-bus:5.7/16: CTRL0 and CTRL1 are a word of their own, so each writer leaves the other's bits alone.
TEST_F(HostSignalsTest, ControlOutputsAndHostSignalsDoNotTouchEachOther) {
  for (unsigned value = 0; value < 16; ++value) {
    write(value);
    write_ctrl(~value & 0xF);
    EXPECT_EQ(both_.get("rdata"), value);
    EXPECT_EQ(both_.get("ctrl"), ~value & 3);
    write(value ^ 0xF);
    write(value);
    EXPECT_EQ(both_.get("ctrl"), ~value & 3);
  }
  write_ctrl(3);
  ASSERT_EQ(both_.get("ctrl"), 3u) << "what the reset is to clear";
  both_.reset();
  EXPECT_EQ(both_.get("ctrl"), 0u);
  EXPECT_LOCKSTEP(both_);
}

// servo-ic:10/10: a trip empties CTRL0 and CTRL1, a write at its edge too, and no write counts until the reset.
TEST_F(HostSignalsTest, ATripEmptiesTheControlOutputsUntilTheReset) {
  for (unsigned value = 1; value < 4; ++value) {
    write(9);
    write_ctrl(value);
    ASSERT_EQ(both_.get("ctrl"), value);
    both_.in.trip = true;
    write_ctrl(value);
    EXPECT_EQ(both_.get("ctrl"), 0u) << "a write at the edge of the trip";
    for (unsigned written = 0; written < 4; ++written) {
      write_ctrl(written);
      EXPECT_EQ(both_.get("ctrl"), 0u);
    }
    write(6);
    EXPECT_EQ(both_.get("rdata"), 6u) << "the host signals go on";
    both_.in.trip = false;  // as the reset that ends a trip does
    both_.reset();
    EXPECT_EQ(both_.get("ctrl"), 0u);
    write_ctrl(value);
    EXPECT_EQ(both_.get("ctrl"), value);
  }
  EXPECT_LOCKSTEP(both_);
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(HostSignalsTest, SleepsWhileNothingMoves) {
  EXPECT_TRUE(both_.asleep());
  write(9);
  write_ctrl(3);
  EXPECT_TRUE(both_.asleep());
  both_.in.wr = both_.in.ctrl_wr = true;  // a strobe that changes nothing
  both_.in.wdata = 3;
  both_.ref();
  EXPECT_TRUE(both_.asleep());
  both_.in.trip = true;
  both_.ref();
  EXPECT_TRUE(both_.asleep());
  EXPECT_LOCKSTEP(both_);
}

TEST_F(HostSignalsTest, ComparisonSeesSwappedBits) {
  both_.mutate = [](HostSignals::Inputs& in) {
    in.wdata = static_cast<std::uint8_t>((in.wdata & 9) | (in.wdata & 2) << 1 | (in.wdata & 4) >> 1);
  };
  write(2);
  EXPECT_NE(both_.difference(), "");
}

}  // namespace
}  // namespace brick
