// Model of rtl/servo_ic/channel_counter.sv: position counter, 1/T timers, latches of the phase and servo clocks.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/servo_ic/channel_decode.h"

namespace brick {

class ChannelCounter {
 public:
  std::uint32_t counter() const { return counter_; }
  bool down() const { return down_; }  // direction of the last count
  std::uint32_t t1() const { return regs::servo_channel::timer1::kT1.get(t1_); }
  std::uint32_t phase_pos() const { return phase_pos_; }
  std::uint32_t servo_pos() const { return servo_pos_; }
  std::uint32_t servo_t1() const { return servo_t1_; }
  std::uint32_t servo_t2() const { return servo_t2_; }

  void clear() { counter_ = 0; }  // an edge of clk_ref with the counter held
  void skip(std::int64_t periods) {
    t2_ = static_cast<std::uint32_t>(std::min<std::int64_t>(kTimerMax, t2_ + periods));
  }
  void sclk(const ChannelDecode::Result& d, bool hold) {
    const std::uint32_t t2 = t2_;
    skip(1);
    if (d.count) {
      t1_ = regs::servo_channel::timer1::kReversed.set(t2_, d.down != down_);
      t2_ = 0;
      down_ = d.down;
      if (!hold) counter_ = (counter_ + (d.down ? 0xFFFFFFu : 1u)) & 0xFFFFFF;
    }
    if (d.echo) t1_ = t2;
    if (d.mark) t2_ = 0;
  }
  void latch_phase() { phase_pos_ = counter_; }
  void latch_servo() {
    namespace field = regs::servo_channel::servo_position;
    servo_pos_ = field::kPosition.at(counter_) | field::kDown.at(down_);
    servo_t1_ = t1_;
    servo_t2_ = t2_;
  }

 private:
  static constexpr std::int64_t kTimerMax = regs::servo_channel::timer2::kT2.mask();
  std::uint32_t counter_ = 0, t1_ = 0, t2_ = 0;
  std::uint32_t phase_pos_ = 0, servo_pos_ = 0, servo_t1_ = 0, servo_t2_ = 0;
  bool down_ = false;
};

}  // namespace brick
