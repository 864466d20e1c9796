#include "systemc/servo_ic/servo_channel.h"

#include <algorithm>

namespace brick {

void ServoChannel::reset(Tick t) {
  ChannelInput input = input_;
  input.reset(t);
  *this = ServoChannel{};
  input_ = input;
  subcount_.reset(t);
  for (ChannelPwm& pwm : pwm_) pwm.reset(t);
}

std::uint32_t ServoChannel::status(bool trip) const {
  const unsigned level = index_.level(input_.level(), is(channel_control::kIndexDemux));
  return level << 12 | capture_.captured() << 11 | capture_.captured_gi() << 10 | equ(trip) << 9 | error_ << 8 |
         loss_ << 7 | index_.incomplete() << 3 | capture_.hall();
}

std::uint32_t ServoChannel::read(Tick now, bool x, unsigned offset, bool trip) const {
  switch ((x ? 8 : 0) + offset) {
    case 0:
      return fine() ? capture_.fraction() << 12 | compare_.b_fraction() : counter_.servo_t1();
    case 1:
      return fine() ? servo_fraction_ << 12 | compare_.a_fraction() : counter_.servo_t2();
    case 2:
    case 3:
    case 4:
      return out_[offset - 2];
    case 5:
    case 6:
      return adc_[offset - 5].value();
    case 7:
      return compare_.a();
    case 8:
      return status(trip);
    case 9:
      return counter_.phase_pos();
    case 10:
      return counter_.servo_pos();
    case 11:
      return capture_.position();
    case 13:
      return control_ | (now < equ_write_until_ ? channel_control::kEquWrite.mask() : 0u);
    case 14:
      return compare_.inc();
    case 15:
      return compare_.b();
    default:
      return 0;
  }
}

void ServoChannel::write(Tick now, bool x, unsigned offset, std::uint32_t value, bool trip) {
  settle_ = 0;
  switch ((x ? 8 : 0) + offset) {
    case 0:
      if (fine()) compare_.set_b_fraction(value);
      break;
    case 1:
      if (fine()) compare_.set_a_fraction(value);
      break;
    case 2:
    case 3:
    case 4:
      if (!trip) out_[offset - 2] = value;
      break;
    case 7:
      compare_.set_a(value);
      break;
    case 8:
      error_ = false;
      loss_ = loss_ && (value >> 7 & 1) != 0;
      break;
    case 13:
      subcount_.advance(now, fine());
      control_ = value & ~channel_control::kEquWrite.mask();
      if (channel_control::kEquWrite.get(value) != 0) {
        equ_write_until_ = next_ref_edge(now);
        compare_.set_equ(channel_control::kEquState.get(value) != 0);
      }
      break;
    case 14:
      compare_.set_inc(value);
      break;
    case 15:
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
  subcount_.advance(edge - kTicksPerRef, fine());
  counter_.latch_servo();
  servo_fraction_ = fraction();
}

void ServoChannel::sample_adc(unsigned bit, unsigned count, bool a, bool b) {
  adc_[0].sample(bit, count, a);
  adc_[1].sample(bit, count, b);
}

void ServoChannel::load_dac(bool trip) {
  dac_[0].load(trip ? 0 : out_[0]);
  dac_[1].load(trip ? 0 : out_[1]);
}

void ServoChannel::load_pwm() {
  for (unsigned i = 0; i < 3; ++i) pwm_[i].load(static_cast<std::int16_t>(out_[i] >> 8));
}

void ServoChannel::run_pwm(Tick now, Tick t, TriangleLine line, unsigned deadtime) {
  for (ChannelPwm& pwm : pwm_) pwm.run(now, t, line, deadtime);
}

Tick ServoChannel::next_pwm_event(Tick now, TriangleLine line) const {
  Tick next = kNever;
  for (unsigned i = 0; i < 3; ++i)
    if (shows_pwm(i)) next = std::min(next, pwm_[i].next_event(now, line));
  return next;
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
  subcount_.advance(edge - kTicksPerRef, fine());

  const ChannelDecode::Result d = decode_.step(ready, control_ & 0xF, hold(), pins & 7, pfm_.event(), pfm_.down());
  pfm_.take_event();
  const ChannelPosition own{counter_.counter(), fine() ? fraction() : 0, hold(), d.count, d.down};
  compare_.sclk(is(channel_control::kCompareChannel) && channel1 != nullptr ? *channel1 : own, fine(),
                is(channel_control::kCompareChannel));

  const unsigned old_fraction = fraction();
  const bool reversed = d.down != counter_.down();
  counter_.sclk(d, hold());
  subcount_.sclk(edge, fine(), d.count, d.echo, reversed, counter_.t1() & 0x7FFFFF);
  capture_.sclk(edge, ready, index, level, control_, hold() ? 0 : counter_.counter(),
                d.count ? (d.down ? 4095 : 0) : old_fraction);
  error_ = (error_ || d.error) && !hold();
  if (ready && index_.sclk(pins)) loss_ = true;
  input_.sclk(edge);

  if (settle_ < kSettled) ++settle_;
  if (subcount_.active()) settle_ = 0;
  return own;
}

}  // namespace brick
