// The Verilated modules of rtl/host: inputs as the models have them, outputs by name.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "systemc/host/inputs.h"
#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

using Outputs = std::vector<std::pair<std::string_view, std::uint32_t>>;

// Of an ISA slave whose RAM is played by the test: `mem_busy`, the model's, is what `mem_busy_d` was at the last edge
// of clk_ref (answered_isa_slave.h).
struct AnsweredInputs : IsaSlaveInputs {
  bool mem_busy_d = false;
};

RtlBlock<InterruptControllerInputs, Outputs> make_rtl_interrupt_controller(int seed = shell_seed());
RtlBlock<Pic8259Inputs, Outputs> make_rtl_pic_8259(int seed = shell_seed());
RtlBlock<HostInterruptInputs, Outputs> make_rtl_host_interrupt(int seed = shell_seed());
RtlBlock<HostSignalsInputs, Outputs> make_rtl_host_signals();
RtlBlock<HostPortInputs, Outputs> make_rtl_host_port();
RtlBlock<DpramInputs, Outputs> make_rtl_dpram(int seed = 0);  // memory has no reset: as the model, it starts as zero
RtlBlock<AnsweredInputs, Outputs> make_rtl_isa_slave(bool on_a_board = false);

// Of an ISA slave as a board sees it: the end of a read does something behind it at +7 alone, and nobody looks at data
// without their strobe.
Outputs seen_by_a_board(Outputs outputs);

}  // namespace brick
