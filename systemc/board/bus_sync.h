// Model of rtl/board/bus_sync.sv: Port A pins through two stages on clk_ref, one strobe a write and one a finished
// read.
#pragma once

#include <cstdint>

#include <systemc>

#include "systemc/core/board_pins.h"
#include "systemc/core/model_block.h"

namespace brick {

class BusSync final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit BusSync(const sc_core::sc_module_name& name) : sc_module(name) {}

  struct Where {
    std::uint32_t addr = 0;
    std::uint8_t aa = 0;
    bool x = false;
    bool internal = false;  // on-chip peripheral page
    bool operator==(const Where& o) const { return addr == o.addr && aa == o.aa && x == o.x && internal == o.internal; }
  };

  void set_pins(const PortAPins& pins) {
    where0_ = {pins.pa_addr & 0x7FFFF, static_cast<std::uint8_t>(pins.pa_aa & 0xF), pins.pa_x, pins.pa_int};
    wdata0_ = pins.pa_wdata & 0xFFFFFF;
    rd0_n_ = pins.pa_rd_n;
    wr0_n_ = pins.pa_wr_n;
  }

  const Where& where() const { return where1_; }     // for reads and for the write strobe
  const Where& rd_where() const { return where2_; }  // for rd_done
  std::uint32_t wdata() const { return wdata1_; }
  bool we() const { return !wr1_n_ && wr2_n_; }
  bool rd_done() const { return rd1_n_ && !rd2_n_; }
  // A write that the pins or stage 1 show has not been executed yet; an access to the on-chip page is in the pipe.
  bool write_pending() const { return we() || (!wr0_n_ && wr1_n_); }
  bool internal_pending() const { return where0_.internal || where1_.internal || where2_.internal; }

  Tick next_event() const override {
    const bool still = where0_ == where1_ && where1_ == where2_ && wdata0_ == wdata1_ && rd0_n_ == rd1_n_ &&
                       rd1_n_ == rd2_n_ && wr0_n_ == wr1_n_ && wr1_n_ == wr2_n_;
    return still ? kNever : next_ref_edge(now_);
  }

  void advance(Tick t) override {
    if (next_ref_edge(now_) <= t) {  // more than one such edge only when the pipe stands still
      where2_ = where1_;
      where1_ = where0_;
      wdata1_ = wdata0_;
      rd2_n_ = rd1_n_;
      rd1_n_ = rd0_n_;
      wr2_n_ = wr1_n_;
      wr1_n_ = wr0_n_;
    }
    now_ = t;
  }

  void reset(Tick t) override {
    where1_ = where2_ = Where{};
    wdata1_ = 0;
    rd1_n_ = rd2_n_ = wr1_n_ = wr2_n_ = true;
    now_ = t;
  }

 private:
  Where where0_, where1_, where2_;
  std::uint32_t wdata0_ = 0, wdata1_ = 0;
  bool rd0_n_ = true, rd1_n_ = true, rd2_n_ = true;
  bool wr0_n_ = true, wr1_n_ = true, wr2_n_ = true;
  Tick now_ = 0;
};

}  // namespace brick
