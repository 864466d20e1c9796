// Port A bus master: decoding, the edges of a cycle one after the other, wait states and /TA, see port_a_master.h.
#include "systemc/cpu/port_a_master.h"

#include <algorithm>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {

constexpr std::uint32_t kWordMask = 0xFFFFFF;
// Areas by their select lines. AA3 would select flash and battery RAM, which are not on this bus: BA3W is storage.
constexpr unsigned kDefaultArea = 3;
constexpr unsigned kOnChipWaitStates = 7;

// Regions of docs/architecture.md that lie on Port A; the first three of each area select.
struct Region {
  std::uint32_t base, size;
  unsigned area;
};
constexpr Region kRegions[] = {
    {regs::kDpramBase, regs::kDpramSize, 2},
    {regs::kLatchesBase, regs::kLatchesSize, kDefaultArea},
    {regs::kGateIcsBase, regs::kGateIcsSize, 1},
    {regs::kSsiPageBase, regs::kSsiPageSize, 1},  // where main memory leaves it out
};
constexpr std::uint32_t kOnChipAddressPins = 0x7F;

bool is_on_chip(std::uint32_t address, bool x) { return x && address - regs::kOnChipBase < regs::kOnChipSize; }
const Region* region_of(std::uint32_t address) {
  const auto region = std::find_if(std::begin(kRegions), std::end(kRegions),
                                   [&](const Region& r) { return address - r.base < r.size; });
  return region == std::end(kRegions) ? nullptr : region;
}

}  // namespace

void PortAMaster::reset(Tick edge, std::int64_t cycle, PortAPins& pins) {
  bcr_ = regs::cpu_bus::kBcr.reset;
  pctl_ = regs::cpu_bus::kPctl.reset;
  clock_.restart(edge, cycle, regs::cpu_bus::pctl::kMultiplier.get(pctl_) + 1);
  state_ = State::kIdle;
  stand_ = edge;
  wires_.forget();
  arrive_until(tick_to_fs(edge));  // the rest is on its way still, whoever is reset
  moving_ta_.reset();
  levels_ = {};
  if (watch_ != nullptr) watch_->bus_reset();
  next_start_ = cycle;
  pins.pa_aa = 0;
  pins.pa_int = false;
  pins.pa_rd_n = pins.pa_wr_n = true;
  driven_ = pins;
  const TimeFs now = tick_to_fs(edge);
  show(PortALine::kAa, now, 0);
  show(PortALine::kRdN, now, 1);
  show(PortALine::kWrN, now, 1);
}

bool PortAMaster::forces_wait_states() const {
  using namespace regs::cpu_bus::bcr;
  constexpr std::uint32_t kDevices = kBa1w.mask() | kBa2w.mask() | kBdfw.mask();
  const bool set_up = ((bcr_ ^ regs::cpu_bus::kBcr.reset) & kDevices) != 0 || pctl_ != regs::cpu_bus::kPctl.reset;
  return forced_bcr_ && set_up;
}

unsigned PortAMaster::wait_states(unsigned area) const {
  using namespace regs::cpu_bus::bcr;
  constexpr regs::Field kFields[] = {kBa0w, kBa1w, kBa2w, kBdfw};
  return kFields[area].get(forces_wait_states() ? *forced_bcr_ : bcr_);
}

bool PortAMaster::maps(std::uint32_t address, bool x) {
  return is_on_chip(address, x) || region_of(address) != nullptr;
}

void PortAMaster::begin(const PortAAccess& access) {
  cycle_ = PortACycle{};
  cycle_.on_chip = is_on_chip(access.address, access.x);
  const unsigned area = cycle_.on_chip ? kDefaultArea : region_of(access.address)->area;
  cycle_.address = access.address;
  cycle_.x = access.x;
  cycle_.aa = static_cast<std::uint8_t>(area < kDefaultArea ? 1u << area : 0);
  cycle_.write = access.write;
  cycle_.pc = access.pc;
  cycle_.multiplier = clock_.multiplier();
  // The on-chip peripherals keep their own pace when the core gets faster than 8 x 9.83 MHz.
  cycle_.wait_states = cycle_.on_chip ? std::max(kOnChipWaitStates, clock_.multiplier() - 1) : wait_states(area);
  if (forced_bcr_ && !cycle_.on_chip) forced_acted_ = forced_acted_ || forces_wait_states();
  if (cycle_.write) cycle_.data = access.data & kWordMask;
  shape_ = port_a_shape(cycle_.wait_states, cycle_.write);
  start_ = std::max(access.start, next_start_);
  origin_ = clock_.origin(start_);
  if (cycle_.on_chip &&
      (access.address == regs::cpu_bus::kBcr.address || access.address == regs::cpu_bus::kPctl.address))
    return control_register();
  state_ = State::kRunning;
  next(Step::kAddress);
}

void PortAMaster::control_register() {
  const bool is_bcr = cycle_.address == regs::cpu_bus::kBcr.address;
  std::uint32_t& reg = is_bcr ? bcr_ : pctl_;
  state_ = State::kDone;
  next_start_ = done_at();
  if (!cycle_.write) {
    cycle_.data = reg;
    return;
  }
  reg = cycle_.data & (is_bcr ? regs::cpu_bus::kBcr : regs::cpu_bus::kPctl).written;
  if (!is_bcr) clock_.restart(clock_.tick(done_at()), done_at(), regs::cpu_bus::pctl::kMultiplier.get(pctl_) + 1);
  if (on_control) on_control();
}

TimeFs PortAMaster::time_of(Step step) const {
  switch (step) {
    case Step::kAddress:
      return clock_.time(origin_, 0);
    case Step::kDriveData:
      return clock_.time(origin_, shape_.data_driven);
    case Step::kStrobeLow:
      return clock_.time(origin_, shape_.strobe_low);
    case Step::kStrobeHigh:
      return clock_.time(origin_, shape_.strobe_high);
    case Step::kEnd:
      return clock_.time(origin_, 4 * (shape_.clocks + shape_.held_clocks));
  }
  return 0;
}

void PortAMaster::next(Step step) {
  step_ = step;
  time_ = time_of(step);
  const Tick before = stand_;  // what comes later is not seen earlier
  stand_ = (wires_.plain() ? fs_to_tick(time_) : wires_.first(time_)) - 1;
  // What the board shows as the strobe rises is not what it shows later.
  if (!wires_.plain() && step == Step::kStrobeHigh)
    stand_ = std::min(wires_.seen(cycle_.write ? kWrLine : kRdLine, time_), fs_to_tick(time_)) - 1;
  stand_ = std::max({stand_, before, wires_.followed_until(time_)});
}

void PortAMaster::move(PortAPins& pins) {
  const PortAPins before = driven_;
  switch (step_) {
    case Step::kAddress:
      driven_.pa_addr = address_pins();
      driven_.pa_x = cycle_.x;
      driven_.pa_aa = cycle_.aa;
      driven_.pa_int = cycle_.on_chip;
      break;
    case Step::kDriveData:
      driven_.pa_wdata = cycle_.data;
      break;
    case Step::kStrobeLow:
      (cycle_.write ? driven_.pa_wr_n : driven_.pa_rd_n) = false;
      break;
    case Step::kStrobeHigh:
      driven_.pa_rd_n = driven_.pa_wr_n = true;
      break;
    case Step::kEnd:
      driven_.pa_aa = 0;
      driven_.pa_int = false;
      break;
  }
  if (!wires_.plain()) return wires_.move(time_, before, driven_, stand_);
  static_cast<PortAPins&>(pins) = driven_;
  strobe_moved_ = step_ == Step::kStrobeLow || step_ == Step::kStrobeHigh;
  follows_at_ = time_;
}

void PortAMaster::see(TimeFs time, const BoardOutputs& board) {
  const Seen now{time, board.get(pin::kPaData), board.get(pin::kPaDataOe) != 0, board.get(pin::kPaTaN) != 0};
  if (seen_.empty() || !now.same_data(seen_.back()) || now.busy != seen_.back().busy) seen_.push_back(now);
}

// Index of what stood on the pins at `time`.
std::size_t PortAMaster::seen_at(TimeFs time) const {
  std::size_t i = seen_.size() - 1;
  while (i > 0 && seen_[i].time > time) --i;
  return i;
}

std::uint32_t PortAMaster::address_pins() const {
  return cycle_.address & (cycle_.on_chip ? kOnChipAddressPins : 0x7FFFFu);
}

std::uint32_t PortAMaster::random() {  // splitmix64
  std::uint64_t z = random_ += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
}

// Whether the strobe may rise now. /TA is sampled a quarter and its set-up before; if it moves from there on it is seen
// or not seen (rows 118 and 119).
bool PortAMaster::acknowledged() {
  if (cycle_.on_chip || cycle_.wait_states == 0) return true;
  cycle_.ta_time = clock_.time(origin_, shape_.strobe_high - 1) - kTaSetup;
  const std::size_t at = seen_at(cycle_.ta_time);
  const bool busy = seen_[at].busy, now_busy = seen_.back().busy;
  bool moved = false;
  for (std::size_t i = at + 1; i < seen_.size(); ++i) moved = moved || seen_[i].busy != seen_[i - 1].busy;
  if (!moved) return !busy;
  return moving_ta_ ? *moving_ta_ != now_busy : (random() & 1) == 0;
}

// The word of a read, at /RD high. Bits that moved after the sample are anything, and so are all
// of them when nobody drove the bus (rows 104 to 106).
void PortAMaster::take_data() {
  // A cycle without time for the set-up takes what is there as /RD falls.
  cycle_.data_time = std::max(time_ - kReadDataSetup, cycle_.strobe_low);
  const std::size_t at = seen_at(cycle_.data_time);
  cycle_.data = seen_[at].data;
  if (cycle_.on_chip) return;
  std::uint32_t moved = seen_[at].driven ? 0 : kWordMask;
  for (std::size_t i = at + 1; i < seen_.size(); ++i) {
    const Seen &before = seen_[i - 1], &after = seen_[i];
    moved |= after.driven == before.driven ? after.data ^ before.data : kWordMask;
  }
  if (moved != 0) cycle_.data = (cycle_.data & ~moved) | (random() & moved);
}

// The strobe has ended for the CPU; false if it goes on.
bool PortAMaster::end_strobe() {
  if (!acknowledged()) {  // one clock more
    ++cycle_.stretched;
    origin_ = clock_.origin(start_ + cycle_.stretched);
    next(Step::kStrobeHigh);
    return false;
  }
  if (!cycle_.write) take_data();
  cycle_.strobe_high = time_;
  return true;
}

// What the lines do at this step, whenever the board's flip-flops see it.
void PortAMaster::tell_watch() {
  if (watch_ == nullptr || cycle_.on_chip) return;
  switch (step_) {
    case Step::kAddress:
      levels_.addr = address_pins();
      levels_.x = cycle_.x;
      levels_.aa = cycle_.aa;
      levels_.addr_oe = true;
      levels_.multiplier = cycle_.multiplier;
      levels_.wait_states = cycle_.wait_states;
      levels_.pc = cycle_.pc;
      break;
    case Step::kDriveData:
      levels_.data = cycle_.data;
      levels_.data_oe = true;
      break;
    case Step::kStrobeLow:
      (cycle_.write ? levels_.wr_n : levels_.rd_n) = false;
      break;
    case Step::kStrobeHigh:
      levels_.rd_n = levels_.wr_n = true;
      break;
    case Step::kEnd:
      levels_.aa = 0;
      levels_.addr_oe = levels_.data_oe = false;
      break;
  }
  watch_->cpu_moved(time_, levels_);
}

void PortAMaster::step(PortAPins& pins, const BoardOutputs& board) {
  strobe_moved_ = false;
  if (!running() || wires_.next() <= stand_) {
    const PortAWires::Taken taken = wires_.take(pins);
    strobe_moved_ = taken.follows;
    follows_at_ = taken.time;
    return;
  }
  arrive_until(time_);
  if (step_ == Step::kStrobeHigh && !end_strobe()) return;
  tell_watch();
  move(pins);
  const bool shown = !cycle_.on_chip;
  switch (step_) {
    case Step::kAddress:
      cycle_.start = time_;
      seen_.clear();
      see(time_, wires_.skew().on() ? arrived_ : board);
      if (shown) {
        show(PortALine::kAddr, time_, driven_.pa_addr);
        show(PortALine::kX, time_, cycle_.x);
        show(PortALine::kAa, time_, cycle_.aa);
      }
      next(cycle_.write && shape_.data_driven < shape_.strobe_low ? Step::kDriveData : Step::kStrobeLow);
      break;
    case Step::kDriveData:
      cycle_.data_time = time_;
      if (shown) show(PortALine::kData, time_, cycle_.data);
      next(shape_.data_driven < shape_.strobe_low ? Step::kStrobeLow : Step::kStrobeHigh);
      break;
    case Step::kStrobeLow:
      cycle_.strobe_low = time_;
      if (shown) show(cycle_.write ? PortALine::kWrN : PortALine::kRdN, time_, 0);
      if (shown && !cycle_.write) show(PortALine::kData, time_, board.get(pin::kPaData));
      next(cycle_.write && shape_.data_driven > shape_.strobe_low ? Step::kDriveData : Step::kStrobeHigh);
      break;
    case Step::kStrobeHigh:
      if (shown) show(cycle_.write ? PortALine::kWrN : PortALine::kRdN, time_, 1);
      next(Step::kEnd);
      break;
    case Step::kEnd:
      cycle_.end = time_;
      if (shown) show(PortALine::kAa, time_, 0);
      state_ = State::kDone;
      next_start_ = start_ + shape_.clocks + cycle_.stretched + shape_.idle_clocks;
      if (on_cycle) on_cycle(cycle_);
      break;
  }
}

// What the board shows comes to the CPU, and to who watches.
void PortAMaster::arrive(TimeFs time, const BoardOutputs& board) {
  arrived_ = board;
  if (running() && step_ != Step::kAddress) see(time, board);
  if (watch_ != nullptr) watch_->board_moved(time, board);
}

void PortAMaster::arrive_until(TimeFs time) {
  std::size_t count = 0;
  for (; count < shown_.size() && shown_[count].time <= time; ++count) arrive(shown_[count].time, shown_[count].board);
  shown_.erase(shown_.begin(), shown_.begin() + static_cast<std::ptrdiff_t>(count));
}

// It overtakes what an edge before it has sent on its longer way: that comes later, as the strobe has left it.
void PortAMaster::board_follows(const BoardOutputs& board) {
  if (!wires_.skew().on()) return arrive(follows_at_, board);
  const BoardOutputs before = shown_.empty() ? arrived_ : shown_.back().board;
  auto at = shown_.begin();
  while (at != shown_.end() && at->time <= follows_at_) ++at;
  const BoardOutputs there = at == shown_.begin() ? arrived_ : (at - 1)->board;
  at = shown_.insert(at, {follows_at_, there});
  for (; at != shown_.end(); ++at)
    for (const auto& line : {pin::kPaData, pin::kPaDataOe, pin::kPaTaN})
      if (board.get(line) != before.get(line)) at->board.set(line, board.get(line));
}

// The peripherals on the CPU's chip have no pads.
void PortAMaster::board_changed(Tick tick, const BoardOutputs& board) {
  const TimeFs edge = tick_to_fs(tick);
  if (wires_.skew().on()) {
    const TimeFs time = edge + (running() && cycle_.on_chip ? 0 : PinSkew::kOutput);
    shown_.push_back({shown_.empty() ? time : std::max(time, shown_.back().time), board});
  } else {
    arrive(edge, board);
  }
  if (!running() || cycle_.write || cycle_.on_chip) return;
  if (step_ == Step::kStrobeHigh) show(PortALine::kData, edge, board.get(pin::kPaData));
}

}  // namespace brick
