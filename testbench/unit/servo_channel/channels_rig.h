// RTL and model of a servo IC side by side, for what its channels do. Every tick compares all pins and the word at the
// present address, and holds the model to its promises: next_motor_event() is not later than the next change of a pin,
// of the strobes where these are asked for alone, nor next_equ_event() than that of an EQU. While the model is judged
// it sleeps until then, and its twin is a second one that is awake at every edge.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "testbench/unit/rtl/comparison.h"
#include "testbench/unit/servo_channel/channel_words.h"
#include "testbench/unit/servo_channel/channels_engine.h"

namespace brick {

constexpr unsigned kA = kEncA, kB = kEncB, kC = kEncC;  // the other pins have their names in motor_pins.h
enum : unsigned { kPulse, kDir, kDacA, kDacB, kAena, kEqu };
enum Switch : unsigned { kTopA, kBottomA, kTopB, kBottomB, kTopC, kBottomC };
constexpr unsigned base(unsigned channel) { return 8 * (channel - 1); }
constexpr std::uint32_t kOwnClocks =
    regs::servo_ic::kClockControl.reset &  // default dividers, PHASE and SERVO driven
    ~(regs::servo_ic::clock_control::kPhaseExternal.mask() | regs::servo_ic::clock_control::kServoExternal.mask());

// Bits of ChannelPins::serial, and those of the packed pins.
constexpr unsigned kStrobesOfSerial = 1u << 1 | 1u << 3;
constexpr MotorOutputs kStrobes{{0, kStrobesOfSerial << motor_pin::kDacClk.lsb, 0, 0, 0, 0}};

class ChannelsRig {
 public:
  ChannelsRig() {
    if (model_judged()) awake_ = std::make_unique<ServoIc>(sc_core::sc_gen_unique_name("awake"));
    each([](ServoIc& ic) { ic.reset(0); });
  }

  ServoIcInputs in = ServoIcInputs();  // with zeros between the fields
  bool lazy = false;                   // the model's edges are executed only when it asks
  std::function<void(bool x, unsigned addr, std::uint32_t&)> mutate;  // negative controls: what the model is written

  void tick() {
    apply();
    const Tick promised = model_.next_motor_event(), of_strobes = model_.next_motor_event(kStrobes),
               of_equ = model_.next_equ_event((1u << kChannels) - 1);
    const ChannelPins before = judged();
    ++now_;
    const bool ref = now_ % kTicksPerRef == 0;
    if (!awake_) rtl_.tick();
    const bool strobe = ref && (in.we || in.rd);
    if (!in.rst_n) {
      each([this](ServoIc& ic) { ic.reset(now_); });
      seen_ = now_;
    } else {
      if (awake_) awake_->advance(now_);
      if (!(lazy || awake_) || promised <= now_ || strobe) advance(now_);
    }
    if (strobe && in.rst_n) {
      if (in.rd) each([this](ServoIc& ic) { ic.read_taken(in.x, in.addr); });
      if (in.we && awake_) awake_->write(in.x, in.addr, in.wdata);
      std::uint32_t value = in.wdata;
      if (in.we && mutate) mutate(in.x, in.addr, value);
      if (in.we) model_.write(in.x, in.addr, value);
    }
    if (in.rst_n && !strobe) {
      const ChannelPins after = judged();
      if (!(after == before) && promised > now_) note("a pin changed, next_motor_event() said", now_, promised);
      if (((after.serial ^ before.serial) & kStrobesOfSerial) != 0 && of_strobes > now_)
        note("a strobe changed, next_motor_event() said", now_, of_strobes);
      if ((after.others ^ before.others) >> 4 * kEqu != 0 && of_equ > now_)
        note("an EQU changed, next_equ_event() said", now_, of_equ);
    }
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
    return awake_ ? model_.read(x, addr) : rtl_.rdata();
  }
  // A read as the bus does it, with its side effect.
  std::uint32_t read(bool x, unsigned addr) {
    const std::uint32_t value = peek(x, addr);
    in.rd = true;
    ref();
    in.rd = false;
    return value;
  }
  // The same by name: a word of the IC, a word of a channel (1..4).
  void write(const regs::Register& word, std::uint32_t value) { write(word.space == 'X', word.address, value); }
  void write(unsigned channel, const regs::Register& word, std::uint32_t value) {
    write(word.space == 'X', base(channel) + word.address, value);
  }
  std::uint32_t peek(unsigned channel, const regs::Register& word) {
    return peek(word.space == 'X', base(channel) + word.address);
  }
  std::uint32_t read(unsigned channel, const regs::Register& word) {
    return read(word.space == 'X', base(channel) + word.address);
  }
  void reset(Tick length = 4) {  // 0: between two edges
    in.rst_n = false;
    apply();
    ticks(length);
    in.rst_n = true;
    apply();
  }
  // Levels of one channel's pins.
  void pin(unsigned channel, unsigned bit, bool level) {
    unsigned& pins = in.pins[channel - 1];
    pins = level ? pins | 1u << bit : pins & ~(1u << bit);
  }

  ChannelPins pins() {
    if (awake_) advance(now_);
    return judged();
  }
  bool pwm(unsigned channel, unsigned bit) { return (pins().pwm >> (6 * (channel - 1) + bit) & 1) != 0; }
  bool other(unsigned group, unsigned channel) { return (pins().others >> (4 * group + channel - 1) & 1) != 0; }
  Tick now() const { return now_; }
  Tick next_equ_event(unsigned channel) {  // of the model
    apply();
    advance(now_);
    return model_.next_equ_event(1u << (channel - 1));
  }
  std::string difference;

 private:
  void advance(Tick t) {
    if (!in.rst_n) return;
    model_.advance(t);
    seen_ = t;
  }
  template <class Act>
  void each(const Act& act) {  // model
    act(model_);
    if (awake_) act(*awake_);
  }
  void apply() {
    if (awake_ && same_bytes(in, applied_)) return;
    advance(now_);  // edges that were left out belong to the old inputs
    if (!awake_) {
      rtl_.in = in;
      rtl_.settle();
    }
    if (!in.rst_n) each([this](ServoIc& ic) { ic.reset(now_); });
    each([this](ServoIc& ic) { set_inputs(ic, in); });
    applied_ = in;
  }
  ChannelPins judged() const { return awake_ ? channel_pins(model_) : channel_pins(rtl_); }
  void compare() {
    if (!difference.empty() || !(engines_compared() || awake_)) return;
    const ChannelPins a = awake_ ? channel_pins(*awake_) : channel_pins(rtl_), b = channel_pins(model_);
    if (a.pwm != b.pwm) note("PWM", a.pwm, b.pwm);
    if (a.others != b.others) note("pins", a.others, b.others);
    if (a.serial != b.serial) note("serial", a.serial, b.serial);
    if (a.phase != b.phase || a.servo != b.servo) note("clocks", a.phase * 2 + a.servo, b.phase * 2 + b.servo);
    if (seen_ != now_ || (mutate && written_word(in.x, in.addr))) return;
    const std::uint32_t twin = awake_ ? awake_->read(in.x, in.addr) : rtl_.rdata(), word = model_.read(in.x, in.addr);
    if (twin != word) note(in.x ? "X" : "Y", twin, word);
  }
  // Words that only read back what was written: of no use to find out what the writing did.
  static bool written_word(bool x, unsigned addr) {
    const unsigned offset = addr & 7;
    return x ? offset >= 4 : offset < 5 || offset == 7;
  }
  void note(const std::string& what, std::int64_t twin, std::int64_t model) {
    if (!difference.empty() || !(engines_compared() || awake_)) return;
    std::ostringstream text;
    text << "tick " << now_ << " word " << (in.x ? "X" : "Y") << in.addr << ": " << what << std::hex
         << (awake_ ? ": awake " : ": RTL ") << twin << ", model " << model;
    difference = text.str();
  }

  RtlServoIc rtl_;
  ServoIc model_{sc_core::sc_gen_unique_name("ic")};
  std::unique_ptr<ServoIc> awake_;  // while the model is judged
  ServoIcInputs applied_ = ServoIcInputs();
  Tick now_ = 0, seen_ = 0;
};

}  // namespace brick
