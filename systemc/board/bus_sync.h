// Model of rtl/board/bus_sync.sv: the falls of /RD and /WR through three stages on clk_ref, one strobe an access.
// Address and data are executed only where a strobe uses them.
#pragma once

#include <cstdint>

#include <systemc>

#include "systemc/board/bus_strobes.h"
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
  };

  void set_pins(const PortAPins& pins, const BusStrobes& strobes) {
    where0_ = {pins.pa_addr & 0x7FFFF, static_cast<std::uint8_t>(pins.pa_aa & 0xF), pins.pa_x, pins.pa_int};
    wdata0_ = pins.pa_wdata & 0xFFFFFF;
    rd_[0] = strobes.rd_toggle();
    wr_[0] = strobes.wr_toggle();
  }

  // Of the access whose strobe is next, right when rd() or we() is.
  const Where& where() const { return where_; }
  std::uint32_t wdata() const { return wdata_; }
  bool we() const { return wr_[2] != wr_[3]; }
  bool rd() const { return rd_[2] != rd_[3]; }
  // A write is under way; an access that the on-chip page may see is.
  bool write_pending() const { return under_way(wr_); }
  bool internal_pending() const { return where0_.internal || under_way(rd_) || under_way(wr_); }

  Tick next_event() const override { return under_way(rd_) || under_way(wr_) ? next_ref_edge(now_) : kNever; }

  void advance(Tick t) override {
    if (next_ref_edge(now_) <= t && next_event() != kNever) {
      where_ = where0_;
      wdata_ = wdata0_;
      for (bool* stage : {rd_, wr_}) {
        stage[3] = stage[2];
        stage[2] = stage[1];
        stage[1] = stage[0];
      }
    }
    now_ = t;
  }

  void reset(Tick t) override {
    where_ = Where{};
    wdata_ = 0;
    for (unsigned stage = 1; stage < 4; ++stage) rd_[stage] = wr_[stage] = false;
    now_ = t;
  }

 private:
  static bool under_way(const bool (&stage)[4]) {
    return stage[0] != stage[1] || stage[1] != stage[2] || stage[2] != stage[3];
  }

  Where where0_, where_;
  std::uint32_t wdata0_ = 0, wdata_ = 0;
  bool rd_[4] = {}, wr_[4] = {};  // stage 0: as bus_strobes shows it
  Tick now_ = 0;
};

}  // namespace brick
