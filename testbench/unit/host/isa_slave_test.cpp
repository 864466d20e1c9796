#include "testbench/unit/host/isa_bench.h"

namespace brick {
namespace {

class IsaSlaveTest : public ::testing::Test, protected IsaBench {
 protected:
  explicit IsaSlaveTest(const IsaSlave::Config& config = {}) : IsaBench(make_rtl_isa_slave(), config) {}
  void TearDown() override {
    if (!negative_) { EXPECT_LOCKSTEP(both); }
  }
  bool negative_ = false;
};

class IsaSlaveVariantTest : public ::testing::Test, protected IsaBench {
 protected:
  IsaSlaveVariantTest() : IsaBench(make_rtl_isa_slave_variant(), {0x310, 0xE, false}) {}
  void TearDown() override { EXPECT_LOCKSTEP(both); }
};

TEST_F(IsaSlaveTest, SixteenBytesAreDecoded) {
  for (unsigned offset = 0; offset < 16; ++offset) {
    strobes.clear();
    const unsigned value = io_read(0x210 + offset);
    io_write(0x210 + offset, 0x40 + offset);
    if (offset < 8) {
      EXPECT_EQ(value, 0xFFA0 + offset);
      EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_rd", offset, 0}, {"hp_wr", offset, 0x40 + offset}}));
    } else if (offset < 12) {
      EXPECT_EQ(value, 0xFFB0 + offset - 8);
      EXPECT_EQ(strobes, (std::vector<Strobe>{{"pic_rd", offset - 8, 0}, {"pic_wr", offset - 8, 0x40 + offset}}));
    } else {
      EXPECT_EQ(value, 0xFFFFu) << "+12..15 hold nothing";
      EXPECT_TRUE(strobes.empty());
    }
  }
}

TEST_F(IsaSlaveTest, EveryAddressBitAndAenAreCompared) {
  for (unsigned bit = 4; bit < 16; ++bit) {
    io_write((0x217) ^ (1u << bit), 0x55);
    EXPECT_TRUE(strobes.empty()) << "SA" << bit;
  }
  both.in.isa_aen = true;
  io_write(0x217, 0x55);
  EXPECT_TRUE(strobes.empty()) << "a DMA cycle";
  both.in.isa_aen = false;
  mem_write(0x00217, 0x55);
  EXPECT_TRUE(strobes.empty()) << "memory is not I/O";
  io_write(0x217, 0x55);
  EXPECT_EQ(strobes.size(), 1u);
}

TEST_F(IsaSlaveTest, IoReadDataIsThereWithin120Nanoseconds) {
  for (int phase = 0; phase < 3; ++phase) {  // of clk_ref against the command
    both.in.isa_sa = 0x212;
    ticks(12 + phase);
    const Tick low = both.now();
    both.in.isa_ior_n = false;
    while (both.get("isa_sd") != 0xFFA2) {
      tick();
      ASSERT_LE(both.now() - low, ns_to_ticks(120)) << "t4";
    }
    EXPECT_LE(both.now() - low, 6) << "second clk_ref edge";
    ticks(60);
    both.in.isa_ior_n = true;
    ticks(9);
    io_read(0x213);  // other data on the bus for the next round
  }
}

TEST_F(IsaSlaveTest, WriteTakesTheDataLastSeenWhileTheCommandWasLow) {
  both.in.isa_sa = 0x217;
  both.in.isa_sd = 0x11;
  ticks(11);
  both.in.isa_iow_n = false;
  ticks(20);
  both.in.isa_sd = 0x22;  // late data
  ticks(40);
  EXPECT_TRUE(strobes.empty()) << "nothing before the command ends";
  both.in.isa_iow_n = true;
  both.in.isa_sd = 0x33;  // no hold at all
  both.in.isa_sa = 0;
  ticks(9);
  EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, 0x22}}));
}

TEST_F(IsaSlaveTest, ReadDataStaysWhileTheRegisterChanges) {
  both.in.isa_sa = 0x212;
  ticks(11);
  both.in.isa_ior_n = false;
  ticks(10);
  const unsigned first = both.get("isa_sd");
  both.in.isa_sa = 0x213;
  ticks(30);
  EXPECT_EQ(both.get("isa_sd"), first) << "a host never sees a byte in transition";
  both.in.isa_ior_n = true;
  ticks(9);
}

// What a read of the interrupt controller gives and what it does belong to one clk_ref edge (8259: acknowledge, poll).
TEST_F(IsaSlaveTest, ReadOfTheInterruptControllerTakesDataAndEffectAtOneEdge) {
  for (int phase = 0; phase < 3; ++phase) {
    both.in.isa_sa = 0x21A;
    ticks(12 + phase);
    both.in.isa_ior_n = false;
    while (!both.get("pic_rd")) {
      EXPECT_NE(both.get("isa_sd"), 0xFFB2u) << "no data before";
      tick();
    }
    do tick();
    while (both.now() % kTicksPerRef != 0);
    EXPECT_EQ(both.get("isa_sd"), 0xFFB2u);
    EXPECT_EQ(both.get("pic_rd"), 0u) << "one clk_ref";
    ticks(60);
    both.in.isa_ior_n = true;
    ticks(9);
    io_read(0x213);
  }
}

TEST_F(IsaSlaveTest, Memcs16FollowsTheAddressAlone) {
  for (unsigned page = 0; page < 16; ++page) {
    for (const unsigned offset : {0x1234u, 0xFFFEu}) {
      both.in.isa_sa = page << 16 | offset;
      both.in.isa_aen = page % 2;
      ticks(static_cast<int>(ns_to_ticks(66)) - 1);  // complete periods within 66 ns
      EXPECT_EQ(both.get("isa_memcs16_n"), page == 0xD ? 0u : 1u);
    }
  }
}

TEST_F(IsaSlaveTest, MemoryWindowHasByteLanes) {
  struct Case {
    unsigned sbhe_n, a0, lanes, data;
  };
  for (const auto& c : {Case{0, 0, 3, 0x12AB}, Case{1, 0, 1, 0x12AB}, Case{0, 1, 2, 0x12AB}, Case{1, 1, 2, 0xABAB}}) {
    strobes.clear();
    both.in.isa_sbhe_n = c.sbhe_n;
    mem_write(0xD8642 + c.a0, 0x12AB);
    EXPECT_EQ(strobes, (std::vector<Strobe>{{"mem_wr", 0x8642 / 2, c.lanes << 16 | c.data}})) << c.sbhe_n << c.a0;
  }
  both.in.mem_rdata = 0x7766;
  both.in.isa_sbhe_n = false;
  EXPECT_EQ(mem_read(0xD0000), 0x7766u);
  both.in.isa_sbhe_n = true;
  EXPECT_EQ(mem_read(0xDFFFF), 0x7777u) << "odd byte of an 8-bit host on the low lane";
  EXPECT_EQ(both.get("isa_sd"), 0x7777u);
}

TEST_F(IsaSlaveTest, MemoryWindowIgnoresAenAndOtherPages) {
  both.in.isa_aen = true;
  mem_write(0xD0000, 1);
  EXPECT_EQ(strobes.size(), 1u) << "AEN disqualifies I/O only";
  strobes.clear();
  for (unsigned page : {0x0u, 0x5u, 0x9u, 0xCu, 0xEu, 0xFu}) mem_write(page << 16, 1);
  EXPECT_TRUE(strobes.empty());
}

TEST_F(IsaSlaveTest, MemorySelectCoversTheCommand) {
  both.in.isa_sa = 0xD0010;
  ticks(11);
  both.in.isa_memr_n = false;
  ticks(6);  // second clk_ref edge at the latest
  EXPECT_EQ(both.get("mem_sel"), 1u);
  EXPECT_EQ(both.get("mem_rd"), 1u);
  EXPECT_EQ(both.get("mem_addr"), 8u);
  ticks(22);
  both.in.isa_memr_n = true;
  ticks(6);
  EXPECT_EQ(both.get("mem_sel"), 0u);
}

TEST_F(IsaSlaveTest, IochrdyIsLowWhileTheMemoryIsBusyAndDataFollows) {
  both.in.mem_rdata = 0x1111;
  both.in.isa_sa = 0xD0000;
  both.ref(4);
  both.in.isa_memr_n = false;
  both.ref(2);
  both.in.mem_busy = true;  // the memory's answer after the edge that saw the request
  both.ref(4);
  EXPECT_EQ(both.get("isa_iochrdy"), 0u);
  EXPECT_NE(both.get("isa_sd"), 0x1111u);
  both.in.mem_busy = false;
  both.in.mem_rdata = 0x2222;
  EXPECT_EQ(both.get("isa_iochrdy"), 1u);
  both.ref();
  EXPECT_EQ(both.get("isa_sd"), 0x2222u) << "one clk_ref after IOCHRDY, the host waits for 120 ns";
  both.in.mem_rdata = 0x3333;
  both.ref(3);
  EXPECT_EQ(both.get("isa_sd"), 0x2222u);
  both.in.isa_memr_n = true;
  both.ref(3);
}

TEST_F(IsaSlaveVariantTest, BaseAddressAndTenBitDecodeAreParameters) {
  io_write(0x210, 1);
  EXPECT_TRUE(strobes.empty());
  io_write(0x317, 0x31);
  io_write(0xFF17 & ~0xC0u, 0x32);  // SA[15:10] are not compared
  mem_write(0xE0000, 0x44);
  mem_write(0xD0000, 0x45);
  EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, 0x31}, {"hp_wr", 7, 0x32}, {"mem_wr", 0, 1u << 16 | 0x44}}));
}

TEST_F(IsaSlaveTest, RandomCyclesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    random_run(seed, 6000);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

class IsaSlaveWrongBaseTest : public IsaSlaveTest {
 protected:
  IsaSlaveWrongBaseTest() : IsaSlaveTest({0x220, 0xD, true}) { negative_ = true; }
};

TEST_F(IsaSlaveWrongBaseTest, ComparisonSeesAWrongBaseAddress) {
  random_run(2, 6000);
  EXPECT_NE(both.difference(), "");
}

class IsaSlaveLooseDecodeTest : public IsaSlaveTest {
 protected:
  IsaSlaveLooseDecodeTest() : IsaSlaveTest({0x210, 0xD, false}) { negative_ = true; }
};

TEST_F(IsaSlaveLooseDecodeTest, ComparisonSeesAnAddressBitThatIsNotCompared) {
  io_read(0x210 ^ 0x8000);
  EXPECT_NE(both.difference(), "");
}

}  // namespace
}  // namespace brick
