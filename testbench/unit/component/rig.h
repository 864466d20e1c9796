// A component between signals and initiators, driven by a list of traffic; records what its ports and its sockets do.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <brick/component.h>
#include <brick/rtl.h>

#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/player.h"
#include "testbench/unit/component/traffic.h"
#include "testbench/unit/random_seed.h"

namespace brick::component {

constexpr Tick kTicks = 1'000'000;  // of most simulations

using Binds = std::function<bool(const std::string&)>;
inline bool all(const std::string&) { return true; }

class Rig : public sc_core::sc_module {
 public:
  // `binds`: the pins that get a signal; `quantum`: how far an initiator's own time runs ahead of the kernel's; `width`
  // of the registers, at the second socket `other_width`.
  Rig(const sc_core::sc_module_name& name, Component& component, const Traffic& traffic, unsigned width,
      const sc_core::sc_time& quantum, const Binds& binds, unsigned other_width = 4)
      : sc_module(name),
        traffic_(traffic),
        first_("first", traffic.accesses, width, quantum, seen.answers, seen.annotated),
        second_("second", traffic.others, other_width, quantum, seen.others, seen.annotated) {
    for (Pin* pin : component.pins())
      if (binds(pin->info().name)) connect(*pin);
    SC_HAS_PROCESS(Rig);
    SC_THREAD(drive);
  }

  Seen seen;
  Player::Socket& socket() { return first_.socket; }
  Player::Socket& other_socket() { return second_.socket; }
  sc_core::sc_signal<bool>& signal(const std::string& pin) { return *bits_.at(pin); }

 private:
  void connect(Pin& pin);  // to a signal of its type, whatever its width
  template <unsigned... kWidth>
  void connect(Pin& pin, std::integer_sequence<unsigned, kWidth...>);
  template <unsigned kWidth>
  void connect_width(Pin& pin);

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

  const Traffic& traffic_;
  Player first_, second_;
  std::vector<std::shared_ptr<void>> signals_;  // of all widths
  std::map<std::string, sc_core::sc_signal<bool>*> bits_;
  std::map<std::string, std::function<void(std::uint32_t)>> writes_;
};

// The first change of a bound pin, or the first access, that is not the same at the same time; the last instant of the
// traffic left out. "" when there is none.
std::string difference(Seen component, Seen block, Picoseconds end, const Binds& binds);

// At least so many changes of each of these pins.
void counts(const Seen& seen, const std::vector<std::string>& pins, std::size_t least);

// The component does what is expected of it; `connect(rig, component)` binds its sockets. With a quantum, one access in
// eight at least makes use of it.
template <class C, class Connect>
void does(const Seen& expected, const Traffic& traffic, C& component, const sc_core::sc_time& quantum, unsigned width,
          unsigned other_width, const Binds& binds, const Connect& connect) {
  Rig rig("rig", component, traffic, width, quantum, binds, other_width);
  connect(rig, component);
  sc_core::sc_start(sc_core::sc_time::from_value(traffic.end - 1));
  EXPECT_EQ(difference(rig.seen, expected, traffic.end, binds), "");
  if (quantum != sc_core::SC_ZERO_TIME) {
    EXPECT_GE(rig.seen.annotated, (expected.answers.size() + expected.others.size()) / 8);
  }
}

// It agrees with the block inside; at least so much happened.
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
  does(expected, traffic, component, quantum, width, 4, binds, [](Rig& rig, C& c) { rig.socket().bind(c.registers); });
}

// Each engine with each quantum and a seed of its own, for the traffic and for the RTL's flip-flops, in a process of
// its own.
template <class Simulation>
void on_each_engine(const Simulation& simulation) {
  std::uint32_t number = 0;
  for (const double quantum_us : {0.0, 3.0, 10.0})
    for (const auto& engine : {+[](std::uint64_t) { return model_engine(); }, &rtl_engine, &lockstep_engine}) {
      const std::uint32_t seed = random_seed(++number);
      SCOPED_TRACE(::testing::Message() << "engine " << (number - 1) % 3 << " (model, rtl, lockstep), quantum "
                                        << quantum_us << " us");
      in_own_process([&] { simulation(engine(seed), sc_core::sc_time(quantum_us, sc_core::SC_US), seed); });
    }
}

}  // namespace brick::component
