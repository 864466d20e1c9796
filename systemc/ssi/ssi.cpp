#include "systemc/ssi/ssi.h"

#include <algorithm>

namespace brick {

namespace {
constexpr Tick kRestTicks = 2360;  // 20 us

bool has(unsigned mask, unsigned n) { return (mask >> n & 1) != 0; }
}  // namespace

// Which word of which channel a register is: those of a Geo PMAC's channel 2 stand $20 addresses after channel 1's, of
// a Brick's channels four addresses after each other, of its groups sixteen, to the end of the page.
Ssi::Where Ssi::where(bool x, unsigned address) const {
  const auto is = [x, address](const regs::Register& r, unsigned stride) {
    const unsigned first = r.address & kPage;
    return x == (r.space == 'X') && address >= first && (address - first) % stride == 0;
  };
  if (geo) {
    const unsigned channel = address >> 5 & 1;
    if (is(regs::ssi_geo::kControl, 0x20)) return {Place::kControl, channel};
    if (is(regs::ssi_geo::kPosition, 0x20)) return {Place::kPosition, channel};
    if (is(regs::ssi_geo::kRefused, 0x20)) return {Place::kRefused, channel};
    if (x && address == (regs::ssi_geo::kTiming.address & kPage)) return {Place::kTiming, channel};
    return {Place::kNone, channel};
  }
  const unsigned channel = address >> 2 & 7;
  if (is(regs::ssi_brick::kControl, 4)) return {Place::kControl, channel};
  if (is(regs::ssi_brick::kPosition, 4)) return {Place::kPosition, channel};
  if (is(regs::ssi_brick::kPositionHigh, 4)) return {Place::kHigh, channel};
  if (is(regs::ssi_brick::kRefused, 4)) return {Place::kRefused, channel};
  if (is(regs::ssi_brick::kTiming, 16)) return {Place::kTiming, channel};
  return {Place::kNone, channel};
}

std::uint32_t Ssi::read(bool x, unsigned address) const {
  const auto [place, n] = where(x, address);
  const Group& g = group_[n / kChannelsEach];
  const Channel& c = g.channel[n % kChannelsEach];
  switch (place) {
    case Place::kControl:
      return c.control & ~regs::ssi_brick::control::kDriver.mask();  // a Geo PMAC has no such bit
    case Place::kPosition:
      return c.position & 0xFFFFFF;
    case Place::kHigh:
      return c.high;
    case Place::kRefused:
      return (geo ? regs::ssi_geo::refused::kCount : regs::ssi_brick::refused::kCount).at(c.refused);
    case Place::kTiming:
      return g.word;
    case Place::kNone:
      break;
  }
  return 0;
}

void Ssi::read_taken(bool x, unsigned address) {
  const auto [place, n] = where(x, address);
  if (place != Place::kPosition) return;
  Channel& c = group_[n / kChannelsEach].channel[n % kChannelsEach];
  c.high = regs::ssi_brick::position_high::kHigh.at(c.position >> 24) |
           regs::ssi_brick::position_high::kParityError.at(c.parity_error);
}

void Ssi::write(bool x, unsigned address, std::uint32_t value) {
  const auto [place, n] = where(x, address);
  Group& g = group_[n / kChannelsEach];
  if (place == Place::kControl) {
    Channel& c = g.channel[n % kChannelsEach];
    c.control = value & (geo ? regs::ssi_geo::kControl : regs::ssi_brick::kControl).written;
    if (!geo || control(c).enable()) c.gray = control(c).gray();
    c.shot_ends = kNever;  // of a single frame that began at this edge, with the word before
  }
  if (place == Place::kTiming) g.word = value & (geo ? regs::ssi_geo::kTiming : regs::ssi_brick::kTiming).written;
}

bool Ssi::triggered(const Group& g) const {
  const ssi::Timing t = timing(g);
  const bool before = t.on_servo() ? servo_ : phase_, after = t.on_servo() ? servo : phase;
  return t.triggers() && before != after && before == t.falling();
}

Tick Ssi::next_event() const {
  Tick next = kNever;
  for (const Group& g : group_) {
    if (g.state == State::kDelay || g.state == State::kLow || g.state == State::kHigh) next = std::min(next, g.next);
    if (nets_moved() && g.state == State::kIdle && triggered(g) &&
        std::any_of(g.channel.begin(), g.channel.end(), [this](const Channel& c) { return control(c).enable(); }))
      next = now_ + 1;
  }
  return next;
}

void Ssi::pass(Tick edges) {
  if (edges <= 0) return;
  data2_ = edges > 1 ? data : data1_;
  data1_ = data;
}

void Ssi::end_shots(Tick t) {
  for (Group& g : group_)
    for (Channel& c : g.channel)
      if (c.shot_ends <= t) {
        c.control &= ~regs::ssi_brick::control::kTrigger.mask();
        c.shot_ends = kNever;
      }
}

void Ssi::advance(Tick t) {
  while (now_ < t) {
    Tick next = nets_moved() ? now_ + 1 : t;
    for (const Group& g : group_) next = g.loads != 0 ? now_ + 1 : std::min(next, g.next);
    pass(next - 1 - now_);
    for (unsigned i = 0; i < kGroups; ++i) edge(next, i);
    pass(1);
    phase_ = phase;
    servo_ = servo;
    now_ = next;
  }
  end_shots(now_);
}

// The pins as they are seen inside follow those outside before a frame can begin, and stay.
void Ssi::reset(Tick t) {
  group_ = {};
  clk_ = 0xFF;
  now_ = t;
}

void Ssi::enter(Group& g, State state, std::int64_t cycles) {
  g.state = state;
  g.cycles += cycles;
  g.next = g.begin + timing(g).ticks(g.cycles);
}

void Ssi::edge(Tick t, unsigned group) {
  Group& g = group_[group];
  const ssi::Timing timing = this->timing(g);
  if (nets_moved() && triggered(g) && g.state != State::kIdle)
    for (Channel& c : g.channel) c.refused = static_cast<std::uint8_t>(c.refused + (control(c).enable() ? 1 : 0));
  if (g.loads != 0) load(g);
  if (g.state == State::kIdle) {
    if (!nets_moved() || !triggered(g)) return;
    start(t, g);
    if (g.state == State::kLow) fall(group);
    return;
  }
  if (t != g.next) return;
  switch (g.state) {
    case State::kIdle:
      break;
    case State::kDelay:
      if (--g.periods > 0) {
        enter(g, State::kDelay, timing.period());
        break;
      }
      enter(g, State::kLow, timing.low_time());
      fall(group);
      break;
    case State::kLow:
      rise(group);
      if (std::any_of(g.channel.begin(), g.channel.end(), [](const Channel& c) { return c.active; })) {
        enter(g, State::kHigh, timing.high_time());
      } else {
        g.state = State::kRest;
        g.next = t + kRestTicks;
      }
      break;
    case State::kHigh:
      enter(g, State::kLow, timing.low_time());
      fall(group);
      break;
    case State::kRest:
      g.state = State::kIdle;
      g.next = kNever;
      break;
  }
}

void Ssi::start(Tick t, Group& g) {
  bool any = false;
  for (Channel& c : g.channel) {
    const ssi::Control control = this->control(c);
    if (!control.enable()) continue;
    any = c.active = c.first = true;
    c.shift = 0;
    c.odd = false;
    c.rises = control.bits() + (control.parity() ? 1 : 0) + 1;
    if (control.single()) c.shot_ends = next_ref_edge(t);
  }
  if (!any) return;
  const ssi::Timing timing = this->timing(g);
  g.begin = t;
  g.cycles = 0;
  g.periods = timing.delay();
  if (g.periods > 0)
    enter(g, State::kDelay, timing.period());
  else
    enter(g, State::kLow, timing.low_time());
}

void Ssi::fall(unsigned group) {
  for (unsigned i = 0; i < kChannelsEach; ++i) {
    const Channel& c = group_[group].channel[i];
    if (c.active && control(c).driver()) clk_ = static_cast<std::uint8_t>(clk_ & ~(1u << (group * kChannelsEach + i)));
  }
}

void Ssi::rise(unsigned group) {
  Group& g = group_[group];
  for (unsigned i = 0; i < kChannelsEach; ++i) {
    Channel& c = g.channel[i];
    const unsigned n = group * kChannelsEach + i;
    clk_ = static_cast<std::uint8_t>(clk_ | 1u << n);
    if (!c.active) continue;
    const ssi::Control control = this->control(c);
    const bool level = has(data2_, n), parity_bit = control.parity() && c.rises == 1;
    if (!c.first) c.odd = c.odd != level;
    if (!c.first && !parity_bit) c.shift = c.shift << 1 | (level != (c.gray && (c.shift & 1) != 0) ? 1 : 0);
    c.first = false;
    if (--c.rises > 0) continue;
    c.active = false;
    g.loads |= 1u << i;
  }
}

void Ssi::load(Group& g) {
  for (unsigned i = 0; g.loads >> i != 0; ++i) {
    if (!has(g.loads, i)) continue;
    Channel& c = g.channel[i];
    const ssi::Control control = this->control(c);
    c.position = c.shift;
    c.parity_error = (control.odd() && !c.odd) || (control.even() && c.odd);
  }
  g.loads = 0;
}

}  // namespace brick
