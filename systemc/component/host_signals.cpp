#include <brick/host_signals.h>

#include "systemc/component/chip.h"
#include "systemc/component/host_signals_words.h"

namespace brick::component {

const std::vector<PinInfo>& HostSignals::pin_table() {
  using namespace host_signals_words;
  constexpr PinDirection kOut = PinDirection::kOut;
  static const std::vector<PinInfo> table{
      {"rst_n", PinDirection::kIn, 0, kRstN, 1, 1, "host-bus:4.3", "reset, asynchronous, active low"},
      {"ipos", kOut, 0, kSignals, 1, 0, "host-bus:4.3", "in position"},
      {"breq", kOut, 0, kSignals + 1, 1, 0, "host-bus:5.7", "buffer request"},
      {"eror", kOut, 0, kSignals + 2, 1, 0, "host-bus:4.3", "fatal following error"},
      {"f1er", kOut, 0, kSignals + 3, 1, 0, "host-bus:4.3", "warning following error"},
      {"ctrl0", kOut, 0, kControl, 1, 0, "host-bus:4.2", "control output 0"},
      {"ctrl1", kOut, 0, kControl + 1, 1, 0, "host-bus:4.2", "control output 1"}};
  return table;
}

HostSignals::HostSignals(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, 8}}),
      registers("registers"),
      rst_n(*this, "rst_n"),
      ipos(*this, "ipos"),
      breq(*this, "breq"),
      eror(*this, "eror"),
      f1er(*this, "f1er"),
      ctrl0(*this, "ctrl0"),
      ctrl1(*this, "ctrl1") {
  registers.register_b_transport(this, &HostSignals::transport);
  registers.register_transport_dbg(this, &HostSignals::debug);
  set_chip(engine.factory().host_signals());
}

}  // namespace brick::component
