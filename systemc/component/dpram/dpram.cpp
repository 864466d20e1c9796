#include <brick/dpram.h>

#include "systemc/component/chip.h"
#include "systemc/component/dpram/dpram_cycle.h"

namespace brick::component {
namespace {
using namespace dpram_words;
}

Dpram::Dpram(const sc_core::sc_module_name& name, TimeBase& time, const DpramOptions& options, const Engine& engine)
    : Component(name, time, pin_table(), {{2, kBytes, Access::kBytes}, {2, kBytes}}),
      DpramPins(*this, ""),
      host("host"),
      cpu("cpu") {
  host.register_b_transport(this, &Dpram::transport_at<kHost>);
  host.register_transport_dbg(this, &Dpram::debug_at<kHost>);
  cpu.register_b_transport(this, &Dpram::transport_at<kCpu>);
  cpu.register_transport_dbg(this, &Dpram::debug_at<kCpu>);
  set_chip(engine.factory().dpram(options.seed));
}

}  // namespace brick::component
