// The Verilated servo IC in a plain loop: the yardstick of its component's chip. Pins are not looked at.
#pragma once

#include <cstdint>
#include <memory>

#include "systemc/core/ticks.h"

namespace brick {

class BareServoIc {
 public:
  // `twice`: the clocks fall in an evaluation of their own, as in every example of Verilator; else as the chip has it.
  explicit BareServoIc(bool twice);
  ~BareServoIc();
  void write(unsigned address, std::uint32_t value);  // bytes as at the component's socket
  void turn();                                        // line A of the first encoder
  void run_until(Tick end);

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace brick
