// The cycles at the two faces of the host port, beat by beat, the same in all engines. A read of the host takes its
// sample with one edge and acts, as isa_slave has it at the end of a command, with the next; all else is one edge.
#pragma once

#include "rtl/regs/brick_regs.hpp"
#include "systemc/component/faces.h"
#include "systemc/component/host_port/host_port_words.h"
#include "systemc/host/inputs.h"

namespace brick::component::host_port_words {

constexpr unsigned kHost = 0, kCpu = 1;                // faces
constexpr unsigned kHostBytes = 8, kCpuBytes = 6 * 4;  // addresses; X:$FFFFC2 + n is at 4 n

}  // namespace brick::component::host_port_words

namespace brick::component::host_port_cycle {
using namespace host_port_words;

constexpr unsigned cpu_register(unsigned address) { return (regs::hi08::kBase & 0x3F) + address / 4; }

// The lines of one face; those of the other stay.
inline void set_lines(HostPortInputs& in, unsigned number, bool on, const Face& face) {
  const Cycle& c = face.cycle;
  if (number == kHost) {
    in.hp_sel = on;
    in.hp_wr = on && c.write;
    in.hp_rd = on && !c.write && face.beat == 0;
    in.hp_rd_done = on && !c.write && face.beat == 1;
    in.hp_addr = static_cast<std::uint8_t>(c.address & 7);
    in.hp_wdata = static_cast<std::uint8_t>(c.value);
  } else {
    in.dsp_sel = on;
    in.dsp_we = on && c.write;
    in.dsp_rd = on && !c.write;
    in.dsp_addr = static_cast<std::uint8_t>(cpu_register(c.address));
    in.dsp_wdata = c.value & 0xFFFFFF;
  }
}

// With the edge of a beat: the cycle has ended.
inline bool after(unsigned number, Face& face) { return number == kCpu || face.cycle.write || face.beat++ == 1; }

}  // namespace brick::component::host_port_cycle
