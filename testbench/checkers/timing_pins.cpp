#include "testbench/checkers/timing_pins.h"

#include <algorithm>

#include "testbench/checkers/timing_port_a.h"

namespace brick {

namespace {

constexpr TimeFs kReadSetUp = 5 * kFsPerNs;  // rows 104, 105: what the CPU leaves itself before /RD rises
constexpr TimeFs kTaSetUp = 2 * kFsPerNs;    // row 118, before a quarter of TC

}  // namespace

void PinWatch::cpu_moved(TimeFs time, const PortALevels& levels) {
  const PortALevels was = cpu_;
  cpu_ = levels;
  if (!levels.same_address(was)) {
    address_time_ = time;
    if (state_ == State::kIdle) {
      seen_.front() = seen_.back();
      seen_.front().time = time;
      seen_.resize(1);
    } else if (!ended_) {
      ended_ = true;
      cycle_.end = time;
      cycle_.address_moved = state_ == State::kLow;
    }
  }
  if (!levels.same_data(was)) {
    data_time_ = time;
    cpu_drives_.set(levels.data_oe, time);
    if (state_ == State::kHigh && cycle_.write && !data_moved_) {
      data_moved_ = true;
      cycle_.data_held = time;
    }
  }
  if (levels.rd_n && !was.rd_n) rd_high_ = time;
  const bool fell = (was.rd_n && !levels.rd_n) || (was.wr_n && !levels.wr_n);
  if (fell && state_ == State::kLow) {
    cycle_.both_strobes = true;
  } else if (fell) {
    if (state_ == State::kHigh) finish(time);
    begin(time);
  } else if (state_ == State::kLow && (cycle_.write ? levels.wr_n : levels.rd_n)) {
    strobe_ended(time);
  }
  if (state_ == State::kHigh && ended_ && !(cycle_.write && levels.data_oe)) finish(time);
}

void PinWatch::board_moved(TimeFs time, const BoardOutputs& board) {
  const Board now{time, board.get(pin::kPaData), board.get(pin::kPaDataOe) != 0, board.get(pin::kPaTaN) != 0};
  const Board& was = seen_.back();
  if (now.data == was.data && now.driven == was.driven && now.busy == was.busy) return;
  if (now.driven != was.driven && cpu_.rd_n)
    drives_outside_ = drives_outside_ || now.driven || time - rd_high_ > pin_delay_;
  board_drives_.set(now.driven, now.time);
  if (state_ == State::kIdle)
    seen_.assign(1, now);
  else
    seen_.push_back(now);
}

void PinWatch::bus_reset() {
  state_ = State::kIdle;
  cpu_ = {};
  cpu_drives_ = {};
  rd_high_ = kReset;
  drives_outside_ = false;
  seen_.erase(seen_.begin(), seen_.end() - 1);
}

void PinWatch::begin(TimeFs time) {
  state_ = State::kLow;
  ended_ = data_moved_ = false;
  cycle_ = {};
  cycle_.address = cpu_.addr;
  cycle_.x = cpu_.x;
  cycle_.aa = cpu_.aa;
  cycle_.write = !cpu_.wr_n;
  cycle_.both_strobes = !cpu_.wr_n && !cpu_.rd_n;
  cycle_.pc = cpu_.pc;
  cycle_.multiplier = cpu_.multiplier;
  cycle_.wait_states = cpu_.wait_states;
  cycle_.start = cpu_.addr_oe ? address_time_ : time;
  cycle_.strobe_low = time;
}

void PinWatch::strobe_ended(TimeFs time) {
  state_ = State::kHigh;
  cycle_.strobe_high = time;
  seen_high_ = seen_.size();
  if (!cycle_.write) return;
  cycle_.data = cpu_.data;
  cycle_.data_on = cpu_drives_.on;
  cycle_.data_valid = cpu_.data_oe ? data_time_ : time;
}

void PinWatch::finish(TimeFs time) {
  state_ = State::kIdle;
  if (!ended_) cycle_.end = time;
  if (cycle_.write) {
    if (!data_moved_) cycle_.data_held = time;
    cycle_.data_off = cpu_drives_.end(time);
  } else {
    read_data();
  }
  cycle_.drives_outside =
      drives_outside_ || (seen_.back().driven && (cycle_.write || time > cycle_.strobe_high + pin_delay_));
  drives_outside_ = false;
  acknowledge();
  turnaround(time);
  seen_.erase(seen_.begin(), seen_.end() - 1);
  if (on_cycle) on_cycle(cycle_);
}

std::size_t PinWatch::seen_at(TimeFs time) const {
  std::size_t i = seen_high_ - 1;
  while (i > 0 && seen_[i].time > time) --i;
  return i;
}

void PinWatch::read_data() {
  PinCycle& c = cycle_;
  const auto moved = [&](std::size_t i) {
    return seen_[i].data != seen_[i - 1].data || seen_[i].driven != seen_[i - 1].driven;
  };
  c.data_valid = c.start;
  const TimeFs sample = std::max(c.strobe_high - kReadSetUp, c.strobe_low);
  for (std::size_t i = 1; i < seen_high_; ++i) {
    if (!moved(i)) continue;
    if (seen_[i].driven) c.data_valid = seen_[i].time;
    c.data_lost = !seen_[i].driven;
    c.data_held = seen_[i].time;
    c.corrupted = c.corrupted || seen_[i].time > sample;
  }
  const Board& last = seen_[seen_high_ - 1];
  c.data = last.data;
  c.corrupted = c.corrupted || !last.driven;
  if (c.data_lost) return;
  if (!last.driven) c.data_valid = c.strobe_high;  // never there
  c.data_held = c.end;
  for (std::size_t i = seen_.size() - 1; i >= seen_high_; --i)
    if (moved(i)) c.data_held = seen_[i].time;
}

// How long the strobe was, how long /TA wanted it, and how each look at a moving /TA fell out.
void PinWatch::acknowledge() {
  PinCycle& c = cycle_;
  c.ta_moved = c.start;
  c.ta_held = c.end;
  c.ta_high = seen_[seen_high_ - 1].busy;
  for (std::size_t i = 1; i < seen_high_; ++i)
    if (seen_[i].busy != seen_[i - 1].busy) c.ta_moved = seen_[i].time;
  for (std::size_t i = seen_.size() - 1; i >= seen_high_; --i)
    if (seen_[i].busy != seen_[i - 1].busy) c.ta_held = seen_[i].time;
  if (c.wait_states == 0) return;
  const auto quarters = [&](std::int64_t count) { return PortATiming::quarters(count, c.multiplier); };
  const auto ws = static_cast<std::int64_t>(c.wait_states);
  const std::int64_t nominal = c.write ? 4 * ws + (ws <= 1 ? 2 : ws <= 3 ? 0 : -2) : 4 * ws + 1;  // rows 102, 116
  const TimeFs more = c.strobe_high - c.strobe_low - quarters(nominal);
  if (more > 0) c.stretched = static_cast<unsigned>((more + quarters(2)) / quarters(4));
  bool asking = true;
  for (unsigned k = 0; k <= c.stretched; ++k) {
    const bool ends = k == c.stretched;
    const TimeFs end = ends ? c.strobe_high : c.strobe_low + quarters(nominal + 4 * static_cast<std::int64_t>(k));
    const std::size_t first =
                          seen_at(c.strobe_low + quarters(nominal + 4 * static_cast<std::int64_t>(k) - 1) - kTaSetUp),
                      last = seen_at(end);
    bool moved = false;
    for (std::size_t i = first + 1; i <= last; ++i) moved = moved || seen_[i].busy != seen_[i - 1].busy;
    if (moved) ++(seen_[last].busy != ends ? c.ta_seen : c.ta_missed);
    asking = asking && !moved && seen_[first].busy;
    if (asking) c.asked = k + 1;
  }
}

void PinWatch::turnaround(TimeFs time) {
  if (!cpu_drives_.ever || !board_drives_.ever) return;
  if ((cycle_.write ? cpu_drives_ : board_drives_).on < cycle_.start) return;  // none of this cycle
  cycle_.turnaround =
      std::max(cpu_drives_.on, board_drives_.on) - std::min(cpu_drives_.end(time), board_drives_.end(time));
  cycle_.cpu_followed = cpu_drives_.on > board_drives_.on;
}

}  // namespace brick
