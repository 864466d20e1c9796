#include <brick/dpram.h>

#include "systemc/component/chip.h"
#include "systemc/component/dpram_words.h"

namespace brick::component {
namespace {
using namespace dpram_words;
}

const std::vector<PinInfo>& Dpram::pin_table() {
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut, kInner = PinDirection::kInner;
  static const std::vector<PinInfo> table{
      {"rst_n", kIn, 0, kRstN, 1, 1, "host-bus:6.1", "reset, asynchronous, active low; the content is kept"},
      {"small", kIn, 0, kSmall, 1, 0, "host-bus:6.1", "only the first 8192 words are fitted"},
      {"busy_host", kOut, 0, kBusyHost, 1, 0, "host-bus:6.9", "the host waits for the CPU"},
      {"busy_cpu", kOut, 0, kBusyCpu, 1, 0, "host-bus:6.9", "the CPU waits for the host"},
      {"cpu_rdata", kInner, 1, 0, 16, 0, "host-bus:6.9", "word of the CPU's last read"},
      {"mem_rdata", kInner, 1, 16, 16, 0, "host-bus:6.9", "word of the host's last read"}};
  return table;
}

Dpram::Dpram(const sc_core::sc_module_name& name, TimeBase& time, const DpramOptions& options, const Engine& engine)
    : Component(name, time, pin_table(), {{2, kBytes, Access::kBytes}, {2, kBytes}}),
      host("host"),
      cpu("cpu"),
      rst_n(*this, "rst_n"),
      small(*this, "small"),
      busy_host(*this, "busy_host"),
      busy_cpu(*this, "busy_cpu") {
  host.register_b_transport(this, &Dpram::transport_at<kHost>);
  host.register_transport_dbg(this, &Dpram::debug_at<kHost>);
  cpu.register_b_transport(this, &Dpram::transport_at<kCpu>);
  cpu.register_transport_dbg(this, &Dpram::debug_at<kCpu>);
  set_chip(engine.factory().dpram(options.seed));
}

}  // namespace brick::component
