// Model of rtl/board/address_decode.sv: which register block a synchronised Port A address selects.
#pragma once

#include <cstdint>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/board/bus_sync.h"

namespace brick {

struct AddressSelect {
  bool any = false;       // a register region: its read data goes to the bus
  bool internal = false;  // the on-chip page
  bool port = false;      // its half with the words of the host port
  bool signals = false;   // X:$070010 host signals
  bool strobe = false;    // X:$070011 watchdog strobe
  bool ctrl = false;      // X:$070012 control outputs
  bool panel = false;     // Y:$078800 control panel port
  bool ssi = false;       // serial encoder inputs
  int ic = -1;            // servo or MACRO IC, index as in BoardInputs::fitted
};

class AddressDecode : public sc_core::sc_module {
 public:
  explicit AddressDecode(const sc_core::sc_module_name& name) : sc_module(name) {}

  static AddressSelect decode(const BusSync::Where& w, std::uint32_t fitted, bool jpan, unsigned ssi) {
    AddressSelect s;
    if (w.internal) {
      s.any = s.internal = true;
      s.port = ((w.addr ^ regs::hi08::kHcr.address) & 0x40) == 0;
      return s;
    }
    const std::uint32_t a = w.addr;
    if (w.aa == 0 && a - regs::kLatchesBase < regs::kLatchesSize) {
      s.any = true;
      s.signals = w.x && a == regs::board_latches::kHostSignals.address;
      s.strobe = w.x && a == regs::board_latches::kWatchdogStrobe.address;
      s.ctrl = w.x && a == regs::board_latches::kControlOutputs.address;
    } else if ((w.aa & 2) != 0 && a - regs::kGateIcsBase < regs::kGateIcsSize) {
      s.any = true;
      s.ssi = ssi == kSsiBrick && a >> 5 == regs::ssi_brick::kBase >> 5;
      s.panel = jpan && !w.x && a == regs::jpan::kInputs.address;
      const int ic = gate_ic(a - regs::kGateIcsBase);
      if (ic >= 0 && (fitted >> ic & 1) != 0) s.ic = ic;
    } else if ((w.aa & 2) != 0 && (ssi & kSsiGeo) != 0 && a - regs::kSsiPageBase < regs::kSsiPageSize) {
      s.any = true;
      s.ssi = ssi == kSsiGeo && a >> 6 == regs::ssi_geo::kBase >> 6;
    }
    return s;
  }

  static constexpr unsigned kSsiGeo = 1, kSsiBrick = 2;  // Straps::ssi_kind; both: a Geo PMAC without them

 private:
  // Servo IC 0 and 1 at $0000 and $0100; 2..9 at $200 and $300 of the pages $0000..$3000; IC m* is $20 above IC m.
  // MACRO ICs at $400 of the pages, 64 words each.
  static int gate_ic(std::uint32_t offset) {
    const std::uint32_t block = offset & 0xFC0, page = offset >> 12, odd = offset >> 8 & 1;
    const bool star = (offset & 0x20) != 0;
    if (block == 0x200 || block == 0x300) return static_cast<int>(2 + 2 * page + odd + (star ? 8 : 0));
    if (block == 0x400) return static_cast<int>(18 + page);
    if (page == 0 && !star && (block == 0x000 || block == 0x100)) return static_cast<int>(odd);
    return -1;
  }
};

}  // namespace brick
