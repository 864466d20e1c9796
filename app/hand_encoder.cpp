#include "app/hand_encoder.h"

#include <cstdlib>

namespace brick {

HandEncoder::HandEncoder(unsigned ic, unsigned channel, std::int64_t counts, std::int64_t rate, Tick now)
    : ic_(ic), channel_(channel), left_(std::abs(counts)), total_(left_), rate_(rate), up_(counts > 0), start_(now) {}

// start + edge / rate in whole ticks, without a product that could overflow.
Tick HandEncoder::time_of(std::int64_t edge) const {
  return start_ + edge / rate_ * kPwmClockHz + edge % rate_ * kPwmClockHz / rate_;
}

Tick HandEncoder::end() const { return time_of(total_); }
Tick HandEncoder::next_event() const { return left_ == 0 ? kNever : time_of(total_ - left_ + 1); }

bool HandEncoder::step(Tick now, MotorInputPins& inputs) {
  if (next_event() > now) return false;
  constexpr unsigned kA = 1u << kEncA, kB = 1u << kEncB;
  std::uint16_t& pins = inputs[ic_].pins[channel_];
  // B leads A when the counter is to go up: B changes while A and B are equal, else A.
  const bool equal = ((pins & kA) != 0) == ((pins & kB) != 0);
  pins = static_cast<std::uint16_t>(pins ^ (equal == up_ ? kB : kA));
  --left_;
  return true;
}

std::optional<MotorPlace> motor_place(std::uint32_t fitted, unsigned motor) {
  unsigned first = 1;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if ((fitted >> ic & 1) == 0) continue;
    if (motor >= first && motor < first + kChannels) return MotorPlace{ic, motor - first};
    first += kChannels;
  }
  return std::nullopt;
}

unsigned motor_number(std::uint32_t fitted, unsigned ic, unsigned channel) {
  return kChannels * static_cast<unsigned>(__builtin_popcount(fitted & ((1u << ic) - 1))) + channel + 1;
}

}  // namespace brick
