#include "testbench/unit/vectors/runner.h"

#include <fmt/format.h>

#include <array>

namespace brick {
namespace {

struct Stop {};  // the rest of the vector makes no sense

const char* verb(Edge edge) { return edge == Edge::kRises ? "rise" : edge == Edge::kFalls ? "fall" : "change"; }

class Runner {
 public:
  Runner(const Vector& vector, Device& device, const Corruption* corruption)
      : vector_(vector), device_(device), corruption_(corruption) {}

  RunResult run() {
    const auto signals = static_cast<unsigned>(device_.signals().size());
    result_.record.declare(vector_.signals.size());
    for (unsigned i = 0; i < signals; ++i) changed(device_.now(), i, device_.value(i));
    device_.on_change = [this](Tick t, unsigned signal, std::uint32_t value) { changed(t, signal, value); };
    try {
      device_.reset();
      result_.marks["begin"] = device_.now();
      for (const Step& s : vector_.steps) {
        now_ = &s;
        std::visit([this](const auto& action) { act(action); }, s.action);
      }
    } catch (const DeviceError& error) { fail(error.what()); } catch (const Stop&) {
    }
    device_.on_change = nullptr;
    return std::move(result_);
  }

 private:
  bool corrupted(Corruption::Kind kind) const { return corruption_ != nullptr && corruption_->kind == kind; }
  bool corrupted(Corruption::Kind kind, unsigned signal) const {
    return corrupted(kind) && corruption_->signal == signal;
  }
  bool corrupted(Corruption::Kind kind, Word word) const {
    return corrupted(kind) && corruption_->word.x == word.x && corruption_->word.addr == word.addr;
  }

  void changed(Tick t, unsigned signal, std::uint32_t value) {
    if (corrupted(Corruption::kLate, signal)) t += corruption_->ticks;
    if (corrupted(Corruption::kStuck, signal)) value = corruption_->bits;
    result_.record.change(t, signal, value);
    shift(signal, value);
  }
  // A serial converter puts out its next bit when the clock falls, an absolute encoder when it rises.
  void shift(unsigned clock, std::uint32_t value) {
    if (sender_ == nullptr || clock != sender_->clock || (value != 0) != sender_->rises) return;
    if (sender_->rises) return drive(sender_->signal, bit_ < 24 ? sender_->word >> (23 - bit_++) & 1 : 0);
    bit_ = bit_ < 23 ? bit_ + 1 : 23;
    drive(sender_->signal, sender_->word >> (23 - bit_) & 1);
  }
  void drive(unsigned signal, std::uint32_t value) {
    device_.drive(signal, corrupted(Corruption::kInvert, signal) ? value ^ 1 : value);
  }

  void fail(const std::string& found) {
    const std::string where =
        now_ == nullptr ? vector_.path : fmt::format("{}:{}: {}", vector_.path, now_->line, now_->text);
    result_.failures.push_back(where + ": " + found);
  }
  void check(bool good, const std::string& found) {
    ++result_.checks;
    if (!good) fail(found);
  }
  Tick from(const Window& w) const { return result_.at(w.from); }
  Tick to(const Window& w) {
    const Tick end = result_.at(w.to);
    if (end <= from(w) || end > device_.now()) {
      fail(fmt::format("found a window from tick {} to {} at tick {}, expected one of at least a tick that has passed",
                       from(w), end, device_.now()));
      throw Stop{};
    }
    return end;
  }
  std::vector<Tick> edges(SignalEdge e, const Window& w) { return result_.record.edges(e, from(w), to(w)); }
  const std::string& name(unsigned signal) const { return vector_.signals[signal].name; }

  // A bus cycle in the record.
  void show(Tick start, Word word, std::uint32_t value) {
    const auto bus = static_cast<unsigned>(vector_.signals.size()) - 1;
    result_.bus.push_back(fmt::format("{}:${:02X}=${:X}", word.x ? "X" : "Y", word.addr, value));
    result_.record.change(start, bus, static_cast<std::uint32_t>(result_.bus.size()));
    result_.record.change(device_.now(), bus, 0);
  }

  void act(const step::Reset&) { device_.reset(); }
  void act(const step::Write& w) {
    const Tick start = device_.now();
    const std::uint32_t value = corrupted(Corruption::kWrite, w.word) ? w.value ^ corruption_->bits : w.value;
    device_.write(w.word.x, w.word.addr, value);
    show(start, w.word, value);
  }
  void act(const step::Read& r) {
    const Tick start = device_.now();
    std::uint32_t value = device_.read(r.word.x, r.word.addr);
    show(start, r.word, r.mask != 0 ? value & r.mask : value);
    if (corrupted(Corruption::kRead, r.word)) value ^= corruption_->bits;
    if (r.mask != 0) check((value & r.mask) == r.value, fmt::format("found ${:06X}", value & r.mask));
  }
  void act(const step::Drive& d) { drive(d.signal, d.value); }
  void act(const step::Wait& w) { device_.run(w.ticks); }
  void act(const step::Until& u) {
    const Tick start = device_.now();
    while (device_.now() < start + u.limit) {
      device_.run_towards_change(u.edge.signal, start + u.limit);
      if (!result_.record.edges(u.edge, start + 1, device_.now() + 1).empty()) return;
    }
    fail(fmt::format("found no {} of {} within {} ticks", verb(u.edge.edge), name(u.edge.signal), u.limit));
    throw Stop{};
  }
  void act(const step::Mark& m) { result_.marks[m.name] = device_.now(); }
  void act(const step::Turn& t) {
    constexpr std::array<std::uint32_t, 4> kA{0, 1, 1, 0}, kB{0, 0, 1, 1};  // upwards A leads
    const auto pin_a = 12 * t.channel, pin_b = pin_a + 1;
    const auto position = static_cast<unsigned>(device_.signals().size()) + t.channel;
    for (std::int64_t n = 0; n != t.counts; n += t.counts > 0 ? 1 : -1) {
      position_[t.channel] += t.counts > 0 ? 1 : -1;
      const auto place = static_cast<unsigned>(position_[t.channel]) & 3;
      drive(pin_a, kA[place]);
      drive(pin_b, kB[place]);
      result_.record.change(device_.now(), position, static_cast<std::uint32_t>(position_[t.channel]));
      device_.run(t.every);
    }
  }
  void act(const step::Send& s) {
    sender_ = &s;
    bit_ = 0;
    drive(s.signal, s.rises ? 1 : s.word >> 23 & 1);
  }
  void act(const step::Command& c) {
    const bool other = corrupted(Corruption::kCommand) && corruption_->line == c.line;
    const std::string reply = device_.command(other ? corruption_->instead : c.line);
    if (c.reply) check(reply == *c.reply, fmt::format("found \"{}\"", reply));
  }

  void act(const step::Level& l) {
    const std::uint32_t value = result_.record.value(l.signal, device_.now());
    check(value == l.value, fmt::format("found {}", value));
  }
  void act(const step::High& h) {
    const Tick ticks = result_.record.high(h.signal, from(h.window), to(h.window));
    check(ticks == h.ticks, fmt::format("found {} ticks", ticks));
  }
  void act(const step::Count& c) {
    const std::size_t times = edges(c.edge, c.window).size();
    check(times == static_cast<std::size_t>(c.times), fmt::format("found {} times", times));
  }
  void act(const step::At& a) {
    const Tick t = result_.at(a.time);
    const auto near = result_.record.edges(a.edge, t - 100'000, t + 100'000);
    Tick nearest = kNever;
    for (const Tick edge : near)
      if (std::abs(edge - t) < std::abs(nearest - t)) nearest = edge;
    check(nearest == t, near.empty() ? fmt::format("found no {} near tick {}", verb(a.edge.edge), t)
                                     : fmt::format("found it {} ticks later", nearest - t));
  }
  void act(const step::Period& p) { distances(edges({p.signal, Edge::kRises}, p.window), p.ticks); }
  void distances(const std::vector<Tick>& rises, Tick ticks) {
    check(rises.size() >= 2, fmt::format("found {} rises, expected at least two", rises.size()));
    for (std::size_t i = 1; i < rises.size(); ++i)
      check(rises[i] - rises[i - 1] == ticks,
            fmt::format("found {} ticks at tick {}", rises[i] - rises[i - 1], rises[i - 1]));
  }
  void act(const step::Pulses& p) {
    const auto rises = edges({p.signal, Edge::kRises}, p.window);
    check(!rises.empty(), "found no pulse");
    for (const Tick rise : rises) {
      const Tick width = result_.record.next_change(p.signal, rise) - rise;
      if (rise + width > device_.now()) {
        check(rise + p.ticks > device_.now(), fmt::format("found more than {} ticks", device_.now() - rise));
      } else {
        check(width == p.ticks, fmt::format("found {} ticks at tick {}", width, rise));
      }
    }
  }
  void act(const step::Stays& s) {
    const auto changes = edges({s.signal, Edge::kChanges}, {s.window.from, s.window.to});
    const std::uint32_t value = result_.record.value(s.signal, from(s.window));
    check(value == s.value, fmt::format("found {}", value));
    const bool later = !changes.empty() && changes.back() > from(s.window);
    check(!later,
          later ? fmt::format("found a change {} ticks after the begin of the window", changes.back() - from(s.window))
                : "");
  }
  void act(const step::Gap& g) {
    const auto firsts = edges(g.first, g.window);
    check(!firsts.empty(), fmt::format("found no {} of {}", verb(g.first.edge), name(g.first.signal)));
    for (const Tick first : firsts) {
      const auto seconds = result_.record.edges(g.second, first, device_.now() + 1);
      if (seconds.empty()) {
        check(first + g.ticks > device_.now(),
              fmt::format("found no {} of {} after tick {}", verb(g.second.edge), name(g.second.signal), first));
      } else {
        check(seconds[0] - first == g.ticks, fmt::format("found {} ticks at tick {}", seconds[0] - first, first));
      }
    }
  }
  void act(const step::Bits& b) {
    std::string bits;
    for (const Tick t : edges({b.clock, Edge::kRises}, b.window))
      bits += result_.record.value(b.signal, t) != 0 ? '1' : '0';
    check(bits == b.bits, "found " + bits);
  }

  const Vector& vector_;
  Device& device_;
  const Corruption* corruption_;
  const Step* now_ = nullptr;
  const step::Send* sender_ = nullptr;
  unsigned bit_ = 0;
  std::array<std::int64_t, 4> position_{};
  RunResult result_;
};

}  // namespace

std::string RunResult::text() const {
  std::string all;
  for (const auto& failure : failures) all += failure + "\n";
  return checks == 0 ? all + "nothing was checked\n" : all;
}

RunResult run_vector(const Vector& vector, Device& device, const Corruption* corruption) {
  return Runner(vector, device, corruption).run();
}

}  // namespace brick
