#include "testbench/checkers/channel_scoreboard.h"

#include <algorithm>
#include <utility>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {
constexpr unsigned kSettle = 8;  // SCLK periods after which a quiet channel stays as it is
}

std::int64_t ChannelScoreboard::index(Tick tick) const {
  const Tick since = tick - phase_;
  return since >= 0 ? since / period_ : -((-since + period_ - 1) / period_);
}

void ChannelScoreboard::synchronise(Tick edge, Tick period, Tick now) {
  phase_ = edge % period;
  period_ = period;
  next_ = index(now);
  busy_ = kSettle;
  decoder.clear_timing();
}

void ChannelScoreboard::follow(Tick tick, std::uint32_t from, int direction) {
  if (compare.count(from, direction)) equs.push_back({tick, compare.equ ? 1 : 0});
}

void ChannelScoreboard::edge(std::int64_t k) {
  const Tick tick = phase_ + k * period_;
  const std::uint32_t before = decoder.raw();
  int moved = decoder.step(k, filter.level());
  while (!pulses_.empty() && pulses_.front().tick < tick) {
    if (decoder.mode == 8) moved = decoder.count(k, pulses_.front().direction);
    pulses_.pop_front();
  }
  if (moved != 0) {
    counts.push_back({tick, decoder.counter()});
    if (own_compare) follow(tick, before, moved);
    if (on_count) on_count(tick, before, moved);
  }
  capture.step(filter.level(), decoder.raw());
  while (!driven_.empty() && driven_.front().tick + kSync <= tick) {
    pins_ = driven_.front().pins;
    driven_.pop_front();
    busy_ = kSettle;
  }
  const std::uint16_t level = filter.level();
  filter.sample(pins_);
  if (keep_levels && filter.level() != level) levels.push_back({tick, filter.level()});
}

void ChannelScoreboard::advance(Tick tick) {
  const std::int64_t end = index(tick);
  while (next_ <= end) {
    if (busy_ == 0 && pulses_.empty()) {  // to the edge that sees the next change
      const std::int64_t wakes = driven_.empty() ? end + 1 : index(driven_.front().tick + kSync - 1) + 1;
      next_ = std::min(std::max(next_, wakes), end + 1);
      if (next_ > end) break;
    }
    if (busy_ > 0) --busy_;
    edge(next_++);
  }
}

std::uint32_t ChannelScoreboard::status(std::uint32_t mask) const {
  using namespace regs::servo_channel::status;
  std::uint32_t bits = std::uint32_t{capture.shown(filter.level())} << kCha.lsb;
  bits = kHallCapture.set(bits, capture.hall());
  for (const auto& [field, set] :
       {std::pair{kDemuxInvalid, capture.incomplete()}, std::pair{kEncoderError, decoder.error()},
        std::pair{kEqu, compare.equ}, std::pair{kCapturedGatedIndex, capture.gated_index()},
        std::pair{kCaptured, capture.captured()}})
    bits = field.set(bits, set ? 1 : 0);
  return bits & mask;
}

}  // namespace brick
