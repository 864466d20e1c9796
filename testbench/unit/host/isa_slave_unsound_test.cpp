// The ISA slave where a host keeps no rule (host-bus:3.9) or is reset in mid-cycle (host-bus:3.8): nothing happens that
// was not asked for, and the next cycle is one again.
#include <map>

#include "testbench/unit/host/isa_slave_fixture.h"

namespace brick {
namespace {

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

// However short a command is: it does nothing, or a write has its own data; and nothing of it is left for the next one.
TEST_F(IsaSlaveTest, ShortCommandIsNoneOrWhole) {
  unsigned value = 0, whole = 0;
  for (const auto command : {&Inputs::isa_iow_n, &Inputs::isa_ior_n, &Inputs::isa_memr_n})
    for (int phase = 0; phase < 3; ++phase)
      for (int width = 1; width <= 8; ++width) {
        SCOPED_TRACE(::testing::Message() << "phase " << phase << ", low for " << width);
        strobes.clear();
        set_address(0x217);
        both.in.isa_sd = static_cast<std::uint16_t>(++value & 0xFF);
        at_phase(phase);
        both.in.*command = false;
        ticks(width);
        both.in.*command = true;
        ticks(20);
        if (command == &Inputs::isa_iow_n && !strobes.empty()) {
          EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, value & 0xFF}}));
          ++whole;
        }
        strobes.clear();
        both.in.isa_iow_n = false;  // nothing else has moved
        ticks(63);
        both.in.isa_iow_n = true;
        ticks(20);
        EXPECT_EQ(strobes, (std::vector<Strobe>{{"hp_wr", 7, value & 0xFF}}));
      }
  EXPECT_GE(whole, 3u * 5) << "all that two edges of clk_pwm and one of clk_ref see";
}

// host-bus:3.9/6 of an 8259: a read acknowledges if, and only if, it has shown data for a tick, however short it was.
TEST_F(IsaSlaveTest, ReadAcknowledgesIfAndOnlyIfItHasShownData) {
  unsigned shown = 0, not_shown = 0;
  for (int phase = 0; phase < 3; ++phase) {
    for (int width = 1; width <= 24; ++width) {
      SCOPED_TRACE(::testing::Message() << "phase " << phase << ", low for " << width);
      strobes.clear();
      set_address(0x21A);
      at_phase(phase);
      both.in.isa_ior_n = false;
      bool data = false;
      for (int n = 0; n < width; ++n) {
        data = data || both.get("isa_sd_oe") != 0;
        tick();
      }
      both.in.isa_ior_n = true;
      ticks(20);
      EXPECT_EQ(strobes, data ? (std::vector<Strobe>{{"pic_rd", 2, 0}}) : std::vector<Strobe>{});
      ++(data ? shown : not_shown);
    }
  }
  EXPECT_GE(shown, 3u * 16) << "data are there after eight ticks, 68 ns";
  EXPECT_GE(not_shown, 3u * 4) << "not within 34 ns";
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
  set_address(0xD0010);
  both.in.isa_sbhe_n = false;
  both.in.mem_rdata = 0x1234;
  ticks(11);
  both.in.isa_memr_n = false;
  ticks(12);
  set_address(0x21B);
  both.in.isa_sbhe_n = true;
  for (int n = 0; n < 16; ++n) {
    EXPECT_EQ(both.get("isa_sd_oe"), 3u) << "both lanes, as at its start";
    EXPECT_EQ(both.get("isa_sd"), 0x1234u);
    tick();
  }
  both.in.isa_memr_n = true;
  ticks(12);
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
          EXPECT_EQ(both.get("isa_iochrdy"), 1u);
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

// docs/isa_slave.md: in a reset all ports are at rest, though no clock comes, and behind it they show what comes of the
// pins since then, whatever was before: here a command that was low, LA that stood, and page 0.
TEST_F(IsaSlaveTest, AResetLeavesNothingOfBefore) {
  const std::map<std::string_view, unsigned> let_go{{"isa_sd", 0xFFFF}, {"isa_iochrdy", 1}, {"isa_memcs16_n", 1}};
  const struct {
    bool Inputs::*command;
    unsigned address, window;
    bool slot8;
  } cycles[] = {{&Inputs::isa_ior_n, 0x217, 0xD4000, false},
                {&Inputs::isa_iow_n, 0x21A, 0xD4000, true},
                {&Inputs::isa_memr_n, 0xD5556, 0xD4000, true},
                {&Inputs::isa_memw_n, 0xD5555, 0xD4000, false},
                {&Inputs::isa_memr_n, 0x01555, 0x00000, false}};
  const auto look = [&] {
    Outputs shown = show(model);
    for (auto& [name, value] : shown) value = both.get(name);
    return shown;
  };
  std::vector<Outputs> first;
  for (const auto& cycle : cycles) {
    SCOPED_TRACE(cycle.address);
    both.in = Inputs();
    both.in.window_flat = false;
    both.in.window = static_cast<std::uint16_t>(cycle.window >> 14);
    both.in.slot8 = cycle.slot8;
    ticks(12);
    io_write(0x21C, 3);
    set_address(cycle.address);
    both.in.isa_sd = both.in.mem_rdata = 0xABCD;
    ticks(11);
    both.in.*cycle.command = false;
    at_phase(0);
    both.reset();
    both.in = Inputs();
    both.in.window_flat = false;
    both.in.window = 0xD4000 >> 14;
    both.in.isa_la = 0xD4000 >> 17;
    both.in.isa_memw_n = false;
    both.in.isa_sd = 0x1234;
    for (const auto& [name, value] : look()) EXPECT_EQ(value, let_go.count(name) != 0 ? let_go.at(name) : 0u) << name;
    for (std::size_t n = 0; n < 20; ++n) {
      if (n == 8) both.in.isa_memw_n = true;
      tick();
      if (first.size() == n) first.push_back(look());
      EXPECT_EQ(look(), first[n]) << "tick " << n;
      EXPECT_EQ(both.get("isa_memcs16_n"), n < 2 ? 1u : 0u) << "LA passes three flip-flops, tick " << n;
    }
    EXPECT_EQ(both.get("mem_wdata"), 0x1234u);
    strobes.clear();
    mem_write(0xD4010, 0x11);
    EXPECT_EQ(strobes, (std::vector<Strobe>{{"mem_wr", 0x10 / 2, 1u << 16 | 0x11}}));
  }
}

// RESETDRV that begins before a command ends makes its write void; one that begins 17 ns after it, or later, does not.
TEST_F(IsaSlaveTest, ResetdrvBeforeTheEndOfAWriteLeavesItUnmade) {
  for (const bool memory : {false, true}) {
    const auto command = memory ? &Inputs::isa_memw_n : &Inputs::isa_iow_n;
    for (int phase = 0; phase < 3; ++phase) {
      for (int after = -12; after <= 12; ++after) {  // ticks from the command's end to RESETDRV
        if (after == 0 || after == 1) continue;      // within the aperture of the two synchronisers
        SCOPED_TRACE(::testing::Message() << memory << " phase " << phase << ", RESETDRV after " << after);
        strobes.clear();
        set_address(memory ? 0xD0000 : 0x21A);
        both.in.isa_sd = 0x1234;
        both.in.isa_sbhe_n = false;
        ticks(11);
        both.in.*command = false;
        ticks(30);
        at_phase(phase);
        if (after < 0) {
          both.in.isa_resetdrv = true;
          ticks(-after);
          both.in.*command = true;
        } else {
          both.in.*command = true;
          ticks(after);
          both.in.isa_resetdrv = true;
        }
        ticks(12);
        both.in.isa_resetdrv = false;
        ticks(20);
        const auto written = memory ? Strobe{"mem_wr", 0, 0x31234} : Strobe{"pic_wr", 2, 0x34};
        EXPECT_EQ(strobes, after < 0 ? std::vector<Strobe>{} : std::vector<Strobe>{written});
      }
    }
  }
}

// A read acknowledges nothing from the moment on at which RESETDRV is seen, nor if that came before its data.
TEST_F(IsaSlaveTest, ResetdrvBeforeTheDataOfAReadLeavesItUnacknowledged) {
  std::size_t void_reads = 0;
  for (int phase = 0; phase < 3; ++phase) {
    for (int moment = -3; moment <= 12; ++moment) {  // ticks from the fall of IOR# to RESETDRV
      SCOPED_TRACE(::testing::Message() << "phase " << phase << ", RESETDRV at " << moment);
      strobes.clear();
      set_address(0x21A);
      at_phase(phase);
      bool data = false, seen = false;
      std::size_t before = 0;  // acknowledges before RESETDRV was seen
      for (int tick = -3; tick < 40; ++tick) {
        if (tick == 0) both.in.isa_ior_n = false;
        if (tick == moment) both.in.isa_resetdrv = true;
        if (tick == moment + 12) both.in.isa_resetdrv = false;
        ticks(1);
        data = data || both.get("isa_sd_oe") != 0;
        if (!seen) before = strobes.size();
        seen = seen || both.get("host_reset") != 0;
      }
      both.in.isa_ior_n = true;
      ticks(15);
      EXPECT_EQ(strobes.size(), before);
      if (!data) { EXPECT_TRUE(strobes.empty()); }
      void_reads += data ? 0 : 1;
    }
  }
  EXPECT_GE(void_reads, 3u * 4) << "from RESETDRV as early as IOR# on";
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

}  // namespace
}  // namespace brick
