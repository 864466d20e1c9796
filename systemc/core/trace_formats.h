// The two waveform formats behind TraceWriter::open.
#pragma once

#include <memory>
#include <string>

#include "systemc/core/trace.h"

namespace brick {

std::unique_ptr<TraceWriter> open_vcd(const std::string& file, TimeFs from, TimeFs to);
std::unique_ptr<TraceWriter> open_fst(const std::string& file, TimeFs from, TimeFs to);

}  // namespace brick
