// The channels of servo IC 0 where they are used: on the whole board, reached over Port A, with the board's PHASE and
// SERVO.
#include <fmt/format.h>

#include "systemc/cosim/engines.h"
#include "testbench/unit/vectors/device.h"

namespace brick {
namespace {

constexpr std::uint32_t kFitted = 0x3, kBase = 0x078000;
constexpr std::uint8_t kGateIcs = 1u << 1;  // AA1
constexpr Tick kStrobe = 12, kPause = 9;    // four and three clk_ref: more than any access needs

std::unique_ptr<Board> make_board(const std::string& engine) {
  if (engine == "rtl") return make_rtl_board(kFitted);
  if (engine == "systemc") return make_model_board(kFitted);
  return make_lockstep_board(make_rtl_board(kFitted), make_model_board(kFitted));
}

// Where a signal of the channels is on the board.
struct Place {
  enum Kind { kPin, kAdcA, kAdcB, kPowerFails, kMotor, kBoard, kNowhere } kind = kNowhere;
  unsigned channel = 0, bit = 0;
  const MotorField* motor = nullptr;
  const PinField* board = nullptr;
};

Place place_of(const std::string& name) {
  if (name == pin::kPhase.name) return {Place::kBoard, 0, 0, nullptr, &pin::kPhase};
  if (name == pin::kServo.name) return {Place::kBoard, 0, 0, nullptr, &pin::kServo};
  if (name == pin::kWdTripped.name) return {Place::kPowerFails};  // trips it at the third reference edge
  const bool of_channel = name.rfind("ch", 0) == 0;
  const unsigned channel = of_channel ? static_cast<unsigned>(name[2] - '1') : 0;
  const std::string plain = of_channel ? name.substr(4) : name;
  if (plain == "adc_a") return {Place::kAdcA, channel};
  if (plain == "adc_b") return {Place::kAdcB, channel};
  for (unsigned i = 0; i < kChannelPins; ++i)
    if (kChannelPinNames[i] == plain) return {Place::kPin, channel, i};
  for (const MotorField& field : motor_pin::kAll)
    if (field.name == plain) return {Place::kMotor, channel, 0, &field};
  return {};
}

class BoardDevice : public Device {
 public:
  explicit BoardDevice(const std::string& engine) : board_(make_board(engine)), values_(signals_.size()) {
    for (const DeviceSignal& signal : signals_) places_.push_back(place_of(signal.name));
    motor_.pins = {};  // every line low, as on the channels alone
    board_->watch_motors(1);
    MotorOutputs stop;
    for (const MotorField& field : motor_pin::kAll) {
      if (field.name == motor_pin::kCount.name) continue;
      for (unsigned channel = 0; channel < kChannels; ++channel) stop.set(field, channel, ~0u);
    }
    board_->stop_on_motor(0, stop);
    apply();
    report();
  }
  const std::vector<DeviceSignal>& signals() const override { return signals_; }
  Tick now() const override { return board_->now(); }
  std::uint32_t value(unsigned signal) const override { return values_[signal]; }

  void reset() override {
    in_.rst_n = false;
    run(120);
    in_.rst_n = true;
    run(kPause);
  }
  void run(Tick ticks) override {
    for (const Tick end = now() + ticks; now() < end;) step(end);
  }
  void run_towards_change(unsigned, Tick limit) override {
    if (now() < limit) step(limit);
  }
  void drive(unsigned signal, std::uint32_t value) override {
    const Place& place = places_[signal];
    const auto set = [value](auto& word, unsigned bit) {
      using Word = std::remove_reference_t<decltype(word)>;
      word = static_cast<Word>((word & ~(1u << bit)) | (value & 1u) << bit);
    };
    if (place.kind == Place::kPin) {
      set(motor_.pins[place.channel], place.bit);
    } else if (place.kind == Place::kAdcA || place.kind == Place::kAdcB) {
      set(place.kind == Place::kAdcA ? motor_.adc_a : motor_.adc_b, place.channel);
    } else if (place.kind == Place::kPowerFails) {
      in_.pwr_good = value == 0;
    } else {
      throw DeviceError(fmt::format("{} is no input of the board", signals_[signal].name));
    }
    change(signal, value & 1);
  }

  void write(bool x, unsigned addr, std::uint32_t value) override {
    address(x, addr);
    in_.pa_wdata = value;
    run(kTicksPerRef);
    in_.pa_wr_n = false;
    run(kStrobe);
    in_.pa_wr_n = true;
    run(kPause);
  }
  std::uint32_t read(bool x, unsigned addr) override {
    address(x, addr);
    run(kTicksPerRef);
    in_.pa_rd_n = false;
    run(kStrobe);
    const std::uint32_t value = board_->outputs().get(pin::kPaData);
    in_.pa_rd_n = true;
    run(kPause);
    return value;
  }
  std::string command(const std::string&) override { throw DeviceError("the board takes no commands"); }

 private:
  void address(bool x, unsigned addr) {
    in_.pa_x = x;
    in_.pa_addr = kBase + addr;
    in_.pa_aa = kGateIcs;
  }
  void apply() {
    in_.fitted = kFitted;
    board_->set_inputs(in_);
    board_->set_motor_inputs(0, motor_);
  }
  // To `limit`, or to the next change: what is driven because of it is seen by the next edge.
  void step(Tick limit) {
    apply();
    try {
      board_->run_until(limit, select_pins(pin::kPhase, pin::kServo));
    } catch (const LockstepDifference& difference) { throw DeviceError(difference.what()); }
    report();
  }
  void report() {
    const MotorOutputs motor = board_->motor_outputs(0);
    for (unsigned i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      if (place.motor != nullptr) change(i, motor.get(*place.motor, place.channel));
      if (place.board != nullptr) change(i, board_->outputs().get(*place.board));
    }
  }
  void change(unsigned signal, std::uint32_t value) {
    if (values_[signal] == value) return;
    values_[signal] = value;
    if (on_change) on_change(now(), signal, value);
  }

  std::unique_ptr<Board> board_;
  std::vector<DeviceSignal> signals_ = channels_signals();
  std::vector<Place> places_;
  std::vector<std::uint32_t> values_;
  BoardInputs in_;
  MotorInputs motor_;
};

}  // namespace

std::unique_ptr<Device> make_board_device(const std::string& engine) { return std::make_unique<BoardDevice>(engine); }

}  // namespace brick
