// The Verilated modules of rtl/host behind one small interface: inputs as the models have them, outputs by name.
// Verilated headers stay in rtl_blocks.cpp, because they and SystemC cannot be included in one file.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "systemc/host/inputs.h"

namespace brick {

using Outputs = std::vector<std::pair<std::string_view, std::uint32_t>>;

template <class Inputs>
class RtlBlock {
 public:
  virtual ~RtlBlock() = default;
  virtual void drive(const Inputs& in) = 0;  // combinational outputs follow at once
  virtual void clock(bool ref) = 0;          // one edge of clk_pwm, and of clk_ref with it
  virtual void reset() = 0;                  // a pulse of rst_n
  virtual Outputs outputs() = 0;
};

std::unique_ptr<RtlBlock<InterruptControllerInputs>> make_rtl_interrupt_controller();
std::unique_ptr<RtlBlock<HostSignalsInputs>> make_rtl_host_signals();
std::unique_ptr<RtlBlock<HostPortInputs>> make_rtl_host_port();
std::unique_ptr<RtlBlock<DpramInputs>> make_rtl_dpram();
std::unique_ptr<RtlBlock<IsaSlaveInputs>> make_rtl_isa_slave();
std::unique_ptr<RtlBlock<IsaSlaveInputs>> make_rtl_isa_slave_variant();  // IoBase 0x310, window 0xE0000, ten-bit decode

}  // namespace brick
