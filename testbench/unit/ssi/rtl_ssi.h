// The Verilated serial encoder inputs.
#pragma once

#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

struct SsiInputs {
  bool rst_n = true, geo = false;
  bool sel = false, x = false, we = false, rd = false;
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  bool phase = true, servo = true;
  unsigned data = 0xFF;
};

struct SsiOutputs {
  unsigned clk;
  std::uint32_t rdata;
};

struct RtlSsi : RtlBlock<SsiInputs, SsiOutputs> {
  RtlSsi();
};

}  // namespace brick
