#include <brick/host_port.h>

#include "systemc/component/chip.h"
#include "systemc/component/host_port/host_port_cycle.h"

namespace brick::component {
namespace {
using namespace host_port_words;
}

HostPort::HostPort(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{1, kHostBytes}, {4, kCpuBytes}}),
      HostPortPins(*this, ""),
      host("host"),
      cpu("cpu") {
  host.register_b_transport(this, &HostPort::transport_at<kHost>);
  host.register_transport_dbg(this, &HostPort::debug_at<kHost>);
  cpu.register_b_transport(this, &HostPort::transport_at<kCpu>);
  cpu.register_transport_dbg(this, &HostPort::debug_at<kCpu>);
  set_chip(engine.factory().host_port());
}

}  // namespace brick::component
