#include "testbench/checkers/isa_checker.h"

#include <algorithm>
#include <utility>

namespace brick {
namespace {

constexpr TimeFs kNs = kFsPerNs;
constexpr TimeFs kBclk = 120 * kNs;
constexpr TimeFs kHold = 25 * kNs;                                             // t3, t7, t15
constexpr TimeFs kTakenBefore = 9 * kNs, kTakenAfter = 17 * kNs;               // host-bus:3.9/2
constexpr TimeFs kLongestWait = 15'600 * kNs;                                  // row 10
constexpr TimeFs kAsked = 3 * detail::kBlockFs / detail::kBlockTicks + 1'000;  // IOCHRDY low in each access to the RAM
constexpr TimeFs kT2Limit = 530 * kNs, kT4Limit = 489 * kNs, kT13Limit = 219 * kNs, kT14Limit = 173 * kNs;
constexpr TimeFs kT16Limit = 66 * kNs;
constexpr TimeFs kUsualPeriod = 12'500'000;  // 80 MHz

std::vector<TimingRule> rules() {
  using Kind = TimingRule::Kind;
  const auto row = [](const char* id, const char* text, const char* source, Kind kind) {
    return TimingRule{id, text, source, kind};
  };
  const auto strobe = [&row](const char* id, const char* text, const char* source) {
    return row(id, text, source, Kind::kLeast);
  };
  const auto sound = [&row](const char* id, const char* text, const char* source) {
    return row(id, text, source, Kind::kHolds);
  };
  return {row("t1", "SA, AEN valid before IOR#, IOW# low", "host-bus:3.4/1", Kind::kLeast),
          row("t2", "IOR#, IOW#, 8-bit MEMR#, MEMW# low", "host-bus:3.4/2", Kind::kLeast),
          row("t3", "address held after the command", "host-bus:3.4/3", Kind::kLeast),
          row("t4", "IOR#, 8-bit MEMR# low to data valid", "host-bus:3.4/4", Kind::kMost),
          row("t5", "data held after the read command", "host-bus:3.4/5", Kind::kLeast),
          row("t5off", "data off after the read command", "host-bus:3.4/5", Kind::kMost),
          row("t6", "write data valid after the command's fall", "host-bus:3.4/6", Kind::kMost),
          row("t7", "write data held after IOW#", "host-bus:3.4/7", Kind::kLeast),
          row("t8", "command low to IOCHRDY low", "host-bus:3.4/8", Kind::kMost),
          row("t9", "IOCHRDY high to the command's end", "host-bus:3.4/9", Kind::kLeast),
          row("t10", "IOCHRDY low", "host-bus:3.4/10", Kind::kMost),
          row("t11", "command high to the next command", "host-bus:3.4/11", Kind::kLeast),
          row("t12", "LA valid before MEMR#, MEMW# low", "host-bus:3.4/12", Kind::kLeast),
          row("t13", "16-bit MEMR#, MEMW# low", "host-bus:3.4/13", Kind::kLeast),
          row("t14", "16-bit MEMR# low to data valid", "host-bus:3.4/14", Kind::kMost),
          row("t15", "write data held after MEMW#", "host-bus:3.4/15", Kind::kLeast),
          row("t16", "LA to MEMCS16# low", "host-bus:3.4/16", Kind::kMost),
          row("t18", "SA, SBHE# valid before MEMR#, MEMW# low", "host-bus:3.4/18", Kind::kLeast),
          strobe("h1", "host port: read strobe low", "host-bus:3.3/1"),
          strobe("h2", "host port: read strobe high", "host-bus:3.3/2"),
          strobe("h3", "host port: read strobe high after +0, +1, +2, +7", "host-bus:3.3/3"),
          strobe("h4", "host port: write strobe low", "host-bus:3.3/4"),
          strobe("h5", "host port: write strobe high after +0, +1, +7", "host-bus:3.3/5"),
          strobe("h6", "host port: write strobe high otherwise", "host-bus:3.3/6"),
          sound("one-command", "one command at a time", "host-bus:3.9/1"),
          sound("address-stands", "SA, SBHE#, AEN stand while a command is low", "host-bus:3.9/2"),
          sound("room-in-tx", "+7 is written while TX is empty", "host-bus:3.9/3"),
          sound("whole-cycle", "no reset while a command is low", "host-bus:3.9/4"),
          sound("ours-only", "the board drives data in reads of its own only", "host-bus:3.9/5")};
}

}  // namespace

IsaChecker::IsaChecker()
    : ledger_("ISA", "IM", rules(), {"I/O", "memory of 16 bits", "memory of 8 bits"}),
      cpu_period_([] { return kUsualPeriod; }) {}

unsigned IsaChecker::commands(const BoardInputs& in) {
  return (in.isa_ior_n ? 0u : 1u) | (in.isa_iow_n ? 0u : 2u) | (in.isa_memr_n ? 0u : 4u) | (in.isa_memw_n ? 0u : 8u);
}

std::uint32_t IsaChecker::address(const BoardInputs& in, bool memory) {
  if (!memory) return in.isa_sa & 0xFFFF;
  return in.slot8 ? in.isa_sa & 0xFFFFF : static_cast<std::uint32_t>(in.isa_la) << 17 | (in.isa_sa & 0x1FFFF);
}

unsigned IsaChecker::lanes(const BoardInputs& in, bool memory) {
  const bool odd = (in.isa_sa & 1) != 0;
  if (!memory || (odd && in.isa_sbhe_n)) return 1;  // the odd byte of an 8-bit host is on the lower lane
  return (in.isa_sbhe_n ? 0u : 2u) | (odd ? 0u : 1u);
}

bool IsaChecker::ours(const BoardInputs& in, const Cycle& c) const {
  if (c.memory()) {
    const std::uint32_t size = in.window_flat ? 0x10000 : 0x4000, space = in.slot8 ? 0xFFFFF : 0xFFFFFF;
    return ((c.address ^ static_cast<std::uint32_t>(in.window) << 14) & space & ~(size - 1)) == 0;
  }
  if (in.isa_aen) return false;  // DMA
  const std::uint32_t compared = in.io_decode16 ? 0xFFF0 : 0x03F0;
  return ((c.address ^ static_cast<std::uint32_t>(in.io_base) << 4) & compared) == 0;
}

// 0 to 7 for a byte of the host port, else -1.
int IsaChecker::port_byte(const BoardInputs& in, const Cycle& c) const {
  const bool port = !c.memory() && ours(in, c) && (c.address & 8) == 0;
  return port ? static_cast<int>(c.address & 7) : -1;
}

TimingPlace IsaChecker::place(TimeFs time, const Cycle& c) {
  TimingPlace where;
  where.time = time;
  where.address = c.address;
  where.space = c.memory() ? 'M' : 'I';
  where.write = c.write();
  return where;
}

void IsaChecker::pins(TimeFs t, const BoardInputs& in, const BoardOutputs& out) {
  const BoardInputs before = std::exchange(in_, in);
  const BoardOutputs shown = std::exchange(out_, out);
  if (!std::exchange(known_, true)) return;

  if (in.isa_la != before.isa_la) la_at_ = t;
  block_select(t, before, shown);
  if (in.isa_sa != before.isa_sa || in.isa_aen != before.isa_aen || in.isa_sbhe_n != before.isa_sbhe_n)
    address_moved(t);
  if (in.isa_sd != before.isa_sd) host_data_moved(t);

  const bool reset = (before.rst_n && !in.rst_n) || (!before.isa_resetdrv && in.isa_resetdrv);
  if (reset) {
    ledger_.holds(kWholeCycle, region(cycle_), !in_cycle_, place(t));
    cycle_.whole = false;
  }
  const bool asleep = !before.rst_n || before.isa_resetdrv;
  if (asleep && in.rst_n && !in.isa_resetdrv) awake_at_ = t + kBclk;  // host-bus:3.8/4
  if (shown.get(pin::kIsaIochrdy) != out.get(pin::kIsaIochrdy)) ready_moved(t, out.get(pin::kIsaIochrdy) != 0);
  if (shown.get(pin::kIsaSd) != out.get(pin::kIsaSd) || shown.get(pin::kIsaSdOe) != out.get(pin::kIsaSdOe))
    board_data(t, in, shown);

  const unsigned now = commands(in), then = commands(before);
  if (now == then) return;
  if ((now & then) == 0) {  // also where one falls in the instant in which the other rises: two cycles
    if (then != 0) end(t, before, out);
    if (now != 0) begin(t, now, in, out);
  }
  if ((now & (now - 1)) != 0) {  // more than one is low
    cycle_.alone = false;
    ledger_.holds(kOneCommand, region(cycle_), false, place(t));
  }
}

// --------------------------------------------------------------------------------------------------------- what moves

// Row 16 is about a move of LA that selects the block of the window. Switches and resets move MEMCS16# too, and so does
// SA in a slot of 8 bits: those are nobody's time to keep.
void IsaChecker::block_select(TimeFs t, const BoardInputs& before, const BoardOutputs& shown) {
  const bool listens = in_.rst_n && !in_.isa_resetdrv && !in_.slot8;
  const bool same = listens && before.rst_n && !before.isa_resetdrv && !before.slot8 && before.window == in_.window;
  if (!same) block_due_ = kNone;
  if (in_.isa_la != before.isa_la) {
    block_overdue(t, before);
    block_due_ = same && in_.isa_la == in_.window >> 3 && shown.get(pin::kIsaMemcs16N) != 0 ? t : kNone;
  }
  if (block_due_ != kNone && out_.get(pin::kIsaMemcs16N) == 0) block_selected(t, in_);
}

// LA moves on or a command falls, and MEMCS16# has not come: only a time beyond the limit is known to break the rule.
void IsaChecker::block_overdue(TimeFs t, const BoardInputs& in) {
  if (block_due_ != kNone && t - block_due_ > kT16Limit) block_selected(t, in);
}

void IsaChecker::block_selected(TimeFs t, const BoardInputs& in) {
  Cycle block;
  block.kind = kMemoryRead;
  block.address = static_cast<std::uint32_t>(in.isa_la) << 17;
  ledger_.enter(kT16, kMemory16, kT16Limit, t - block_due_, place(t, block));
  block_due_ = kNone;
}

void IsaChecker::address_moved(TimeFs t) {
  sa_at_ = t;
  if (in_cycle_) cycle_.moved = true;
  if (in_cycle_ && t - cycle_.low <= kTakenAfter) cycle_.unsure = true;
  if (!in_cycle_ && std::exchange(hold_address_, false)) enter(kT3, kHold, t - high_at_, t);
}

void IsaChecker::host_data_moved(TimeFs t) {
  data_at_ = t;
  if (!in_cycle_ && std::exchange(hold_data_, false)) enter(cycle_.memory() ? kT15 : kT7, kHold, t - high_at_, t);
}

void IsaChecker::ready_moved(TimeFs t, bool ready) {
  if (!in_cycle_) return;
  if (!ready) {
    cycle_.ready_low = t;
    cycle_.ready_high = kNone;
    enter(kT8, 366 * kNs, t - cycle_.low, t);
  } else if (cycle_.ready_low != kNone) {
    cycle_.ready_high = t;
    enter(kT10, kLongestWait, t - cycle_.ready_low, t);
  }
}

// SD as the board drives it. In the tick after a command it may still be on (t5). Whose the read is cannot be said when
// its address moved around the fall of the command.
void IsaChecker::board_data(TimeFs t, const BoardInputs& in, const BoardOutputs& shown) {
  const unsigned driven = out_.get(pin::kIsaSdOe), before = shown.get(pin::kIsaSdOe);
  if (driven != 0 && before == 0 && !(in_cycle_ && cycle_.unsure)) {
    const bool read = in_cycle_ && cycle_.alone && !cycle_.write();
    ledger_.holds(kOursOnly, region(cycle_), read && ours(in, cycle_), place(t));
  }
  if (in_cycle_) {
    const bool whole = (driven & cycle_.lanes) == cycle_.lanes, was = (before & cycle_.lanes) == cycle_.lanes;
    if (whole) cycle_.data_valid = t;
    if (was && !whole) cycle_.data_gone = t;
    cycle_.answered = cycle_.answered || whole;
    return;
  }
  if (before == 0 || !read_floats_) return;
  if (driven == 0) {
    enter(kT5, 0, t - high_at_, t);
    enter(kT5Off, 30 * kNs, t - high_at_, t);
    read_floats_ = false;
  }
}

// ------------------------------------------------------------------------------------------------------------- a cycle

void IsaChecker::begin(TimeFs t, unsigned now, const BoardInputs& in, const BoardOutputs& out) {
  // Nothing moved since the last command: it was held at least until now. A shorter pause is row 11's.
  const bool held = t - high_at_ >= kHold;
  if (std::exchange(hold_address_, false) && held) enter(kT3, kHold, t - high_at_, t);
  if (std::exchange(hold_data_, false) && held) enter(cycle_.memory() ? kT15 : kT7, kHold, t - high_at_, t);

  if (std::exchange(read_floats_, false)) enter(kT5Off, 30 * kNs, t - high_at_, t);
  block_overdue(t, in);

  cycle_ = {};
  cycle_.kind = (now & 1) != 0 ? kIoRead : (now & 2) != 0 ? kIoWrite : (now & 4) != 0 ? kMemoryRead : kMemoryWrite;
  cycle_.alone = (now & (now - 1)) == 0;
  cycle_.low = t;
  cycle_.unsure = t - sa_at_ < kTakenBefore;
  cycle_.address = address(in, cycle_.memory());
  cycle_.wide = cycle_.memory() && !in.slot8 && out.get(pin::kIsaMemcs16N) == 0;
  cycle_.lanes = lanes(in, cycle_.memory());
  in_cycle_ = true;
  bool sound = in.rst_n && !in.isa_resetdrv && t >= awake_at_;
  const auto least = [&](Rule rule, TimeFs required, TimeFs since) {
    enter(rule, required, t - since, t);
    sound = sound && t - since >= required;
  };
  if (high_at_ != kNone) least(kT11, 170 * kNs, high_at_);
  if (cycle_.memory()) {
    if (!in.slot8) least(kT12, 111 * kNs, la_at_);
    least(kT18, 34 * kNs, sa_at_);
  } else if (!in.isa_aen) {
    least(kT1, 91 * kNs, sa_at_);
  }
  cycle_.due = sound && !cycle_.write() && ours(in, cycle_);
  port_strobe(t, in);
}

// host-bus:3.3: how long the strobe was high before.
void IsaChecker::port_strobe(TimeFs t, const BoardInputs& in) {
  const int byte = port_byte(in, cycle_);
  if (byte < 0) return;
  const TimeFs long_high = 5 * cpu_period_() / 2 + 3'300'000;
  if (cycle_.write()) {
    if (port_write_.end == kNone) return;
    if (port_write_.slow)
      enter(kH5, long_high, t - port_write_.end, t);
    else
      enter(kH6, 8'250'000, t - port_write_.end, t);
  } else if (port_read_.end != kNone) {
    enter(kH2, 4'950'000, t - port_read_.end, t);
    const bool such = byte <= 2 || byte == 7;
    if (such && port_read_.slow) enter(kH3, long_high, t - port_read_.end, t);
  }
}

// `in` as it stood while the command was low.
void IsaChecker::end(TimeFs t, const BoardInputs& in, const BoardOutputs& out) {
  in_cycle_ = false;
  const bool stretched = cycle_.ready_low != kNone;
  if (cycle_.alone) {
    const bool waited = stretched && (cycle_.ready_high == kNone || cycle_.ready_high - cycle_.ready_low > kAsked);
    ++cycles_[cycle_.kind][cycle_.wide][waited];
    ledger_.holds(kOneCommand, region(cycle_), true, place(t));
  }
  ledger_.holds(kAddressStands, region(cycle_), !cycle_.moved, place(t));
  if (cycle_.wide)
    enter(kT13, kT13Limit, t - cycle_.low, t);
  else
    enter(kT2, kT2Limit, t - cycle_.low, t);
  // IOCHRDY that is still low has been high for less than no time.
  if (stretched && cycle_.whole) enter(kT9, kBclk, cycle_.ready_high == kNone ? -1 : t - cycle_.ready_high, t);
  if (stretched && cycle_.ready_high == kNone && t - cycle_.ready_low > kLongestWait)
    enter(kT10, kLongestWait, t - cycle_.ready_low, t);
  high_at_ = t;
  hold_address_ = true;
  if (cycle_.write())
    end_write(t, in, out);
  else
    end_read(t);
  const int byte = port_byte(in, cycle_);
  if (byte < 0) return;
  const bool slow = byte <= 1 || byte == 7 || (byte == 2 && !cycle_.write());
  (cycle_.write() ? port_write_ : port_read_) = {t, slow};
  if (cycle_.write())
    enter(kH4, 6'600'000, t - cycle_.low, t);
  else
    enter(kH1, cpu_period_() + 4'950'000, t - cycle_.low, t);
}

// When data have to be there: rows 4 and 14; behind IOCHRDY for a host that ends the command one BCLK after it (row 9)
// and looks at them as long before as in a cycle without it. kNone: IOCHRDY is still low.
TimeFs IsaChecker::data_limit() const {
  const TimeFs limit = cycle_.wide ? kT14Limit : kT4Limit;
  if (cycle_.ready_low == kNone) return limit;
  if (cycle_.ready_high == kNone) return kNone;
  const TimeFs sample = cycle_.wide ? kT13Limit - kT14Limit : kT2Limit - kT4Limit;
  return std::max(limit, cycle_.ready_high - cycle_.low + kBclk - sample);
}

void IsaChecker::end_read(TimeFs t) {
  const unsigned driven = out_.get(pin::kIsaSdOe);
  read_floats_ = driven != 0;
  if (!cycle_.alone || !cycle_.whole || cycle_.unsure) return;
  const Rule row = cycle_.wide ? kT14 : kT4;
  const TimeFs limit = data_limit();
  if (!cycle_.answered) {  // a command that ends before the limit asks for nothing
    if (cycle_.due && limit != kNone && t - cycle_.low > limit) enter(row, limit, t - cycle_.low, t);
    return;
  }
  ++answered_;
  if (limit != kNone) enter(row, limit, cycle_.data_valid - cycle_.low, t);
  if ((driven & cycle_.lanes) != cycle_.lanes) enter(kT5, 0, cycle_.data_gone - t, t);  // gone before the command
}

void IsaChecker::end_write(TimeFs t, const BoardInputs& in, const BoardOutputs& out) {
  hold_data_ = true;
  enter(kT6, 22 * kNs, data_at_ - cycle_.low, t);
  if (port_byte(in, cycle_) == 7) ledger_.holds(kRoomInTx, kIo, out.get(pin::kTxde) != 0, place(t));
}

}  // namespace brick
