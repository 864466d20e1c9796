// Model of rtl/servo_ic/servo_channel.sv and channel_regs.sv: one channel of a servo IC. The owner (servo_channels.h)
// finds the edges at which something happens and executes only those. docs/servo_channel.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"
#include "systemc/core/motor_digest.h"
#include "systemc/servo_ic/channel_capture.h"
#include "systemc/servo_ic/channel_compare.h"
#include "systemc/servo_ic/channel_counter.h"
#include "systemc/servo_ic/channel_decode.h"
#include "systemc/servo_ic/channel_index.h"
#include "systemc/servo_ic/channel_input.h"
#include "systemc/servo_ic/channel_pfm.h"
#include "systemc/servo_ic/channel_pwm.h"
#include "systemc/servo_ic/channel_serial.h"
#include "systemc/servo_ic/channel_subcount.h"

namespace brick {

namespace channel_control = regs::servo_channel::control;

class ServoChannel {
 public:
  void reset(Tick t);

  // Registers, offset 0..7, after all edges up to `now` have been executed.
  std::uint32_t read(Tick now, bool x, unsigned offset, bool trip) const;
  // `sclk`: this edge is one of SCLK.
  void write(Tick now, bool sclk, bool x, unsigned offset, std::uint32_t value, bool trip);
  void read_taken(Tick now) { capture_.read(now); }  // of X:+3

  void set_pins(Tick now, unsigned pins);  // bits by ChannelPin

  // Edges. `edge` is one of clk_ref throughout.
  void latch_phase();
  void latch_servo(Tick edge);
  void sample_adc(unsigned bit, unsigned count, bool a, bool b);
  void sample_adc_stream(unsigned bit, unsigned count, std::uint32_t a, std::uint32_t b);
  void load_dac(bool trip, unsigned cut);
  // What the control word says of the DAC lines has changed: it is so for the last `unclocked` bits of the stream.
  void change_dac_lines(unsigned unclocked);
  void load_pwm();
  void run_pwm(Tick now, Tick t, TriangleLine line, unsigned deadtime) const;
  bool advance_pfm(std::int64_t periods, bool trip, unsigned width) {  // true when a pulse begins with the last of them
    if (!pfm_.advance(periods, pfm_inputs(trip, width))) return false;
    settle_ = 0;
    return true;
  }
  void stop_pfm() { pfm_.stop(); }
  void hold_counter() {
    counter_.clear();
    error_ = false;
  }

  // SCLK. A settled channel changes nothing but T2.
  bool settled() const { return settle_ >= kSettled; }
  // The next edge of clk_ref does nothing by itself: no bit of the control word falls back, the held counter is 0.
  bool quiet(Tick now) const { return now >= equ_write_until_ && !(hold() && (counter_.counter() != 0 || error_)); }
  bool uses_channel1() const { return is(channel_control::kCompareChannel); }
  void skip_sclk(std::int64_t periods) { counter_.skip(periods); }
  ChannelPosition position() const {
    return {counter_.counter(), fine() ? fraction() : 0, still(), false, false};
  }                                                                  // settled
  ChannelPosition sclk(Tick edge, const ChannelPosition* channel1);  // returns its own position before the edge

  ChannelPfm::Inputs pfm_inputs(bool trip, unsigned width) const { return {runs_pfm(trip), out_[2], width}; }
  bool runs_pfm(bool trip) const { return is(channel_control::kCPfm) && !trip; }
  const ChannelPfm& pfm() const { return pfm_; }
  bool hold() const { return is(channel_control::kCounterReset); }
  bool still() const { return hold() || mldt(); }  // no motion for a compare to look at
  bool fine() const { return is(channel_control::kHardware1t); }
  void forget_position() { compare_.forget(); }
  bool shows_pwm(unsigned output) const { return !is(output == 2 ? channel_control::kCPfm : channel_control::kAbDac); }
  Tick next_pwm_event(Tick now, TriangleLine line) const;
  std::uint32_t counter() const { return counter_.counter(); }

  // Whether EQU can change without a write, and for how many SCLK edges it does not at least.
  bool compares(bool trip) const { return !hold() && (!settled() || counts_pulses(trip)); }
  bool counts_pulses(bool trip) const {
    return decode() == regs::decode::kInternalPulse && is(channel_control::kCPfm) && !trip;
  }
  std::uint32_t edges_to_equ() const { return compare_.edges_to_hit(counter_.counter(), fine()); }

  // The PWM, as it was at mark(), `by` ticks later.
  void mark(Tick now) {
    for (ChannelPwm& pwm : pwm_) pwm.balance(now);
    marked_ = pwm_;
  }
  bool repeats(Tick by) const {
    return std::equal(pwm_.begin(), pwm_.end(), marked_.begin(),
                      [by](const ChannelPwm& a, const ChannelPwm& b) { return a.repeats(b, by); });
  }
  void jump(Tick now, Tick by, Tick periods) {
    for (unsigned i = 0; i < 3; ++i) pwm_[i].jump(now, by, marked_[i], periods);
  }

  // Pins
  // Before the control word or `trip` changes, after the edges up to `now`: what the PWM has done was done with these.
  void settle_pwm_times(Tick now, bool trip) const;
  PwmTimes pwm_times(Tick now, bool trip) const {
    settle_pwm_times(now, trip);
    return pwm_times_;
  }
  unsigned pwm(bool trip) const;  // C bottom, C top, B bottom, B top, A bottom, A top from bit 5 down
  bool pulse() const { return is(channel_control::kCPfm) && pfm_.pulse() != is(channel_control::kCInvert); }
  bool dir() const { return is(channel_control::kCPfm) && pfm_.down() != is(channel_control::kPfmDirInvert); }
  bool dac_a(unsigned left) const {
    return is(channel_control::kAbDac) && dac_[0].data(left) != is(channel_control::kAbInvert);
  }
  bool dac_b(unsigned left) const {
    return is(channel_control::kAbDac) && dac_[1].data(left) != is(channel_control::kAbInvert);
  }
  // The last 24 bits of a DAC line that were clocked; `unclocked` bits of the present stream were not.
  std::uint32_t dac_line(unsigned output, unsigned unclocked) const {
    const DacLine& line = dac_line_[output];
    return static_cast<std::uint32_t>((std::uint64_t{line.before} << 24 | line.present) >> unclocked) & 0xFFFFFF;
  }
  bool aena(bool trip) const { return is(channel_control::kAena) && !trip; }
  bool equ(bool trip) const { return compare_.equ() && !trip; }

 private:
  // SCLK edges after the last outside influence until nothing moves any more. A pin that has just moved is a sample at
  // the second, the filter's level behind the third; the fourth counts, shifts the index and sees an edge of a flag;
  // the fifth captures by the index that was shifted, finds the loss of two samples and shows the compare the new
  // position, from which the sixth has not moved. One more is to spare; after a reset the sixth is the first of all
  // that acts.
  static constexpr unsigned kSettled = 7;

  struct DacLine {  // what is sent on it: the stream before and the present one
    std::uint32_t before = 0, present = 0;
  };
  std::uint32_t dac_stream(unsigned output) const {
    if (!is(channel_control::kAbDac)) return 0;
    return dac_[output].stream() ^ (is(channel_control::kAbInvert) ? 0xFFFFFF : 0);
  }
  bool is(const regs::Field& field) const { return field.is_set(control_); }
  std::uint32_t decode() const { return channel_control::kDecode.get(control_); }
  bool mldt() const { return decode() == regs::decode::kMldt; }
  bool has_fraction() const { return fine() && !still(); }
  unsigned fraction() const { return counter_.down() ? 4095 - subcount_.e() : subcount_.e(); }
  std::uint32_t status(bool trip) const;

  std::uint32_t control_ = 0;
  Tick equ_write_until_ = 0;  // edge at which EQU write falls back
  std::array<std::uint32_t, 3> out_{};
  bool error_ = false, loss_ = false;
  bool error_now_ = false, loss_now_ = false;  // at the last SCLK; while settled at each
  unsigned settle_ = 0;
  unsigned servo_fraction_ = 0;

  ChannelInput input_;
  ChannelIndex index_;
  ChannelDecode decode_;
  ChannelCounter counter_;
  ChannelSubcount subcount_;
  ChannelCapture capture_;
  ChannelCompare compare_;
  mutable std::array<ChannelPwm, 3> pwm_;  // executed when somebody looks at it
  std::array<ChannelPwm, 3> marked_;
  mutable PwmTimes pwm_times_;  // of the pins
  struct PwmSettled {           // of the switches, when that was brought up to date
    Tick balance = 0;
    std::uint64_t dead_times = 0;
  };
  mutable std::array<PwmSettled, 3> pwm_settled_;
  ChannelPfm pfm_;
  std::array<ChannelDac, 2> dac_;
  std::array<DacLine, 2> dac_line_;
  std::array<ChannelAdc, 2> adc_;
};

}  // namespace brick
