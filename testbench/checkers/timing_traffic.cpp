#include "testbench/checkers/timing_traffic.h"

#include <numeric>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {

constexpr std::uint32_t kAllBits = 0xFFFFFF, kMostWaitStates = 0x1FFFFF;
constexpr unsigned kResetMultiplier = 8, kFastest = 32;
constexpr unsigned kTickMultiplier = 12;  // a CPU clock is a tick
constexpr unsigned kAccessesPerPhase = 6, kLongestIdle = 4;
constexpr Tick kAdvance = 48;
constexpr unsigned kFirstMacroIc = 18;

// Lowest fitted IC: servo ICs 0..9 and 2*..9*, then MACRO ICs (host-bus:1/5, host-bus:1/6).
std::uint32_t gate_ic_base(unsigned ic) {
  constexpr std::uint32_t kServo[] = {0x078000, 0x078100, 0x078200, 0x078300, 0x079200,
                                      0x079300, 0x07A200, 0x07A300, 0x07B200, 0x07B300};
  constexpr std::uint32_t kMacro[] = {0x078400, 0x079400, 0x07A400, 0x07B400};
  if (ic < 10) return kServo[ic];
  return ic < kFirstMacroIc ? kServo[ic - 8] + 0x20 : kMacro[ic - kFirstMacroIc];
}

}  // namespace

BusTraffic::BusTraffic(Machine& machine, std::uint64_t seed) : machine_(machine), random_(seed) {
  machine_.attach_bus_master(this);
  const std::uint32_t fitted = machine_.fitted();
  if (fitted != 0) {
    const unsigned ic = static_cast<unsigned>(__builtin_ctz(fitted));
    const std::uint32_t base = gate_ic_base(ic);
    if (ic < kFirstMacroIc)  // words that the hardware leaves alone: increment of the compare position of each channel
      for (unsigned channel = 0; channel < 4; ++channel)
        words_[Region::kGateIcs].push_back({true, base + 8 * channel + 6});
    else  // ADC strobe and node activation
      words_[Region::kGateIcs] = {{true, base + 0x0E}, {false, base + 0x0F}};
  }
  for (unsigned i = 0; i < 6; ++i) words_[Region::kDpram].push_back({i % 2 != 0, 0x060C00 + i / 2});
  words_[Region::kDefaultArea] = {{true, 0x070010}, {true, 0x070011}};
  set_clock(kResetMultiplier);
  control(regs::cpu_bus::kBcr.address, kMostWaitStates);
  for (auto& region : words_) {
    read_.clear();
    for (const Word& w : region)
      for (const std::uint32_t value : {0u, kAllBits}) {
        queue_.push_back({{w.x, w.address, true, value, kLongestIdle}});
        queue_.push_back({{w.x, w.address, false, 0, kLongestIdle}});
      }
    finish();
    for (std::size_t i = 0; i < region.size(); ++i) region[i].mask = region[i].value = read_[2 * i + 1] & ~read_[2 * i];
  }
}

BusTraffic::~BusTraffic() { machine_.attach_bus_master(nullptr); }

std::optional<BusMaster::Access> BusTraffic::next() {
  if (under_way_ == queue_.size()) return std::nullopt;
  return queue_[under_way_++];
}

void BusTraffic::done(const Access& access, std::uint32_t data) {
  const Queued& made = queue_.front();
  if (made.judged && (data & made.mask) != made.value) ++wrong_reads_;
  queue_.pop_front();
  --under_way_;
  if (!access.write) read_.push_back(data);
}

void BusTraffic::finish(const std::function<void()>& meanwhile) {
  while (!queue_.empty()) {
    if (meanwhile) meanwhile();
    machine_.run_until(machine_.now() + kAdvance);
  }
}

void BusTraffic::control(std::uint32_t address, std::uint32_t value) {
  queue_.push_back({{true, address, true, value, 0}});
}

void BusTraffic::set_clock(unsigned multiplier) {
  multiplier_ = multiplier;
  control(regs::cpu_bus::kPctl.address, multiplier - 1);
}

void BusTraffic::set_wait_states(Region region, unsigned ws) {
  using namespace regs::cpu_bus::bcr;
  const regs::Field field = region == Region::kGateIcs ? kBa1w : region == Region::kDpram ? kBa2w : kBdfw;
  control(regs::cpu_bus::kBcr.address, (kMostWaitStates & ~field.mask()) | ws << field.lsb);
}

// A new clock begins with an edge of the board's: a few periods of the fastest one move that edge.
void BusTraffic::another_phase() {
  control(regs::cpu_bus::kPctl.address, kFastest - 1);
  queue_.push_back({{true, regs::cpu_bus::kPctl.address, false, 0, draw(3 * kFastest)}});
  control(regs::cpu_bus::kPctl.address, multiplier_ - 1);
}

BusTraffic::Queued BusTraffic::access(Word& w, bool write, std::uint32_t value) {
  Queued a{{w.x, w.address, write, value, 0}};
  if (write) {
    w.value = value & w.mask;
  } else {
    a.judged = true;
    a.mask = w.mask;
    a.value = w.value;
  }
  return a;
}

void BusTraffic::exercise(Region region, unsigned count, const std::function<void()>& meanwhile) {
  auto& words = words_[region];
  for (unsigned i = 0; i < count && !words.empty(); ++i) {
    if (i % kAccessesPerPhase == 0) another_phase();
    Word& w = words[draw(static_cast<std::uint32_t>(words.size()))];
    const bool write = i < 2 ? i == 0 : draw(2) != 0;  // both, however few
    const std::uint32_t value = static_cast<std::uint32_t>(random_()) & kAllBits;
    queue_.push_back(access(w, write, value));
    queue_.back().idle = draw(2) != 0 ? 0 : draw(kLongestIdle);
  }
  finish(meanwhile);
}

// The clock begins anew at each edge of clk_pwm in a period of clk_ref; from there its clocks have as many phases as
// its multiplier and the four quarters of a clock leave. Each write turns all bits over and is read before the next one
// of its word, so one that is lost shows.
unsigned BusTraffic::every_phase(Region region) {
  constexpr bool kWrite = true, kRead = false;
  constexpr std::array<std::pair<bool, bool>, 5> kPairs{
      {{kWrite, kRead}, {kRead, kWrite}, {kRead, kRead}, {kWrite, kWrite}, {kRead, kRead}}};
  const unsigned slots = multiplier_ / std::gcd(multiplier_, 4u);
  auto& words = words_[region];
  std::size_t word = 0;
  unsigned made = 0;
  const auto pair = [&](std::pair<bool, bool> writes, unsigned slot, bool early, bool moving_ta) {
    Word &first = words[word], &second = words[(word + (writes.first == writes.second ? 1 : 0)) % words.size()];
    for (const bool behind : {false, true}) {
      Word& w = behind ? second : first;
      queue_.push_back(access(w, behind ? writes.second : writes.first, ~w.value & kAllBits));
      Queued& a = queue_.back();
      a.early = early;
      a.moving_ta = moving_ta;
      if (!behind) a.slot = slot, a.slots = slots;
      ++made;
    }
  };
  for (unsigned edge = 0; edge < kTicksPerRef; ++edge) {
    control(regs::cpu_bus::kPctl.address, kTickMultiplier - 1);
    control(regs::cpu_bus::kPctl.address, multiplier_ - 1);
    queue_.back().slot = edge;
    queue_.back().slots = kTicksPerRef;
    for (unsigned slot = 0; slot < slots; ++slot)
      for (const bool moving_ta : {false, true}) {
        if (moving_ta && region != Region::kDpram) continue;
        for (const bool early : {false, true}) {
          for (const auto& writes : kPairs) pair(writes, slot, early, moving_ta);
          word = (word + 1) % words.size();
        }
      }
  }
  finish();
  return made;
}

void BusTraffic::share(unsigned count, const std::function<void()>& meanwhile) {
  for (unsigned i = 0; i < count; ++i)
    queue_.push_back({{false, kSharedAddress, draw(2) != 0, i, draw(i == 0 ? 16 * kLongestIdle : kLongestIdle)}});
  finish(meanwhile);
}

std::string BusTraffic::verify(Region region) {
  auto& words = words_[region];
  control(regs::cpu_bus::kBcr.address, kMostWaitStates);
  control(regs::cpu_bus::kPctl.address, kResetMultiplier - 1);
  finish();
  read_.clear();
  for (const Word& w : words) queue_.push_back({{w.x, w.address, false, 0, kLongestIdle}});
  finish();
  wrong_reads_ = 0;
  std::string problem;
  for (std::size_t i = 0; i < words.size(); ++i) {
    Word& w = words[i];
    const std::uint32_t holds = read_[i] & w.mask;
    if (holds != w.value && problem.empty())
      problem = fmt::format("{}:${:06X} holds ${:06X}, expected ${:06X}", w.x ? 'X' : 'Y', w.address, holds, w.value);
    w.value = holds;  // what comes next starts from there
  }
  return problem;
}

}  // namespace brick
