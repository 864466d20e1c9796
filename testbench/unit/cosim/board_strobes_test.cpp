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
    rest(phase);
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

// However many reads of others follow: each shows its own word, and none of them before its sample.
TEST_P(BoardMap, TheWordOfTheRamIsShownByItsReadAlone) {
  rig.write(true, 0x060000, 0x1234);
  rig.write(true, kHostSignals, 0x5);
  EXPECT_EQ(rig.read(true, 0x060000), 0x1234u);
  for (int reads = 1; reads <= 9; ++reads) {
    rig.in.pa_addr = kHostSignals;
    rig.in.pa_x = true;
    rig.in.pa_aa = 0;
    rig.in.pa_rd_n = false;
    rig.apply();
    rig.run(3);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 0u) << reads;
    rig.run(9);
    EXPECT_EQ(rig.get(pin::kPaData), 0x5u) << reads;
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(6);
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
    rest(phase);
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

// host-bus:2.6/2: a write has the address and the data of 25.4 to 50.9 ns after the fall of its strobe, however long
// that is low: from then on they may be another's.
TEST_P(BoardMap, AWriteIsOfTheAddressWhereItStands) {
  constexpr Tick kStands = 2 * kTicksPerRef;  // 50.9 ns
  for (Tick phase = 0; phase < kTicksPerRef; ++phase)
    for (const Tick low : {kStands + 1, kStands + 3, kStands + 6, Tick{30}}) {
      rig.write(true, kHostSignals, 0);
      rest(phase);
      rig.in.pa_x = true;
      rig.in.pa_addr = kHostSignals;
      rig.in.pa_wdata = 7;
      rig.in.pa_wr_n = false;
      rig.apply();
      rig.run(kStands);
      rig.in.pa_addr = kHostSignals + 0x40;  // nobody's
      rig.in.pa_wdata = 2;
      rig.apply();
      rig.run(low - kStands);
      rig.in.pa_wr_n = true;
      rig.apply();
      rig.run(12);
      EXPECT_EQ(rig.get(pin::kIpos) | rig.get(pin::kBreq) << 1 | rig.get(pin::kEror) << 2, 7u)
          << "phase " << phase << ", low for " << low << " ticks";
    }
}

// host-bus:2.6/1: low for 50.9 ns at the edges of clk_pwm, a strobe is an access however soon the next one follows; too
// short, it is none. The two words that HOTX gets go to RX one after the other; of the two that the host has sent each
// read frees one.
TEST_P(BoardMap, AStrobeOfSixTicksIsAnAccessHoweverSoonTheNextAndAShortOneIsNone) {
  const auto strobes = [this](bool BoardInputs::*strobe, unsigned word, Tick phase, Tick low) {
    rig.in.pa_addr = word;
    rig.in.pa_x = rig.in.pa_int = true;
    rig.apply();
    rig.run(6 + 3 - rig.now() % 3 + phase);
    for (int i = 0; i < 2; ++i)
      for (const bool level : {false, true}) {
        rig.in.*strobe = level;
        rig.apply();
        rig.run(level ? 1 : low);
      }
    rig.run(9);
    rig.in.pa_int = false;
    rig.apply();
  };
  constexpr unsigned kRxdf = 1, kTrdy = 4;
  for (Tick phase = 0; phase < 3; ++phase) {
    rig.run(30);
    rig.in.pa_wdata = 0x41;
    for (const Tick low : {1, 2, 3}) strobes(&BoardInputs::pa_wr_n, 0x47, phase, low);  // X:$FFFFC7
    EXPECT_EQ(io_read(2) & kRxdf, 0u) << "phase " << phase;
    strobes(&BoardInputs::pa_wr_n, 0x47, phase, 6);
    for (int word = 0; word < 2; ++word) {
      EXPECT_NE(io_read(2) & kRxdf, 0u) << "word " << word << ", phase " << phase;
      EXPECT_EQ(io_read(7), 0x41u);
    }
    EXPECT_EQ(io_read(2) & kRxdf, 0u);
    io_write(7, 0x42);
    io_write(7, 0x43);
    for (const Tick low : {1, 2, 3}) strobes(&BoardInputs::pa_rd_n, 0x46, phase, low);  // X:$FFFFC6
    EXPECT_EQ(io_read(2) & kTrdy, 0u) << "phase " << phase;
    strobes(&BoardInputs::pa_rd_n, 0x46, phase, 6);
    EXPECT_NE(io_read(2) & kTrdy, 0u) << "phase " << phase;
  }
}

// host-bus:2.6/2: the lines of the bus may come a tick later than the strobe, as pads and wires make them, and go a
// tick earlier than it.
TEST_P(BoardMap, SelectsMayComeATickBehindTheStrobe) {
  struct Place {
    std::uint32_t address;
    std::uint8_t aa;
    std::uint32_t value;
  };
  for (const Place& at : {Place{kHostSignals, 0, 0x6}, {kServoIcBase[0] + 6, 2, 0x123456}, {0x060007, 4, 0x89AB}})
    for (Tick phase = 0; phase < 3; ++phase)
      for (const bool write : {true, false}) {
        rest(phase);
        rig.in.pa_aa = 1;
        rig.in.pa_addr = ~at.address & 0x7FFFF;
        rig.in.pa_x = true;
        rig.in.pa_wdata = at.value;
        (write ? rig.in.pa_wr_n : rig.in.pa_rd_n) = false;
        rig.apply();
        rig.run(1);
        rig.in.pa_aa = at.aa;
        rig.in.pa_addr = at.address;
        rig.apply();
        rig.run(9);
        if (!write) {
          EXPECT_EQ(rig.get(pin::kPaDataOe), 1u) << std::hex << at.address << ", phase " << phase;
          EXPECT_EQ(rig.get(pin::kPaData), at.value) << std::hex << at.address << ", phase " << phase;
        }
        rig.in.pa_aa = 1;
        rig.apply();
        rig.run(1);
        rig.in.pa_wr_n = rig.in.pa_rd_n = true;
        rig.apply();
        rig.run(3);
      }
}

// host-bus:2.6/9: the selects of the cycle before or of the next one, on the bus while another device's strobe is still
// or already seen low, make it none of ours: nothing is written, and D is not driven.
TEST_P(BoardMap, StrobesOfOthersMeetTheSelectsOfTheirNeighbours) {
  struct Place {
    std::uint32_t address;
    std::uint8_t aa;
    std::uint32_t value;
  };
  for (const Place& at : {Place{kHostSignals, 0, 0x6}, {kServoIcBase[0] + 6, 2, 0x123456}, {0x060007, 4, 0x89AB}}) {
    rig.write(true, at.address, at.value);
    for (Tick phase = 0; phase < 3; ++phase)
      for (const Tick low : {1, 2, 3, 4, 7, 8, 9, 20})
        for (const bool write : {true, false}) {
          rest(phase);
          const auto select = [&](bool ours) {
            rig.in.pa_aa = ours ? at.aa : 1;
            rig.in.pa_addr = at.address;
            rig.in.pa_x = true;
            rig.in.pa_wdata = ~at.value & 0xFFFFFF;
            rig.apply();
          };
          bool driven = false;
          const auto run = [&](Tick ticks) {
            for (; ticks > 0; --ticks) {
              rig.run(1);
              driven = driven || rig.get(pin::kPaDataOe) != 0;
            }
          };
          select(true);
          (write ? rig.in.pa_wr_n : rig.in.pa_rd_n) = false;
          rig.apply();
          run(1);
          if (low > 2) {
            select(false);
            run(low - 2);
          }
          select(true);
          if (low > 1) run(1);
          rig.in.pa_wr_n = rig.in.pa_rd_n = true;
          rig.apply();
          run(12);
          EXPECT_FALSE(driven) << std::hex << at.address << ", phase " << phase << ", low " << low;
          EXPECT_EQ(rig.read(true, at.address), at.value)
              << std::hex << at.address << ", phase " << phase << ", low " << low << (write ? ", write" : ", read");
        }
  }
}

// host-bus:2.5/8, host-bus:6.9/8: a strobe of another device, two ticks before that of the RAM, takes nothing of the
// RAM's /TA: it is high until the word stands.
TEST_P(BoardMap, TaOfTheRamIsNotTakenAwayByTheStrobeBeforeIt) {
  for (Tick phase = 0; phase < 3; ++phase)
    for (const unsigned before : {1u, 2u})
      for (const bool write : {false, true}) {
        rest(phase);
        bool& strobe_n = write ? rig.in.pa_wr_n : rig.in.pa_rd_n;
        rig.in.pa_aa = 1;
        for (unsigned i = 0; i < before; ++i)
          for (const bool level : {false, true}) {
            strobe_n = level;
            rig.apply();
            rig.run(1);
          }
        rig.in.pa_aa = 4;
        rig.in.pa_addr = 0x060000;
        rig.in.pa_x = true;
        strobe_n = false;
        rig.apply();
        for (unsigned edge = 1; edge <= (write ? 2u : 3u); ++edge) {
          rig.run(1);
          EXPECT_EQ(rig.get(pin::kPaTaN), 1u) << "edge " << edge << ", phase " << phase << ", after " << before;
        }
        rig.run(3);
        EXPECT_EQ(rig.get(pin::kPaTaN), 0u);
        strobe_n = true;
        rig.apply();
        rig.run(6);
        rig.in.pa_aa = 0;
        rig.apply();
      }
}

// host-bus:2.6/9: the strobe of a RAM cycle, /WR 22.3 ns before the next cycle's /RD as at I52 = 31, is none of the
// registers': the read that follows is one read, and nothing is written there.
TEST_P(BoardMap, StrobesOfOtherDevicesDoNotTouchTheRegistersThatFollow) {
  for (const std::uint8_t other : {std::uint8_t{1}, std::uint8_t{4}}) {  // main memory, dual-ported RAM
    for (Tick phase = 0; phase < 3; ++phase) {
      rig.write(true, kHostSignals, 0x5);
      rest(phase);
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

// host-bus:2.6/5: the sample of a read is on the pins while that read is low, never in the next one, however soon that
// falls: of another device nothing is driven, of ours its own word. Two falls are two ticks apart or more.
TEST_P(BoardMap, NoReadShowsTheSampleOfTheOneBeforeIt) {
  struct Place {
    std::uint32_t address;
    std::uint8_t aa;
    std::uint32_t value;
  };
  const Place mine{kServoIcBase[1] + 0x14, 2, 0x222222}, others{0x000010, 1, 0};
  rig.write(true, mine.address, mine.value);
  for (const Place& before : {Place{kServoIcBase[0] + 0x14, 2, 0x111111}, {0x060007, 4, 0x3333}}) {
    rig.write(true, before.address, before.value);
    for (const Place& next : {mine, others})
      for (Tick phase = 0; phase < kTicksPerRef; ++phase)
        for (Tick low = 1; low <= 12; ++low)
          for (Tick high = low < 2 ? 1 : 0; high <= 2; ++high) {
            SCOPED_TRACE(::testing::Message() << std::hex << before.address << " then " << next.address << ", phase "
                                              << phase << ", low for " << low << ", high for " << high);
            rest(phase);
            const auto fall = [&](const Place& at) {
              rig.in.pa_addr = at.address;
              rig.in.pa_x = true;
              rig.in.pa_aa = at.aa;
              rig.in.pa_rd_n = false;
              rig.apply();
            };
            const auto rise = [&] {
              rig.in.pa_rd_n = true;
              rig.apply();
            };
            fall(before);
            rig.run(low);
            rise();
            rig.run(high);
            fall(next);
            for (int tick = 1; tick <= 12; ++tick) {
              rig.run(1);
              const bool driven = rig.get(pin::kPaDataOe) != 0;
              ASSERT_TRUE(!driven || next.aa == mine.aa) << tick;
              ASSERT_TRUE(!driven || rig.get(pin::kPaData) == mine.value) << tick;
            }
            ASSERT_EQ(rig.get(pin::kPaDataOe), next.aa == mine.aa ? 1u : 0u);
            rise();
          }
  }
}

// host-bus:2.6/10: the reset acts at once and forgets the cycle that it meets. D is let go and its word is gone, /TA is
// low, and a strobe that is still low behind it asks for nothing, however many were counted before.
TEST_P(BoardMap, AResetInACycleEndsItThoughItsStrobeStaysLow) {
  struct Place {
    std::uint32_t address;
    std::uint8_t aa;
    std::uint32_t kept;  // behind a reset
  };
  for (const Place& at : {Place{kHostSignals, 0, 0}, {kServoIcBase[0] + 0x14, 2, 0xFFFFFE}, {0x060007, 4, 0x55}})
    for (unsigned before = 0; before < 4; ++before)
      for (const bool write : {false, true}) {
        SCOPED_TRACE(::testing::Message()
                     << std::hex << at.address << (write ? ", write" : ", read") << ", behind " << before << " more");
        bool& strobe_n = write ? rig.in.pa_wr_n : rig.in.pa_rd_n;
        rig.write(true, at.address, 0x55);
        for (unsigned i = 0; i < before; ++i) write ? rig.write(true, 0x050000, 0) : void(rig.read(true, 0x050000));
        rig.in.pa_addr = at.address;
        rig.in.pa_x = true;
        rig.in.pa_aa = at.aa;
        rig.in.pa_wdata = 0x0A;
        rig.apply();
        rig.run(2);
        strobe_n = false;
        rig.apply();
        rig.run(write ? 1 : 12);  // a write that has only begun
        EXPECT_EQ(rig.get(pin::kPaDataOe), write ? 0u : 1u);
        rig.in.rst_n = false;
        for (int tick = 0; tick < 60; ++tick) {
          rig.in.rst_n = tick >= 20;
          rig.apply();
          rig.run(1);
          ASSERT_EQ(rig.get(pin::kPaDataOe), 0u) << tick;
          ASSERT_EQ(rig.get(pin::kPaData), 0u) << tick;
          ASSERT_EQ(rig.get(pin::kPaTaN), 0u) << tick;
        }
        strobe_n = true;
        rig.apply();
        rig.run(12);
        EXPECT_EQ(rig.read(true, at.address), at.kept);
      }
}

}  // namespace
}  // namespace brick
