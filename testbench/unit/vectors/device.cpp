#include "testbench/unit/vectors/device.h"

#include <fmt/format.h>

#include <tuple>

namespace brick {
namespace {

class Compared : public Device {
 public:
  Compared(std::unique_ptr<Device> first, std::unique_ptr<Device> second)
      : first_(std::move(first)), second_(std::move(second)) {
    first_->on_change = [this](Tick t, unsigned signal, std::uint32_t value) {
      seen_[0].emplace_back(t, signal, value);
    };
    second_->on_change = [this](Tick t, unsigned signal, std::uint32_t value) {
      seen_[1].emplace_back(t, signal, value);
    };
  }
  const std::vector<DeviceSignal>& signals() const override { return first_->signals(); }
  Tick now() const override { return first_->now(); }
  std::uint32_t value(unsigned signal) const override { return first_->value(signal); }
  void reset() override {
    first_->reset();
    second_->reset();
    compare();
  }
  void run(Tick ticks) override {
    for (; ticks > 0; --ticks) {  // what on_change drives must reach both at the same tick
      first_->run(1);
      second_->run(1);
      compare();
    }
  }
  void run_towards_change(unsigned, Tick limit) override {
    if (now() < limit) run(1);
  }
  void drive(unsigned signal, std::uint32_t value) override {
    first_->drive(signal, value);
    second_->drive(signal, value);
    if (!comparing_) compare();
  }
  void write(bool x, unsigned addr, std::uint32_t value) override {
    first_->write(x, addr, value);
    second_->write(x, addr, value);
    compare();
  }
  std::uint32_t read(bool x, unsigned addr) override {
    const std::uint32_t a = first_->read(x, addr), b = second_->read(x, addr);
    compare();
    if (a != b)
      throw DeviceError(fmt::format("tick {}: {}:${:02X} reads ${:06X} on RTL, ${:06X} on the model", now(),
                                    x ? "X" : "Y", addr, a, b));
    return a;
  }
  std::string command(const std::string&) override { throw DeviceError("this device takes no commands"); }

 private:
  using Change = std::tuple<Tick, unsigned, std::uint32_t>;

  void compare() {
    comparing_ = true;
    for (std::size_t i = 0; i < seen_[0].size() || i < seen_[1].size(); ++i) {
      const bool same = i < seen_[0].size() && i < seen_[1].size() && seen_[0][i] == seen_[1][i];
      if (!same) throw DeviceError("RTL and model differ: RTL " + text(0, i) + ", model " + text(1, i));
      const auto [tick, signal, value] = seen_[0][i];
      if (on_change) on_change(tick, signal, value);
    }
    seen_[0].clear();
    seen_[1].clear();
    comparing_ = false;
  }
  std::string text(unsigned engine, std::size_t i) const {
    if (i >= seen_[engine].size()) return "changes nothing";
    const auto [tick, signal, value] = seen_[engine][i];
    return fmt::format("{} = {} at tick {}", signals()[signal].name, value, tick);
  }

  std::unique_ptr<Device> first_, second_;
  std::vector<Change> seen_[2];
  bool comparing_ = false;
};

}  // namespace

std::unique_ptr<Device> compared(std::unique_ptr<Device> first, std::unique_ptr<Device> second) {
  return std::make_unique<Compared>(std::move(first), std::move(second));
}

const std::vector<DeviceKind>& device_kinds() {
  static const std::vector<DeviceKind> kinds{
      {"channels",
       channels_signals(),
       32,
       true,
       false,
       {"rtl", "systemc", "both", "board_rtl", "board_systemc", "board_both"}},
      {"controller", controller_signals(), 0, false, true, {"rtl", "systemc", "both"}},
      {"buses", buses_signals(), 0, false, false, {"rtl", "systemc", "both"}},
      {"ssi", ssi_signals(), 64, false, false, {"rtl", "systemc", "both"}}};
  return kinds;
}

std::unique_ptr<Device> make_device(const std::string& kind, const std::string& engine, const std::string& board) {
  if (kind == "controller") return make_controller(engine, board);
  if (kind == "buses") return make_buses(engine);
  if (kind == "ssi" && engine == "both") return compared(make_ssi(true), make_ssi(false));
  if (kind == "ssi") return make_ssi(engine == "rtl");
  const std::string on_board = "board_";
  if (engine.rfind(on_board, 0) == 0) return make_board_device(engine.substr(on_board.size()));
  if (engine == "both") return compared(make_channels(true), make_channels(false));
  return make_channels(engine == "rtl");
}

}  // namespace brick
