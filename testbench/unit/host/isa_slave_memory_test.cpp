// Memory cycles of the ISA slave: LA and MEMCS16#, the place of the window and its pages, byte lanes, slots of 8 bits
// (host-bus:3.7), IOCHRDY, and who drives SD (host-bus:3.8).
#include "testbench/unit/host/isa_slave_fixture.h"

namespace brick {
namespace {

// host-bus:3.4/16: the block of 128 KiB that LA names, whatever SA and AEN are.
TEST_F(IsaSlaveTest, Memcs16FollowsLaAlone) {
  for (unsigned la = 0; la < 0x80; ++la) {
    both.in.isa_la = static_cast<std::uint8_t>(la);
    both.in.isa_sa = la % 3 == 0 ? 0xD1234 : 0x21234;
    both.in.isa_aen = la % 2;
    ticks(within(66));
    EXPECT_EQ(both.get("isa_memcs16_n"), la == 0xD0000 >> 17 ? 0u : 1u) << la;
  }
}

// LA may be let go of when the command falls: it is taken before.
// LA goes with the command, whose pad is up to 8.477 ns later than LA's.
TEST_F(IsaSlaveTest, LaNeedsNoHold) {
  for (int phase = 0; phase < 3; ++phase) {
    for (const int late : {0, 1}) {
      strobes.clear();
      set_address(0xD0010);
      at_phase(phase);
      both.in.isa_la = 0;
      ticks(late);
      both.in.isa_memw_n = false;
      ticks(28);
      both.in.isa_memw_n = true;
      ticks(12);
      EXPECT_EQ(strobes.size(), 1u) << "phase " << phase << ", late by " << late;
    }
  }
}

// host-bus:3.7
TEST_F(IsaSlaveTest, WindowIsInOneMebibyteOnly) {
  both.in.window = 0xD4000 >> 14;
  both.in.window_flat = false;
  ticks(3);
  mem_write(0xD4000, 1);
  ASSERT_EQ(strobes.size(), 1u);
  strobes.clear();
  for (unsigned bit = 14; bit < 24; ++bit) mem_write(0xD4000 ^ 1u << bit, 1);
  EXPECT_TRUE(strobes.empty()) << "A23..A14 are compared";
  both.in.window_flat = true;
  ticks(3);
  for (unsigned address : {0xD0000u, 0xD4000u, 0xD8000u, 0xDC000u}) mem_write(address, 1);
  EXPECT_EQ(strobes.size(), 4u) << "64 KiB";
  strobes.clear();
  for (unsigned bit = 16; bit < 24; ++bit) mem_write(0xD4000 ^ 1u << bit, 1);
  EXPECT_TRUE(strobes.empty());
}

TEST_F(IsaSlaveTest, PageRegisterChoosesAQuarter) {
  io_write(0x21C, 3);
  EXPECT_EQ(io_read(0x21C), 0xFFFFu) << "no page register while the window is flat";
  both.in.window_flat = false;
  both.in.window = 0xD4000 >> 14;
  ticks(3);
  EXPECT_EQ(io_read(0x21C), 0xFFFCu) << "page 0 after a reset";
  for (unsigned page = 0; page < 4; ++page) {
    strobes.clear();
    io_write(0x21C, 0xF8 | page);
    for (unsigned other : {0x21Du, 0x21Eu, 0x21Fu, 0x22Cu}) io_write(other, ~page);
    EXPECT_EQ(io_read(0x21C), 0xFFFCu | page);
    EXPECT_EQ(io_read(0x21F), 0xFFFFu);
    both.in.isa_sbhe_n = false;
    mem_write(0xD4000 + 0x3FFE, 0x1234);
    EXPECT_EQ(strobes, (std::vector<Strobe>{{"mem_wr", page << 13 | 0x1FFF, 3u << 16 | 0x1234}}));
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
  EXPECT_EQ(mem_read(0xD0001), 0x77FFu) << "the upper lane alone is driven";
  both.in.isa_sbhe_n = true;
  EXPECT_EQ(mem_read(0xD0000), 0xFF66u) << "the lower lane alone";
  EXPECT_EQ(mem_read(0xDFFFF), 0xFF77u) << "odd byte of an 8-bit host on the low lane";
}

TEST_F(IsaSlaveTest, MemoryWindowIgnoresAen) {
  both.in.isa_aen = true;
  mem_write(0xD0000, 1);
  EXPECT_EQ(strobes.size(), 1u) << "AEN disqualifies I/O only";
}

// host-bus:3.7: in an 8-bit slot there is no LA, and SMEMR#, SMEMW# stay high above the first mebibyte.
TEST_F(IsaSlaveTest, EightBitSlotIsDecodedWithoutLa) {
  both.in.slot8 = true;
  ticks(3);
  both.in.isa_sbhe_n = true;
  const auto write = [&](unsigned address) {
    both.in.isa_sa = address;
    both.in.isa_la = 0x7F;
    ticks(11);
    both.in.isa_memw_n = false;
    ticks(28);
    both.in.isa_memw_n = true;
    ticks(12);
  };
  for (unsigned bit = 16; bit < 20; ++bit) write(0xD0000 ^ 1u << bit);
  EXPECT_TRUE(strobes.empty());
  write(0xD0000);
  EXPECT_EQ(strobes.size(), 1u) << "whatever is on the pins of LA";
  strobes.clear();
  mem_write(0x3D0000, 1);
  mem_write(0xFD0001, 2);
  EXPECT_EQ(strobes, (std::vector<Strobe>{{"mem_wr", 0, 1u << 16 | 1}, {"mem_wr", 0, 2u << 16 | 0x0202}}));
}

// host-bus:3.7/5: SMEMR# and SMEMW# stand for A23 to A20, whatever the card's switches say of them.
TEST_F(IsaSlaveTest, EightBitSlotComparesNoAddressAboveOneMebibyte) {
  both.in.slot8 = true;
  both.in.window |= 0x3C0;
  ticks(3);
  both.in.isa_sbhe_n = true;
  mem_write(0xD0000, 1);
  EXPECT_EQ(strobes, (std::vector<Strobe>{{"mem_wr", 0, 1u << 16 | 1}}));
}

// host-bus:3.4/18: SA[19:17] of an 8-bit slot are as late as all of SA. 34 ns are four ticks and a little; at 25 ns
// the aperture of the first flip-flop is covered too.
TEST_F(IsaSlaveTest, EightBitSlotTakesItsWholeAddress25NanosecondsBeforeTheCommand) {
  both.in.slot8 = true;
  both.in.isa_sbhe_n = true;
  for (int phase = 0; phase < 3; ++phase) {
    set_address(0x20000);
    at_phase(phase);
    strobes.clear();
    set_address(0xD0000);
    ticks(3);
    both.in.isa_memw_n = false;
    ticks(28);
    both.in.isa_memw_n = true;
    ticks(12);
    EXPECT_EQ(strobes.size(), 1u) << phase;
  }
}

TEST_F(IsaSlaveTest, MemorySelectCoversTheCommand) {
  set_address(0xD0010);
  ticks(11);
  both.in.isa_memr_n = false;
  EXPECT_LE(ticks_until("mem_sel", 1, 20), 5) << "two clk_pwm edges, one of clk_ref";
  EXPECT_EQ(both.get("mem_rd"), 1u);
  EXPECT_EQ(both.get("mem_addr"), 8u);
  ticks(22);
  EXPECT_EQ(both.get("mem_sel"), 1u);
  both.in.isa_memr_n = true;
  EXPECT_LE(ticks_until("mem_sel", 0, 20), 5);
}

// host-bus:3.4, row 8: 70 ns are aimed for, at the pads. To a flip-flop the command has a pad of 8.477 ns and an
// aperture of 1, IOCHRDY has 10 ns from its own; the ticks between are the rest. And it is high again one clk_ref
// later, if the memory is free.
TEST_F(IsaSlaveTest, IochrdyIsLowWithin70NanosecondsAtThePads) {
  constexpr double kTick = 1e9 / 117'964'800, kPads = kTick + 1 + 10;
  for (const bool write : {false, true})
    for (int phase = 0; phase < 3; ++phase) {
      set_address(0xD0010);
      at_phase(phase);
      (write ? both.in.isa_memw_n : both.in.isa_memr_n) = false;
      const int low = ticks_until("isa_iochrdy", 0, 20);
      EXPECT_GE(low, 0);
      EXPECT_LE(low * kTick + kPads, 70) << phase;
      EXPECT_EQ(ticks_until("isa_iochrdy", 1, 20), static_cast<int>(kTicksPerRef));
      ticks(28);
      both.in.isa_memr_n = both.in.isa_memw_n = true;
      EXPECT_EQ(ticks_until("isa_iochrdy", 0, 12), -1);
    }
}

// It is the RAM that is waited for, in cycles of the window alone.
TEST_F(IsaSlaveTest, IochrdyIsHighInAllOtherCycles) {
  for (const unsigned address : {0x212u, 0x219u, 0x21Cu, 0x220u, 0xE0000u})
    for (const auto command : {&Inputs::isa_ior_n, &Inputs::isa_iow_n, &Inputs::isa_memr_n, &Inputs::isa_memw_n}) {
      set_address(address);
      ticks(11);
      both.in.*command = false;
      for (int n = 0; n < 40; ++n) {
        EXPECT_EQ(both.get("isa_iochrdy"), 1u) << std::hex << address;
        tick();
      }
      both.in.*command = true;
      ticks(12);
    }
}

TEST_F(IsaSlaveTest, IochrdyIsLowWhileTheMemoryIsBusyAndDataFollows) {
  both.in.mem_rdata = 0x1111;
  both.in.isa_sbhe_n = false;
  set_address(0xD0000);
  both.ref(4);
  both.in.isa_memr_n = false;
  both.ref();
  ASSERT_EQ(both.get("mem_sel"), 1u);
  both.in.mem_busy_d = true;  // the memory's answer at the edge that sees the request
  for (int n = 0; n < 15; ++n) {
    EXPECT_EQ(both.get("isa_iochrdy"), 0u) << "tick " << n;
    tick();
  }
  EXPECT_EQ(both.get("isa_iochrdy"), 0u);
  EXPECT_EQ(both.get("isa_sd_oe"), 0u) << "no data yet";
  both.in.mem_busy_d = false;
  both.ref();
  both.in.mem_rdata = 0x2222;
  EXPECT_EQ(both.get("isa_iochrdy"), 1u);
  both.ref();
  EXPECT_EQ(bus_data(), 0x2222u) << "one clk_ref after IOCHRDY, the host waits for 120 ns";
  both.in.mem_rdata = 0x3333;
  both.ref(3);
  EXPECT_EQ(bus_data(), 0x2222u);
  both.in.isa_memr_n = true;
  both.ref(3);
}

// host-bus:3.4/5: what is not ours floats.
TEST_F(IsaSlaveTest, BusIsDrivenInReadsOfOursOnly) {
  const auto never = [&](unsigned address, bool Inputs::*command) {
    set_address(address);
    ticks(11);
    both.in.*command = false;
    for (int n = 0; n < 63; ++n) {
      EXPECT_EQ(both.get("isa_sd_oe"), 0u) << std::hex << address;
      tick();
    }
    both.in.*command = true;
    ticks(15);
  };
  both.in.isa_sbhe_n = false;
  for (const unsigned address : {0x212u, 0x213u}) {
    set_address(address);
    ticks(11);
    both.in.isa_ior_n = false;
    ticks(20);
    EXPECT_EQ(both.get("isa_sd_oe"), 1u) << "I/O is on the low lane, whatever SBHE# is";
    both.in.isa_ior_n = true;
    ticks(15);
  }
  for (const bool memory : {false, true}) {  // another read command that falls as the first one ends is none of ours
    set_address(memory ? 0xD0000 : 0x212);
    ticks(11);
    (memory ? both.in.isa_memr_n : both.in.isa_ior_n) = false;
    ticks(30);
    EXPECT_NE(both.get("isa_sd_oe"), 0u);
    std::swap(both.in.isa_memr_n, both.in.isa_ior_n);
    for (int n = 0; n < 20; ++n) {
      EXPECT_EQ(both.get("isa_sd_oe"), 0u) << n;
      tick();
    }
    both.in.isa_memr_n = both.in.isa_ior_n = true;
    ticks(15);
  }
  for (unsigned offset = 0; offset < 16; ++offset) never(0x220 + offset, &Inputs::isa_ior_n);
  never(0xE0000, &Inputs::isa_memr_n);
  never(0x1D0000, &Inputs::isa_memr_n);
  never(0x217, &Inputs::isa_iow_n);
  never(0xD0000, &Inputs::isa_memw_n);
  both.in.isa_aen = true;
  for (const unsigned address : {0x212u, 0x218u, 0x21Cu}) never(address, &Inputs::isa_ior_n);
}

}  // namespace
}  // namespace brick
