// Model of rtl/servo_ic/servo_channels.sv: the four channels of a servo IC with the clocks they share. Its owner
// advances it along straight pieces of the triangle and calls turn() after the edge that leaves a turnaround.
// docs/servo_channel.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"
#include "systemc/core/motor_digest.h"
#include "systemc/core/motor_pins.h"
#include "systemc/servo_ic/channel_clocks.h"
#include "systemc/servo_ic/servo_channel.h"

namespace brick {

class ServoChannels : public sc_core::sc_module, public ModelBlock {
 public:
  explicit ServoChannels(const sc_core::sc_module_name& name) : sc_module(name) {}

  // Seen by the edges to come.
  struct Inputs {
    bool trip;
    std::uint32_t clock_control;                 // the word, for its dividers (I7m03)
    std::uint32_t dac_strobe;                    // I7m05
    std::uint32_t adc_strobe;                    // I7m06
    unsigned deadtime;                           // I7m04
    TriangleLine line;                           // the triangle from the next edge on
    bool phase_rises, phase_falls, servo_falls;  // turned over by each such edge of the clock chain
    std::uint8_t adc_a, adc_b;                   // bit n-1: channel n
  };
  Inputs in{};
  void set_adc(std::uint8_t a, std::uint8_t b) {  // a level that moves ends what send_adc() has given
    sends_ = sends_ && a == in.adc_a && b == in.adc_b;
    in.adc_a = a;
    in.adc_b = b;
  }
  void set_trip(bool trip) {
    if (trip != in.trip) settle_pwm_times();
    if (trip && !in.trip) dac_.ask(next_ref_edge(now_) + kTicksPerRef);  // it is seen, then it asks
    in.trip = trip;
  }
  void set_pins(unsigned channel, unsigned pins) { channel_[channel].set_pins(now_, pins); }  // channel 0..3

  // Registers, offset 0..31, as they stand after the last executed edge, which also executes a write or takes the
  // sample of a read.
  std::uint32_t read(bool x, unsigned offset) const { return channel_[offset >> 3].read(now_, x, offset & 7, in.trip); }
  void write(bool x, unsigned offset, std::uint32_t value);
  static bool read_acts(bool x, unsigned offset) {  // taking the word does something
    return x && (offset & 7) == regs::servo_channel::kFlagPosition.address;
  }
  void read_taken(bool x, unsigned offset) {
    if (read_acts(x, offset)) channel_[offset >> 3].read_taken(now_);
  }
  void turn() { turned_ = true; }  // the channels load their commands with the next edge

  // Pins: bit n-1, or six bits from 6(n-1), belong to channel n.
  std::uint32_t pwm() const;
  unsigned pulse() const {
    return each([](const ServoChannel& c) { return c.pulse(); });
  }
  unsigned dir() const {
    return each([](const ServoChannel& c) { return c.dir(); });
  }
  unsigned dac_a() const {
    return each([this](const ServoChannel& c) { return c.dac_a(dac_.left()); });
  }
  unsigned dac_b() const {
    return each([this](const ServoChannel& c) { return c.dac_b(dac_.left()); });
  }
  unsigned aena() const {
    return each([this](const ServoChannel& c) { return c.aena(in.trip); });
  }
  unsigned equ() const {
    return each([this](const ServoChannel& c) { return c.equ(in.trip); });
  }
  bool dac_clk() const { return dac_.clk(now_); }
  bool dac_strobe() const { return dac_.strobe(); }
  bool adc_clk() const { return adc_.clk(now_); }
  bool adc_strobe() const { return adc_.strobe(); }

  MotorOutputs motor_outputs(const MotorOutputs& select = kAllMotorOutputs) const;  // of the others anything

  // As MotorDigest, after the last executed edge.
  ConverterWords dac_lines() const;
  MotorDigest::AdcStream adc_stream() const;
  void send_adc(const ConverterWords& words);
  unsigned adc_lines(bool b) const;
  PwmTimes pwm_times(unsigned channel) const {
    catch_up_pwm();
    return channel_[channel].pwm_times(now_, in.trip);
  }

  // The triangle is taken as the endless line `in.line`; the owner knows where it ends.
  Tick next_event() const override { return next_event(kAllMotorOutputs); }
  Tick next_event(const MotorOutputs& select) const;      // of the outputs selected
  bool follow_clocks(const MotorOutputs& select) const {  // whether such an output moves by the clocks alone
    return has_pwm(select) || has_dac(select) || has_adc(select);
  }
  Tick next_equ_event(unsigned channels) const;  // no edge before it changes EQU of one of them, bit n-1 for channel n
  void advance(Tick t) override;                 // not beyond the end of the line
  void reset(Tick t) override;

  // For ClockFollower.
  void mark();
  bool repeats() const;
  void jump(Tick by);

 private:
  static bool has_pwm(const MotorOutputs& select) { return (select.w[0] & kPwmPins) != 0; }
  static bool has_adc(const MotorOutputs& select) { return (select.w[1] & kAdcPins) != 0; }
  bool has_dac(const MotorOutputs& select) const { return (select.w[1] & kDacPins) != 0 || has_dac_data(select); }
  bool has_dac_data(const MotorOutputs& select) const {
    return (select.w[1] & kDacData) != 0 &&
           std::any_of(channel_.begin(), channel_.end(), [](const ServoChannel& c) { return !c.shows_pwm(0); });
  }
  const ServoChannel& compared_by(const ServoChannel& c) const { return c.uses_channel1() ? channel_[0] : c; }
  Tick next_equ_of(const ServoChannel& channel) const;
  template <class Pin>
  unsigned each(Pin pin) const {
    unsigned bits = 0;
    for (unsigned i = 0; i < kChannels; ++i) bits |= static_cast<unsigned>(pin(channel_[i])) << i;
    return bits;
  }
  unsigned divider(const regs::Field& clock) const { return clock.get(in.clock_control); }
  std::uint32_t sent_in_stream(unsigned line) const;
  void catch_up_pwm(Tick t) const;
  void catch_up_pwm() const { catch_up_pwm(now_); }
  bool pwm_inputs_move() const { return turned_ || started_ || in.line != line_ || in.deadtime != pwm_deadtime_; }
  void settle_pwm_times() const {
    catch_up_pwm();
    for (const ServoChannel& channel : channel_) channel.settle_pwm_times(now_, in.trip);
  }
  void run_dac(Tick t, bool phase_rise);
  void run_ref(Tick t, bool phase_rise);
  void run_sclk(Tick t);

  static constexpr unsigned kDeadtimeReset =
      regs::servo_ic::pwm_control::kDeadtime.get(regs::servo_ic::kPwmControl.reset);

  static bool has_pfm(const MotorOutputs& select) { return (select.w[0] & ~kPwmPins) != 0; }
  static bool has_position(const MotorOutputs& select) {
    return ((select.w[1] & kEquPins) | select.w[2] | select.w[3] | select.w[4] | select.w[5]) != 0;
  }

  static constexpr std::uint32_t kPwmPins = 0xFFFFFF;  // of word 0 of the outputs
  static constexpr std::uint32_t kDacData = 0xFF, kEquPins = 0xF000, kDacPins = 0x30000, kAdcPins = 0xC0000,
                                 kDacClk = 0x10000,
                                 kAdcClk = 0x40000;  // of word 1
  static constexpr regs::Field kSclk = regs::servo_ic::clock_control::kSclkDivider,
                               kPfm = regs::servo_ic::clock_control::kPfmDivider,
                               kDac = regs::servo_ic::clock_control::kDacDivider,
                               kAdc = regs::servo_ic::clock_control::kAdcDivider;
  std::array<ServoChannel, kChannels> channel_;
  ChannelDivider sclk_, pfm_;
  ChannelStrobe dac_, adc_;
  std::int64_t adc_bits_ = 0, marked_adc_bits_ = 0;  // of the streams begun so far
  // What send_adc() has given, if it has; its first bit is this one of the present stream.
  bool sends_ = false;
  ConverterWords sent_{};
  int sent_from_ = 0;
  bool phase_rises_{}, phase_falls_{}, servo_falls_{};  // at the last edge of clk_ref
  Tick phase_rise_{};                                   // edge that took the last one
  Tick marked_{};
  Tick now_{};
  // The PWM acts on nothing inside: it has been executed up to here only and goes on along this line when somebody
  // looks at it or the line ends. Triangle, turnaround and dead time reach it a tick later (channel_triangle.sv).
  mutable Tick pwm_now_{};
  mutable TriangleLine pwm_line_;
  unsigned pwm_deadtime_{};
  TriangleLine line_;  // where `in.line` is if its owner does not move it
  bool turned_{};      // the last edge has left a turnaround
  bool started_{};     // the last edge was the reset's
};

}  // namespace brick
