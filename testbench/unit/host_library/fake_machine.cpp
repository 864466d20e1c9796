#include "testbench/unit/host_library/fake_machine.h"

#include <algorithm>
#include <utility>

namespace brick {

struct Machine::Impl {
  FakeMachine fake;
  Tick now = 0, next_text = 0;
  BoardInputs pins, applied;
  BoardOutputs outputs;
  Signals signals;
  std::vector<BusCycle> cycles;
  Aperture aperture;  // none
  unsigned icr = 0;

  // HREQ as ICR asks for it; answers are there when they have been thought of.
  void look_at_port() {
    for (; !fake.later.empty() && fake.later.front().first <= now; fake.later.pop_front())
      fake.to_host.insert(fake.to_host.end(), fake.later.front().second.begin(), fake.later.front().second.end());
    if (icr != 0)
      outputs.set(pin::kHreq, (icr & 1u) != 0 && !fake.to_host.empty() ? 1u : fake.takes ? icr >> 1 & 1u : 0u);
  }
};

namespace {
FakeMachine* newest = nullptr;
}

FakeMachine& FakeMachine::last() { return *newest; }

Machine::Machine(sc_core::sc_module_name name, const MachineConfig&)
    : sc_module(name), impl_(std::make_unique<Impl>()) {
  newest = &impl_->fake;
  impl_->outputs.set(pin::kIsaIochrdy, 1);
}
Machine::~Machine() = default;

Tick Machine::now() const { return impl_->now; }
HostInputs& Machine::inputs() { return impl_->pins; }
const BoardOutputs& Machine::outputs() const { return impl_->outputs; }
PciBridge* Machine::pci() { return impl_->fake.bridge; }
const PinSkew& Machine::skew() const {
  static const PinSkew kNone;
  return kNone;
}
Aperture& Machine::aperture() { return impl_->aperture; }
void Machine::apply_partly() {}
Signals& Machine::signals() { return impl_->signals; }
const std::vector<Machine::BusCycle>& Machine::last_bus_cycles() const { return impl_->cycles; }

Tick Machine::run_until(Tick limit, const BoardOutputs& stop_on) {
  Impl& m = *impl_;
  while (m.now < limit) {
    const BoardOutputs before = m.outputs;
    ++m.now;
    if (!m.fake.planned.empty() && m.fake.planned.front().first <= m.now) {
      m.outputs = m.fake.planned.front().second;
      m.fake.planned.erase(m.fake.planned.begin());
    }
    m.outputs.set(pin::kIsaSdOe, !m.applied.isa_memr_n ? 3 : !m.applied.isa_ior_n ? 1 : 0);
    m.outputs.set(pin::kIsaIochrdy, m.now < m.fake.ready_low_from || m.now >= m.fake.ready_low_to);
    m.look_at_port();
    if (before.differs(m.outputs, stop_on)) break;
    if (!m.fake.planned.empty() || m.fake.ready_low_from != kNever) continue;
    m.now = m.fake.later.empty() ? limit : std::clamp(m.fake.later.front().first - 1, m.now, limit);  // else all stands
  }
  return m.now;
}

void Machine::apply(TimeFs) {
  Impl& m = *impl_;
  FakeMachine& f = m.fake;
  if (f.records) f.changes.push_back({m.now + 1, m.applied, m.pins});
  m.look_at_port();
  if (f.sends && f.to_host.empty() && m.now >= m.next_text) {
    const std::string text = f.sends();
    f.to_host.insert(f.to_host.end(), text.begin(), text.end());
    m.next_text = m.now + f.sends_every;
  }
  const std::uint32_t offset = m.pins.isa_sa - 0x210, word = (m.pins.isa_sa - 0xD0000) & ~1u;
  if (m.applied.isa_ior_n && !m.pins.isa_ior_n) {
    std::uint8_t value = f.io[offset];
    if (offset == 2) value = f.port_status.value_or((f.takes ? 2 : 0) | (f.to_host.empty() ? 0 : 1));
    if (offset == 7) value = f.to_host.empty() ? 0 : f.to_host.front();
    m.outputs.set(pin::kIsaSd, 0xFF00u | value);
  }
  if (!m.applied.isa_ior_n && m.pins.isa_ior_n && offset == 7 && !f.to_host.empty()) f.to_host.pop_front();
  if (!m.applied.isa_memr_n && m.pins.isa_memr_n) m.outputs.set(pin::kIsaSd, 0xFFFF);
  if (m.applied.isa_memr_n && !m.pins.isa_memr_n) m.outputs.set(pin::kIsaSd, f.memory[word]);
  if (!m.applied.isa_memw_n && m.pins.isa_memw_n) {
    const unsigned lanes = (m.pins.isa_sa % 2 == 0 ? 0x00FFu : 0u) | (m.pins.isa_sbhe_n ? 0u : 0xFF00u);
    f.memory[word] = static_cast<std::uint16_t>((f.memory[word] & ~lanes) | (m.pins.isa_sd & lanes));
  }
  if (!m.applied.isa_iow_n && m.pins.isa_iow_n) {
    const auto byte = static_cast<std::uint8_t>(m.pins.isa_sd);
    f.io[offset] = byte;
    if (offset == 0) m.icr = byte;
    if (offset == 0 && byte == 0) m.outputs.set(pin::kHreq, 0);
    const auto say = [&](std::string answer, Tick after = 0) {
      if (f.sends) answer += f.sends();
      if (after == 0 && f.later.empty())
        f.to_host.insert(f.to_host.end(), answer.begin(), answer.end());
      else
        f.later.emplace_back((f.later.empty() ? m.now : f.later.back().first) + after, answer);
    };
    if (offset == 7 && byte == '\r') {
      const std::string line = std::exchange(f.line, "");
      if (f.controller) say(f.controller(line), f.thinking);
    } else if (offset == 7 && byte < ' ') {
      if (f.control) say(f.control(static_cast<char>(byte)));
    } else if (offset == 7) {
      f.line.push_back(static_cast<char>(byte));
    }
  }
  m.applied = m.pins;
  m.look_at_port();
}

}  // namespace brick

int sc_main(int, char**) { return 0; }  // libsystemc asks for it
