// Host port under test: both twins, and the accesses of the two sides as the bus synchronisers make them.
#pragma once

#include <random>

#include "systemc/host/host_port.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {

class HostPortTest : public ::testing::Test {
 protected:
  enum Host : std::uint8_t { kIcr, kCvr, kIsr, kIvr, kUnused, kData5, kData6, kData7 };
  enum Cpu : std::uint8_t { kHcr = 2, kHsr, kHpcr, kHbar, kHorx, kHotx };
  enum IsrBit : unsigned { kRxdf = 0x01, kTxde = 0x02, kTrdy = 0x04, kHf2 = 0x08, kHf3 = 0x10, kHreq = 0x80 };
  enum HsrBit : unsigned { kHrdf = 1, kHtde = 2, kHcp = 4, kHf0 = 8, kHf1 = 16 };
  enum IcrBit : std::uint8_t { kRreq = 1, kTreq = 2, kHlend = 0x20, kInit = 0x80 };

  HostPort model_{"host_port"};
  Lockstep<HostPort> both_{make_rtl_host_port(), model_, [](const HostPort& m) {
                             return Outputs{{"hp_rdata", m.hp_rdata()}, {"dsp_rdata", m.dsp_rdata()},
                                            {"hreq", m.hreq()},         {"irq", m.irq()},
                                            {"txde", m.txde()},         {"rxdf", m.rxdf()}};
                           }};

  void TearDown() override {
    if (!both_.mutate) { EXPECT_LOCKSTEP(both_); }
  }

  // One access each: one clk_ref, a read of the host two, its byte and its end.
  void host_write(std::uint8_t addr, unsigned value) {
    both_.in.hp_sel = both_.in.hp_wr = true;
    both_.in.hp_addr = addr;
    both_.in.hp_wdata = static_cast<std::uint8_t>(value);
    both_.ref();
    both_.in.hp_sel = both_.in.hp_wr = false;
  }
  unsigned host_peek(std::uint8_t addr) {  // no side effect
    both_.in.hp_addr = addr;
    return both_.get("hp_rdata");
  }
  unsigned host_read(std::uint8_t addr) {
    const unsigned value = host_peek(addr);
    both_.in.hp_sel = both_.in.hp_rd = true;
    both_.ref();
    both_.in.hp_rd = false;
    both_.in.hp_rd_done = true;
    both_.ref();
    both_.in.hp_sel = both_.in.hp_rd_done = false;
    return value;
  }
  void cpu_write(std::uint8_t addr, std::uint32_t value) {
    both_.in.dsp_sel = both_.in.dsp_we = true;
    both_.in.dsp_addr = addr;
    both_.in.dsp_wdata = value;
    both_.ref();
    both_.in.dsp_sel = both_.in.dsp_we = false;
  }
  std::uint32_t cpu_peek(std::uint8_t addr) {
    both_.in.dsp_addr = addr;
    return both_.get("dsp_rdata");
  }
  std::uint32_t cpu_read(std::uint8_t addr) {
    const std::uint32_t value = cpu_peek(addr);
    both_.in.dsp_sel = both_.in.dsp_rd = true;
    both_.ref();
    both_.in.dsp_sel = both_.in.dsp_rd = false;
    return value;
  }
  void host_send(std::uint32_t word) {  // HLEND = 0
    host_write(kData5, word >> 16);
    host_write(kData6, word >> 8);
    host_write(kData7, word);
  }
  unsigned isr() { return host_peek(kIsr); }
  unsigned hsr() { return cpu_peek(kHsr) & 0x1F; }

  void random_run(unsigned seed, int ticks) {
    std::mt19937 random(random_seed(seed));
    both_.lazy = seed % 2;
    for (int i = 0; i < ticks && both_.difference().empty(); ++i) {
      if (both_.now() % kTicksPerRef == 0) {
        auto& in = both_.in;
        in.hp_addr = random() % 8;
        in.hp_wdata = static_cast<std::uint8_t>(random());
        if (in.hp_addr == kIcr && random() % 4) in.hp_wdata &= 0x7F;
        in.hp_wr = random() % 4 == 0;
        in.hp_rd = random() % 2;
        in.hp_rd_done = !in.hp_wr && random() % 3 == 0;
        in.hp_sel = random() % 8 != 0;
        in.dsp_addr = static_cast<std::uint8_t>(random() % 8 ? 2 + random() % 6 : random() % 64);
        in.dsp_wdata = random() & 0xFFFFFF;
        in.dsp_we = random() % 4 == 0;
        in.dsp_rd = !in.dsp_we && random() % 3 == 0;
        in.dsp_sel = random() % 8 != 0;
        in.hp_reset = random() % 60 == 0;
      }
      if (random() % 3000 == 0) both_.reset();
      both_.tick();
    }
  }
};

}  // namespace brick
