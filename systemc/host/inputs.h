// Input pins of the host-side blocks, named as the RTL ports without _i. Free of SystemC, so that the model and whoever
// drives the Verilated module can share them.
#pragma once

#include <cstdint>

#include "systemc/core/board_pins.h"

namespace brick {

struct InterruptControllerInputs {
  bool reset = false;  // RESETDRV
  std::uint8_t line = 0;
  bool wr = false;
  std::uint8_t addr = 0;  // 0..3
  std::uint8_t wdata = 0;
};

struct Pic8259Inputs {
  std::uint8_t line = 0;
  bool rd = false, wr = false;
  std::uint8_t addr = 0;  // 0..3
  std::uint8_t wdata = 0;
};

struct HostInterruptInputs {
  bool request = false, served = false;
};

struct HostSignalsInputs {
  bool wr = false;
  bool ctrl_wr = false;
  std::uint8_t wdata = 0;  // 4 bits
  bool trip = false;       // of the watchdog
};

struct HostPortInputs {
  bool hp_sel = false, hp_rd = false, hp_rd_done = false, hp_wr = false;
  std::uint8_t hp_addr = 0;  // 0..7
  std::uint8_t hp_wdata = 0;
  bool hp_reset = false;  // RESETDRV
  bool dsp_sel = false, dsp_we = false, dsp_rd = false;
  std::uint8_t dsp_addr = 0;  // low six bits of X:$FFFFxx
  std::uint32_t dsp_wdata = 0;
};

struct DpramInputs {
  bool small = false;  // strap: only the first 8192 words are fitted
  // Port A pins and the falls of its strobes
  std::uint8_t rd_falls = 0, wr_falls = 0;  // two bits, Gray: bus_strobes
  bool cpu_sel = false, cpu_x = false;
  std::uint16_t cpu_addr = 0;  // 14 bits
  bool cpu_rd_n = true, cpu_wr_n = true;
  std::uint16_t cpu_wdata = 0;
  // from isa_slave
  bool mem_sel = false, mem_rd = false, mem_wr = false;
  std::uint16_t mem_addr = 0;  // 15 bits
  std::uint8_t mem_be = 0;
  std::uint16_t mem_wdata = 0;

  static bool selected(const PortAPins& pins) { return (pins.pa_aa & 4) != 0 && !pins.pa_int; }
  void set_cpu_pins(const PortAPins& pins, std::uint8_t falls_of_rd, std::uint8_t falls_of_wr) {
    rd_falls = falls_of_rd;
    wr_falls = falls_of_wr;
    cpu_sel = selected(pins);
    cpu_x = pins.pa_x;
    cpu_addr = static_cast<std::uint16_t>(pins.pa_addr & 0x3FFF);
    cpu_rd_n = pins.pa_rd_n;
    cpu_wr_n = pins.pa_wr_n;
    cpu_wdata = static_cast<std::uint16_t>(pins.pa_wdata);
  }
};

struct IsaSlaveInputs : IsaPins, IsaStraps {
  std::uint8_t hp_rdata = 0, pic_rdata = 0;
  std::uint16_t mem_rdata = 0;
  bool mem_busy = false;
};

}  // namespace brick
