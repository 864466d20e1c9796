// The cycles at the two faces of the dual-ported RAM, beat by beat, the same in all engines.
//   host, on clk_ref, as isa_slave makes them: an edge that sees the command and makes no request yet; the request, for
//     as long as BUSY; of a write an edge more, which makes it. A read has its word with the edge that grants it.
//   CPU, on clk_pwm: the strobe is low until /TA is, then high for two edges, 17 ns (host-bus:2.2, rows 113 and 114).
//     A write is made by the second of them.
// So a cycle begins with the lines of the one before at rest; after one that was broken off Faces sees to it.
#pragma once

#include "systemc/component/dpram/dpram_words.h"
#include "systemc/component/faces.h"
#include "systemc/host/inputs.h"

namespace brick::component::dpram_words {

constexpr unsigned kHost = 0, kCpu = 1;  // faces
constexpr unsigned kBytes = 0x10000, kSmallBytes = 0x4000;

}  // namespace brick::component::dpram_words

namespace brick::component::dpram_cycle {
using namespace dpram_words;

enum HostBeat : unsigned { kCommand, kRequest, kEnd };
enum CpuBeat : unsigned { kStrobe, kHigh, kLast };

constexpr unsigned word_of(unsigned address) { return address / 2; }

// The address stands to the edge that sees the end.
inline void set_host_lines(DpramInputs& in, bool on, const Face& face) {
  const Cycle& c = face.cycle;
  in.mem_sel = on && face.beat == kRequest;
  in.mem_wr = on && face.beat == kEnd;
  if (!on) return;
  in.mem_rd = !c.write;
  in.mem_addr = static_cast<std::uint16_t>(word_of(c.address));
  in.mem_be = static_cast<std::uint8_t>(c.lanes & 3);
  in.mem_wdata = static_cast<std::uint16_t>(c.value);
}

inline PortAPins cpu_pins(bool on, const Face& face) {
  const Cycle& c = face.cycle;
  const bool low = on && face.beat == kStrobe;
  PortAPins pins;
  pins.pa_aa = on ? 4 : 0;
  pins.pa_addr = word_of(c.address) >> 1;  // the Y word is the even one
  pins.pa_x = (word_of(c.address) & 1) != 0;
  pins.pa_rd_n = !low || c.write;
  pins.pa_wr_n = !low || !c.write;
  pins.pa_wdata = c.value & 0xFFFF;
  return pins;
}

// With the edge of a beat: the cycle has ended. `busy`, `wait`, `data`: what the block shows then.
inline bool host_after(Face& face, bool busy, std::uint16_t data) {
  if (face.beat == kRequest && busy) return false;
  if (face.beat == kRequest) face.value = data;
  return face.beat++ == (face.cycle.write ? kEnd : kRequest);
}
inline bool cpu_after(Face& face, bool wait, std::uint16_t data) {
  if (face.beat == kStrobe && wait) return false;
  if (face.beat == kStrobe) face.value = data;
  return face.beat++ == kLast;
}

}  // namespace brick::component::dpram_cycle
