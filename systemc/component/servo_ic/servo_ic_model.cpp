// The servo IC of the SystemC model behind the pins of its component.
#include "systemc/servo_ic/servo_ic.h"

#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/servo_ic/servo_ic_words.h"

namespace brick::component {
namespace {
using namespace servo_ic_words;

class ServoIcModel final : public ModelChip {
 public:
  ServoIcModel() : ModelChip(kOutputWords), ic_("model") {
    ic_.set_motor_inputs({});
    power_on();
  }

  std::uint32_t peek(unsigned, unsigned address) override { return ic_.read((address & 4) != 0, address / 8); }

 private:
  void drive(const PinWords& in) override {
    MotorInputs pins;
    pins.adc_a = pins.adc_b = 0;
    for (unsigned n = 0; n < kChannels; ++n) {
      pins.pins[n] = static_cast<std::uint16_t>(in[n] & 0xFFF);
      pins.adc_a = static_cast<std::uint8_t>(pins.adc_a | (in[n] >> kAdcA.lsb & 1) << n);
      pins.adc_b = static_cast<std::uint8_t>(pins.adc_b | (in[n] >> kAdcB.lsb & 1) << n);
    }
    ic_.set_motor_inputs(pins);
    ic_.set_trip(kTrip.is_set(in));
    ic_.set_pins(kPhaseI.is_set(in), kServoI.is_set(in));
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }

  void watch_changed() override {
    motor_ = {};
    motor_.w[0] = watched_[0];
    motor_.w[1] = watched_[1];
    channels_of_equ_ = watched_[0] == 0 && (watched_[1] & ~kEquPins) == 0 ? watched_[1] / kFirstEqu : 0;
  }
  Tick next_event() const override {
    Tick next = watched_[kPhaseO.word] != 0 ? ic_.next_event() : kNever;
    if (channels_of_equ_ != 0)
      next = std::min(next, ic_.next_equ_event(channels_of_equ_));
    else if (motor_ != MotorOutputs{})
      next = std::min(next, ic_.next_motor_event(motor_));
    return next;
  }
  void block_advance(Tick t) override { ic_.advance(t); }
  void block_reset(Tick t) override { ic_.reset(t); }
  void before(unsigned, const Face&) override {}
  bool after(unsigned, Face& face) override {
    const unsigned address = face.cycle.address;
    if (face.cycle.write)
      ic_.write((address & 4) != 0, address / 8, face.cycle.value & 0xFFFFFF);
    else
      ic_.read_taken((address & 4) != 0, address / 8);
    return true;
  }
  void show(PinWords& words) const override {
    const MotorOutputs motor = ic_.motor_outputs();
    words[0] = motor.w[0];
    words[1] = motor.w[1];
    words[kPhaseO.word] = kPhaseO.at(ic_.phase() || !ic_.phase_oe()) | kPhaseOe.at(ic_.phase_oe()) |
                          kServoO.at(ic_.servo() || !ic_.servo_oe()) | kServoOe.at(ic_.servo_oe());
  }

  static constexpr std::uint32_t kFirstEqu = 1u << motor_pin::kEqu.lsb, kEquPins = 0xF * kFirstEqu;
  brick::ServoIc ic_;
  MotorOutputs motor_;            // watched
  unsigned channels_of_equ_ = 0;  // nothing but EQU of these is watched
};

}  // namespace

std::unique_ptr<Chip> model_servo_ic() { return std::make_unique<ServoIcModel>(); }

}  // namespace brick::component
