#include "systemc/servo_ic/servo_channel.h"

#include <algorithm>
#include <iterator>

namespace brick {
namespace {

namespace words = regs::servo_channel;
namespace status_bits = words::status;
namespace fine_words = regs::servo_channel_fine;

constexpr unsigned word(bool x, unsigned offset) { return (x ? 8 : 0) + offset; }
constexpr unsigned word(const regs::Register& r) { return word(r.space == 'X', r.address); }

// With hardware 1/T the timer words hold fractions.
static_assert(word(words::kTimer1) == word(fine_words::kTimer1) && word(words::kTimer2) == word(fine_words::kTimer2));

// The input pins stand in the status word in the order of ChannelPin.
constexpr regs::Field kInputs[] = {status_bits::kCha,   status_bits::kChb,   status_bits::kChc,   status_bits::kFault,
                                   status_bits::kHmfl,  status_bits::kPlim,  status_bits::kMlim,  status_bits::kUser,
                                   status_bits::kFlagW, status_bits::kFlagV, status_bits::kFlagU, status_bits::kFlagT};
constexpr bool in_order() {
  for (unsigned pin = 0; pin < kChannelPins; ++pin)
    if (kInputs[pin].lsb != kInputs[0].lsb + pin) return false;
  return true;
}
static_assert(std::size(kInputs) == kChannelPins && in_order());

// What the output pins are, which level is off and the sense of DIR: a trip holds them.
constexpr std::uint32_t kOutputBits = channel_control::kPfmDirInvert.mask() | channel_control::kAbInvert.mask() |
                                      channel_control::kCInvert.mask() | channel_control::kAbDac.mask() |
                                      channel_control::kCPfm.mask();

}  // namespace

void ServoChannel::reset(Tick t) {
  ChannelInput input = input_;
  input.reset(t);
  settle_pwm_times(t, false);
  const auto pwm = pwm_;
  const auto settled = pwm_settled_;
  const PwmTimes times = pwm_times_;
  *this = ServoChannel{};
  input_ = input;
  subcount_.reset(t);
  pwm_ = pwm;
  pwm_settled_ = settled;
  pwm_times_ = times;
  for (ChannelPwm& one : pwm_) one.reset(t);
}

std::uint32_t ServoChannel::status(bool trip) const {
  using namespace status_bits;
  return index_.level(input_.level(), is(channel_control::kIndexDemux)) << kInputs[0].lsb |
         kCaptured.at(capture_.captured()) | kCapturedGatedIndex.at(capture_.captured_gi()) | kEqu.at(equ(trip)) |
         kEncoderError.at(error_) | kEncoderLoss.at(loss_) | kDemuxInvalid.at(index_.incomplete()) |
         kHallCapture.at(capture_.hall());
}

std::uint32_t ServoChannel::read(Tick now, bool x, unsigned offset, bool trip) const {
  switch (word(x, offset)) {
    case word(words::kTimer1):
      if (!fine()) return counter_.servo_t1();
      return fine_words::timer1::kCaptured.at(capture_.fraction()) |
             fine_words::timer1::kCompareB.at(compare_.b_fraction());
    case word(words::kTimer2):
      if (!fine()) return counter_.servo_t2();
      return fine_words::timer2::kServo.at(servo_fraction_) | fine_words::timer2::kCompareA.at(compare_.a_fraction());
    case word(words::kOutA):
      return out_[0];
    case word(words::kOutB):
      return out_[1];
    case word(words::kOutC):
      return out_[2];
    case word(words::kAdcA):
      return adc_[0].value();
    case word(words::kAdcB):
      return adc_[1].value();
    case word(words::kCompareA):
      return compare_.a();
    case word(words::kStatus):
      return status(trip);
    case word(words::kPhasePosition):
      return counter_.phase_pos();
    case word(words::kServoPosition):
      return counter_.servo_pos();
    case word(words::kFlagPosition):
      return capture_.position();
    case word(words::kControl):
      return control_ | channel_control::kEquWrite.at(now < equ_write_until_);
    case word(words::kCompareIncrement):
      return compare_.inc();
    case word(words::kCompareB):
      return compare_.b();
    default:
      return 0;
  }
}

void ServoChannel::write(Tick now, bool sclk, bool x, unsigned offset, std::uint32_t value, bool trip) {
  const unsigned code = word(x, offset);
  if (code != word(words::kOutA) && code != word(words::kOutB) && code != word(words::kOutC))
    settle_ = 0;  // what is counted of an output are its pulses, which say so themselves
  const std::uint32_t held = trip ? kOutputBits : 0;
  switch (code) {
    case word(words::kTimer1):
      if (fine()) compare_.set_b_fraction(value);
      break;
    case word(words::kTimer2):
      if (fine()) compare_.set_a_fraction(value);
      break;
    case word(words::kOutA):
      if (!trip) out_[0] = value;
      break;
    case word(words::kOutB):
      if (!trip) out_[1] = value;
      break;
    case word(words::kOutC):
      if (!trip) out_[2] = value;
      break;
    case word(words::kCompareA):
      compare_.set_a(value);
      break;
    case word(words::kStatus):
      error_ = sclk && error_now_ && !hold();
      loss_ = (sclk && loss_now_) || (loss_ && status_bits::kEncoderLoss.is_set(value));
      break;
    case word(words::kControl):
      subcount_.advance(now, has_fraction());
      control_ = (control_ & held) | (value & ~held & ~channel_control::kEquWrite.mask());
      if (channel_control::kEquWrite.is_set(value)) {
        equ_write_until_ = next_ref_edge(now);
        compare_.set_equ(channel_control::kEquState.is_set(value));
      }
      break;
    case word(words::kCompareIncrement):
      compare_.set_inc(value);
      break;
    case word(words::kCompareB):
      compare_.set_b(value);
      break;
    default:
      break;
  }
}

void ServoChannel::set_pins(Tick now, unsigned pins) {
  if (pins == input_.pins()) return;
  input_.set_pins(now, pins);
  settle_ = 0;
}

void ServoChannel::latch_phase() {
  counter_.latch_phase();
  for (ChannelAdc& adc : adc_) adc.transfer();
}

void ServoChannel::latch_servo(Tick edge) {
  subcount_.advance(edge - kTicksPerRef, has_fraction());
  counter_.latch_servo();
  servo_fraction_ = fraction();
}

void ServoChannel::sample_adc(unsigned bit, unsigned count, bool a, bool b) {
  adc_[0].sample(bit, count, a);
  adc_[1].sample(bit, count, b);
}

void ServoChannel::sample_adc_stream(unsigned bit, unsigned count, std::uint32_t a, std::uint32_t b) {
  adc_[0].sample_stream(bit, count, a);
  adc_[1].sample_stream(bit, count, b);
}

void ServoChannel::load_dac(bool trip, unsigned cut) {
  for (unsigned i = 0; i < 2; ++i) {
    dac_[i].load(trip ? 0 : out_[i]);
    dac_line_[i] = {dac_line(i, cut), dac_stream(i)};
  }
}

void ServoChannel::change_dac_lines(unsigned unclocked) {
  const std::uint32_t to_go = (1u << unclocked) - 1;
  for (unsigned i = 0; i < 2; ++i) {
    std::uint32_t& line = dac_line_[i].present;
    line = (line & ~to_go) | (dac_stream(i) & to_go);
  }
}

void ServoChannel::load_pwm() {
  for (unsigned i = 0; i < 3; ++i) pwm_[i].load(static_cast<std::int16_t>(out_[i] >> 8));
}

void ServoChannel::run_pwm(Tick now, Tick t, TriangleLine line, unsigned deadtime) const {
  for (ChannelPwm& pwm : pwm_) pwm.run(now, t, line, deadtime);
}

Tick ServoChannel::next_pwm_event(Tick now, TriangleLine line) const {
  Tick next = kNever;
  for (unsigned i = 0; i < 3; ++i)
    if (shows_pwm(i)) next = std::min(next, pwm_[i].next_event(now, line));
  return next;
}

// With inverted outputs both switches of a phase are on in its dead time, and while a trip turns it off.
void ServoChannel::settle_pwm_times(Tick now, bool trip) const {
  for (unsigned i = 0; i < 3; ++i) {
    const Tick balance = pwm_[i].balance(now);
    const std::uint64_t dead_times = pwm_[i].dead_times();
    const Tick more = balance - pwm_settled_[i].balance;
    const std::uint64_t more_dead_times = dead_times - pwm_settled_[i].dead_times;
    pwm_settled_[i] = {balance, dead_times};
    if (!shows_pwm(i) || trip) continue;
    const bool inverted = is(i == 2 ? channel_control::kCInvert : channel_control::kAbInvert);
    pwm_times_.balance[i] += inverted ? -more : more;
    pwm_times_.shorts += inverted ? more_dead_times : 0;
  }
}

unsigned ServoChannel::pwm(bool trip) const {
  unsigned pins = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if (!shows_pwm(i)) continue;
    const unsigned pair = trip ? 0 : pwm_[i].top() | pwm_[i].bot() << 1;
    pins |= (is(i == 2 ? channel_control::kCInvert : channel_control::kAbInvert) ? pair ^ 3 : pair) << (2 * i);
  }
  return pins;
}

ChannelPosition ServoChannel::sclk(Tick edge, const ChannelPosition* channel1) {
  const bool ready = input_.ready();
  const unsigned pins = input_.level();
  const unsigned level = index_.level(pins, is(channel_control::kIndexDemux));
  const bool index = ChannelIndex::index(level, is(channel_control::kGatedIndex), is(channel_control::kGateState));
  subcount_.advance(edge - kTicksPerRef, has_fraction());

  const ChannelDecode::Result d = decode_.step(ready, decode(), hold(), pins & 7, pfm_.event(), pfm_.down());
  pfm_.take_event();
  const ChannelPosition own{counter_.counter(), fine() ? fraction() : 0, still(), d.count, d.down};
  compare_.sclk(is(channel_control::kCompareChannel) && channel1 != nullptr ? *channel1 : own, fine());

  const unsigned old_fraction = fraction();
  const bool reversed = d.down != counter_.down();
  counter_.sclk(d, hold());
  subcount_.sclk(edge, has_fraction(), d.count, reversed, counter_.t1());
  capture_.sclk(edge, ready, index, level, control_, hold() ? 0 : counter_.counter(),
                d.count ? (d.down ? 4095 : 0) : old_fraction);
  error_now_ = d.error;
  error_ = (error_ || error_now_) && !hold();
  loss_now_ = ready && index_.sclk(pins);
  loss_ = loss_ || loss_now_;
  input_.sclk(edge);

  if (settle_ < kSettled) ++settle_;
  if (subcount_.active()) settle_ = 0;
  return own;
}

}  // namespace brick
