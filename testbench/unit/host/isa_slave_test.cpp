#include "testbench/unit/host/isa_bench.h"

namespace brick {
namespace {

class IsaSlaveTest : public ::testing::Test, protected IsaBench {
 protected:
  void TearDown() override {
    if (!both.mutate) { EXPECT_LOCKSTEP(both); }
  }
  // Ticks from now until `name` shows `value`; -1 if it does not within `most`.
  int ticks_until(std::string_view name, unsigned value, int most) {
    for (int n = 0; n <= most; ++n) {
      if (both.get(name) == value) return n;
      tick();
    }
    return -1;
  }
  // The slave stands idle, and the next edge of clk_ref comes `phase` + 1 ticks from now.
  void at_phase(int phase) {
    ticks(12);
    while (next_ref_edge(both.now()) - both.now() != phase + 1) tick();
  }
};

// Complete periods of clk_pwm within a time.
constexpr int within(std::int64_t ns) { return static_cast<int>(ns_to_ticks(ns)) - 1; }

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
    do tick();
    while (both.now() % kTicksPerRef != 0);
    EXPECT_EQ(bus_data(), 0xFFB2u);
    EXPECT_EQ(both.get("pic_rd"), 0u) << "one clk_ref";
    ticks(60);
    both.in.isa_ior_n = true;
    ticks(9);
    io_read(0x213);
  }
}

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

// host-bus:3.7: in an 8-bit slot there is no LA, and SMEMR#, SMEMW# stay high above the first mebibyte.
TEST_F(IsaSlaveTest, EightBitSlotIsDecodedWithoutLa) {
  both.in.slot8 = true;
  ticks(3);
  both.in.isa_sbhe_n = true;
  for (unsigned bit = 16; bit < 20; ++bit) {
    both.in.isa_sa = 0xD0000 ^ 1u << bit;
    both.in.isa_la = 0x7F;
    ticks(11);
    both.in.isa_memw_n = false;
    ticks(28);
    both.in.isa_memw_n = true;
    ticks(12);
  }
  EXPECT_TRUE(strobes.empty());
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
    for (unsigned other : {0x21Du, 0x21Eu, 0x21Fu}) io_write(other, ~page);
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
  never(0x220, &Inputs::isa_ior_n);
  never(0xE0000, &Inputs::isa_memr_n);
  never(0x1D0000, &Inputs::isa_memr_n);
  never(0x217, &Inputs::isa_iow_n);
  never(0xD0000, &Inputs::isa_memw_n);
  both.in.isa_aen = true;
  never(0x212, &Inputs::isa_ior_n);
}

TEST_F(IsaSlaveTest, MemoryWindowIgnoresAen) {
  both.in.isa_aen = true;
  mem_write(0xD0000, 1);
  EXPECT_EQ(strobes.size(), 1u) << "AEN disqualifies I/O only";
}

// LA may be let go of when the command falls: it is taken before.
TEST_F(IsaSlaveTest, LaNeedsNoHold) {
  for (int phase = 0; phase < 3; ++phase) {
    strobes.clear();
    set_address(0xD0010);
    at_phase(phase);
    both.in.isa_memw_n = false;
    both.in.isa_la = 0;
    ticks(28);
    both.in.isa_memw_n = true;
    ticks(12);
    EXPECT_EQ(strobes.size(), 1u);
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

TEST_F(IsaSlaveTest, IochrdyIsLowWhileTheMemoryIsBusyAndDataFollows) {
  both.in.mem_rdata = 0x1111;
  both.in.isa_sbhe_n = false;
  set_address(0xD0000);
  both.ref(4);
  both.in.isa_memr_n = false;
  both.ref(2);
  ASSERT_EQ(both.get("mem_sel"), 1u);
  both.in.mem_busy = true;  // the memory's answer after the edge that saw the request
  both.ref(4);
  EXPECT_EQ(both.get("isa_iochrdy"), 0u);
  EXPECT_EQ(both.get("isa_sd_oe"), 0u) << "no data yet";
  both.in.mem_busy = false;
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

// ------------------------------------------------------------------------------------------ what no sound host does

TEST_F(IsaSlaveTest, TwoCommandsAtOnceDoNothing) {
  bool Inputs::*const commands[] = {&Inputs::isa_ior_n, &Inputs::isa_iow_n, &Inputs::isa_memr_n, &Inputs::isa_memw_n};
  for (const auto first : commands) {
    for (const auto second : commands) {
      if (first == second) continue;
      for (const int delay : {0, 30}) {
        strobes.clear();
        const bool memory = first == commands[2] || first == commands[3];
        set_address(memory ? 0xD0000 : 0x217);
        ticks(11);
        both.in.*first = false;
        ticks(delay);
        both.in.*second = false;
        ticks(8);
        EXPECT_EQ(both.get("isa_sd_oe"), 0u);
        EXPECT_EQ(both.get("mem_sel"), 0u);
        ticks(40);
        both.in.*first = true;
        ticks(20);
        both.in.*second = true;
        ticks(12);
        EXPECT_TRUE(strobes.empty());
      }
    }
  }
  io_write(0x217, 1);
  EXPECT_EQ(strobes.size(), 1u) << "the next cycle is one again";
}

TEST_F(IsaSlaveTest, ReadTooShortForItsDataTakesNothing) {
  std::size_t reads = 0;
  for (int phase = 0; phase < 3; ++phase) {
    for (int width = 1; width <= 12; ++width) {
      strobes.clear();
      set_address(0x217);
      at_phase(phase);
      both.in.isa_ior_n = false;
      ticks(width);
      const bool data = both.get("isa_sd_oe") != 0;
      both.in.isa_ior_n = true;
      ticks(15);
      if (!data) { EXPECT_TRUE(strobes.empty()) << width; }
      reads += strobes.size();
    }
  }
  EXPECT_GT(reads, 0u);
}

// A read of an 8259 acknowledges at the edge that takes the byte: not if the command is gone by then, or another came.
TEST_F(IsaSlaveTest, ReadThatEndsBeforeItsByteIsTakenAcknowledgesNothing) {
  for (int phase = 0; phase < 3; ++phase) {
    for (const bool second : {false, true}) {
      for (const int width : {1, 2, 3, 20}) {
        strobes.clear();
        set_address(0x21A);
        at_phase(phase);
        both.in.isa_ior_n = false;
        ticks(width);
        (second ? both.in.isa_iow_n : both.in.isa_ior_n) = !second;
        ticks(20);
        both.in.isa_ior_n = both.in.isa_iow_n = true;
        ticks(15);
        EXPECT_EQ(strobes.size(), width == 20 ? 1u : 0u) << phase << " " << width << " " << second;
      }
    }
  }
}

TEST_F(IsaSlaveTest, AddressThatMovesDuringACycleIsNotLookedAt) {
  set_address(0x217);
  both.in.isa_sd = 0x41;
  ticks(11);
  both.in.isa_iow_n = false;
  ticks(12);
  set_address(0x21A);
  ticks(50);
  both.in.isa_iow_n = true;
  ticks(12);
  EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, 0x41}}));
}

TEST_F(IsaSlaveTest, CommandThatWasLowAtAResetDoesNothing) {
  for (const bool line : {true, false}) {  // the board's reset, RESETDRV
    for (const auto command : {&Inputs::isa_iow_n, &Inputs::isa_ior_n, &Inputs::isa_memw_n}) {
      for (int moment : {1, 4, 7, 10, 40}) {
        strobes.clear();
        set_address(command == &Inputs::isa_memw_n ? 0xD0000 : 0x217);
        ticks(11);
        both.in.*command = false;
        ticks(moment);
        if (line) {
          both.reset();
        } else {
          both.in.isa_resetdrv = true;
          ticks(12);
          both.in.isa_resetdrv = false;
        }
        EXPECT_EQ(both.get("isa_sd_oe"), 0u);
        ticks(30);
        EXPECT_EQ(both.get("isa_sd_oe"), 0u) << "not taken up again";
        both.in.*command = true;
        ticks(15);
        EXPECT_TRUE(strobes.empty()) << moment;
      }
    }
  }
  io_write(0x217, 1);
  EXPECT_EQ(strobes.size(), 1u);
}

// host-bus:3.8
TEST_F(IsaSlaveTest, ResetdrvResetsTheHostSide) {
  both.in.window_flat = false;
  ticks(3);
  io_write(0x21C, 2);
  EXPECT_EQ(io_read(0x21C), 0xFFFEu);
  both.in.isa_resetdrv = true;
  EXPECT_LE(ticks_until("host_reset", 1, 20), 6) << "two clk_ref edges";
  strobes.clear();
  EXPECT_EQ(io_read(0x212), 0xFFFFu) << "nobody answers";
  io_write(0x217, 1);
  EXPECT_TRUE(strobes.empty());
  both.in.isa_resetdrv = false;
  EXPECT_LE(ticks_until("host_reset", 0, 20), 6);
  ticks(6);
  EXPECT_EQ(io_read(0x21C), 0xFFFCu);
}

TEST_F(IsaSlaveTest, RandomCyclesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    random_run(seed, 6000);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

// ----------------------------------------------------------------------------------------------- negative controls

TEST_F(IsaSlaveTest, ComparisonSeesAWrongBaseAddress) {
  both.mutate = [](Inputs& in) { in.io_base ^= 0x80; };
  io_read(0x212);
  EXPECT_NE(both.difference(), "");
}

TEST_F(IsaSlaveTest, ComparisonSeesAnAddressBitThatIsNotCompared) {
  both.mutate = [](Inputs& in) { in.io_decode16 = false; };
  both.ref(2);
  io_read(0x210 ^ 0x8000);
  EXPECT_NE(both.difference(), "");
}

TEST_F(IsaSlaveTest, ComparisonSeesLaThatIsNotCompared) {
  both.mutate = [](Inputs& in) { in.slot8 = true; };
  both.ref(2);
  mem_write(0x1D0000, 1);
  EXPECT_NE(both.difference(), "");
}

}  // namespace
}  // namespace brick
