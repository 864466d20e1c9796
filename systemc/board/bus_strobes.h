// Model of rtl/board/bus_strobes.sv: the falls of /RD and /WR in cycles that are selected, each as a level that turns
// over. It knows no clock: a fall acts at once, before the next edge of anything.
#pragma once

#include "systemc/core/board_pins.h"

namespace brick {

class BusStrobes {
 public:
  void set_pins(const PortAPins& pins, bool sel, bool rst_n) {
    rd_toggle_ = rst_n && rd_toggle_ != (sel && rd_n_ && !pins.pa_rd_n);
    wr_toggle_ = rst_n && wr_toggle_ != (sel && wr_n_ && !pins.pa_wr_n);
    rd_n_ = pins.pa_rd_n;
    wr_n_ = pins.pa_wr_n;
  }
  bool moves(const PortAPins& pins) const { return pins.pa_rd_n != rd_n_ || pins.pa_wr_n != wr_n_; }
  bool rd_toggle() const { return rd_toggle_; }
  bool wr_toggle() const { return wr_toggle_; }

 private:
  bool rd_n_ = true, wr_n_ = true;
  bool rd_toggle_ = false, wr_toggle_ = false;
};

}  // namespace brick
