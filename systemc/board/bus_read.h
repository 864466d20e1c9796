// Model of rtl/board/bus_read.sv: the sample that a read shows, and whether the pins are driven with it.
#pragma once

#include <cstdint>

namespace brick {

class BusRead {
 public:
  std::uint32_t data() const { return data_; }
  bool oe() const { return oe_; }

  void set_rd_n(bool rd_n) {
    rd_n_ = rd_n;
    if (rd_n) oe_ = false;  // without a clock
  }
  // The sample of a read in a register region, of one elsewhere.
  void take(std::uint32_t data, bool on_chip) {
    data_ = data;
    oe_ = !rd_n_ && !on_chip;
  }
  void take_nothing() { oe_ = false; }
  void reset() {
    data_ = 0;
    oe_ = false;
  }

 private:
  std::uint32_t data_ = 0;
  bool rd_n_ = true, oe_ = false;
};

}  // namespace brick
