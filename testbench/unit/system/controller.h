// Test fixture: a controller with the project's firmware, and a host that has logged on.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "testbench/host/host_link.h"
#include "testbench/unit/covers.h"

namespace brick {

inline Tick ms_to_ticks(std::int64_t ms) { return ns_to_ticks(ms * 1'000'000); }

// How GoogleTest names an engine in a test's parameter.
inline void PrintTo(Engine engine, std::ostream* out) {
  *out << (engine == Engine::kRtl ? "rtl" : engine == Engine::kSystemC ? "systemc" : "lockstep");
}

inline std::string engine_name(const ::testing::TestParamInfo<Engine>& info) {
  switch (info.param) {
    case Engine::kRtl:
      return "Rtl";
    case Engine::kSystemC:
      return "SystemC";
    default:
      return "Lockstep";
  }
}

class Controller : public ::testing::TestWithParam<Engine> {
 protected:
  void start(const MachineConfig& changes = {}) {
    finish();
    MachineConfig config = changes;
    config.engine = GetParam();
    config.firmware = BRICK_FIRMWARE;
    machine_ = std::make_unique<Machine>(sc_core::sc_gen_unique_name("machine"), config);
    bus_ = std::make_unique<HostBus>(*machine_);
    link_ = std::make_unique<HostLink>(*bus_);
    ASSERT_TRUE(link_->connect(ms_to_ticks(50))) << "no reply from the firmware";
  }

  // A test that provokes an error of the machine takes it (Machine::take_run_errors).
  void TearDown() override { finish(); }

  // Ends the run; the flash file is written.
  void finish() {
    if (machine_ != nullptr) { EXPECT_THAT(machine_->run_errors(), ::testing::IsEmpty()); }
    link_.reset();
    bus_.reset();
    machine_.reset();
  }

  Machine& machine() { return *machine_; }
  HostBus& bus() { return *bus_; }
  HostLink& link() { return *link_; }

  // The reply as one line: data lines joined by '|', "" when there is none.
  std::string ask(const std::string& command) {
    const Reply reply = link_->command(command);
    EXPECT_TRUE(reply.complete) << "no complete reply to " << command;
    std::string joined;
    for (const auto& line : reply.lines) joined += (joined.empty() ? "" : "|") + line;
    return joined;
  }

  // Lets simulated time pass.
  void wait(Tick ticks) { machine_->run_until(machine_->now() + ticks); }

  // Ticks of the next `count` falling edges of a one-bit output, found one change at a time.
  std::vector<Tick> falling_edges(const PinField& pin, unsigned count, Tick limit) {
    std::vector<Tick> edges;
    const BoardOutputs stop = select_pins(pin);
    const Tick end = machine_->now() + limit;
    while (edges.size() < count && machine_->now() < end) {
      const bool before = machine_->outputs().get(pin) != 0;
      machine_->run_until(end, stop);
      if (before && machine_->outputs().get(pin) == 0) edges.push_back(machine_->now());
    }
    return edges;
  }

 private:
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<HostBus> bus_;
  std::unique_ptr<HostLink> link_;
};

// An engine of BRICK_ON_ENGINES. at_night: with BRICK_NIGHT in the environment only (plans/night.toml).
struct OnEngine {
  OnEngine(Engine e, bool night = false) : engine(e), at_night(night) {}
  Engine engine;
  bool at_night;
};
inline OnEngine at_night(Engine engine) { return {engine, true}; }
inline bool night() { return std::getenv("BRICK_NIGHT") != nullptr; }

inline std::vector<Engine> engines(std::initializer_list<OnEngine> all) {
  std::vector<Engine> chosen;
  for (const OnEngine& one : all)
    if (!one.at_night || night()) chosen.push_back(one.engine);
  return chosen;
}

#define BRICK_ON_ENGINES(suite, ...) \
  INSTANTIATE_TEST_SUITE_P(, suite, ::testing::ValuesIn(engines({__VA_ARGS__})), engine_name)

}  // namespace brick
