// A component between signals and an initiator, driven by a list of traffic; records what its ports and its socket do.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sysc/kernel/sc_dynamic_processes.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <brick/component.h>

#include "testbench/unit/component/traffic.h"

namespace brick::component {

using Binds = std::function<bool(const std::string&)>;
inline bool all(const std::string&) { return true; }

class Rig : public sc_core::sc_module {
 public:
  // `binds`: the pins that get a signal; `quantum`: how far the initiator's own time runs ahead of the kernel's.
  Rig(const sc_core::sc_module_name& name, Component& component, const Traffic& traffic, unsigned width,
      const sc_core::sc_time& quantum, const Binds& binds)
      : sc_module(name), traffic_(traffic), width_(width), quantum_(quantum) {
    for (Pin* pin : component.pins()) {
      const PinInfo& info = pin->info();
      if (!binds(info.name)) continue;
      connect(*pin, std::make_integer_sequence<unsigned, 32>());
    }
    SC_HAS_PROCESS(Rig);
    SC_THREAD(drive);
    SC_THREAD(initiate);
  }

  tlm_utils::simple_initiator_socket_optional<Rig> socket{"socket"};
  Seen seen;
  sc_core::sc_signal<bool>& signal(const std::string& pin) { return *bits_.at(pin); }

 private:
  // A signal of the pin's type, whatever its width.
  template <unsigned... kWidth>
  void connect(Pin& pin, std::integer_sequence<unsigned, kWidth...>) {
    (connect_width<kWidth + 1>(pin), ...);
  }
  template <unsigned kWidth>
  void connect_width(Pin& pin) {
    const PinInfo& info = pin.info();
    if (info.width != kWidth) return;
    using Value = PinValue<kWidth>;
    auto signal =
        std::make_shared<sc_core::sc_signal<Value>>(("s_" + info.name).c_str(), static_cast<Value>(info.idle));
    if (info.direction == PinDirection::kIn) {
      dynamic_cast<In<kWidth>&>(pin).bind(*signal);
      writes_[info.name] = [s = signal.get()](std::uint32_t value) { s->write(static_cast<Value>(value)); };
    } else {
      dynamic_cast<Out<kWidth>&>(pin).bind(*signal);
      sc_core::sc_spawn_options process;
      process.spawn_method();
      process.dont_initialize();
      process.set_sensitivity(&signal->value_changed_event());
      sc_core::sc_spawn(
          [this, name = info.name, s = signal.get()] { changed(name, static_cast<std::uint32_t>(s->read())); },
          ("see_" + info.name).c_str(), &process);
    }
    if constexpr (kWidth == 1) bits_[info.name] = signal.get();
    signals_.push_back(std::move(signal));
  }

  static sc_core::sc_time time(Picoseconds ps) { return sc_core::sc_time::from_value(ps); }
  void changed(const std::string& name, std::uint32_t level) {
    if (sc_core::sc_time_stamp() != sc_core::SC_ZERO_TIME)  // outputs come to their first level
      seen.changes.emplace_back(sc_core::sc_time_stamp().value(), name, level);
  }

  void drive() {
    for (const PinChange& change : traffic_.pins) {
      if (const auto wait_for = time(change.time) - sc_core::sc_time_stamp(); wait_for != sc_core::SC_ZERO_TIME)
        wait(wait_for);
      writes_.at(change.pin)(change.value);
    }
  }

  void initiate() {
    sc_core::sc_time local;
    for (const Access& access : traffic_.accesses) {
      local += time(access.idle);
      if (local > quantum_) {
        wait(local);
        local = sc_core::SC_ZERO_TIME;
      }
      unsigned char data[4];
      for (unsigned i = 0; i < width_; ++i) data[i] = static_cast<unsigned char>(access.value >> 8 * i);
      tlm::tlm_generic_payload payload;
      payload.set_command(access.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
      payload.set_address(access.address);
      payload.set_data_ptr(data);
      payload.set_data_length(width_);
      payload.set_streaming_width(width_);
      socket->b_transport(payload, local);
      const sc_core::sc_time end = sc_core::sc_time_stamp() + local;
      if (!payload.is_response_ok()) SC_REPORT_ERROR("/test/response", payload.get_response_string().c_str());
      std::uint32_t value = 0;
      for (unsigned i = 0; i < width_; ++i) value |= static_cast<std::uint32_t>(data[i]) << 8 * i;
      seen.answers.emplace_back(end.value(), value);
    }
  }

  const Traffic& traffic_;
  unsigned width_;
  sc_core::sc_time quantum_;
  std::vector<std::shared_ptr<void>> signals_;  // of all widths
  std::map<std::string, sc_core::sc_signal<bool>*> bits_;
  std::map<std::string, std::function<void(std::uint32_t)>> writes_;
};

// The first change of a bound pin, or the first access, that is not the same at the same time; the last instant of the
// traffic left out. "" when there is none.
std::string difference(Seen component, Seen block, Picoseconds end, const Binds& binds);

// The component on this engine agrees with the block inside; at least so much happened.
template <class C>
void agrees(Block& block, Traffic traffic, const Engine& engine, const sc_core::sc_time& quantum, unsigned width,
            const Binds& binds, std::size_t least_accesses, std::size_t least_changes) {
  traffic.pins.erase(
      std::remove_if(traffic.pins.begin(), traffic.pins.end(), [&binds](const PinChange& c) { return !binds(c.pin); }),
      traffic.pins.end());
  const Seen expected = run(block, traffic);
  EXPECT_GE(expected.answers.size(), least_accesses);
  EXPECT_GE(expected.changes.size(), least_changes);
  TimeBase time("time");
  C component("component", time, engine);
  Rig rig("rig", component, traffic, width, quantum, binds);
  rig.socket.bind(component.registers);
  sc_core::sc_start(sc_core::sc_time::from_value(traffic.end - 1));
  EXPECT_EQ(difference(rig.seen, expected, traffic.end, binds), "");
}

}  // namespace brick::component
