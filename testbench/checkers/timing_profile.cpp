#include "testbench/checkers/timing_profile.h"

#include <algorithm>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/machine/machine.h"

namespace brick {

namespace {

constexpr TimeFs kLongestPulse = 50'000 * kFsPerNs;  // host-bus:5.7/6
constexpr unsigned kRealTimeTask = 1;
constexpr std::uint32_t kCarriageReturn = 0x0D;

constexpr BoardOutputs kLines = select_pins(pin::kIpos, pin::kBreq, pin::kEror, pin::kF1er, pin::kHreq);
constexpr BoardOutputs kMask = select_pins(pin::kPicMsk, pin::kPicElr);

}  // namespace

void TimingProfile::Span::enter(TimeFs length, TimeFs end) {
  least = count == 0 ? length : std::min(least, length);
  if (count == 0 || length > most) {
    most = length;
    most_at = end;
  }
  ++count;
}

TimingProfile::TimingProfile(Machine& machine) : machine_(machine) {
  machine.on_outputs = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    outputs(t, before, after);
  };
  machine.on_task = [this](TimeFs time) {
    const unsigned task = machine_.task();
    if (task == kRealTimeTask && task_ < kRealTimeTask) real_time_ = time;
    task_ = task;
  };
}

TimingProfile::~TimingProfile() {
  machine_.on_outputs = nullptr;
  machine_.on_task = nullptr;
}

void TimingProfile::cycle(const PortACycle& c) {
  if (c.on_chip) {
    if (!c.write && c.address == regs::hi08::kHorx.address && c.data == kCarriageReturn) line_end_ = c.data_time;
    return;
  }
  const unsigned task = c.pc == 0 ? kBench : machine_.task();
  for (Load* load : {&tasks_[task], &by_pc_[{task, c.pc}]}) {
    ++load->cycles;
    load->time += c.end - c.start;
  }
}

std::map<std::pair<unsigned, std::string>, TimingProfile::Load> TimingProfile::functions() const {
  std::map<std::pair<unsigned, std::string>, Load> sum;
  for (const auto& [key, load] : by_pc_) {
    Load& entry = sum[{key.first, machine_.function_at(key.second)}];
    entry.cycles += load.cycles;
    entry.time += load.time;
  }
  return sum;
}

void TimingProfile::outputs(Tick tick, const BoardOutputs& before, const BoardOutputs& after) {
  const auto rose = [&](const PinField& f) { return before.get(f) == 0 && after.get(f) != 0; };
  const TimeFs now = tick_to_fs(tick);
  if (before.get(pin::kBreq) != after.get(pin::kBreq)) breq_edge(now, after.get(pin::kBreq) != 0);
  if (before.differs(after, kMask)) line_rose_.reset();
  if (rose(pin::kIsaIrq) && line_rose_) interrupt_.enter(now - *line_rose_, now);
  if (rose(pin::kIsaIrq)) line_rose_.reset();
  if (!before.differs(after, kLines)) return;
  // The lines that no board file moves (host-bus:4.2).
  const std::pair<const PinField*, unsigned> lines[] = {
      {&pin::kIpos, 0}, {&pin::kBreq, 1}, {&pin::kEror, 2}, {&pin::kF1er, 3}, {&pin::kHreq, 4}};
  for (const auto& [line, bit] : lines)
    if (rose(*line) && (after.get(pin::kPicMsk) >> bit & 1) != 0 && after.get(pin::kIsaIrq) == 0) line_rose_ = now;
}

void TimingProfile::breq_edge(TimeFs now, bool level) {
  if (!level) {
    fell_ = now;
    fell_for_ = line_end_;
    line_end_.reset();
    return;
  }
  // A pulse falls and rises for one line. With another line before the rise it was `&n` that moved the pin, and a long
  // low within one line is either one that selects and clears or a pulse that breaks its bound.
  if (machine_.task() == kRealTimeTask) {
    rise_.enter(now - real_time_, now);
  } else if (fell_ && fell_for_ && !line_end_) {
    const TimeFs low = now - *fell_;
    if (low <= kLongestPulse) fall_.enter(*fell_ - *fell_for_, *fell_);
    (low <= kLongestPulse ? pulse_ : longer_).enter(low, now);
  }
  fell_.reset();
  line_end_.reset();
}

}  // namespace brick
