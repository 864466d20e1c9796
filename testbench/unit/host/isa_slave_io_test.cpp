// I/O cycles of the ISA slave: which of them are the board's (host-bus:3.1), when data come and go (host-bus:3.4), and
// the edge at which a read or a write takes place.
#include "testbench/unit/host/isa_slave_fixture.h"

namespace brick {
namespace {

// host-bus:3.1
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
      EXPECT_EQ(value, 0xFFFFu) << "+12..15 hold nothing while the window is flat";
      EXPECT_TRUE(strobes.empty());
    }
  }
}

TEST_F(IsaSlaveTest, EveryAddressBitAndAenAreCompared) {
  for (unsigned bit = 4; bit < 16; ++bit) {  // the switches compare A4..A11, above that is 0
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

TEST_F(IsaSlaveTest, EverySwitchOfTheBaseIsCompared) {
  for (unsigned base : {0x00u, 0x21u, 0xFFu, 0x01u, 0x02u, 0x04u, 0x08u, 0x10u, 0x20u, 0x40u, 0x80u}) {
    both.in.io_base = static_cast<std::uint8_t>(base);
    ticks(3);
    for (unsigned other = 1; other < 0x100; other <<= 1) io_write((base ^ other) << 4 | 7, 1);
    EXPECT_TRUE(strobes.empty()) << base;
    io_write(base << 4 | 7, 2);
    EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, 2}}));
    strobes.clear();
  }
}

TEST_F(IsaSlaveTest, ClassicDecodeLooksAtTenBits) {
  both.in.io_decode16 = false;
  both.in.io_base = 0x71;  // A10 is set, and is not compared
  ticks(3);
  for (unsigned bit = 10; bit < 16; ++bit) io_write(0x317 ^ 1u << bit, bit);
  EXPECT_EQ(strobes.size(), 6u);
  strobes.clear();
  for (unsigned bit = 4; bit < 10; ++bit) io_write(0x317 ^ 1u << bit, bit);
  EXPECT_TRUE(strobes.empty());
}

// host-bus:3.4/4, host-bus:3.4/5
TEST_F(IsaSlaveTest, IoReadDataIsThereWithin120NanosecondsAndGoesWithTheCommand) {
  for (int phase = 0; phase < 3; ++phase) {  // of clk_ref against the command
    both.in.isa_sa = 0x212;
    at_phase(phase);
    both.in.isa_ior_n = false;
    const int valid = ticks_until("isa_sd_oe", 1, 60);
    EXPECT_GE(valid, 0);
    EXPECT_LE(valid, within(120)) << "t4 as aimed for";
    EXPECT_LE(valid, 8) << "the third clk_ref edge at the latest";
    EXPECT_EQ(bus_data(), 0xFFA2u) << "an I/O byte is on the low lane";
    EXPECT_EQ(both.get("isa_sd"), 0xFFA2u) << "and ones where nobody drives";
    ticks(60);
    EXPECT_EQ(bus_data(), 0xFFA2u);
    both.in.isa_ior_n = true;
    EXPECT_EQ(both.get("isa_sd_oe"), 0u) << "t5: without a clock";
  }
}

// host-bus:3.4/7, host-bus:3.4/15
TEST_F(IsaSlaveTest, WriteTakesTheDataLastSeenWhileTheCommandWasLow) {
  for (int phase = 0; phase < 3; ++phase) {
    strobes.clear();
    both.in.isa_sa = 0x217;
    both.in.isa_sd = 0x11;
    at_phase(phase);
    both.in.isa_iow_n = false;
    ticks(20);
    both.in.isa_sd = 0x22;  // late data
    ticks(40);
    EXPECT_TRUE(strobes.empty()) << "nothing before the command ends";
    both.in.isa_iow_n = true;
    both.in.isa_sd = 0x33;  // no hold at all
    both.in.isa_sa = 0;
    ticks(within(170));
    EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, 0x22}})) << "before the next command may come (t11)";
  }
}

// Nothing moves between two commands but the data, and they not with the end of the first.
TEST_F(IsaSlaveTest, WritesOfOneRegisterTakeTheirOwnDataEach) {
  const unsigned values[] = {0x41, 0x42, 0x42, 0x43};
  set_address(0x217);
  for (const unsigned value : values) {
    both.in.isa_sd = static_cast<std::uint16_t>(value);
    ticks(20);
    both.in.isa_iow_n = false;
    ticks(63);
    both.in.isa_iow_n = true;
    ticks(20);
  }
  ASSERT_EQ(strobes.size(), std::size(values));
  for (unsigned n = 0; n < std::size(values); ++n) EXPECT_EQ(strobes[n], (Strobe{"hp_wr", 7, values[n]}));
}

// docs/isa_slave.md: they pass to a register on clk_ref at the end of the cycle, so nothing behind this bus hangs on
// clk_pwm.
TEST_F(IsaSlaveTest, WriteDataMoveAtTheEndOfTheirCycleOnly) {
  io_write(0x217, 0x11);
  for (const bool write : {false, true}) {
    set_address(0x217);
    both.in.isa_sd = 0x22;
    ticks(11);
    (write ? both.in.isa_iow_n : both.in.isa_ior_n) = false;
    for (int n = 0; n < 63; ++n) {
      EXPECT_EQ(both.get("hp_wdata"), 0x11u) << n;
      tick();
    }
    both.in.isa_iow_n = both.in.isa_ior_n = true;
    ticks(12);
    EXPECT_EQ(both.get("hp_wdata"), write ? 0x22u : 0x11u);
  }
}

// Each pin moves alone, long after all others have come to rest.
TEST_F(IsaSlaveTest, EachPinIsSeenThoughNothingElseMoves) {
  const auto write = [&](bool memory) {
    strobes.clear();
    ticks(20);
    (memory ? both.in.isa_memw_n : both.in.isa_iow_n) = false;
    ticks(63);
    both.in.isa_memw_n = both.in.isa_iow_n = true;
    ticks(20);
    return strobes;
  };
  set_address(0xD0217);
  both.in.isa_sd = 0x1234;
  both.in.isa_sbhe_n = false;
  both.in.isa_sa = 0x216;
  ticks(20);
  both.in.isa_sa = 0x217;
  EXPECT_EQ(write(false), (std::vector<Strobe>{{"hp_wr", 7, 0x34}})) << "SA";
  both.in.isa_aen = true;
  EXPECT_TRUE(write(false).empty()) << "AEN";
  both.in.isa_aen = false;
  EXPECT_EQ(write(false).size(), 1u);
  both.in.isa_sa = 0xD0216;
  EXPECT_EQ(write(true), (std::vector<Strobe>{{"mem_wr", 0x216 / 2, 3u << 16 | 0x1234}}));
  both.in.isa_sbhe_n = true;
  EXPECT_EQ(write(true), (std::vector<Strobe>{{"mem_wr", 0x216 / 2, 1u << 16 | 0x1234}})) << "SBHE#";
  both.in.isa_sd = 0x4321;
  EXPECT_EQ(write(true), (std::vector<Strobe>{{"mem_wr", 0x216 / 2, 1u << 16 | 0x4321}})) << "SD";
  both.in.isa_la = 0;
  EXPECT_TRUE(write(true).empty()) << "LA";
  both.in.isa_la = 0xD0000 >> 17;
  EXPECT_EQ(write(true).size(), 1u);
  both.in.window_flat = false;
  both.in.window = 0xD4000 >> 14;
  EXPECT_TRUE(write(true).empty()) << "a window of 16 KiB";
  both.in.isa_resetdrv = true;
  ticks(20);
  EXPECT_EQ(both.get("host_reset"), 1u);
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(IsaSlaveTest, SleepsWhileNothingMoves) {
  const auto rests = [&] {
    ticks(63);
    return both.asleep();
  };
  EXPECT_TRUE(rests());
  const struct {
    unsigned address;
    bool Inputs::*command;
  } cycles[] = {{0x217, &Inputs::isa_ior_n},   {0x217, &Inputs::isa_iow_n},    {0x21A, &Inputs::isa_ior_n},
                {0x220, &Inputs::isa_ior_n},   {0xD0000, &Inputs::isa_memr_n}, {0xD0000, &Inputs::isa_memw_n},
                {0xE0000, &Inputs::isa_memr_n}};
  for (const auto& cycle : cycles) {
    set_address(cycle.address);
    EXPECT_TRUE(rests()) << std::hex << cycle.address;
    both.in.*cycle.command = false;
    EXPECT_TRUE(rests()) << std::hex << cycle.address << ", the command is low";
    both.in.*cycle.command = true;
    EXPECT_TRUE(rests()) << std::hex << cycle.address << ", it is high";
  }
  both.in.isa_ior_n = both.in.isa_iow_n = false;
  EXPECT_TRUE(rests()) << "two commands";
  both.in.isa_ior_n = both.in.isa_iow_n = true;
  both.in.isa_resetdrv = true;
  EXPECT_TRUE(rests()) << "RESETDRV";
}

// An edge is asked for where the cycle moves on, as docs/isa_slave.md has it: start, data or what stands for it, end
// and the clock after it; and one of clk_pwm where a read lets go of SD, three while a read of the interrupt controller
// may act. On a board the end of a read shows at the receive register alone.
TEST_F(IsaSlaveTest, AsksForNoMoreEdgesThanTheCycleHasSteps) {
  const struct {
    unsigned address;
    bool Inputs::*command;
    std::size_t steps, on_a_board;
  } cycles[] = {{0x212, &Inputs::isa_ior_n, 5, 3},    {0x217, &Inputs::isa_ior_n, 5, 5},
                {0x21A, &Inputs::isa_ior_n, 8, 6},    {0x21C, &Inputs::isa_ior_n, 5, 3},
                {0x217, &Inputs::isa_iow_n, 4, 4},    {0x21C, &Inputs::isa_iow_n, 4, 4},
                {0xD0000, &Inputs::isa_memr_n, 6, 6}, {0xD0000, &Inputs::isa_memw_n, 4, 4},
                {0x220, &Inputs::isa_ior_n, 4, 2},    {0xE0000, &Inputs::isa_memw_n, 4, 4}};
  IsaBench board(true);
  for (IsaBench* bench : {static_cast<IsaBench*>(this), &board})
    for (const auto& cycle : cycles) {
      bench->set_address(cycle.address);
      bench->ticks(20);
      const std::size_t before = bench->both.events();
      bench->both.in.*cycle.command = false;
      bench->ticks(63);
      bench->both.in.*cycle.command = true;
      bench->ticks(20);
      EXPECT_LE(bench->both.events() - before, bench == this ? cycle.steps : cycle.on_a_board)
          << std::hex << cycle.address << (bench == this ? "" : ", on a board");
    }
  EXPECT_LOCKSTEP(board.both);
}

// Nor for any where nothing but addresses and data move, unless MEMCS16# does.
TEST_F(IsaSlaveTest, AsksForNoEdgeBetweenCycles) {
  set_address(0xE0000);
  ticks(20);
  const std::size_t before = both.events();
  for (unsigned block = 0; block < 0x80; ++block) {
    if (block == 0xD0000 >> 17) continue;
    set_address(block << 17 | block);
    both.in.isa_sd = static_cast<std::uint16_t>(block * 0x123);
    both.in.isa_aen = block % 2;
    both.in.isa_sbhe_n = block % 3 == 0;
    ticks(static_cast<int>(block % 7));
  }
  ticks(12);
  EXPECT_EQ(both.events(), before);
  set_address(0xD0000);
  ticks(12);
  EXPECT_EQ(both.events(), before + 1) << "MEMCS16#";
  both.in.isa_aen = both.in.isa_sbhe_n = false;
}

TEST_F(IsaSlaveTest, ReadDataStaysWhileTheRegisterChanges) {
  both.in.isa_sa = 0x212;
  ticks(11);
  both.in.isa_ior_n = false;
  ticks(10);
  const unsigned first = bus_data();
  EXPECT_EQ(first, 0xFFA2u);
  both.in.isa_sa = 0x213;
  port = 0x50;
  for (int i = 0; i < 30; ++i) {
    tick();
    EXPECT_EQ(bus_data(), first) << "a host never sees a byte in transition";
  }
  both.in.isa_ior_n = true;
  ticks(9);
}

// The host port is told of a read at one edge of clk_ref, which takes the byte, and of no other cycle.
TEST_F(IsaSlaveTest, ReadOfTheHostPortLooksOnce) {
  for (unsigned offset = 0; offset < 16; ++offset)
    for (const bool write : {false, true}) {
      SCOPED_TRACE(::testing::Message() << (write ? "write +" : "read +") << offset);
      unsigned looks = 0, byte = 0;
      set_address(0x210 + offset);
      ticks(11);
      for (int n = 0; n < 80; ++n) {
        (write ? both.in.isa_iow_n : both.in.isa_ior_n) = n >= 63;
        port = static_cast<std::uint8_t>(port + 37);
        if (is_ref_edge(both.now() + 1) && both.get("hp_rd") != 0) {
          ++looks;
          byte = (port + offset) & 0xFF;
        }
        tick();
        if (n == 62 && looks != 0) { EXPECT_EQ(bus_data(), 0xFF00 | byte); }
      }
      EXPECT_EQ(looks, !write && offset < 8 ? 1u : 0u);
    }
}

// What a read of the interrupt controller gives and what it does belong to one clk_ref edge (8259: acknowledge, poll).
TEST_F(IsaSlaveTest, ReadOfTheInterruptControllerTakesDataAndEffectAtOneEdge) {
  for (int phase = 0; phase < 3; ++phase) {
    both.in.isa_sa = 0x21A;
    ticks(12 + phase);
    both.in.isa_ior_n = false;
    while (!both.get("pic_rd")) {
      EXPECT_EQ(both.get("isa_sd_oe"), 0u) << "no data before";
      tick();
    }
    do {
      pic = static_cast<std::uint8_t>(pic + 37);
      tick();
    } while (both.now() % kTicksPerRef != 0);
    const unsigned byte = (pic + 2u) & 0xFF;
    EXPECT_EQ(both.get("pic_rd"), 0u) << "one clk_ref";
    for (int n = 0; n < 60; ++n) {
      EXPECT_EQ(bus_data(), 0xFF00 | byte);
      pic = static_cast<std::uint8_t>(pic + 37);
      tick();
    }
    both.in.isa_ior_n = true;
    ticks(9);
    io_read(0x213);
  }
}

}  // namespace
}  // namespace brick
