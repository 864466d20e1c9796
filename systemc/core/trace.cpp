// Chooses the waveform format by the ending of the file name.
#include "systemc/core/trace.h"

#include <stdexcept>

#include "systemc/core/trace_formats.h"

namespace brick {

std::unique_ptr<TraceWriter> TraceWriter::open(const std::string& file, TimeFs from, TimeFs to) {
  if (to < from) throw std::runtime_error(file + ": the waveform window ends before it begins");
  const std::string ending = file.size() > 4 ? file.substr(file.size() - 4) : "";
  if (ending == ".vcd") return open_vcd(file, from, to);
  if (ending == ".fst") return open_fst(file, from, to);
  throw std::runtime_error(file + ": waveform files end in .vcd or .fst");
}

}  // namespace brick
