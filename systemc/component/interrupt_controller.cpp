#include <brick/interrupt_controller.h>

#include "systemc/component/chip.h"
#include "systemc/component/interrupt_controller_words.h"

namespace brick::component {

const std::vector<PinInfo>& InterruptController::pin_table() {
  using namespace interrupt_controller_words;
  static const std::vector<PinInfo> table = [] {
    std::vector<PinInfo> rows{
        {"rst_n", PinDirection::kIn, 0, kRstN, 1, 1, "host-bus:4.1", "reset, asynchronous, active low"},
        {"resetdrv", PinDirection::kIn, 0, kResetDrv, 1, 0, "host-bus:3.8", "RESETDRV of the host bus"}};
    for (unsigned line = 0; line < 8; ++line)
      rows.push_back({"ir" + std::to_string(line), PinDirection::kIn, 0, kLine + line, 1, 0, "host-bus:4.2",
                      "line IR" + std::to_string(line)});
    rows.push_back({"irq", PinDirection::kOut, 1, kIrq, 1, 0, "host-bus:4.1", "interrupt of the host"});
    constexpr const char* kRegisters[] = {"ist", "sig", "msk", "elr"};
    for (unsigned i = 0; i < 4; ++i)
      rows.push_back({kRegisters[i], PinDirection::kInner, 0, 8 * i, 8, 0, "host-bus:4.1", "register"});
    return rows;
  }();
  return table;
}

InterruptController::InterruptController(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{1, 4}}),
      registers("registers"),
      rst_n(*this, "rst_n"),
      resetdrv(*this, "resetdrv"),
      ir(pin_array<In<>, 8>(*this, "ir")),
      irq(*this, "irq") {
  registers.register_b_transport(this, &InterruptController::transport);
  registers.register_transport_dbg(this, &InterruptController::debug);
  set_chip(engine.factory().interrupt_controller());
}

}  // namespace brick::component
