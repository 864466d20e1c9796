#include "testbench/checkers/port_a_drive.h"

#include <fmt/format.h>

#include "rtl/pins/board_pins.hpp"

namespace brick {

namespace {

constexpr Tick kNear = 3;

// The first edge that finds /RD low is `first`. Registers: three more for the count, then the edge of clk_ref that
// takes the address, and the next one, which takes the sample (host-bus:2.6/3). The RAM: the second edge after it
// (host-bus:6.9/8).
Tick drives_from(PortADrive::Cycle of, Tick first) {
  if (of == PortADrive::kOther) return kNever;
  if (of == PortADrive::kRam) return first + 2;
  const Tick taken = (first + 3 + kTicksPerRef - 1) / kTicksPerRef * kTicksPerRef;
  return taken + kTicksPerRef;
}

}  // namespace

void PortADrive::lines(Tick now, const PortAPins& pins, const BoardOutputs& at_once) {
  missing(now);
  const bool low[2] = {!pins.pa_rd_n, !pins.pa_wr_n};
  for (const bool write : {false, true}) {
    if (low[write] && !low_[write]) {
      auto& next = write ? writes_ : reads_;
      of_[write] = next.front();
      next.pop_front();
      first_low_[write] = now + 1;
      if (!write) on_ = drives_from(of_[0], now + 1);
      met_ += of_[write] == kOther && now - off_ <= kNear ? 1 : 0;
    }
    if (!write && !low[0] && low_[0] && due(now)) {
      off_ = now;
      ++driven_[of_[0]];
    }
    low_[write] = low[write];
  }
  judge(now, at_once);
}

// host-bus:6.9/8: where another device's write has fallen three edges before /RD or less, the RAM may look at that
// first.
Tick PortADrive::late() const {
  return of_[0] == kRam && of_[1] == kOther && first_low_[0] - first_low_[1] <= 3 ? 2 : 0;
}

void PortADrive::edge(Tick tick, const BoardOutputs& shown) {
  missing(tick - 1);
  judge(tick, shown);
}

// Nothing has moved up to `now` since the last look.
void PortADrive::missing(Tick now) {
  if (drives_ || !due(now - late()) || told_) return;
  fault(now, "not driven in a read of its own");
  told_ = true;
}

void PortADrive::judge(Tick now, const BoardOutputs& shown) {
  const bool drives = shown.get(pin::kPaDataOe) != 0, due_now = due(now);
  const bool must = due_now && (drives_ || due(now - late()));
  const std::uint32_t word = shown.get(pin::kPaData);
  if (drives && !due_now) fault(now, fmt::format("driven {}", where()));
  if (!drives && must && !told_) fault(now, "not driven in a read of its own");
  if (drives && due_now && drives_ && word != word_) fault(now, "a word that moves");
  word_ = word;
  told_ = must && !drives;
  drives_ = drives && due_now;
}

std::string PortADrive::where() const {
  static constexpr const char* kNames[] = {"another device", "a register", "the RAM"};
  for (const bool write : {true, false})
    if (low_[write])
      return fmt::format("{} a {} of {}", !write && of_[0] != kOther ? "too early in" : "in", write ? "write" : "read",
                         kNames[of_[write]]);
  return "behind /RD";
}

void PortADrive::fault(Tick now, const std::string& what) {
  if (faults_++ == 0) first_ = fmt::format("{} at tick {}", what, now);
  ++kinds_[what];
}

std::string PortADrive::text() const {
  std::string text = first_.empty() ? "" : "first " + first_;
  for (const auto& [what, times] : kinds_) text += fmt::format("; {} {} times", what, times);
  return text;
}

}  // namespace brick
