// Model of rtl/board/bus_strobes.sv: the falls of /RD and of /WR, each counted in two bits of Gray code. It knows no
// clock: a fall acts at once, before the next edge of anything.
#pragma once

#include <cstdint>

#include "systemc/core/board_pins.h"

namespace brick {

// The count after one more fall: 0, 1, 3, 2.
constexpr std::uint8_t next_fall(std::uint8_t falls) {
  return static_cast<std::uint8_t>((falls << 1 & 2) | (~falls >> 1 & 1));
}

class BusStrobes {
 public:
  void set_pins(const PortAPins& pins, bool rst_n) {
    count(rd_falls_, rd_n_, pins.pa_rd_n, rst_n);
    count(wr_falls_, wr_n_, pins.pa_wr_n, rst_n);
  }
  bool moves(const PortAPins& pins) const { return pins.pa_rd_n != rd_n_ || pins.pa_wr_n != wr_n_; }
  std::uint8_t rd_falls() const { return rd_falls_; }
  std::uint8_t wr_falls() const { return wr_falls_; }

 private:
  static void count(std::uint8_t& falls, bool& was_n, bool now_n, bool rst_n) {
    if (!rst_n)
      falls = 0;
    else if (was_n && !now_n)
      falls = next_fall(falls);
    was_n = now_n;
  }

  bool rd_n_ = true, wr_n_ = true;
  std::uint8_t rd_falls_ = 0, wr_falls_ = 0;
};

}  // namespace brick
