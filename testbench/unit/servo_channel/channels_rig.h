// RTL and model of the four channels (with registers and clock chain) side by side. Every tick compares all pins and the word
// at the present address, and holds the model to its promise: next_event() is not later than the next change of a pin.
#pragma once

#include <cstdint>
#include <functional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "systemc/servo_ic/clock_gen.h"
#include "systemc/servo_ic/servo_channels.h"
#include "systemc/servo_ic/servo_ic_regs.h"
#include "testbench/unit/servo_channel/rtl_channels.h"

namespace brick {

// The model as a servo IC joins its parts.
class ChannelsModel {
 public:
  ChannelsModel() { apply(); }

  void set_inputs(const ChannelInputs& in) {
    clock_gen_.in.phase = in.phase;
    clock_gen_.in.servo = in.servo;
    channels_.in.trip = in.trip;
    channels_.in.adc_a = static_cast<std::uint8_t>(in.adc_a);
    channels_.in.adc_b = static_cast<std::uint8_t>(in.adc_b);
    for (unsigned i = 0; i < 4; ++i) channels_.set_pins(i, in.pins[i]);
  }
  void advance(Tick t) {
    while (now_ < t) {
      const Tick end = std::min(t, clock_gen_.next_special_edge());
      channels_.advance(end);
      const bool up = clock_gen_.up(), phase = clock_gen_.phase_clock(), servo = clock_gen_.servo_clock();
      clock_gen_.advance(end);
      if (clock_gen_.up() != up) channels_.turn();
      if (clock_gen_.phase_clock() != phase) {
        bool& edges = phase ? channels_.in.phase_falls : channels_.in.phase_rises;
        edges = !edges;
      }
      if (servo && !clock_gen_.servo_clock()) channels_.in.servo_falls = !channels_.in.servo_falls;
      now_ = end;
      follow();
    }
  }
  Tick next_event() const { return std::min(clock_gen_.next_special_edge(), channels_.next_event()); }
  void reset(Tick t) {
    now_ = t;
    regs_.reset();
    clock_gen_.reset(t);
    channels_.reset(t);
    apply();
  }
  std::uint32_t read(bool x, unsigned addr) const { return regs_.read(x, addr) | channels_.read(x, addr); }
  void write(bool x, unsigned addr, std::uint32_t value) {
    regs_.write(x, addr, value);
    channels_.write(x, addr, value);
    apply();
  }
  void read_done(bool x, unsigned addr) { channels_.read_done(x, addr); }
  ChannelPins pins() const {
    const ServoChannels& c = channels_;
    return {c.pwm(), c.equ() << 20 | c.aena() << 16 | c.dac_b() << 12 | c.dac_a() << 8 | c.dir() << 4 | c.pulse(),
            c.adc_strobe() * 8u | c.adc_clk() * 4u | c.dac_strobe() * 2u | c.dac_clk() * 1u, clock_gen_.phase(), clock_gen_.servo()};
  }

 private:
  void apply() {
    clock_gen_.in.max_count = regs_.max_count();
    clock_gen_.in.phase_div = regs_.phase_div();
    clock_gen_.in.servo_div = regs_.servo_div();
    clock_gen_.in.phase_ext = regs_.phase_ext();
    clock_gen_.in.servo_ext = regs_.servo_ext();
    channels_.in.dividers = regs_.read(true, 0x04) & 0xFFF;
    channels_.in.dac_strobe = regs_.read(true, 0x0C);
    channels_.in.adc_strobe = regs_.read(true, 0x14);
    channels_.in.deadtime = regs_.read(true, 0x1C) & 0xFF;
    follow();
  }
  void follow() { channels_.in.line = {clock_gen_.cnt(), clock_gen_.up() ? 1 : -1}; }
  ServoIcRegs regs_{sc_core::sc_gen_unique_name("regs")};
  ClockGen clock_gen_{sc_core::sc_gen_unique_name("clock_gen")};
  ServoChannels channels_{sc_core::sc_gen_unique_name("channels")};
  Tick now_ = 0;
};

class ChannelsRig {
 public:
  ChannelInputs in;
  bool lazy = false;                                                  // the model's edges are executed only when it asks
  std::function<void(bool x, unsigned addr, std::uint32_t&)> mutate;  // negative controls: what the model is written

  void tick() {
    apply();
    const Tick promised = model_.next_event();
    const ChannelPins before = rtl_.pins();
    ++now_;
    const bool ref = now_ % kTicksPerRef == 0;
    rtl_.tick(ref);
    const bool strobe = ref && (in.we || in.read_done);
    if (!in.rst_n) {
      model_.reset(now_);
      seen_ = now_;
    } else if (!lazy || promised <= now_ || strobe) {
      advance(now_);
    }
    if (strobe && in.rst_n) {
      if (in.read_done) model_.read_done(in.x, in.addr);
      std::uint32_t value = in.wdata;
      if (in.we && mutate) mutate(in.x, in.addr, value);
      if (in.we) model_.write(in.x, in.addr, value);
    }
    if (!(rtl_.pins() == before) && promised > now_ && in.rst_n && !strobe) note("a pin changed, next_event() said", now_, promised);
    compare();
  }
  void ticks(Tick n) {
    for (Tick end = now_ + n; now_ < end;) tick();
  }
  void ref(int n = 1) {
    do tick();
    while (now_ % kTicksPerRef != 0 || --n > 0);
  }
  void write(bool x, unsigned addr, std::uint32_t value) {
    in.x = x;
    in.addr = addr;
    in.wdata = value;
    in.we = true;
    ref();
    in.we = false;
  }
  std::uint32_t peek(bool x, unsigned addr) {
    in.x = x;
    in.addr = addr;
    apply();
    advance(now_);
    compare();
    return rtl_.rdata();
  }
  // A read as the bus does it, with its side effect.
  std::uint32_t read(bool x, unsigned addr) {
    const std::uint32_t value = peek(x, addr);
    in.read_done = true;
    ref();
    in.read_done = false;
    return value;
  }
  void reset() {
    in.rst_n = false;
    ticks(4);
    in.rst_n = true;
  }
  // Levels of one channel's pins.
  void pin(unsigned channel, unsigned bit, bool level) {
    unsigned& pins = in.pins[channel - 1];
    pins = level ? pins | 1u << bit : pins & ~(1u << bit);
  }

  ChannelPins pins() const { return rtl_.pins(); }
  bool pwm(unsigned channel, unsigned bit) const { return (rtl_.pins().pwm >> (6 * (channel - 1) + bit) & 1) != 0; }
  bool other(unsigned group, unsigned channel) const { return (rtl_.pins().others >> (4 * group + channel - 1) & 1) != 0; }
  Tick now() const { return now_; }
  std::string difference;

 private:
  void advance(Tick t) {
    if (!in.rst_n) return;
    model_.advance(t);
    seen_ = t;
  }
  void apply() {
    advance(now_);  // edges that were left out belong to the old inputs
    model_.set_inputs(in);
    rtl_.drive(in);
    if (!in.rst_n) model_.reset(now_);
    model_.set_inputs(in);
  }
  void compare() {
    if (!difference.empty()) return;
    const ChannelPins a = rtl_.pins(), b = model_.pins();
    if (a.pwm != b.pwm) note("PWM", a.pwm, b.pwm);
    if (a.others != b.others) note("pins", a.others, b.others);
    if (a.serial != b.serial) note("serial", a.serial, b.serial);
    if (a.phase != b.phase || a.servo != b.servo) note("clocks", a.phase * 2 + a.servo, b.phase * 2 + b.servo);
    if (seen_ != now_ || (mutate && written_word(in.x, in.addr))) return;
    const std::uint32_t word = model_.read(in.x, in.addr);
    if (rtl_.rdata() != word) note(in.x ? "X" : "Y", rtl_.rdata(), word);
  }
  // Words that only read back what was written: of no use to find out what the writing did.
  static bool written_word(bool x, unsigned addr) {
    const unsigned offset = addr & 7;
    return x ? offset >= 4 : offset < 5 || offset == 7;
  }
  void note(const std::string& what, std::int64_t rtl, std::int64_t model) {
    if (!difference.empty()) return;
    std::ostringstream text;
    text << "tick " << now_ << " word " << (in.x ? "X" : "Y") << in.addr << ": " << what << std::hex << ": RTL " << rtl << ", model "
         << model;
    difference = text.str();
  }

  RtlChannels rtl_;
  ChannelsModel model_;
  Tick now_ = 0, seen_ = 0;
};

// Register offsets of channel 1 and bits of its pins; control word fields as the I-variables.
constexpr unsigned kA = kEncA, kB = kEncB, kC = kEncC;  // the other pins have their names in motor_pins.h
enum : unsigned { kPulse, kDir, kDacA, kDacB, kAena, kEqu };
constexpr unsigned base(unsigned channel) { return 8 * (channel - 1); }
constexpr std::uint32_t kOwnClocks = 0x3008D2;  // default dividers, PHASE and SERVO driven

}  // namespace brick
