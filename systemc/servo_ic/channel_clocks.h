// Model of rtl/servo_ic/channel_divider.sv, channel_strobe.sv and channel_clocks.sv: what the four channels share.
// Dividers are closed form; a serial stream is executed bit by bit while it runs and costs nothing afterwards.
// docs/servo_channel.md.
#pragma once

#include <algorithm>
#include <cstdint>

#include "systemc/core/model_block.h"

namespace brick {

// clk_ref / 2^n, free running; a new n is taken at the terminal count.
class ChannelDivider {
 public:
  void reset(Tick t) { *this = {next_ref_edge(t), t, 0}; }

  Tick start() const { return start_; }  // edge that started the present period
  Tick next() const { return next_; }    // and the next one
  Tick mid() const { return start_ + (kTicksPerRef << n_) / 2; }
  bool fast() const { return n_ == 0; }  // the present period is one clk_ref long, without a middle

  // The edge of the k-th start from here.
  Tick after(std::int64_t k, unsigned n) const { return next_ + (k - 1) * (kTicksPerRef << n); }

  // How many periods start up to t, at least the next one; n has not changed since the present one started.
  std::int64_t count(Tick t, unsigned n) const { return ((t - next_) / kTicksPerRef >> n) + 1; }
  bool steady(unsigned n) const { return n_ == n; }
  void take_steadily(Tick t) { take(t, n_); }  // the same with the divider as it is

  // Executes the edges up to t and returns how many of them started a period.
  std::int64_t take(Tick t, unsigned n) {
    if (t < next_) return 0;
    const std::int64_t k = count(t, n);
    start_ = after(k, n);
    next_ = start_ + (kTicksPerRef << n);
    n_ = n;
    return k;
  }

  ChannelDivider() = default;

 private:
  ChannelDivider(Tick next, Tick start, unsigned n) : next_(next), start_(start), n_(n) {}
  Tick next_{}, start_{};
  unsigned n_{};
};

// Common part of a serial stream: 24 bits of a strobe word from the first bit clock not before the rising edge of
// PHASE.
class ChannelStrobe {
 public:
  void reset(Tick t) {
    divider_.reset(t);
    now_ = t;
    pending_ = false;
    asked_ = kNever;
    left_ = 0;
    word_ = 0;
  }

  // From the edge t on, a bit clock that finds no stream under way starts one, unless PHASE has done so.
  void ask(Tick t) { asked_ = t; }

  // Executes the edges up to t; `rise`: PHASE rises at t, the first edge of clk_ref that has not been executed. `load`
  // (with the number of bits that are left out of the stream before) and `sample` (with the number of the first bit and
  // how many bits) are called in the order of their edges.
  template <class Load, class Sample>
  void advance(Tick t, bool rise, unsigned n, std::uint32_t word, Load load, Sample sample) {
    if (idle() && !rise && divider_.steady(n)) {  // the divider is executed when it is looked at
      now_ = t;
      return;
    }
    divider_.take_steadily(now_);
    for (;;) {
      const Tick ce = divider_.next();
      if (left_ != 0 && !divider_.fast() && now_ < divider_.mid() && divider_.mid() <= t) sample(24 - left_, 1u);
      if (ce > t) break;
      if (left_ == 0 && ce >= asked_) pending_ = true;
      if (left_ == 0 && !pending_ && !(rise && ce == t)) {
        divider_.take(std::min(t, asked_ - 1), n);  // nothing to send
        now_ = std::max(now_, ce);
        continue;
      }
      if (!pending_ && !rise && divider_.steady(n)) {  // whole bits at once
        const auto bits = static_cast<unsigned>(std::min<std::int64_t>(left_, divider_.count(t, n)));
        if (divider_.fast())
          sample(24 - left_, bits);
        else
          sample(25 - left_, bits - 1);
        left_ -= bits;
        now_ = divider_.after(bits, n);
        divider_.take(now_, n);
        continue;
      }
      if (divider_.fast() && left_ != 0) sample(24 - left_, 1u);
      if (pending_ || (rise && ce == t)) {
        pending_ = rise = false;
        if (ce >= asked_) asked_ = kNever;
        const unsigned cut = left_ == 0 ? 0 : left_ - 1;
        left_ = 24;
        word_ = word;
        load(cut);
      } else {
        --left_;
      }
      divider_.take(ce, n);
      now_ = ce;
    }
    pending_ |= rise;
    now_ = t;
  }

  bool idle() const { return left_ == 0 && !pending_ && asked_ == kNever; }
  unsigned left() const { return left_; }  // bits to go, the present one included
  std::uint32_t word() const { return word_; }
  Tick end(unsigned n) const { return divider_.after(left_, n); }  // of the last bit, while there are some to go
  // Bits whose rising edge of the clock is not before `now`.
  unsigned unclocked(Tick now) const {
    if (left_ == 0) return 0;
    return left_ - ((divider_.fast() ? now % kTicksPerRef == 2 : now > divider_.mid()) ? 1 : 0);
  }
  bool strobe() const { return word_ >> (left_ != 0 ? left_ - 1 : 0) & 1; }
  bool clk(Tick now) const { return left_ != 0 && (divider_.fast() ? now % kTicksPerRef != 0 : now >= divider_.mid()); }

  // Of the strobe, and where asked of the clock and of the data bits; the divider is `n`.
  Tick next_event(Tick now, unsigned n, bool clock, bool data) const {
    const Tick load = asked_ == kNever ? kNever : std::max(now + 1, asked_);
    if (left_ == 0) return pending_ ? divider_.next() : load;
    if (clock && divider_.fast()) return now + (now % kTicksPerRef == 1 ? 2 : 1);
    if (clock && now < divider_.mid()) return divider_.mid();
    if (clock || data || pending_) return divider_.next();
    const std::uint32_t to_go = (1u << (left_ - 1)) - 1, other = (strobe() ? ~word_ : word_) & to_go;
    if (other == 0) return load;
    const unsigned highest = 31 - static_cast<unsigned>(__builtin_clz(other));
    return std::min(load, divider_.after(left_ - 1 - highest, n));
  }

 private:
  ChannelDivider divider_;
  Tick now_{};
  bool pending_{};
  Tick asked_{};
  unsigned left_{};
  std::uint32_t word_{};
};

}  // namespace brick
