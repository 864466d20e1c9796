#include <brick/host_port.h>

#include "systemc/component/chip.h"
#include "systemc/component/host_port_words.h"

namespace brick::component {
namespace {
using namespace host_port_words;
}

const std::vector<PinInfo>& HostPort::pin_table() {
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut;
  static const std::vector<PinInfo> table{
      {"rst_n", kIn, 0, kRstN, 1, 1, "host-bus:3.2", "reset, asynchronous, active low"},
      {"resetdrv", kIn, 0, kResetDrv, 1, 0, "host-bus:3.8", "RESETDRV of the host bus"},
      {"hreq", kOut, 0, kHreq, 1, 0, "host-bus:3.2", "host port request"},
      {"irq", kOut, 0, kIrq, 1, 0, "host-bus:3.2", "interrupt of the CPU"},
      {"txde", kOut, 0, kTxde, 1, 0, "host-bus:3.2", "TX is empty"},
      {"rxdf", kOut, 0, kRxdf, 1, 0, "host-bus:3.2", "RX holds a word"}};
  return table;
}

HostPort::HostPort(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{1, kHostBytes}, {4, kCpuBytes}}),
      host("host"),
      cpu("cpu"),
      rst_n(*this, "rst_n"),
      resetdrv(*this, "resetdrv"),
      hreq(*this, "hreq"),
      irq(*this, "irq"),
      txde(*this, "txde"),
      rxdf(*this, "rxdf") {
  host.register_b_transport(this, &HostPort::transport_at<kHost>);
  host.register_transport_dbg(this, &HostPort::debug_at<kHost>);
  cpu.register_b_transport(this, &HostPort::transport_at<kCpu>);
  cpu.register_transport_dbg(this, &HostPort::debug_at<kCpu>);
  set_chip(engine.factory().host_port());
}

}  // namespace brick::component
