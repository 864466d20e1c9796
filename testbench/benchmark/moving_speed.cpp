// The whole controller with motors that move, on the SystemC engine: eight axes, all of them at one speed. The machine
// beside it has no motors and is idle; the two run in turn, so that both meet the same weather.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "app/command_file.h"
#include "app/plant_file.h"
#include "app/time_text.h"
#include "testbench/benchmark/benchmark.h"
#include "testbench/benchmark/measure.h"
#include "testbench/host/host_link.h"
#include "testbench/plant/plant.h"

namespace brick {
namespace {

constexpr unsigned kMotors = 8;
constexpr double kCountsPerMs = 32;  // Ixx22 of the set-ups

class Controller {
 public:
  Controller(const std::string& firmware, const std::string& name)
      : machine_(sc_core::sc_gen_unique_name("machine"), config(firmware)), bus_(machine_), link_(bus_) {
    if (!link_.connect(ticks(0.2))) throw std::runtime_error(name + ": firmware is silent");
  }

  void wait(double simulated) { bus_.wait(ticks(simulated)); }
  double rate(double simulated) {
    return simulated / seconds([&] { wait(simulated); });
  }
  std::string ask(const std::string& line) {
    const Reply reply = link_.command(line);
    if (reply.error || !reply.complete) throw std::runtime_error(line + ": refused");
    return reply.lines.empty() ? "" : reply.lines.front();
  }
  void each_motor(const std::string& command) {
    for (unsigned motor = 1; motor <= kMotors; ++motor) ask(fmt::format("#{}{}", motor, command));
  }
  Machine& machine() { return machine_; }

 private:
  static MachineConfig config(const std::string& firmware) {
    MachineConfig config;
    config.firmware = firmware;
    return config;
  }
  static Tick ticks(double simulated) { return static_cast<Tick>(simulated * kTicksPerSecond); }

  Machine machine_;
  HostBus bus_;
  HostLink link_;
};

// Lines for the controller, and waits.
void set_up(Controller& controller, const std::string& file) {
  const std::string wait = "@wait ";
  std::ifstream in(file);
  for (const SourceLine& line : read_command_file(in, file)) {
    if (line.text.compare(0, wait.size(), wait) == 0)
      controller.wait(static_cast<double>(parse_time(line.text.substr(wait.size()))) * 1e-15);
    else
      controller.ask(line.text);
  }
}

// Whoever stands still costs nothing: each motor has gone its way while it was measured.
void judge_way(Controller& controller, const std::vector<double>& from, double simulated) {
  for (unsigned motor = 1; motor <= kMotors; ++motor) {
    const double way = std::stod(controller.ask(fmt::format("#{}P", motor))) - from[motor - 1];
    if (std::fabs(way / (kCountsPerMs * 1e3 * simulated) - 1) > 0.05)
      throw std::runtime_error(fmt::format("motor {} went {} counts in {} s or more", motor, way, simulated));
  }
}

}  // namespace

void measure_moving(const std::string& name, const std::string& what, const std::string& firmware, double simulated,
                    double goal, double goal_ratio) {
  Controller idle(firmware, "idle"), moving(firmware, name);
  plant::Plant plant(
      read_plant_file(fmt::format(BRICK_EXAMPLES "/plants/{}.toml", name), moving.machine().fitted(), 1));
  moving.machine().attach(plant);
  set_up(moving, fmt::format(BRICK_EXAMPLES "/setups/{}.pmc", name));
  moving.wait(0.3);  // a phase reference is found
  moving.each_motor("J/");
  moving.wait(0.05);
  moving.each_motor("J+");
  moving.wait(0.1);  // Ixx22 is reached

  std::vector<double> from, speed, ratio;
  for (unsigned motor = 1; motor <= kMotors; ++motor) from.push_back(std::stod(moving.ask(fmt::format("#{}P", motor))));
  for (int round = 0; round < kRounds; ++round) {
    const double still = idle.rate(10 * simulated);
    speed.push_back(moving.rate(simulated));
    ratio.push_back(speed.back() / still);
  }
  judge_way(moving, from, kRounds * simulated);
  moving.machine().detach(plant);
  row("SystemC, " + what, fmt::format("{:.3f} sim s/s", median(speed)), fmt::format(">= {} sim s/s", goal),
      median(speed) >= goal);
  row("  ratio to the idle machine", fmt::format("{:.3f}", median(ratio)), fmt::format(">= {}", goal_ratio),
      median(ratio) >= goal_ratio);
}

}  // namespace brick
