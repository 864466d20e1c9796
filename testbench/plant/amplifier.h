// The power stage of one axis: is it on, has it tripped and why, what does it tell the controller. FAULT and the status
// nibble of ADC A show the cause; a command on the ADC strobe clears it (servo-ic:11.1). The codes are ours: the real
// ones are not published.
#pragma once

#include <cmath>
#include <cstdint>

namespace brick::plant {

struct AmplifierParameters {
  double bus_volts = 48;        // between the rails; a phase is at +- half of it
  double full_scale_amps = 10;  // of the ADC words, and of a torque command of 10 V
  double trip_amps = 20;        // over-current
  bool fault_level = true;      // level of the FAULT pin that means a fault
  std::int64_t adc_noise = 0;   // peak, in bits of the 14-bit current
  bool adc = true;         // wired to the serial ADC lines, which also bring commands; costs a stop at each clock edge
  bool always_on = false;  // AENA is not wired
};

class Amplifier {
 public:
  enum class Fault : std::uint8_t {
    kNone,
    kOverCurrent,
    kShortedBus,
    kUnderVoltage,
    kOverVoltage,
    kOverTemperature,
    kI2t
  };

  explicit Amplifier(const AmplifierParameters& parameters) : par_(parameters) {}
  const AmplifierParameters& parameters() const { return par_; }

  void enable(bool aena) { enabled_ = aena; }
  bool on() const { return (enabled_ || par_.always_on) && fault_ == Fault::kNone; }
  Fault fault() const { return fault_; }
  bool fault_pin() const { return (fault_ != Fault::kNone) == par_.fault_level; }

  // The first cause stays until it is cleared.
  void trip(Fault cause) {
    if (fault_ == Fault::kNone) fault_ = cause;
  }
  void clear() { fault_ = Fault::kNone; }
  void watch(double amps) {
    if (std::fabs(amps) > par_.trip_amps) trip(Fault::kOverCurrent);
  }
  // Word on the ADC strobe: bits 23..20 $F, 18..16 the axis (0..3), 15 clears faults.
  void command(unsigned axis, std::uint32_t word) {
    if (word >> 20 == 0xF && (word >> 16 & 7) == axis && (word >> 15 & 1) != 0) clear();
  }

  // 18 bits: the current as 14-bit two's complement, then four bits of status. `noise` in bits of the current.
  std::uint32_t adc_word(double amps, std::int64_t noise, unsigned status) const {
    double code = std::floor(amps / par_.full_scale_amps * 8192 + 0.5) + static_cast<double>(noise);
    code = code > 8191 ? 8191 : code < -8192 ? -8192 : code;
    return (static_cast<std::uint32_t>(static_cast<std::int32_t>(code)) & 0x3FFF) << 4 | (status & 0xF);
  }

 private:
  AmplifierParameters par_;
  bool enabled_ = false;
  Fault fault_ = Fault::kNone;
};

}  // namespace brick::plant
