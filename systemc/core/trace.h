// Waveform files, VCD and FST, from sources that run ahead of each other: records carry their own time, the writer
// holds them back until every source has passed that time (`flush_until`) and writes them in order.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "systemc/core/signals.h"

namespace brick {

class TraceWriter {
 public:
  virtual ~TraceWriter() = default;

  // All before the first record. `of` is what the records name: the signal itself, or of an alias its signal.
  virtual void declare(Signals::Id id, const Signals::Info& info, Signals::Id of) = 0;
  virtual void record(Signals::Id id, TimeFs time, std::uint64_t value) = 0;
  virtual void record_text(Signals::Id id, TimeFs time, const std::string& text) = 0;
  virtual void flush_until(TimeFs time) = 0;  // no record before `time` will come any more
  virtual void close() = 0;                   // writes what is left; throws what flush_until() has told

  // The file takes no more, said once from flush_until(), which drops what comes after. Without it that throws.
  std::function<void(const std::string&)> on_failure;

  // Opens FILE.vcd or FILE.fst for the window [from, to] (values at `from` are dumped first). Throws std::runtime_error
  // with one clear line when the ending is neither, or the file cannot be written.
  static std::unique_ptr<TraceWriter> open(const std::string& file, TimeFs from = 0, TimeFs to = kForever);
};

}  // namespace brick
