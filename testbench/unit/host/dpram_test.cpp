#include "testbench/unit/host/dpram_bench.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

class DpramTest : public ::testing::Test, protected DpramBench {
 protected:
  void TearDown() override {
    if (!both.mutate) { EXPECT_LOCKSTEP(both); }
  }
};

class DpramSmallTest : public ::testing::Test, protected DpramBench {
 protected:
  DpramSmallTest() : DpramBench(true) {}
  void TearDown() override { EXPECT_LOCKSTEP(both); }
};

TEST_F(DpramTest, CpuDataComesWithTheThirdEdgeAndTheEndOfTheWaitOneLater) {
  host_write(6, 0x1234);
  EXPECT_FALSE(cpu_wait());
  cpu_start_read(6);
  EXPECT_TRUE(cpu_wait()) << "with the strobe, before any edge";
  both.ticks(2);
  EXPECT_NE(both.get("cpu_rdata"), 0x1234u);
  both.tick();
  EXPECT_EQ(both.get("cpu_rdata"), 0x1234u);
  EXPECT_TRUE(cpu_wait()) << "/TA may be sampled up to 3 ns after the data";
  both.tick();
  EXPECT_FALSE(cpu_wait());
  EXPECT_FALSE(cpu_busy());
  both.ticks(20);
  EXPECT_EQ(both.get("cpu_rdata"), 0x1234u) << "held";
}

// docs/dpram.md: held until the next read.
TEST_F(DpramTest, WordOfAReadStaysThroughWrites) {
  host_write(6, 0x1234);
  EXPECT_EQ(cpu_read(6), 0x1234u);
  cpu_write(6, 0x4321);
  cpu_write(7, 0x5678);
  EXPECT_EQ(both.get("cpu_rdata"), 0x1234u);
  EXPECT_EQ(cpu_read(6), 0x4321u);
}

TEST_F(DpramTest, WordOfAReadOfTheHostStaysThroughWrites) {
  host_write(6, 0x1234);
  EXPECT_EQ(host_read(6), 0x1234u);
  host_write(7, 0x5678);
  cpu_write(6, 0x4321);
  cpu_write(7, 0x8765);
  EXPECT_EQ(both.get("mem_rdata"), 0x1234u);
  EXPECT_EQ(host_read(6), 0x4321u);
}

// docs/dpram.md, a host's side of one's own.
TEST_F(DpramTest, AHostsSideOfOnesOwnIsGrantedAtItsFirstEdgeAndAnewBehindAGap) {
  for (const bool with_select : {false, true}) {
    const unsigned value = with_select ? 0x1111 : 0x2222;
    host_start(6, false);
    both.ref();
    both.in.mem_sel = with_select;  // at the edge of the write
    both.in.mem_wr = true;
    both.in.mem_wdata = static_cast<std::uint16_t>(value);
    both.in.mem_be = 3;
    both.ref();
    both.in.mem_sel = both.in.mem_wr = false;
    both.ref();
    host_start(6, true);
    both.ref();
    EXPECT_EQ(both.get("mem_rdata"), value) << "behind one edge";
    host_end_read();
  }
  host_write(7, 0x3333);
  host_start(6, true);
  both.ref();
  both.in.mem_addr = 7;
  both.ref(2);
  EXPECT_EQ(both.get("mem_rdata"), 0x1111u) << "without a gap the word of the first";
  host_end_read();
  EXPECT_EQ(host_read(7), 0x3333u);
  // A write at the edge that would grant it comes too early.
  host_start(7, false);
  both.in.mem_wr = true;
  both.in.mem_wdata = 0x4444;
  both.in.mem_be = 3;
  both.ref();
  both.in.mem_wr = false;
  host_end_read();
  EXPECT_EQ(host_read(7), 0x3333u);
}

TEST_F(DpramTest, CpuWriteWaitsForTheThirdEdgeAndIsMadeTwoLater) {
  cpu_start_write(6, 0x4321);
  for (int tick = 0; tick < 3; ++tick) {
    EXPECT_TRUE(cpu_wait()) << tick;
    both.tick();
  }
  EXPECT_FALSE(cpu_wait());
  cpu_end();
  both.tick();
  EXPECT_EQ(model.peek(6), 0u);
  both.tick();
  EXPECT_EQ(model.peek(6), 0x4321u);
}

TEST_F(DpramTest, YWordIsAtTheEvenAndXWordAtTheOddHostWord) {
  for (const unsigned address : {0x0000u, 0x0001u, 0x1000u, 0x3FFFu}) {  // less $060000; host offset 4a and 4a + 2
    host_write(4 * address / 2, 0xA000 + address);
    host_write((4 * address + 2) / 2, 0x5000 + address);
    for (const bool x : {false, true}) {
      both.in.cpu_sel = true;
      both.in.cpu_addr = static_cast<std::uint16_t>(address);
      both.in.cpu_x = x;
      both.in.cpu_rd_n = false;
      both.in.rd_falls = next_fall(both.in.rd_falls);
      both.ticks(kAccess);
      EXPECT_EQ(both.get("cpu_rdata"), (x ? 0x5000 : 0xA000) + address) << (x ? "X" : "Y");
      cpu_end();
      both.ticks(kRest);
    }
  }
}

TEST_F(DpramTest, BothSidesReadWhatTheOtherWrote) {
  for (unsigned word = 0; word < 32768; word += 1023) {
    cpu_write(word, word ^ 0xFFFF);
    EXPECT_EQ(host_read(word), (word ^ 0xFFFF) & 0xFFFF);
    host_write(word, word + 1);
    EXPECT_EQ(cpu_read(word), word + 1);
  }
}

TEST_F(DpramTest, HostWritesSingleBytes) {
  host_write(9, 0x1111);
  host_write(9, 0x22FF, 2);
  EXPECT_EQ(cpu_read(9), 0x2211u);
  host_write(9, 0xFF33, 1);
  EXPECT_EQ(cpu_read(9), 0x2233u);
  host_write(9, 0xFFFF, 0);
  EXPECT_EQ(cpu_read(9), 0x2233u);
  for (const unsigned before : {0x0000u, 0xFFFFu})
    for (const unsigned lanes : {1u, 2u}) {
      host_write(9, before);
      host_write(9, ~before, lanes);
      EXPECT_EQ(cpu_read(9), before ^ (lanes == 1 ? 0x00FFu : 0xFF00u));
    }
}

TEST_F(DpramTest, CpuDataMayComeTwoTicksAfterTheStrobe) {
  cpu_start_write(5, 0xDEAD);
  both.ticks(2);
  both.in.cpu_wdata = 0xBEEF;  // valid from here on, rows 102 and 108 of the bus timing let data lag the strobe
  both.tick();
  both.in.cpu_wdata = 0xDEAD;  // sampled
  cpu_end();
  both.ticks(kRest);
  EXPECT_EQ(host_read(5), 0xBEEFu);
}

// Cycles back to back: /RD may be high for 13.5 ns only (row 113), less than two ticks, or even between two edges.
TEST_F(DpramTest, StrobesWithoutATickBetweenThemAreTwo) {
  for (const int high : {0, 1, 2}) {
    for (unsigned word = 10; word < 14; ++word) {
      cpu_start_write(word, 0x100 * word + static_cast<unsigned>(high));
      both.ticks(kAccess);
      cpu_end();
      both.ticks(high);
    }
    for (unsigned word = 10; word < 14; ++word) {
      cpu_start_read(word);
      both.ticks(kAccess + 1);
      EXPECT_FALSE(cpu_wait());
      EXPECT_EQ(both.get("cpu_rdata"), 0x100 * word + static_cast<unsigned>(high)) << high;
      cpu_end();
      both.ticks(high);
    }
    both.ticks(kRest);
  }
}

// Ended before its data were sampled: nobody knows what stood on the bus then.
TEST_F(DpramTest, AWriteStrobeThatIsTooShortWritesNothing) {
  cpu_write(7, 0x0F0F);
  for (const int length : {0, 1, 2}) {
    cpu_start_write(7, 0x1111);
    both.ticks(length);
    both.in.cpu_wr_n = true;
    both.ticks(10);
    cpu_end();
    both.ticks(kRest);
    EXPECT_EQ(host_read(7), 0x0F0Fu) << length;
  }
}

// A strobe that has ended before its access, as one without wait states, and the next with another address at once:
// what is asked for once is done once, where it was asked for, at whatever tick each of the two falls and rises. Where
// two falls are two ticks or more apart (host-bus:2.6/9) the strobe may be high between two ticks and be seen by none.
TEST_F(DpramTest, AStrobeThatHasEndedTakesNothingOfTheNext) {
  unsigned made = 0;
  for (const bool busy : {false, true})
    for (int low = 0; low <= 6; ++low)
      for (int high = low < 2 ? 1 : 0; high <= 4; ++high) {
        SCOPED_TRACE(::testing::Message() << "low for " << low << ", high for " << high << ", BUSY " << busy);
        host_write(20, 0x2020);
        host_write(21, 0x2121);
        if (busy) {
          host_start(20, true);
          both.ref();
        }
        cpu_start_write(20, 0xAAAA);
        both.ticks(low);
        cpu_end();
        both.in.cpu_addr = 500;  // nobody's
        both.ticks(high);
        cpu_start_write(21, 0xDEAD);  // not yet its data
        both.tick();
        both.in.cpu_wdata = 0xBBBB;
        both.ticks(kAccess + 2);
        EXPECT_FALSE(cpu_wait());
        cpu_end();
        both.ticks(kRest);
        if (busy) host_end_read();
        EXPECT_EQ(host_read(21), 0xBBBBu);
        EXPECT_EQ(host_read(1000), 0u);
        EXPECT_EQ(host_read(1001), 0u);
        const unsigned first = host_read(20);
        EXPECT_TRUE(first == 0x2020 || (first == 0xAAAA && low >= kAccess && !busy)) << std::hex << first;
        EXPECT_EQ(first == 0xAAAA, low >= kAccess && !busy);
        made += first == 0xAAAA ? 1 : 0;
        ASSERT_EQ(both.difference(), "");
      }
  EXPECT_EQ(made, static_cast<unsigned>((6 - kAccess + 1) * 5)) << "each way of the low times that are long enough";
}

// The same for reads: the pins are driven with the word of the strobe that is low, or not at all.
TEST_F(DpramTest, NoReadShowsTheWordOfTheStrobeBefore) {
  host_write(20, 0x2020);
  host_write(21, 0x2121);
  for (const bool busy : {false, true})
    for (int low = 0; low <= 6; ++low)
      for (int high = 1; high <= 4; ++high) {
        SCOPED_TRACE(::testing::Message() << "low for " << low << ", high for " << high << ", BUSY " << busy);
        if (busy) {
          host_start(20, false);
          both.ref();
        }
        cpu_start_read(20);
        both.ticks(low);
        cpu_end();
        EXPECT_FALSE(both.get("cpu_drive"));
        both.ticks(high);
        cpu_start_read(21);
        for (int tick = 0; tick < kAccess + 3; ++tick) {
          if (both.get("cpu_drive") != 0) { EXPECT_EQ(both.get("cpu_rdata"), 0x2121u) << tick; }
          both.tick();
        }
        EXPECT_TRUE(both.get("cpu_drive"));
        EXPECT_FALSE(cpu_wait());
        cpu_end();
        both.ticks(kRest);
        if (busy) host_end_write(0x2020);
        both.ticks(kRest);
        ASSERT_EQ(both.difference(), "");
      }
}

// A read that waits is given up and the host goes while /RD is high: its grant may come when the next has fallen.
TEST_F(DpramTest, NoReadShowsTheWordOfOneThatWasGivenUp) {
  host_write(20, 0x2020);
  host_write(21, 0x2121);
  unsigned waited = 0;
  for (int low = 8; low <= 14; ++low)
    for (int host_goes = -6; host_goes <= 8; ++host_goes)
      for (int high = 1; high <= 3; ++high) {
        SCOPED_TRACE(::testing::Message() << low << ", host goes at " << host_goes << ", high for " << high);
        host_start(20, false);
        both.ref();
        cpu_start_read(20);
        for (int tick = 0; tick < low + high + kAccess + 6; ++tick) {
          if (tick == low) waited += both.get("cpu_busy") != 0 ? 1 : 0, cpu_end();
          if (tick == low + high) cpu_start_read(21);
          if (tick == low + host_goes) both.in.mem_sel = both.in.mem_rd = both.in.mem_wr = false;
          if (tick >= low + high && both.get("cpu_drive") != 0) { ASSERT_EQ(both.get("cpu_rdata"), 0x2121u) << tick; }
          both.tick();
        }
        cpu_end();
        both.ticks(kRest);
        ASSERT_EQ(both.difference(), "");
      }
  EXPECT_GT(waited, 50u);
}

TEST_F(DpramTest, ThePinsAreDrivenFromTheDataToTheEndOfTheStrobe) {
  for (int cycle = 0; cycle < 2; ++cycle) {
    EXPECT_FALSE(both.get("cpu_drive"));
    cpu_start_read(6);
    for (int tick = 0; tick < kAccess; ++tick) {
      EXPECT_FALSE(both.get("cpu_drive")) << tick;
      both.tick();
    }
    EXPECT_TRUE(both.get("cpu_drive"));
    both.ticks(4);
    EXPECT_TRUE(both.get("cpu_drive"));
    both.in.cpu_rd_n = true;
    EXPECT_FALSE(both.get("cpu_drive")) << "without a clock";
    both.ticks(2);
    cpu_end();
  }
  cpu_start_write(6, 1);
  both.ticks(kAccess + 2);
  EXPECT_FALSE(both.get("cpu_drive"));
  cpu_end();
  both.ticks(kRest);
  host_start(6, false);
  both.ref(2);
  cpu_start_read(6);
  both.ticks(kAccess + 6);
  EXPECT_FALSE(both.get("cpu_drive")) << "BUSY: its word does not stand yet";
  host_end_write(2);
  EXPECT_FALSE(both.get("cpu_drive"));
  both.tick();
  EXPECT_TRUE(both.get("cpu_drive"));
  cpu_end();
}

// host-bus:2.6/5. Two bits count the falls: of four reads of others behind one of ours the last has its count.
TEST_F(DpramTest, ReadsOfOtherDevicesDriveNothing) {
  cpu_read(6);
  for (int read = 0; read < 8; ++read) {
    cpu_start_read(6);
    both.in.cpu_sel = false;
    for (int tick = 0; tick < kAccess + 3; ++tick) {
      EXPECT_FALSE(both.get("cpu_drive")) << read << ", tick " << tick;
      both.tick();
    }
    cpu_end();
    both.ticks(2);
  }
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(DpramTest, SleepsWhileNothingMoves) {
  const auto rests = [&] {
    both.ref(4);
    return both.asleep();
  };
  EXPECT_TRUE(rests());
  for (const bool ours : {true, false})
    for (const bool read : {true, false}) {
      read ? cpu_start_read(8) : cpu_start_write(8, 1);
      both.in.cpu_sel = ours;
      EXPECT_TRUE(rests()) << ours << read;
      cpu_end();
      EXPECT_TRUE(rests()) << ours << read;
    }
  for (const bool read : {true, false}) {
    host_start(8, read);
    EXPECT_TRUE(rests()) << "the host has the word";
    read ? cpu_start_write(8, 1) : cpu_start_read(8);
    EXPECT_TRUE(rests());
    EXPECT_TRUE(cpu_busy());
    cpu_end();
    both.in.mem_sel = false;
    EXPECT_TRUE(rests());
    read ? cpu_start_write(8, 1) : cpu_start_read(8);
    both.ref(2);
    host_start(8, read);
    EXPECT_TRUE(rests());
    EXPECT_TRUE(host_busy());
    cpu_end();
    both.in.mem_sel = false;
    EXPECT_TRUE(rests());
  }
}

// A strobe of ours asks for the edges of the stages that it passes and of the write two edges behind them; one of
// another device for none, nor does an address that moves without a select.
TEST_F(DpramTest, AsksForNoMoreEdgesThanAStrobeHasStages) {
  const auto asked = [&](auto act) {
    const std::size_t before = both.events();
    act();
    both.ref(8);
    return both.events() - before;
  };
  for (const bool read : {true, false}) {
    const auto start = [&] { read ? cpu_start_read(8) : cpu_start_write(8, 1); };
    EXPECT_LE(asked(start), 5u) << read;
    EXPECT_LE(asked([&] { cpu_end(); }), 5u) << read;
    const auto of_others = [&] { start(), both.in.cpu_sel = false; };
    EXPECT_EQ(asked(of_others), 0u) << read;
    EXPECT_EQ(asked([&] { cpu_end(), both.in.cpu_addr = 77; }), 0u) << read;
    EXPECT_LE(asked([&] { host_start(8, read); }), 1u) << "the grant";
    EXPECT_LE(asked([&] { both.in.mem_sel = false; }), 1u) << "its end";
  }
}

TEST_F(DpramTest, StrobesOfOtherDevicesDoNotWait) {
  cpu_start_read(6);
  both.in.cpu_sel = false;
  for (int tick = 0; tick < 6; ++tick) {
    EXPECT_FALSE(cpu_wait());
    both.tick();
  }
  cpu_end();
  both.tick();
  both.in.cpu_sel = true;  // selected, no strobe yet: nothing is left of the one before
  both.ticks(3);
  EXPECT_FALSE(cpu_wait());
  both.in.cpu_sel = false;
}

// host-bus:6.9/8: a strobe of another device shortly before, of either kind, neither takes /TA away nor keeps it up; to
// what falls right behind a write of another device, a read within three edges or a write within two, the RAM may come
// two clocks late.
TEST_F(DpramTest, StrobesOfOtherDevicesKeepNoTaUp) {
  for (const bool other_reads : {true, false})
    for (const bool read : {true, false})
      for (int low = 1; low <= 4; ++low)
        for (int high = 0; high <= 3; ++high) {
          SCOPED_TRACE(::testing::Message() << other_reads << read << ", low for " << low << ", high for " << high);
          if (low + high < 2) continue;
          other_reads ? cpu_start_read(6) : cpu_start_write(6, 0xFFFF);
          both.in.cpu_sel = false;
          both.ticks(low);
          cpu_end();
          both.ticks(high);
          read ? cpu_start_read(7) : cpu_start_write(7, 0x0707);
          EXPECT_TRUE(cpu_wait());
          const bool late = !other_reads && low + high <= (read ? 3 : 2);
          both.ticks(kAccess + (read ? 1 : 0) + (late ? 2 : 0));
          EXPECT_FALSE(cpu_wait());
          cpu_end();
          both.ticks(kRest);
          EXPECT_EQ(host_read(6), 0u);
        }
  EXPECT_EQ(host_read(7), 0x0707u);
}

TEST_F(DpramTest, UnselectedStrobesDoNothing) {
  cpu_write(4, 0x0F0F);
  cpu_start_write(4, 0x1234);
  both.in.cpu_sel = false;
  both.ticks(6);
  cpu_end();
  both.ticks(2);
  EXPECT_EQ(host_read(4), 0x0F0Fu);
}

TEST_F(DpramTest, NothingIsAskedForAfterAReset) {
  for (const bool before : {false, true}) {
    if (before) {
      cpu_read(6);  // one of each: their counts of strobes done are odd
      cpu_write(7, 0x0707);
      cpu_start_write(6, 1);  // lost with the reset
    }
    both.ticks(2);
    cpu_end();
    both.in.rd_falls = both.in.wr_falls = 0;  // the counts are reset with it
    both.reset();
    both.in.cpu_sel = true;
    for (int tick = 0; tick < 10; ++tick) {
      EXPECT_FALSE(cpu_wait()) << tick;
      EXPECT_FALSE(cpu_busy()) << tick;
      EXPECT_FALSE(both.get("cpu_drive")) << tick;
      both.tick();
    }
    cpu_end();
    EXPECT_EQ(host_read(6), 0u);
  }
}

TEST_F(DpramTest, ResetKeepsTheContent) {
  cpu_write(100, 0xCAFE);
  both.reset();
  EXPECT_EQ(host_read(100), 0xCAFEu);
}

// docs/dpram.md: nobody shows the word of a read of before.
TEST_F(DpramTest, BothSidesShowZeroAfterAReset) {
  host_write(6, 0x1234);
  EXPECT_EQ(cpu_read(6), 0x1234u);
  EXPECT_EQ(host_read(6), 0x1234u);
  both.in.rd_falls = both.in.wr_falls = 0;
  both.reset();
  for (int tick = 0; tick < 6; ++tick) {
    EXPECT_EQ(both.get("cpu_rdata"), 0u) << tick;
    EXPECT_EQ(both.get("mem_rdata"), 0u) << tick;
    both.tick();
  }
  EXPECT_EQ(host_read(6), 0x1234u);
}

// The cells are there, and hold something before the strap says that they are not.
TEST_F(DpramSmallTest, WordsThatAreNotFittedReadZeroAndIgnoreWrites) {
  const auto strap = [this](bool is_small) {
    both.in.small = is_small;
    both.ticks(kRest);
  };
  cpu_write(8191, 0x7777);
  for (const unsigned word : {8192u, 16383u, 16384u, 24576u, 32767u}) {
    for (const bool host : {false, true}) {
      SCOPED_TRACE(::testing::Message() << word << (host ? " by the host" : " by the CPU"));
      strap(false);
      cpu_write(word, 0x3333);
      strap(true);
      if (host)
        host_write(word, 0x2222);
      else
        cpu_write(word, 0x1111);
      EXPECT_EQ(host_read(word), 0u);
      EXPECT_EQ(cpu_read(word), 0u);
      strap(false);
      EXPECT_EQ(host_read(word), 0x3333u);
      strap(true);
    }
  }
  EXPECT_EQ(host_read(8191), 0x7777u);
  EXPECT_EQ(cpu_read(0), 0u) << "no alias";
}

TEST_F(DpramSmallTest, WordOfAReadStaysThroughWritesBeyondTheFittedSize) {
  host_write(5, 0x1111);
  for (const unsigned word : {5u, 9000u}) {
    const unsigned value = word == 5 ? 0x1111 : 0;
    EXPECT_EQ(cpu_read(word), value);
    EXPECT_EQ(host_read(word), value);
    cpu_write(9005 - word, 0x2222);
    host_write(9005 - word, 0x2222);
    EXPECT_EQ(both.get("cpu_rdata"), value);
    EXPECT_EQ(both.get("mem_rdata"), value);
  }
}

TEST_F(DpramSmallTest, RandomAccessesAgree) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    random_run(random_seed(seed), 6000, 32768);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

TEST_F(DpramTest, RandomMeetingsOfBothSidesAgree) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    random_run(random_seed(seed), 6000, 1 + seed % 4);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

TEST_F(DpramTest, ComparisonSeesACpuStrobeOneTickLate) {
  bool last = false;
  Tick seen = -1;
  bool late = false;
  both.mutate = [&](Dpram::Inputs& in) {
    if (both.now() != seen) {
      seen = both.now();
      late = last;
      last = in.cpu_sel;
    }
    in.cpu_sel = in.cpu_sel && late;
  };
  random_run(2, 6000, 2);
  EXPECT_NE(both.difference(), "");
}

TEST_F(DpramTest, ComparisonSeesALostByteLane) {
  both.mutate = [](Dpram::Inputs& in) { in.mem_be &= 1; };
  random_run(2, 6000, 2);
  EXPECT_NE(both.difference(), "");
}

}  // namespace
}  // namespace brick
