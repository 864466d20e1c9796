// The whole controller with its firmware, addressed by command lines over the host bus. Changes of its pins are
// reported while a vector waits, not while a command is under way.
#include "systemc/cosim/engines.h"
#include "systemc/machine/board_file.h"
#include "testbench/host/host_link.h"
#include "testbench/unit/vectors/device.h"

namespace brick {
namespace {

constexpr PinField kReported[] = {pin::kPhase,     pin::kServo,       pin::kBreq,
                                  pin::kWdTripped, pin::kPhaseSource, pin::kSourceConflict};
constexpr Tick kBootTime = ns_to_ticks(100'000'000);

class ControllerDevice : public Device {
 public:
  ControllerDevice(const std::string& engine, const std::string& board) {
    MachineConfig config;
    config.engine = engine == "rtl" ? Engine::kRtl : engine == "systemc" ? Engine::kSystemC : Engine::kLockstep;
    config.board = read_board_file("boards/" + board + ".toml");
    config.firmware = BRICK_FIRMWARE;
    machine_ = std::make_unique<Machine>(sc_core::sc_gen_unique_name("machine"), config);
    bus_ = std::make_unique<HostBus>(*machine_);
    link_ = std::make_unique<HostLink>(*bus_);
    values_.resize(signals_.size());
  }
  const std::vector<DeviceSignal>& signals() const override { return signals_; }
  Tick now() const override { return machine_->now(); }
  std::uint32_t value(unsigned signal) const override { return values_[signal]; }

  void reset() override {
    guarded([&] {
      if (machine_->now() > 0) machine_->reset();
      connect();
    });
  }
  void run(Tick ticks) override {
    guarded([&] {
      const Tick end = now() + ticks;
      while (now() < end) {
        machine_->run_until(end, select());
        report();
      }
    });
  }
  void run_towards_change(unsigned, Tick limit) override {
    guarded([&] {
      machine_->run_until(limit, select());
      report();
    });
  }
  void drive(unsigned, std::uint32_t) override { throw DeviceError("this device has no input pin"); }
  void write(bool, unsigned, std::uint32_t) override { throw DeviceError("registers are reached by commands"); }
  std::uint32_t read(bool, unsigned) override { throw DeviceError("registers are reached by commands"); }

  std::string command(const std::string& line) override {
    std::string joined;
    guarded([&] {
      const Reply reply = link_->command(line);
      if (line.rfind("$$$", 0) == 0) {
        connect();
      } else if (!reply.complete) {
        throw DeviceError("no complete reply to " + line);
      }
      for (const auto& text : reply.lines) joined += (joined.empty() ? "" : "|") + text;
      report();
    });
    return joined;
  }

 private:
  template <class Action>
  void guarded(Action action) {
    try {
      action();
    } catch (const LockstepDifference& difference) { throw DeviceError(difference.what()); }
  }
  void connect() {
    if (!link_->connect(now() + kBootTime)) throw DeviceError("no reply from the firmware");
    report();
  }
  static BoardOutputs select() {
    BoardOutputs all;
    for (const auto& field : kReported) all.set(field, ~0u);
    return all;
  }
  void report() {
    for (unsigned i = 0; i < values_.size(); ++i) {
      const std::uint32_t value = machine_->outputs().get(kReported[i]);
      if (values_[i] == value) continue;
      values_[i] = value;
      if (on_change) on_change(now(), i, value);
    }
  }

  std::vector<DeviceSignal> signals_ = controller_signals();
  std::vector<std::uint32_t> values_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<HostBus> bus_;
  std::unique_ptr<HostLink> link_;
};

}  // namespace

std::vector<DeviceSignal> controller_signals() {
  std::vector<DeviceSignal> all;
  for (const auto& field : kReported) all.push_back({std::string(field.name), false});
  return all;
}

std::unique_ptr<Device> make_controller(const std::string& engine, const std::string& board) {
  return std::make_unique<ControllerDevice>(engine, board);
}

}  // namespace brick
