// The four channels of a servo IC with its registers and clock chain: Verilated RTL or model, one tick at a time.
#include "testbench/unit/servo_channel/channels_engine.h"
#include "testbench/unit/vectors/device.h"

namespace brick {
namespace {

constexpr unsigned kPins = 12;
constexpr const char* kPinNames[kPins] = {"enc_a", "enc_b", "enc_c", "fault", "hmfl", "plim",
                                          "mlim",  "user",  "w",     "v",     "u",    "t"};
constexpr const char* kPwmNames[6] = {"pwm_a_top", "pwm_a_bot", "pwm_b_top", "pwm_b_bot", "pwm_c_top", "pwm_c_bot"};
constexpr const char* kOtherNames[6] = {"pfm_pulse", "pfm_dir", "dac", "dac_b", "aena", "equ"};
constexpr const char* kSerialNames[4] = {"dac_clk", "dac_strobe", "adc_clk", "adc_strobe"};

// Where the groups begin among the signals: inputs first.
enum : unsigned {
  kInPins = 0,
  kInAdcA = 4 * kPins,
  kInAdcB = kInAdcA + 4,
  kInPhase = kInAdcB + 4,
  kInServo,
  kInTrip,
  kOutPwm,
  kOutOthers = kOutPwm + 24,
  kOutSerial = kOutOthers + 24,
  kOutPhase = kOutSerial + 4,
  kOutServo,
  kAllSignals
};

class ChannelsDevice : public Device {
 public:
  explicit ChannelsDevice(std::unique_ptr<ChannelsEngine> engine) : engine_(std::move(engine)), values_(kAllSignals) {
    values_[kInPhase] = values_[kInServo] = 1;
    read_pins();
  }
  const std::vector<DeviceSignal>& signals() const override { return signals_; }
  Tick now() const override { return now_; }
  std::uint32_t value(unsigned signal) const override { return values_[signal]; }

  void reset() override {
    in_.rst_n = false;
    run(4);
    in_.rst_n = true;
  }
  void run(Tick ticks) override {
    for (; ticks > 0; --ticks) {
      engine_->run(in_, ++now_);
      read_pins();
    }
  }
  void run_towards_change(unsigned, Tick limit) override {
    if (now_ < limit) run(1);
  }
  void drive(unsigned signal, std::uint32_t value) override {
    const auto set = [value](auto& word, unsigned bit) {
      using Word = std::remove_reference_t<decltype(word)>;
      word = static_cast<Word>((word & ~(1u << bit)) | (value & 1u) << bit);
    };
    if (signal < kInAdcA) {
      set(in_.pins[signal / kPins], signal % kPins);
    } else if (signal < kInAdcB) {
      set(in_.adc_a, signal - kInAdcA);
    } else if (signal < kInPhase) {
      set(in_.adc_b, signal - kInAdcB);
    } else {
      (signal == kInPhase ? in_.phase : signal == kInServo ? in_.servo : in_.trip) = value != 0;
    }
    change(signal, value & 1);
  }
  void write(bool x, unsigned addr, std::uint32_t value) override {
    address(x, addr);
    in_.wdata = value;
    in_.we = true;
    run_to_ref();
    in_.we = false;
  }
  std::uint32_t read(bool x, unsigned addr) override {
    address(x, addr);
    run_to_ref();  // the first edge that sees the address; the next one takes the data
    const std::uint32_t value = engine_->word(in_);
    in_.rd = true;
    run_to_ref();
    in_.rd = false;
    return value;
  }
  std::string command(const std::string&) override { throw DeviceError("the channels take no commands"); }

 private:
  void address(bool x, unsigned addr) {
    in_.x = x;
    in_.addr = addr;
  }
  void run_to_ref() {
    do run(1);
    while (now_ % kTicksPerRef != 0);
  }
  void read_pins() {
    const ChannelPins p = engine_->pins();
    for (unsigned i = 0; i < 24; ++i) change(kOutPwm + i, p.pwm >> i & 1);
    for (unsigned i = 0; i < 24; ++i) change(kOutOthers + i, p.others >> i & 1);
    for (unsigned i = 0; i < 4; ++i) change(kOutSerial + i, p.serial >> i & 1);
    change(kOutPhase, p.phase ? 1 : 0);
    change(kOutServo, p.servo ? 1 : 0);
  }
  void change(unsigned signal, std::uint32_t value) {
    if (values_[signal] == value) return;
    values_[signal] = value;
    if (on_change) on_change(now_, signal, value);
  }

  std::unique_ptr<ChannelsEngine> engine_;
  std::vector<DeviceSignal> signals_ = channels_signals();
  std::vector<std::uint32_t> values_;
  ServoIcInputs in_;
  Tick now_ = 0;
};

}  // namespace

// Names as in the waveform, the scope of the IC left out; what the four channels share has no channel.
std::vector<DeviceSignal> channels_signals() {
  std::vector<DeviceSignal> all;
  const auto channel = [](unsigned n) { return "ch" + std::to_string(n + 1) + "."; };
  for (unsigned n = 0; n < 4; ++n)
    for (const char* name : kPinNames) all.push_back({channel(n) + name, true});
  for (const char* name : {"adc_a", "adc_b"})
    for (unsigned n = 0; n < 4; ++n) all.push_back({channel(n) + name, true});
  for (const char* name : {"clock.phase_in", "clock.servo_in", "watchdog.tripped"}) all.push_back({name, true});
  for (unsigned n = 0; n < 4; ++n)
    for (const char* name : kPwmNames) all.push_back({channel(n) + name, false});
  for (const char* name : kOtherNames)
    for (unsigned n = 0; n < 4; ++n) all.push_back({channel(n) + name, false});
  for (const char* name : kSerialNames) all.push_back({name, false});
  for (const char* name : {"clock.phase", "clock.servo"}) all.push_back({name, false});
  return all;
}

std::unique_ptr<Device> make_channels(bool rtl) { return std::make_unique<ChannelsDevice>(make_channels_engine(rtl)); }

}  // namespace brick
