// The two sides meet: BUSY, who waits for whom, ties, and torn 32-bit items.
#include "testbench/unit/host/dpram_bench.h"

namespace brick {
namespace {

class DpramCollisionTest : public ::testing::Test, protected DpramBench {
 protected:
  DpramCollisionTest() {
    host_write(8, 0x0101);
    host_write(9, 0x0909);
  }
  void TearDown() override { EXPECT_LOCKSTEP(both); }
};

TEST_F(DpramCollisionTest, DifferentCellsDoNotDisturbEachOther) {
  host_start(8, false);
  both.ref(2);
  cpu_start_write(9, 0x5555);
  both.ticks(4);
  EXPECT_FALSE(cpu_busy());
  EXPECT_FALSE(host_busy());
  cpu_end();
  both.ref(2);
  host_end_write(0x6666);
  EXPECT_EQ(cpu_read(8), 0x6666u);
  EXPECT_EQ(cpu_read(9), 0x5555u);
}

TEST_F(DpramCollisionTest, TwoReadsOfOneCellDoNotWait) {
  host_start(8, true);
  both.ref();
  cpu_start_read(8);
  both.ticks(3);
  EXPECT_FALSE(cpu_busy());
  EXPECT_FALSE(host_busy());
  EXPECT_EQ(both.get("cpu_rdata"), 0x0101u);
  EXPECT_EQ(both.get("mem_rdata"), 0x0101u);
  host_end_read();  // and with the CPU first
  EXPECT_NE(host_read(9), 0x0101u);
  host_start(8, true);
  both.ref();
  EXPECT_FALSE(host_busy());
  EXPECT_EQ(both.get("mem_rdata"), 0x0101u);
}

TEST_F(DpramCollisionTest, CpuWaitsForAHostWriteAndThenReadsTheNewValue) {
  host_start(8, false);
  both.ref();
  cpu_start_read(8);
  both.ticks(2);
  EXPECT_FALSE(cpu_busy());
  both.tick();
  EXPECT_TRUE(cpu_busy()) << "the third edge after the fall of the strobe";
  both.ref(5);
  EXPECT_TRUE(cpu_busy());
  host_end_write(0xABCD);
  EXPECT_TRUE(cpu_busy());
  both.tick();
  EXPECT_FALSE(cpu_busy());
  EXPECT_EQ(both.get("cpu_rdata"), 0xABCDu) << "data together with the end of BUSY";
  EXPECT_TRUE(cpu_wait()) << "/TA one later";
  both.tick();
  EXPECT_FALSE(cpu_wait());
}

// docs/dpram.md: a strobe is another device's a clock after its fall was seen, for selects may come so late.
TEST_F(DpramCollisionTest, ASelectBehindItsStrobeIsInTime) {
  for (const bool read : {true, false})
    for (int late = 0; late <= 2; ++late) {
      SCOPED_TRACE(::testing::Message() << (read ? "read" : "write") << ", select " << late << " ticks late");
      host_write(8, 0x0101);
      host_start(8, !read);
      both.ref(2);
      read ? cpu_start_read(8) : cpu_start_write(8, 0x7777);
      both.in.cpu_sel = late == 0;
      both.ticks(late);
      both.in.cpu_sel = true;
      both.ticks(kAccess + 1 - late);
      EXPECT_TRUE(cpu_wait());
      EXPECT_TRUE(cpu_busy());
      read ? host_end_write(0x2222) : host_end_read();
      both.tick();
      EXPECT_FALSE(cpu_busy());
      if (read) { EXPECT_EQ(both.get("cpu_rdata"), 0x2222u); }
      both.ticks(2);
      EXPECT_FALSE(cpu_wait());
      cpu_end();
      both.ticks(kRest);
      EXPECT_EQ(host_read(8), read ? 0x2222u : 0x7777u);
    }
}

TEST_F(DpramCollisionTest, CpuWriteWaitsForAHostRead) {
  host_start(8, true);
  both.ref();
  cpu_start_write(8, 0x7777);
  both.ticks(9);
  EXPECT_TRUE(cpu_busy());
  EXPECT_EQ(both.get("mem_rdata"), 0x0101u);
  host_end_read();
  both.tick();
  EXPECT_FALSE(cpu_busy());
  cpu_end();
  both.ticks(2);
  EXPECT_EQ(host_read(8), 0x7777u);
}

TEST_F(DpramCollisionTest, HostWaitsForACpuWriteAndThenReadsTheNewValue) {
  cpu_start_write(8, 0x4321);
  both.ref();
  host_start(8, true);
  both.ref();
  EXPECT_TRUE(host_busy());
  EXPECT_FALSE(cpu_busy());
  both.ref(4);
  EXPECT_TRUE(host_busy()) << "as long as the CPU's strobe is low";
  cpu_end();
  both.ref(2);
  EXPECT_FALSE(host_busy());
  EXPECT_EQ(both.get("mem_rdata"), 0x4321u);
}

TEST_F(DpramCollisionTest, HostWriteWaitsForACpuRead) {
  cpu_start_read(8);
  both.ref();
  host_start(8, false);
  both.ref(3);
  EXPECT_TRUE(host_busy());
  EXPECT_EQ(both.get("cpu_rdata"), 0x0101u);
  cpu_end();
  both.ref(2);
  EXPECT_FALSE(host_busy());
  host_end_write(0x2468);
  EXPECT_EQ(cpu_read(8), 0x2468u);
}

// The cell of a granted write is the one that its strobe came with, whatever the pins show when it is made.
TEST_F(DpramCollisionTest, AddressMayGoWithTheStrobe) {
  cpu_start_write(8, 0x3333);
  both.ticks(kAccess);
  cpu_end();
  both.in.cpu_addr = 100;
  host_start(8, true);
  while (!host_busy()) both.tick();
  while (host_busy()) both.tick();
  EXPECT_EQ(both.get("mem_rdata"), 0x3333u);
  host_end_read();
  EXPECT_EQ(host_read(200), 0u);
}

TEST_F(DpramCollisionTest, RequestsThatMeetAtOneEdgeGoToTheCpu) {
  // The host's request meets its first clk_ref edge at tick T. The CPU's strobe that fell before tick T - 2 has come
  // through two flip-flops and is ready at T too; one tick later it is ready at T + 1.
  for (const int later : {0, 1}) {
    cpu_end();
    both.in.mem_sel = false;
    both.ref(3);
    both.ticks(later);
    cpu_start_write(8, 0x1000);
    both.ticks(2 - later);
    host_start(8, false);
    both.tick();
    ASSERT_TRUE(is_ref_edge(both.now()));
    both.tick();
    EXPECT_EQ(host_busy(), later == 0);
    EXPECT_EQ(cpu_busy(), later == 1);
  }
}

// The host waits for one access of the CPU, not for those that it begins after that.
TEST_F(DpramCollisionTest, AWaitingHostIsNextHoweverSoonTheCpuComesAgain) {
  for (const int high : {0, 1, 2, 3}) {
    cpu_start_write(8, 0x0001);
    both.ref();
    host_start(8, true);
    both.ref();
    ASSERT_TRUE(host_busy());
    cpu_end();
    both.ticks(high);
    cpu_start_write(8, 0x0002);
    both.ref(3);
    EXPECT_FALSE(host_busy()) << high;
    EXPECT_TRUE(cpu_busy()) << high;
    EXPECT_EQ(both.get("mem_rdata"), 0x0001u) << high;
    host_end_read();
    while (cpu_wait()) both.tick();
    cpu_end();
    both.ref(3);
    EXPECT_EQ(host_read(8), 0x0002u);
  }
}

// Between two strobes of a fast CPU /WR may be high for less than a tick (row 114), where no edge sees it.
TEST_F(DpramCollisionTest, HostIsLetInByTheNextStrobeIfTheHighBeforeItWasTooShortToBeSeen) {
  cpu_start_write(8, 0x4444);
  both.ticks(6);
  host_start(8, true);
  both.ref(2);
  EXPECT_TRUE(host_busy());
  both.in.cpu_sel = false;  // another device's write follows, /WR is low at every edge
  both.in.wr_falls = next_fall(both.in.wr_falls);
  both.ticks(3);
  both.ref(2);
  EXPECT_FALSE(host_busy());
  EXPECT_EQ(both.get("mem_rdata"), 0x4444u);
  both.in.cpu_wr_n = true;
}

TEST_F(DpramCollisionTest, CpuStrobeThatEndsWhileBusyDoesNothing) {
  for (const bool read : {false, true}) {  // what the host does meanwhile: a read leaves the cell as it was
    host_start(8, read);
    both.ref();
    cpu_start_write(8, 0x9999);
    both.ticks(6);
    EXPECT_TRUE(cpu_busy());
    cpu_end();
    both.ticks(3);
    EXPECT_FALSE(cpu_busy());
    if (read)
      host_end_read();
    else
      host_end_write(0x8888);
    EXPECT_EQ(host_read(8), 0x8888u) << "the CPU went on without /TA: its write is lost";
  }
}

// host-bus:2.6/5: the word of a read that waits and is given up is not shown in the next one, which is another
// device's and whose select comes with its strobe.
TEST_F(DpramCollisionTest, NoReadOfAnotherDeviceShowsTheWordOfOneThatWasGivenUp) {
  unsigned waited = 0;
  for (int low = 8; low <= 14; ++low)
    for (int host_goes = -6; host_goes <= 8; ++host_goes)
      for (int high = 0; high <= 3; ++high) {
        SCOPED_TRACE(::testing::Message() << low << ", host goes at " << host_goes << ", high for " << high);
        host_start(20, false);
        both.ref();
        cpu_start_read(20);
        for (int tick = 0; tick < low + high + kAccess + 6; ++tick) {
          if (tick == low) {
            waited += both.get("cpu_busy") != 0 ? 1 : 0;
            cpu_end();
            both.in.cpu_sel = true;
          }
          if (tick == low + high) {
            cpu_start_read(20);
            both.in.cpu_sel = false;
          }
          if (tick == low + host_goes) both.in.mem_sel = both.in.mem_rd = both.in.mem_wr = false;
          if (tick >= low) { ASSERT_FALSE(both.get("cpu_drive")) << tick; }
          both.tick();
        }
        cpu_end();
        both.ticks(kRest);
      }
  EXPECT_GE(waited, 7u * 9 * 4) << "all in which the host goes with the CPU or later";
}

TEST_F(DpramCollisionTest, HostCommandThatEndsWhileBusyDoesNothing) {
  cpu_start_read(8);
  both.ref();
  host_start(8, false);
  both.ref();
  EXPECT_TRUE(host_busy());
  host_end_write(0x8888);
  EXPECT_FALSE(host_busy());
  cpu_end();
  both.ref();
  EXPECT_EQ(host_read(8), 0x0101u);
}

// An item of two words becomes $00030004 while the host reads it low half first. Each half of the CPU's write overlaps
// the host's read of that half, and BUSY keeps each whole; nothing keeps the two halves together.
TEST_F(DpramCollisionTest, A32BitItemTears) {
  cpu_write(8, 0x0002);
  cpu_write(9, 0x0001);
  host_start(8, true);
  both.ref();
  cpu_start_write(8, 0x0004);
  both.ticks(3);
  EXPECT_TRUE(cpu_busy()) << "the host has the low half";
  const unsigned low = both.get("mem_rdata");
  host_end_read();
  both.tick();
  EXPECT_FALSE(cpu_busy()) << "written now";
  cpu_end();
  both.ref();

  cpu_start_write(9, 0x0003);
  both.ref();
  host_start(9, true);
  both.ref(2);
  EXPECT_TRUE(host_busy()) << "the CPU has the high half";
  cpu_end();
  both.ref(2);
  EXPECT_FALSE(host_busy());
  const unsigned high = both.get("mem_rdata");
  host_end_read();
  EXPECT_EQ(high << 16 | low, 0x00030002u) << "neither the old nor the new value";
  EXPECT_EQ(host_read(9) << 16 | host_read(8), 0x00030004u) << "a second reading tells";
}

// How long either side waits is the other's strobe and what it takes to see it end: the host's own edge, and three
// ticks for a strobe of the CPU. Strobes of any length, so that no sum is right by chance.
TEST_F(DpramCollisionTest, BusyEndsWithTheStrobeOfTheOther) {
  for (const int length : {2, 9, 40}) {
    host_start(8, false);
    both.ref();
    cpu_start_read(8);
    both.ref(length);
    EXPECT_TRUE(cpu_busy()) << length;
    host_end_write(1);
    EXPECT_TRUE(cpu_busy());
    both.tick();
    EXPECT_FALSE(cpu_busy()) << length;
    cpu_end();
    both.ref(2);

    cpu_start_write(8, 2);
    both.ref();
    host_start(8, true);
    both.ref(length);
    EXPECT_TRUE(host_busy()) << length;
    cpu_end();
    const Tick end = both.now();
    while (host_busy()) both.tick();
    EXPECT_LE(both.now() - end, 3 + kTicksPerRef) << length << ": two flip-flops and a third, then clk_ref";
    host_end_read();
  }
}

// A reset acts at once, without a clock: nobody waits behind it, and no word is anybody's.
TEST_F(DpramCollisionTest, AResetEndsBusyAndFreesTheWord) {
  const auto reset = [this] {
    cpu_end();
    both.in.mem_sel = false;
    both.in.rd_falls = both.in.wr_falls = 0;  // the counts are reset with it
    both.reset();
    EXPECT_FALSE(cpu_busy());
    EXPECT_FALSE(host_busy());
  };
  for (const unsigned word : {0u, 8u})
    for (const bool read : {false, true}) {
      SCOPED_TRACE(::testing::Message() << word << (read ? ", read" : ", write") << " of the CPU");
      host_start(word, !read);
      both.ref();
      read ? cpu_start_read(word) : cpu_start_write(word, 0x5555);
      both.ref(3);
      EXPECT_TRUE(cpu_busy());
      reset();
      both.ref(2);

      read ? cpu_start_read(word) : cpu_start_write(word, 0x5555);
      both.ref(2);
      host_start(word, !read);
      both.ref(2);
      EXPECT_TRUE(host_busy());
      reset();
      host_start(word, !read);
      both.tick();
      both.ref();
      EXPECT_FALSE(host_busy());
      host_end_read();

      read ? cpu_start_read(word) : cpu_start_write(word, 0x5555);
      both.ref(3);
      both.ticks(kTicksPerRef - 1);
      reset();
      host_start(word, !read);
      both.tick();  // the first edge of both clocks behind the reset
      EXPECT_FALSE(host_busy());
      host_end_read();

      const unsigned kept = host_read(word);
      host_start(word, false);
      both.ref(2);
      reset();
      host_end_write(~kept & 0xFFFF);
      EXPECT_EQ(host_read(word), kept) << "what the host had begun is not written";
    }
}

}  // namespace
}  // namespace brick
