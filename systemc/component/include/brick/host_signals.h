// Host signals: the latches of IPOS, BREQ, EROR, F1ER and of the control outputs. docs/host_signals.md, host-bus:4.3.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/host_signals.h>

namespace brick::component {

class HostSignals final : public Component, public HostSignalsPins {
 public:
  HostSignals(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // Two words of 4 bytes: 0 host signals, bits 0 IPOS, 1 BREQ, 2 EROR, 3 F1ER (X:$070010); 4 control outputs, bits 0
  // CTRL0, 1 CTRL1 (X:$070012).
  tlm_utils::simple_target_socket_optional<HostSignals> registers;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
