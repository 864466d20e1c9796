#include "testbench/benches/port_a_driver.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace brick {

namespace {

constexpr TimeFs kRefPeriod = tick_to_fs(kTicksPerRef);
constexpr std::size_t kShown = 64;  // changes of outputs: more than any cycle's
constexpr TimeFs kStuck = 100'000 * kFsPerNs;
constexpr TimeFs kClockAtOne = 101'725'260;  // TC at I52 = 0: 12 ticks, in femtoseconds

}  // namespace

PortALimits port_a_limits(unsigned i52, unsigned wait_states, bool write) {
  const TimeFs tc = kClockAtOne / (i52 + 1), ws = wait_states, form = ws <= 3 ? 0 : ws <= 7 ? 1 : 2;
  const auto row = [tc](TimeFs quarters, TimeFs guard) {
    return std::max<TimeFs>(0, quarters * tc / 4 - guard * kFsPerNs / 10);
  };
  PortALimits l{};
  l.clock = tc;
  l.ready = row(1, -20);
  if (write) {
    l.setup = row(ws <= 1 ? 1 : ws <= 3 ? 3 : 5, 20);
    l.low = row(ws <= 1 ? 6 : ws <= 3 ? 4 * ws : 4 * ws - 2, 40);
    l.hold = l.data_hold = row(1 + 4 * form, 20);
    l.data = std::max<TimeFs>(0, l.low - row(4 * ws - 1, 30));
  } else {
    l.setup = row(2, 20);
    l.low = row(4 * ws + 1, 40);
    l.hold = row(ws == 1 ? 1 : form == 2 ? 9 : 5, 20);
    l.sample = row(4 * ws + 1, 50);
  }
  return l;
}

PortADriver::PortADriver(Machine& machine, std::uint64_t seed)
    : machine_(machine), aperture_(kAperture, seed), driven_(machine.port_a()), random_(seed) {
  wires_.set_aperture(&aperture_);
  wires_.set_skew(machine.skew());
  shown_.emplace_back(machine.now(), machine.outputs());
  others_ = machine.on_outputs;
  machine_.on_outputs = [this](Tick tick, const BoardOutputs& before, const BoardOutputs& after) {
    drive_.edge(tick, after);
    shown_.emplace_back(tick, after);
    if (shown_.size() > kShown) shown_.pop_front();
    if (others_) others_(tick, before, after);
  };
}

PortADriver::~PortADriver() { machine_.on_outputs = others_; }

unsigned PortADriver::least_phase(bool write) const {
  return *std::min_element(phases_[write].begin(), phases_[write].end());
}

// With the lines that are under way.
void PortADriver::run_to(Tick tick) {
  while (wires_.next() <= tick) {
    board_to(wires_.next());
    const TimeFs time = wires_.take(machine_.port_a()).time;
    machine_.apply();
    drive_.lines(machine_.now(), machine_.port_a(), machine_.port_a_at_once());
    if (machine_.signals().traced()) show(time);
  }
  board_to(tick);
}

void PortADriver::board_to(Tick tick) {
  if (then_at_ <= tick) {
    machine_.run_until(std::exchange(then_at_, kNever));
    std::exchange(then_, nullptr)();
  }
  if (machine_.now() < tick) machine_.run_until(tick);
}

void PortADriver::show(TimeFs time) {
  const PortAPins& pins = machine_.port_a();
  Signals& signals = machine_.signals();
  const TimeFs now = std::max(time, machine_.now_fs());
  const auto set = [&](const char* name, std::uint64_t value) { signals.set(*signals.find(name), now, value); };
  set("bus.addr", pins.pa_addr);
  set("bus.x", pins.pa_x);
  set("bus.aa", pins.pa_aa);
  set("bus.data", pins.pa_wdata);
  set("bus.rd_n", pins.pa_rd_n);
  set("bus.wr_n", pins.pa_wr_n);
}

void PortADriver::move(TimeFs time, const std::function<void(PortAPins&)>& edit) {
  run_to(wires_.first(time) - 1);
  const PortAPins from = driven_;
  edit(driven_);
  wires_.move(time, from, driven_, machine_.now());
}

void PortADriver::set_clock(unsigned i52) {
  i52_ = i52;
  aperture_.set_width(wires_.skew().on() && i52 > kWholeAperture ? kAperture / 2 : kAperture);
}

// What the board shows that has come to the CPU by then, if it is so long on its way.
const BoardOutputs& PortADriver::at_cpu(TimeFs time, TimeFs way) {
  const Tick edge = fs_to_tick_floor(time - way);
  run_to(edge);
  auto last = shown_.end() - 1;
  while (last != shown_.begin() && last->first > edge) --last;
  return last->second;
}

// /TA rises without a clock and falls with one.
bool PortADriver::acknowledged(TimeFs time) {
  return at_cpu(time, output_delay()).get(pin::kPaTaN) == 0 && at_cpu(time, 0).get(pin::kPaTaN) == 0;
}

void PortADriver::foreign(const Place& place, bool write, std::uint32_t data) {
  cycle(place, PortADrive::kOther, write, data);
}

PortADrive::Cycle PortADriver::own(const Place& place) {
  return place.on_chip ? PortADrive::kOther : place.aa == 4 ? PortADrive::kRam : PortADrive::kRegisters;
}

std::uint32_t PortADriver::cycle(const Place& place, PortADrive::Cycle of, bool write, std::uint32_t data) {
  const PortALimits l = port_a_limits(i52_, place.wait_states, write);
  const TimeFs start = free_at_, fall = start + l.setup;
  ++phases_[write][static_cast<std::size_t>((fall - tick_to_fs(fs_to_tick_floor(fall) / kTicksPerRef * kTicksPerRef)) *
                                            kBins / kRefPeriod % kBins)];
  move(start, [&](PortAPins& p) {
    p.pa_addr = place.address;
    p.pa_x = place.x;
    p.pa_aa = place.aa;
    p.pa_int = place.on_chip;
  });
  drive_.cycle(of, write);
  move(fall, [&](PortAPins& p) { (write ? p.pa_wr_n : p.pa_rd_n) = false; });
  if (write) move(fall + l.data, [&](PortAPins& p) { p.pa_wdata = data; });
  TimeFs rise = fall + l.low;
  if (write && spoiled_ > 0) move(rise - spoiled_, [&](PortAPins& p) { p.pa_wdata = ~data & 0xFFFFFF; });
  for (; !place.on_chip; rise += l.clock, ++stretched_) {
    if (acknowledged(rise - l.ready)) break;
    if (rise - fall > kStuck)
      throw std::runtime_error(fmt::format(
          "/TA is high for ever at ${:06X}, AA {}, {}: AA {} at the board, /RD {}, /WR {}", place.address, place.aa,
          write ? "write" : "read", machine_.port_a().pa_aa, machine_.port_a().pa_rd_n, machine_.port_a().pa_wr_n));
  }
  std::uint32_t word = 0;
  if (!write) {
    const TimeFs sample = rise - (l.low - l.sample);
    const BoardOutputs& shown = at_cpu(sample, place.on_chip ? 0 : output_delay());
    word = shown.get(pin::kPaData);
    floating_ += of != PortADrive::kOther && shown.get(pin::kPaDataOe) == 0;
  }
  move(rise, [](PortAPins& p) { p.pa_rd_n = p.pa_wr_n = true; });
  if (write) move(rise + l.data_hold, [&](PortAPins& p) { p.pa_wdata = random() & 0xFFFFFF; });
  // Up to three wait states an idle clock follows, in which the lines stand; row 117 has it in it from two on.
  const bool idles = place.wait_states <= 3 && (write || place.wait_states == 1);
  free_at_ = rise + l.hold + (idles ? l.clock : 0);
  // Nothing holds the lines until the next address; it comes at once, or this is what stands there.
  move(free_at_, [&](PortAPins& p) {
    p.pa_addr = random() & 0x7FFFF;
    p.pa_x = (random() & 1) != 0;
    p.pa_aa = random() & 0xF;
    p.pa_int = false;
  });
  return word;
}

void PortADriver::rest() { run_to(fs_to_tick_floor(free_at_)); }

}  // namespace brick
