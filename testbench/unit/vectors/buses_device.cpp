// Both buses of the board, line by line: a vector drives the lines of the CPU and those of the host, and sees what the
// board drives. After the reset of 150 ticks clk_ref rises at ticks that three divides.
#include <fmt/format.h>

#include "systemc/cosim/engines.h"
#include "testbench/unit/vectors/device.h"

namespace brick {
namespace {

constexpr std::uint32_t kFitted = 0x3;
constexpr Tick kResetLow = 120, kResetOver = 30;

struct Input {
  const char* name;
  unsigned width;
  void (*set)(BoardInputs&, std::uint32_t);
};
constexpr Input kInputs[] = {
    {"bus.addr", 19, [](BoardInputs& in, std::uint32_t v) { in.pa_addr = v; }},
    {"bus.x", 1, [](BoardInputs& in, std::uint32_t v) { in.pa_x = v != 0; }},
    {"bus.aa", 4, [](BoardInputs& in, std::uint32_t v) { in.pa_aa = static_cast<std::uint8_t>(v); }},
    {"bus.rd_n", 1, [](BoardInputs& in, std::uint32_t v) { in.pa_rd_n = v != 0; }},
    {"bus.wr_n", 1, [](BoardInputs& in, std::uint32_t v) { in.pa_wr_n = v != 0; }},
    {"bus.data", 24, [](BoardInputs& in, std::uint32_t v) { in.pa_wdata = v; }},
    {"host.isa.addr", 24, [](BoardInputs& in, std::uint32_t v) { in.set_address(v); }},
    {"host.isa.ior_n", 1, [](BoardInputs& in, std::uint32_t v) { in.isa_ior_n = v != 0; }},
    {"host.isa.iow_n", 1, [](BoardInputs& in, std::uint32_t v) { in.isa_iow_n = v != 0; }},
    {"host.isa.memr_n", 1, [](BoardInputs& in, std::uint32_t v) { in.isa_memr_n = v != 0; }},
    {"host.isa.memw_n", 1, [](BoardInputs& in, std::uint32_t v) { in.isa_memw_n = v != 0; }},
    {"host.isa.sbhe_n", 1, [](BoardInputs& in, std::uint32_t v) { in.isa_sbhe_n = v != 0; }},
    {"host.isa.wdata", 16, [](BoardInputs& in, std::uint32_t v) { in.isa_sd = static_cast<std::uint16_t>(v); }}};
constexpr unsigned kInputCount = std::size(kInputs);

constexpr PinField kOutputs[] = {pin::kPaData, pin::kPaDataOe, pin::kPaTaN,      pin::kBreq,
                                 pin::kIsaSd,  pin::kIsaSdOe,  pin::kIsaIochrdy, pin::kIsaMemcs16N};

std::unique_ptr<Board> make_board(const std::string& engine) {
  if (engine == "rtl") return make_rtl_board(kFitted);
  if (engine == "systemc") return make_model_board(kFitted);
  return make_lockstep_board(make_rtl_board(kFitted), make_model_board(kFitted));
}

class BusesDevice : public Device {
 public:
  explicit BusesDevice(const std::string& engine) : board_(make_board(engine)), values_(signals_.size()) {
    in_.fitted = kFitted;
    for (unsigned i = 0; i < kInputCount; ++i)  // strobes and commands rest high
      if (signals_[i].name.compare(signals_[i].name.size() - 2, 2, "_n") == 0) values_[i] = 1;
    report(0, board_->outputs());
    board_->on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) { report(t, after); };
  }
  const std::vector<DeviceSignal>& signals() const override { return signals_; }
  Tick now() const override { return board_->now(); }
  std::uint32_t value(unsigned signal) const override { return values_[signal]; }

  void reset() override {
    in_.rst_n = false;
    run(kResetLow);
    in_.rst_n = true;
    run(kResetOver);
  }
  void run(Tick ticks) override {
    board_->set_inputs(in_);
    try {
      board_->run_until(now() + ticks);
    } catch (const LockstepDifference& difference) { throw DeviceError(difference.what()); }
  }
  void run_towards_change(unsigned, Tick limit) override {
    if (now() < limit) run(1);
  }
  void drive(unsigned signal, std::uint32_t value) override {
    kInputs[signal].set(in_, value);
    change(now(), signal, value);
  }
  void write(bool, unsigned, std::uint32_t) override { throw DeviceError("a cycle is made of its lines"); }
  std::uint32_t read(bool, unsigned) override { throw DeviceError("a cycle is made of its lines"); }
  std::string command(const std::string&) override { throw DeviceError("the board takes no commands"); }

 private:
  void report(Tick t, const BoardOutputs& board) {
    for (unsigned i = 0; i < std::size(kOutputs); ++i) change(t, kInputCount + i, board.get(kOutputs[i]));
  }
  void change(Tick t, unsigned signal, std::uint32_t value) {
    if (values_[signal] == value) return;
    values_[signal] = value;
    if (on_change) on_change(t, signal, value);
  }

  std::unique_ptr<Board> board_;
  std::vector<DeviceSignal> signals_ = buses_signals();
  std::vector<std::uint32_t> values_;
  BoardInputs in_;
};

}  // namespace

std::vector<DeviceSignal> buses_signals() {
  std::vector<DeviceSignal> all;
  for (const Input& input : kInputs) all.push_back({input.name, true, input.width});
  for (const PinField& field : kOutputs) {
    all.push_back({std::string(field.name), false, field.width});
    if (field.name == pin::kPaData.name) all.back().enable = pin::kPaDataOe.name;
    if (field.name == pin::kIsaSd.name) all.back().enable = pin::kIsaSdOe.name;
  }
  return all;
}

std::unique_ptr<Device> make_buses(const std::string& engine) { return std::make_unique<BusesDevice>(engine); }

}  // namespace brick
