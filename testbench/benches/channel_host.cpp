#include "testbench/benches/channel_host.h"

#include <algorithm>

#include <fmt/format.h>

#include "systemc/cpu/port_a.h"

namespace brick {

namespace {
constexpr Tick kQuiet = 12;  // SCLK periods after the last level
}  // namespace

std::uint32_t PinPlayer::ics() const {
  std::uint32_t mask = 0;
  for (const unsigned ic : ics_) mask |= 1u << ic;
  return mask;
}

MotorOutputs PinPlayer::stops(unsigned) const {
  MotorOutputs pins;
  for (unsigned n = 0; n < kChannels; ++n) pins.set(motor_pin::kPfmPulse, n, 1);
  return pins;
}

void PinPlayer::changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
  const auto place = static_cast<unsigned>(std::find(ics_.begin(), ics_.end(), ic) - ics_.begin());
  for (unsigned n = 0; n < kChannels; ++n) {
    const unsigned channel = place * kChannels + n;
    Seen& s = seen[channel];
    const auto count = static_cast<std::int32_t>(after.get(motor_pin::kCount, n));
    if (static_cast<std::int32_t>(before.get(motor_pin::kCount, n)) != count)
      s.counts.push_back({tick, (count ^ 0x800000) - 0x800000});
    if (before.get(motor_pin::kEqu, n) != after.get(motor_pin::kEqu, n))
      s.equs.push_back({tick, after.get(motor_pin::kEqu, n)});
    if (before.get(motor_pin::kPfmPulse, n) == 0 && after.get(motor_pin::kPfmPulse, n) != 0) {
      s.pulses.push_back({tick, after.get(motor_pin::kPfmDir, n) != 0 ? -1 : 1});
      if (on_pulse) on_pulse(tick, channel);
    }
  }
}

bool PinPlayer::step(Tick now, MotorInputPins& inputs) {
  bool edited = false;
  for (; !events_.empty() && events_.begin()->first <= now; events_.erase(events_.begin())) {
    const PinEvent& e = events_.begin()->second;
    inputs[ics_[e.channel / kChannels]].pins[e.channel % kChannels] = e.pins;
    edited = true;
  }
  return edited;
}

ChannelHost::ChannelHost(BenchContext& b)
    : ServoHost(b, b.seed * 65'537), player_(fitted()), pins_(channels(), b.machine.idle_channel_pins()) {
  for (unsigned i = 0; i < pins_.size(); ++i) boards_.push_back(std::make_unique<ChannelScoreboard>(pins_[i]));
  b.machine.attach(player_);
  b.machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
  b.bus.watch(select_pins(pin::kServo), [this](Tick t, const BoardOutputs&, const BoardOutputs& o) {
    if (o.get(pin::kServo) == 0) servo_falls_.push_back(t);
  });
}

ChannelHost::~ChannelHost() {
  bench().bus.watch({}, nullptr);
  bench().machine.on_bus_cycle = nullptr;
  bench().machine.detach(player_);
}

// What the host has asked for is read in the background; the tasks above it look at channels of their own accord.
void ChannelHost::cycle(const PortACycle& c) {
  constexpr unsigned kBackground = 0;  // cpu.task
  if (bench().machine.task() != kBackground) return;
  if (c.write || c.on_chip || c.address < 0x78000 || c.address > 0x7BFFF) return;
  const Tick sample = bus_edge(c, bench().machine);  // what changes a period of clk_ref before it is read
  reads_[2 * c.address + (c.x ? 1 : 0)] = {sample - 1 - kTicksPerRef, c.data, -1, sample};
}

// An IC latches with its own edge of the chain: before the pin falls if it drives the net, behind it if it follows.
ChannelHost::BusRead ChannelHost::last_read(unsigned channel, const regs::Register& word) const {
  const auto at = reads_.find(2 * address(channel, word) + (word.space == 'X' ? 1 : 0));
  if (at == reads_.end()) return {};
  BusRead read = at->second;
  const auto next = std::upper_bound(servo_falls_.begin(), servo_falls_.end(), read.tick - behind(channel / kChannels));
  if (next != servo_falls_.begin()) read.servo = *std::prev(next);
  return read;
}

void ChannelHost::follow() {
  for (auto& board : boards_) board->advance(now());
}

void ChannelHost::assign(unsigned k, const std::vector<unsigned>& values) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < values.size(); ++i) words.push_back(fmt::format("I{}={}", i_channel(i, k), values[i]));
  say(words);
}

std::vector<long> ChannelHost::read(unsigned number) { return numbers(fmt::format("M{},{},100", number, channels())); }

void ChannelHost::sclk(unsigned n) {
  std::vector<std::string> words;
  for (unsigned place = 0; place < places(); ++place)
    words.push_back(fmt::format("I{}={}", i_global(place, 3), 2258 / 64 * 64 + n * 9));  // PFM_CLK the same
  say(words);
  period_ = kTicksPerRef << n;
  const Tick start = now() + 10 * period_ + pick(50);
  for (auto& s : player_.seen) s.clear();
  for (unsigned place = 0; place < places(); ++place) {
    const unsigned channel = place * kChannels;
    const auto other = static_cast<std::uint16_t>(pins_[channel] ^ 1u << kEncA);
    player_.add({start, channel, other});
    player_.add({start + 20 * period_, channel, pins_[channel]});
  }
  bench().bus.advance_to(start + 40 * period_);
  for (unsigned place = 0; place < places(); ++place) {
    const unsigned channel = place * kChannels;
    const auto& seen = player_.seen[channel].counts;
    const Tick from = ChannelScoreboard::earliest(start, period_), to = ChannelScoreboard::latest(start, period_);
    const bool found = seen.size() == 2 && seen[0].tick >= from && seen[0].tick <= to;
    const Tick edge = seen.empty() ? start : seen[0].tick;
    for (unsigned i = 0; i < kChannels; ++i) boards_[channel + i]->synchronise(edge, period_, start - 5 * period_);
    boards_[channel]->drive(start, static_cast<std::uint16_t>(pins_[channel] ^ 1u << kEncA));
    boards_[channel]->drive(start + 20 * period_, pins_[channel]);
    boards_[channel]->advance(now());
    const std::string difference = counts(channel).text;
    bench().report.step(fmt::format("{} counts an edge of A and back, SCLK every {} ticks", name(channel), period_),
                        found && difference.empty(),
                        found && difference.empty()
                            ? fmt::format("after {} ticks, expected {} to {}", edge - start, from - start, to - start)
                            : fmt::format("expected after {} to {} ticks; {}", from - start, to - start, difference));
  }
  follow();
}

void ChannelHost::drive(unsigned channel, Tick start, const std::vector<Hold>& holds) {
  Tick tick = start;
  for (const Hold& h : holds) {
    if (h.pins != pins_[channel]) {
      player_.add({tick, channel, h.pins});
      boards_[channel]->drive(tick, h.pins);
      pins_[channel] = h.pins;
    }
    tick += h.ticks;
  }
  played_ = std::max(played_, tick);
}

void ChannelHost::play() {
  bench().bus.advance_to(std::max(played_, now()) + kQuiet * period_);
  for (unsigned i = 0; i < channels(); ++i) {
    for (const auto& p : player_.seen[i].pulses) boards_[i]->pulse(p.tick, static_cast<int>(p.value));
    player_.seen[i].pulses.clear();
  }
  follow();
}

namespace {
// The first difference in words.
ChannelHost::Difference differ(std::vector<ChannelScoreboard::Change>& expected,
                               std::vector<ChannelScoreboard::Change>& seen) {
  ChannelHost::Difference d{"", expected.size()};
  const auto text = [](const std::vector<ChannelScoreboard::Change>& list, std::size_t i) {
    return i < list.size() ? fmt::format("{} at tick {}", list[i].value, list[i].tick) : std::string("nothing");
  };
  const auto [e, s] = std::mismatch(expected.begin(), expected.end(), seen.begin(), seen.end());
  if (e != expected.end() || s != seen.end()) {
    const auto at = static_cast<std::size_t>(e - expected.begin());
    d.text = fmt::format("change {}: {}, expected {}", at + 1, text(seen, at), text(expected, at));
  }
  expected.clear();
  seen.clear();
  return d;
}
}  // namespace

ChannelHost::Difference ChannelHost::counts(unsigned channel) {
  return differ(boards_[channel]->counts, player_.seen[channel].counts);
}
ChannelHost::Difference ChannelHost::equs(unsigned channel) {
  return differ(boards_[channel]->equs, player_.seen[channel].equs);
}

}  // namespace brick
