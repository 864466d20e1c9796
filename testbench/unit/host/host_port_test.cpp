// Registers, flags, interrupts and commands of the host port. The data paths are in host_port_data_test.cpp.
#include "testbench/unit/host/host_port_bench.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

TEST_F(HostPortTest, ResetValuesAreThoseOfTheDataSheet) {
  const unsigned host[] = {0x00, 0x32, 0x06, 0x0F, 0x00, 0x00, 0x00, 0x00};
  for (std::uint8_t addr = 0; addr < 8; ++addr) EXPECT_EQ(host_peek(addr), host[addr]) << "+" << int{addr};
  EXPECT_EQ(cpu_peek(kHcr), 0u);
  EXPECT_EQ(cpu_peek(kHsr), 0x3202u) << "HTDE, and the command number 0x32 in bits 14..8";
  EXPECT_EQ(cpu_peek(kHpcr), 0u);
  EXPECT_EQ(cpu_peek(kHbar), 0x80u);
  EXPECT_EQ(cpu_peek(kHorx), 0u);
  EXPECT_EQ(cpu_peek(kHotx), 0u);
  EXPECT_EQ(both_.get("hreq"), 0u);
  EXPECT_EQ(both_.get("irq"), 0u);
}

TEST_F(HostPortTest, HostRegistersHoldTheirBits) {
  for (unsigned bit = 0; bit < 8; ++bit) {
    host_write(kIcr, 1u << bit);
    EXPECT_EQ(host_peek(kIcr), (1u << bit) & 0x3F) << "bit 6 is 0, INIT falls by itself";
    host_write(kIcr, 0);
    host_write(kCvr, 1u << bit);
    EXPECT_EQ(host_peek(kCvr), 1u << bit);
    host_write(kIvr, 1u << bit);
    EXPECT_EQ(host_peek(kIvr), 1u << bit);
    host_write(kIsr, 1u << bit);
    EXPECT_EQ(isr(), 0x06u) << "read only";
    host_write(kUnused, 1u << bit);
    EXPECT_EQ(host_peek(kUnused), 0u);
  }
}

TEST_F(HostPortTest, CpuRegistersHoldTheirBits) {
  for (unsigned bit = 0; bit < 24; ++bit) {
    const std::uint32_t one = 1u << bit;
    cpu_write(kHcr, one);
    EXPECT_EQ(cpu_peek(kHcr), one & 0x1F);
    cpu_write(kHcr, 0);
    cpu_write(kHpcr, one);
    EXPECT_EQ(cpu_peek(kHpcr), one & 0xFF7F);
    cpu_write(kHbar, one);
    EXPECT_EQ(cpu_peek(kHbar), one & 0xFF);
    cpu_write(kHorx, one);
    EXPECT_EQ(cpu_peek(kHorx), 0u) << "read only";
    cpu_write(kHsr, one & ~4u);
    EXPECT_EQ(cpu_peek(kHsr), 0x3202u) << "read only but for bit 2";
  }
  for (std::uint8_t addr = 0; addr < 64; ++addr)
    if (addr < kHcr || addr > kHotx) { EXPECT_EQ(cpu_peek(addr), 0u) << "nothing at X:$FFFFC0 + " << int{addr}; }
}

// Each register is written while all others hold values of their own, and what cannot be written too.
TEST_F(HostPortTest, AWriteTouchesNoOtherRegister) {
  cpu_write(kHotx, 0xABCDEF);
  host_send(0x123456);
  both_.ref(2);
  struct Word {
    bool host;
    unsigned addr, value, other;  // 0, 0: not written
  };
  std::vector<Word> words = {{true, kIcr, 0x18, 0x0C},  {true, kCvr, 0xA5, 0xCA},       {true, kIvr, 0x77, 0x81},
                             {false, kHcr, 0x18, 0x0E}, {false, kHpcr, 0x5A2C, 0xA513}, {false, kHbar, 0x45, 0x9B},
                             {true, kUnused, 0, 0},     {false, kHorx, 0x123456, 0},    {true, kData5, 0xAB, 0xAB},
                             {true, kData6, 0xCD, 0xCD}};
  const auto write = [&](const Word& word, unsigned value) {
    const auto addr = static_cast<std::uint8_t>(word.addr);
    word.host ? host_write(addr, value) : cpu_write(addr, value);
  };
  const auto all_hold = [&](const Word& written) {
    for (const Word& word : words) {
      const auto addr = static_cast<std::uint8_t>(word.addr);
      EXPECT_EQ(word.host ? host_peek(addr) : cpu_peek(addr), word.value)
          << (word.host ? "+" : "X:$FFFFC0 + ") << word.addr << " after a write of "
          << (written.host ? "+" : "X:$FFFFC0 + ") << written.addr;
    }
  };
  for (std::size_t n = 0; n < 6; ++n) write(words[n], words[n].value);
  for (int round = 0; round < 2; ++round)
    for (std::size_t n = 0; n < words.size(); ++n) {
      Word& word = words[n];
      if (n < 6) std::swap(word.value, word.other);
      write(word, n < 6 ? word.value : 0xFF);
      all_hold(word);
    }
  write({true, kIsr, 0, 0}, 0xFF);
  all_hold({true, kIsr, 0, 0});
  write({false, kHsr, 0, 0}, 0xFFFFFB);
  all_hold({false, kHsr, 0, 0});

  host_write(kData5, 0x65);  // the upper bytes of the next word
  host_write(kData6, 0x43);
  for (std::size_t n = 0; n < 8; ++n) write(words[n], words[n].value);
  write({true, kIsr, 0, 0}, 0xFF);
  write({false, kHsr, 0, 0}, 0xFFFFFB);
  host_write(kData7, 0x21);
  EXPECT_EQ(cpu_read(kHorx), 0x123456u);
  both_.ref();
  EXPECT_EQ(cpu_read(kHorx), 0x654321u);
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(HostPortTest, SleepsWhileNothingMoves) {
  EXPECT_TRUE(both_.asleep());
  for (unsigned word = 1; word <= 2; ++word) {
    host_send(word);
    cpu_write(kHotx, word);
    both_.ref(2);
    EXPECT_TRUE(both_.asleep()) << word;
  }
  both_.in.hp_sel = both_.in.hp_rd = true;
  both_.ref(2);
  EXPECT_TRUE(both_.asleep()) << "a read of the host";
  both_.in.hp_sel = both_.in.hp_rd = false;
  both_.in.hp_reset = true;
  both_.ref(2);
  EXPECT_TRUE(both_.asleep()) << "RESETDRV";
}

TEST_F(HostPortTest, WithoutSelectNothingHappens) {
  both_.in.hp_wr = both_.in.dsp_we = true;
  both_.in.hp_wdata = 0xFF;
  both_.in.dsp_wdata = 0x1F;
  for (const std::uint8_t addr : {kHcr, kHpcr, kHbar}) {
    const std::uint32_t before = cpu_peek(addr);
    both_.ref(2);
    EXPECT_EQ(host_peek(kIcr), 0u);
    EXPECT_EQ(cpu_peek(addr), before) << int{addr};
  }
}

TEST_F(HostPortTest, FlagsCrossInBothDirections) {
  for (unsigned flags = 0; flags < 4; ++flags) {
    host_write(kIcr, flags << 3);
    EXPECT_EQ(hsr() & (kHf0 | kHf1), flags << 3) << "HF1, HF0";
    cpu_write(kHcr, flags << 3);
    EXPECT_EQ(isr() & (kHf2 | kHf3), flags << 3) << "HF3, HF2";
  }
}

// Of every filling of the two ways: with a word in HORX alone TX is free, so TXDE calls the host although TRDY does
// not.
TEST_F(HostPortTest, HreqIsRxdfOrTxdeAsEnabled) {
  for (unsigned enable = 0; enable < 4; ++enable) {
    for (const bool rxdf : {false, true}) {
      for (const unsigned under_way : {0u, 1u, 2u}) {  // words to the CPU: none, in HORX, in HORX and TX
        both_.reset();
        host_write(kIcr, enable);
        if (rxdf) {
          cpu_write(kHotx, 1);
          both_.ref();
        }
        for (unsigned word = 1; word <= under_way; ++word) {
          host_send(word);
          both_.ref();
        }
        const bool txde = under_way < 2, trdy = under_way == 0;
        ASSERT_EQ(isr() & (kTxde | kTrdy), (txde ? kTxde : 0u) | (trdy ? kTrdy : 0u));
        const bool expected = ((enable & kRreq) && rxdf) || ((enable & kTreq) && txde);
        EXPECT_EQ(both_.get("hreq"), expected ? 1u : 0u) << enable << rxdf << under_way;
        EXPECT_EQ(isr() & kHreq, expected ? kHreq : 0u);
      }
    }
  }
}

TEST_F(HostPortTest, CpuInterruptFollowsItsThreeSources) {
  cpu_write(kHcr, 2);
  EXPECT_EQ(both_.get("irq"), 1u) << "HTIE and HTDE";
  cpu_write(kHcr, 1);
  EXPECT_EQ(both_.get("irq"), 0u);
  host_send('A');
  both_.ref();
  EXPECT_EQ(both_.get("irq"), 1u) << "HRIE and HRDF";
  cpu_read(kHorx);
  EXPECT_EQ(both_.get("irq"), 0u);
  cpu_write(kHcr, 4);
  EXPECT_EQ(both_.get("irq"), 0u);
  host_write(kCvr, 0x80 | 0x25);
  EXPECT_EQ(both_.get("irq"), 1u) << "HCIE and HCP";
  cpu_write(kHcr, 2);
  cpu_write(kHotx, 1);
  both_.ref();
  cpu_write(kHotx, 2);
  EXPECT_EQ(both_.get("irq"), 0u) << "HOTX is full";
}

TEST_F(HostPortTest, HostCommandPendsUntilTheCpuTakesIt) {
  host_write(kCvr, 0x80 | 0x25);
  EXPECT_EQ(cpu_peek(kHsr), 0x2506u) << "HV = 0x25, HCP, HTDE";
  cpu_write(kHsr, 0xFFFFFB);
  EXPECT_EQ(host_peek(kCvr), 0xA5u) << "only bit 2 takes it";
  cpu_write(kHsr, 4);
  EXPECT_EQ(host_peek(kCvr), 0x25u);
  EXPECT_EQ(hsr() & kHcp, 0u);
}

TEST_F(HostPortTest, CommandWrittenAtTheMomentOfTakingIsNotLost) {
  host_write(kCvr, 0x80 | 0x25);
  both_.in.dsp_sel = both_.in.dsp_we = true;
  both_.in.dsp_addr = kHsr;
  both_.in.dsp_wdata = 4;
  host_write(kCvr, 0x80 | 0x26);
  both_.in.dsp_sel = both_.in.dsp_we = false;
  EXPECT_EQ(host_peek(kCvr), 0xA6u);
}

// host-bus:3.8: the host's side as after the board's reset, both ways empty; what the CPU has set up stays.
TEST_F(HostPortTest, ResetdrvEmptiesBothWays) {
  cpu_write(kHcr, 0x1F);
  host_write(kIcr, kRreq | kHlend);
  host_write(kCvr, 0x91);
  host_write(kIvr, 0x33);
  cpu_write(kHotx, 0x123456);
  both_.ref(2);
  cpu_write(kHotx, 0x654321);
  host_write(kData7, 1);
  both_.ref(2);
  host_write(kData7, 2);
  both_.ref(2);
  ASSERT_EQ(isr() & (kRxdf | kTxde), unsigned{kRxdf});
  both_.in.hp_reset = true;
  both_.ref();
  both_.in.hp_reset = false;
  EXPECT_EQ(isr() & 0x87u, unsigned{kTxde | kTrdy});
  EXPECT_EQ(hsr() & (kHrdf | kHtde | kHcp), unsigned{kHtde});
  EXPECT_EQ(host_peek(kIcr), 0u);
  EXPECT_EQ(host_peek(kCvr), 0x32u);
  EXPECT_EQ(host_peek(kIvr), 0x0Fu);
  EXPECT_EQ(cpu_peek(kHcr), 0x1Fu);
  EXPECT_EQ(both_.get("txde"), 1u);
  EXPECT_EQ(both_.get("rxdf"), 0u);
}

TEST_F(HostPortTest, ResetdrvResetsOneRegisterAlone) {
  const struct { unsigned addr, written, reset; } rows[] = {{kIcr, kRreq, 0}, {kCvr, 0x11, 0x32}, {kIvr, 0x33, 0x0F}};
  for (const auto& row : rows) {
    host_write(row.addr, row.written);
    both_.ref(4);
    ASSERT_EQ(host_peek(row.addr), row.written);
    both_.in.hp_reset = true;
    both_.ref();
    both_.in.hp_reset = false;
    EXPECT_EQ(host_peek(row.addr), row.reset);
  }
}

TEST_F(HostPortTest, RandomAccessesOfBothSidesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    random_run(random_seed(seed), 6000);
    ASSERT_EQ(both_.difference(), "") << "seed " << seed;
  }
}

TEST_F(HostPortTest, ComparisonSeesAnIgnoredInit) {
  both_.mutate = [](HostPort::Inputs& in) {
    if (in.hp_addr == kIcr) in.hp_wdata &= 0x7F;
  };
  random_run(2, 6000);
  EXPECT_NE(both_.difference(), "");
}

TEST_F(HostPortTest, ComparisonSeesRxFreedByTheWrongByte) {
  both_.mutate = [](HostPort::Inputs& in) { in.hp_rd_done = in.hp_rd_done && in.hp_addr != kData7; };
  random_run(2, 6000);
  EXPECT_NE(both_.difference(), "");
}

}  // namespace
}  // namespace brick
