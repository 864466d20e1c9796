// Model of rtl/board/bus_sync.sv: strobes, address and data of Port A through flip-flops on clk_pwm; an access is taken
// at the edge of clk_ref that finds a new strobe low, and made at the next one if the strobe was still low then. Edges
// that nobody can see are executed when the next one matters.
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
    std::uint32_t addr;
    std::uint8_t aa;
    bool x;
    bool internal;  // on-chip peripheral page

    bool own() const { return internal || (aa & 2) != 0 || aa == 0; }  // a register region
  };

  void set_pins(const PortAPins& pins, const BusStrobes& strobes) {
    pins0_ = {pins.pa_addr & 0x7FFFF, static_cast<std::uint8_t>(pins.pa_aa & 0xF), pins.pa_x, pins.pa_int};
    wdata0_ = pins.pa_wdata & 0xFFFFFF;
    rd_.set(strobes.rd_falls(), !pins.pa_rd_n);
    wr_.set(strobes.wr_falls(), !pins.pa_wr_n);
  }

  // Of the access whose strobe is next, right when rd() or we() is.
  const Where& where() const { return where_; }
  std::uint32_t wdata() const { return wdata_; }
  bool we() const { return wr_.shown; }
  bool rd() const { return rd_.shown; }
  std::uint8_t rd_falls() const { return rd_.seen; }
  bool under_way() const { return rd_.under_way() || wr_.under_way(); }
  // A write is under way; an access that the on-chip page may see is.
  bool write_pending() const { return wr_.under_way(); }
  bool internal_pending() const { return pins0_.internal || under_way(); }
  // The pins may have gone on to the next access by now.
  bool may_be_internal() const { return pins0_.internal || pins_.internal || where_.internal; }

  // The edge with which a strobe begins or ends, at the earliest. One of a read acts at its end only, when the sample
  // is taken: where nobody else wants to know of it (the on-chip page does) it has no beginning.
  Tick next_event() const override {
    const bool write = wr_.under_way();
    if (!write && !rd_.under_way()) return kNever;
    if (rd() || we()) return now_ + 1;
    const Tick made = std::min(rd_.made(now_), wr_.made(now_));
    return write || may_be_internal() ? std::max(made - 1, now_ + 1) : made;
  }

  void advance(Tick t) override {
    while (now_ < t && under_way()) {
      ++now_;
      const bool last = now_ % kTicksPerRef == kTicksPerRef - 1;
      const bool ref = is_ref_edge(now_), own = pins_.own();
      rd_.edge(last, ref, own);
      wr_.edge(last, ref, own);
      if (ref) {
        where_ = pins_;
        wdata_ = wdata0_;
      }
      pins_ = pins0_;
    }
    now_ = t;
  }

  void reset(Tick t) override {
    pins_ = where_ = Where{};
    wdata_ = 0;
    rd_.reset();
    wr_.reset();
    now_ = t;
  }

 private:
  // A strobe's pins, what the stages of clk_pwm show, and the access.
  struct Strobe {
    std::uint8_t falls0, falls1, falls2, falls3, seen;
    bool low0, low1, low2;
    bool taken, shown;

    void set(std::uint8_t falls, bool low) {
      falls0 = falls;
      low0 = low;
    }
    void edge(bool last, bool ref, bool own) {
      shown = last && taken && low2 && falls2 == seen;
      if (ref) {
        taken = own && falls3 != seen && falls2 == falls3 && low2;
        seen = falls3;
      }
      falls3 = falls2;
      falls2 = falls1;
      falls1 = falls0;
      low2 = low1;
      low1 = low0;
    }
    void reset() {
      falls1 = falls2 = falls3 = seen = 0;
      low1 = low2 = taken = shown = false;
    }
    // Another edge changes something that may come to show: a count that all have followed does not, whatever the
    // level.
    bool under_way() const {
      return falls0 != falls1 || falls1 != falls2 || falls2 != falls3 || falls3 != seen || taken || shown;
    }
    // The edge at which the access is made, at the earliest; never, or later, where nothing is under way.
    Tick made(Tick now) const {
      if (taken || shown) return next_ref_edge(now);
      const Tick arrives = falls3 != seen     ? 1
                           : falls2 != falls3 ? 2
                           : falls1 != falls2 ? 3
                           : falls0 != falls1 ? 4
                                              : kNever;
      return next_ref_edge(now + arrives - 1) + kTicksPerRef;
    }
  };

  Where pins0_{}, pins_{}, where_{};
  std::uint32_t wdata0_{}, wdata_{};
  Strobe rd_{}, wr_{};
  Tick now_{};
};

}  // namespace brick
