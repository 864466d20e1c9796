// Model of rtl/board/bus_read.sv: the sample that a read shows, and whether the pins are driven with it.
#pragma once

#include <cstdint>

namespace brick {

class BusRead {
 public:
  std::uint32_t data() const { return data_; }
  bool oe() const { return oe_ && falls_ == of_; }

  // /RD and the falls it has had, as they are.
  void set_rd(bool rd_n, std::uint8_t falls) {
    rd_n_ = rd_n;
    falls_ = falls;
    if (rd_n) oe_ = false;  // without a clock
  }
  // The sample of a read in a register region, with its count. Others find the pins off: /RD has been high.
  void take(std::uint32_t data, std::uint8_t of, bool on_chip) {
    data_ = data;
    of_ = of;
    oe_ = !rd_n_ && !on_chip;
  }
  void reset() {
    data_ = 0;
    oe_ = false;
  }

 private:
  std::uint32_t data_{};
  std::uint8_t of_{}, falls_{};
  bool rd_n_{}, oe_{};
};

}  // namespace brick
