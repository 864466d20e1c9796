#include "testbench/plant/ssi_encoder.h"

namespace brick::plant {

namespace {
// A clock that rests for longer than this many of its low times begins a new word.
constexpr Tick kPause = 4;
}  // namespace

void SsiEncoder::hold(std::uint64_t position) {
  held_ = par_.bits >= 64 ? position : position & ((std::uint64_t{1} << par_.bits) - 1);
  word_ = par_.gray ? held_ ^ held_ >> 1 : held_;
  if (par_.parity != SsiEncoderParameters::Parity::kNone) {
    const bool odd = __builtin_parityll(word_) != 0;
    word_ = word_ << 1 | (odd == (par_.parity == SsiEncoderParameters::Parity::kEven) ? 1 : 0);
  }
  spoilt_ = par_.error_every > 0 && random_.below(par_.error_every) == 0;
  if (spoilt_) word_ ^= std::uint64_t{1} << random_.below(length());
}

void SsiEncoder::show(Tick t, bool level) {
  if (!par_.missing) changes_.emplace_back(t + par_.delay, level);
}

void SsiEncoder::clock(Tick t, bool level, std::uint64_t position) {
  const Tick rested = t - last_;
  last_ = t;
  if (!level) {
    const bool over = rested > par_.monoflop;
    if (over) hold(position);
    if (over || rested > kPause * low_) sent_ = 0;
    // The data line has risen with the end of the monoflop and stays up till the first bit.
    while (!changes_.empty() && changes_.back().first > t + par_.delay) changes_.pop_back();
    return;
  }
  low_ = rested;
  ++sent_;
  show(t, sent_ <= length() && (word_ >> (length() - sent_) & 1) != 0);
  // If this was the last edge, the monoflop ends and lets the line up.
  show(t + par_.monoflop, true);
}

bool SsiEncoder::level(Tick t) {
  while (!changes_.empty() && changes_.front().first <= t) {
    level_ = changes_.front().second;
    changes_.pop_front();
  }
  return level_;
}

}  // namespace brick::plant
