// What strobes of Port A do at the pins of the whole board, the same expectations on both engines: when the word of a
// read stands and the bus is driven, that each fall is an access, and that those of other devices are none.
#include "testbench/unit/cosim/board_map.h"

namespace brick {
namespace {

// docs/port_a.md: the word of a read and its side effect are of one edge, the third of clk_ref that sees /RD low. HRDF
// falls when HORX has been read. On the on-chip page no pin is driven.
TEST_P(BoardMap, ReadOfTheHostPortTakesTheWordAtItsSample) {
  on_chip_write(0xFFFFC2, 1);  // HRIE
  for (Tick first = 1; first <= 3; ++first) {
    io_write(7, static_cast<std::uint16_t>(0x40 + first));
    rig.run(30);
    rig.run(6 - first - rig.now() % 3);  // the edge of clk_ref that first sees /RD low is so many ticks away
    begin_on_chip_read(0xFFFFC6);
    rig.run(first + 5);
    EXPECT_EQ(rig.get(pin::kIrqHost), 1u) << "before the sample";
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kIrqHost), 0u) << first;
    EXPECT_EQ(rig.get(pin::kPaData), 0x40u + static_cast<std::uint32_t>(first));
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u);
    io_write(7, 0x55);  // /RD still low
    EXPECT_EQ(rig.get(pin::kPaData), 0x40u + static_cast<std::uint32_t>(first));
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(9);
    EXPECT_EQ(rig.get(pin::kIrqHost), 1u) << "the end of the cycle takes nothing more";
    begin_on_chip_read(0xFFFFC6);
    rig.run(9);
    EXPECT_EQ(rig.get(pin::kPaData), 0x55u);
    rig.in.pa_rd_n = true;
    rig.apply();
  }
}

// docs/port_a.md: the board drives the bus from the sample on and no longer than /RD is low.
// host-bus:6.9/8: the third edge of clk_pwm after the strobe has the word.
TEST_P(BoardMap, DataPinsAreDrivenFromTheWordOfTheRamToTheEndOfTheRead) {
  rig.write(true, 0x060000, 0x1234);
  for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
    rig.run(30 + phase);
    rig.in.pa_addr = 0x060000;
    rig.in.pa_x = true;
    rig.in.pa_aa = 4;
    rig.apply();
    rig.run(2);
    rig.in.pa_rd_n = false;
    rig.apply();
    rig.run(2);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u);
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 1u);
    EXPECT_EQ(rig.get(pin::kPaData), 0x1234u);
    rig.run(20);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 1u);
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << "off with /RD";
    rig.in.pa_aa = 0;
    rig.apply();
  }
}

TEST_P(BoardMap, DataPinsAreDrivenFromTheSampleToTheEndOfTheRead) {
  struct Case {
    std::uint32_t address;
    std::uint8_t aa;
    std::uint32_t oe;
  };
  for (const Case& c : {Case{kHostSignals, 0, 1},
                        {kServoIcBase[0], 2, 1},
                        {0x078020, 2, 1},
                        {kHostSignals, 2, 0},
                        {0x050000, 0, 0},
                        {kServoIcBase[0], 8, 0}}) {
    SCOPED_TRACE(::testing::Message() << std::hex << c.address << " AA " << unsigned{c.aa});
    rig.run(30);
    rig.run(3 - rig.now() % 3);
    rig.in.pa_addr = c.address;
    rig.in.pa_x = true;
    rig.in.pa_aa = c.aa;
    rig.in.pa_rd_n = false;
    rig.apply();
    rig.run(8);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << "the third edge of clk_ref has not come";
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kPaDataOe), c.oe);
    rig.run(40);
    EXPECT_EQ(rig.get(pin::kPaDataOe), c.oe);
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(1);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << "off with /RD";
    rig.in.pa_rd_n = false;
    rig.apply();
    rig.run(5);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << "the next read has its own sample";
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(9);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << "too short for one";
  }
}

// /WR high for a tick only, less than a period of clk_ref: each of the writes is made, once.
TEST_P(BoardMap, WritesBackToBackDoNotMerge) {
  for (Tick phase = 0; phase < 3; ++phase) {
    rig.write(true, kHostSignals, 0);
    rig.run(30 + phase);
    rig.in.pa_x = true;
    rig.in.pa_addr = kHostSignals;
    rig.apply();
    for (const std::uint32_t value : {0x1u, 0x3u, 0x7u}) {
      rig.in.pa_wr_n = false;
      rig.apply();
      rig.in.pa_wdata = value;  // behind the strobe
      rig.apply();
      rig.run(9);
      EXPECT_EQ(rig.get(pin::kIpos) | rig.get(pin::kBreq) << 1 | rig.get(pin::kEror) << 2, value) << phase;
      rig.in.pa_wr_n = true;
      rig.apply();
      rig.run(1);
    }
  }
}

// host-bus:2.6/1: lows of a tick, 33.9 ns apart. The two words that HOTX gets go to RX one after the other; of the two
// that the host has sent each read frees one.
TEST_P(BoardMap, EachFallOfAStrobeIsAnAccessHoweverShortAndSoon) {
  const auto strobes = [this](bool BoardInputs::*strobe, unsigned word, Tick phase, Tick apart) {
    rig.in.pa_addr = word;
    rig.in.pa_x = rig.in.pa_int = true;
    rig.apply();
    rig.run(6 + 3 - rig.now() % 3 + phase);
    for (int i = 0; i < 2; ++i)
      for (const bool level : {false, true}) {
        rig.in.*strobe = level;
        rig.apply();
        rig.run(level ? apart - 1 : 1);
      }
    rig.run(9);
    rig.in.pa_int = false;
    rig.apply();
  };
  constexpr unsigned kRxdf = 1, kTrdy = 4;
  for (Tick phase = 0; phase < 3; ++phase) {
    rig.run(30);
    rig.in.pa_wdata = 0x41;
    strobes(&BoardInputs::pa_wr_n, 0x07, phase, 4);  // X:$FFFFC7
    for (int word = 0; word < 2; ++word) {
      EXPECT_NE(io_read(2) & kRxdf, 0u) << "word " << word << ", phase " << phase;
      EXPECT_EQ(io_read(7), 0x41u);
    }
    EXPECT_EQ(io_read(2) & kRxdf, 0u);
    io_write(7, 0x42);
    io_write(7, 0x43);
    EXPECT_EQ(io_read(2) & kTrdy, 0u);
    strobes(&BoardInputs::pa_rd_n, 0x06, phase, 7);  // X:$FFFFC6: the second word needs a period to come
    EXPECT_NE(io_read(2) & kTrdy, 0u) << "phase " << phase;
  }
}

// host-bus:2.6/9: the strobe of a RAM cycle, /WR 22.3 ns before the next cycle's /RD as at I52 = 31, is none of the
// registers': the read that follows is one read, and nothing is written there.
TEST_P(BoardMap, StrobesOfOtherDevicesDoNotTouchTheRegistersThatFollow) {
  for (const std::uint8_t other : {std::uint8_t{1}, std::uint8_t{4}}) {  // main memory, dual-ported RAM
    for (Tick phase = 0; phase < 3; ++phase) {
      rig.write(true, kHostSignals, 0x5);
      rig.run(30 + phase);
      rig.in.pa_x = true;
      rig.in.pa_addr = 0x60000;
      rig.in.pa_aa = other;
      rig.in.pa_wdata = 0xA;
      rig.apply();
      rig.in.pa_wr_n = false;
      rig.apply();
      rig.run(2);
      rig.in.pa_wr_n = true;
      rig.in.pa_aa = 0;
      rig.in.pa_addr = kHostSignals;
      rig.apply();
      rig.run(1);
      rig.in.pa_rd_n = false;
      rig.apply();
      rig.run(9);
      EXPECT_EQ(rig.get(pin::kPaDataOe), 1u) << phase;
      EXPECT_EQ(rig.get(pin::kPaData), 0x5u) << phase;
      rig.in.pa_rd_n = true;
      rig.apply();
      rig.run(12);
      EXPECT_EQ(rig.read(true, kHostSignals), 0x5u) << phase;
    }
  }
}

}  // namespace
}  // namespace brick
