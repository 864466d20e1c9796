// Model of rtl/board/bus_sync.sv: the falls of /RD and /WR through three stages on clk_ref, one strobe an access.
// Address and data are executed only where a strobe uses them.
#pragma once

#include <algorithm>
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
    rd_.set(strobes.rd_toggle());
    wr_.set(strobes.wr_toggle());
  }

  // Of the access whose strobe is next, right when rd() or we() is.
  const Where& where() const { return where_; }
  std::uint32_t wdata() const { return wdata_; }
  bool we() const { return wr_.strobe(); }
  bool rd() const { return rd_.strobe(); }
  bool under_way() const { return rd_.under_way() || wr_.under_way(); }
  // A write is under way; an access that the on-chip page may see is.
  bool write_pending() const { return wr_.under_way(); }
  bool internal_pending() const { return where0_.internal || under_way(); }

  // The edge with which a strobe begins or ends. One of a read acts at its end only, when the sample is taken: where
  // nobody else wants to know of it (the on-chip page does) it has no beginning.
  Tick next_event() const override {
    const bool write = wr_.under_way();
    if (!write && !rd_.under_way()) return kNever;
    const Tick edge = next_ref_edge(now_);
    if (rd() || we()) return edge;
    const Tick begin =
        std::min(edge + kTicksPerRef * rd_.edges_to_strobe(), edge + kTicksPerRef * wr_.edges_to_strobe());
    return write || where0_.internal ? begin : begin + kTicksPerRef;
  }

  void advance(Tick t) override {
    for (Tick edge = next_ref_edge(now_); under_way() && edge <= t; edge += kTicksPerRef) {
      where_ = where0_;
      wdata_ = wdata0_;
      rd_.shift();
      wr_.shift();
    }
    now_ = t;
  }

  void reset(Tick t) override {
    where_ = Where{};
    wdata_ = 0;
    rd_.reset();
    wr_.reset();
    now_ = t;
  }

 private:
  // A level and three stages behind it, the level in bit 0.
  class Stages {
   public:
    void set(bool level) { bits_ = (bits_ & 14u) | (level ? 1u : 0u); }
    void shift() { bits_ = (bits_ << 1 | (bits_ & 1)) & 15; }
    void reset() { bits_ = bits_ & 1; }
    bool under_way() const { return bits_ != 0 && bits_ != 15; }
    bool strobe() const { return ((bits_ >> 2 ^ bits_ >> 3) & 1) != 0; }
    // Edges before the one with which a strobe begins; many when none does.
    Tick edges_to_strobe() const {
      const unsigned moves = bits_ ^ bits_ >> 1;
      return (moves & 2) != 0 ? 0 : (moves & 1) != 0 ? 1 : kMany;
    }

   private:
    static constexpr Tick kMany = 1 << 20;
    unsigned bits_ = 0;
  };

  Where where0_, where_;
  std::uint32_t wdata0_ = 0, wdata_ = 0;
  Stages rd_, wr_;
  Tick now_ = 0;
};

}  // namespace brick
