#include "testbench/unit/host/dpram_bench.h"

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

TEST_F(DpramTest, CpuDataComesTwoEdgesAfterTheStrobe) {
  host_write(6, 0x1234);
  cpu_start_read(6);
  both.tick();
  EXPECT_NE(both.get("cpu_rdata"), 0x1234u);
  both.tick();
  EXPECT_EQ(both.get("cpu_rdata"), 0x1234u);
  EXPECT_FALSE(cpu_busy());
}

TEST_F(DpramTest, YWordIsAtTheEvenAndXWordAtTheOddHostWord) {
  for (const unsigned address : {0x0000u, 0x0001u, 0x1000u, 0x3FFFu}) {  // less $060000; host offset 4a and 4a + 2
    host_write(4 * address / 2, 0xA000 + address);
    host_write((4 * address + 2) / 2, 0x5000 + address);
    both.in.cpu_sel = true;
    both.in.cpu_addr = static_cast<std::uint16_t>(address);
    both.in.cpu_rd_n = false;
    both.in.cpu_x = false;
    both.ticks(3);
    EXPECT_EQ(both.get("cpu_rdata"), 0xA000 + address) << "Y";
    both.in.cpu_rd_n = true;
    both.ticks(2);
    both.in.cpu_rd_n = false;
    both.in.cpu_x = true;
    both.ticks(3);
    EXPECT_EQ(both.get("cpu_rdata"), 0x5000 + address) << "X";
    cpu_end();
    both.ticks(2);
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
}

TEST_F(DpramTest, CpuDataMayComeOneTickAfterTheStrobe) {
  cpu_start_write(5, 0xDEAD);
  both.tick();
  both.in.cpu_wdata = 0xBEEF;  // valid from here on, row 110 of the bus timing lets data lag the strobe
  both.ticks(2);
  cpu_end();
  both.ticks(2);
  EXPECT_EQ(host_read(5), 0xBEEFu);
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

TEST_F(DpramTest, ResetKeepsTheContent) {
  cpu_write(100, 0xCAFE);
  both.reset();
  EXPECT_EQ(host_read(100), 0xCAFEu);
}

TEST_F(DpramSmallTest, WordsThatAreNotFittedReadZeroAndIgnoreWrites) {
  cpu_write(8191, 0x7777);
  cpu_write(8192, 0x1111);
  host_write(32767, 0x2222);
  EXPECT_EQ(host_read(8191), 0x7777u);
  EXPECT_EQ(host_read(8192), 0u);
  EXPECT_EQ(cpu_read(32767), 0u);
  EXPECT_EQ(cpu_read(0), 0u) << "no alias";
}

TEST_F(DpramSmallTest, RandomAccessesAgree) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    random_run(seed, 6000, 32768);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

TEST_F(DpramTest, RandomMeetingsOfBothSidesAgree) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    random_run(seed, 6000, 1 + seed % 4);
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
