// pwm: commands through M-variables on all phases of two servo ICs, switch pins watched edge by edge. Where the
// triangle of an IC stands is learnt once a round from one falling edge at command 0; from there on every edge of its
// 12 phases has its tick (testbench/checkers/pwm_scoreboard.h), through new commands at any time and new I7000.
#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "systemc/core/clock_delays.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/output_host.h"
#include "testbench/checkers/pwm_scoreboard.h"

namespace brick {
namespace {

constexpr unsigned kPhases = 3;  // A, B, C of a channel
constexpr std::array<const MotorField*, kPhases> kTop{&motor_pin::kPwmATop, &motor_pin::kPwmBTop, &motor_pin::kPwmCTop};
constexpr std::array<const MotorField*, kPhases> kBottom{&motor_pin::kPwmABot, &motor_pin::kPwmBBot,
                                                         &motor_pin::kPwmCBot};
constexpr std::array<unsigned, kPhases> kVariable{2, 4, 7};  // M102, M104, M107
constexpr std::array<regs::Register, kPhases> kOut{word::kOutA, word::kOutB, word::kOutC};
// A turn takes what was written before it: commands a tick later, because the turn reaches a channel a tick late
// (servo-ic:5.11/4), I7m00 a tick earlier (servo-ic:5.1/5, servo-ic:5.1/12). Turns that are seen are late by kPwmDelay.
constexpr Tick kCommandBeforeTurn = kPwmDelay, kLimitBeforeTurn = kPwmDelay + 2;
constexpr Tick kNear = 8;  // of a turn to the edge of PHASE, servo-ic:5.1/6
enum Switches : unsigned { kOff = 0, kUpper = 1, kLower = 2, kShort = 3 };

class Pwm {
 public:
  explicit Pwm(BenchContext& b) : host_(b), commands_(kPhases * host_.channels()), inverted_(host_.channels()) {
    rule_.greater = !b.negative;
    for (unsigned i = 0; i < kPhases; ++i) host_.define(100 + kVariable[i], kOut[i], true, ServoHost::kCommand);
  }

  void vectors();
  void round(unsigned number);
  void new_limits();
  void total() {
    drop();
    report_.step("upper and lower switch both on, ever", shorts_, 1000 * host_.places(),
                 fmt::format("never in {} levels of {} phases", shorts_.made(), phases()));
  }

 private:
  unsigned phases() const { return static_cast<unsigned>(commands_.size()); }
  unsigned place(unsigned phase) const { return phase / kPhases / kChannels; }
  bool inverted(unsigned phase) const {
    return (inverted_[phase / kPhases] >> (phase % kPhases == 2 ? 1 : 0) & 1) != 0;
  }
  std::string name(unsigned phase) const {
    return fmt::format("{} {}", host_.name(phase / kPhases), "ABC"[phase % kPhases]);
  }
  Tick period(unsigned place) const { return 4 * static_cast<Tick>(limit_[place]) + 6; }

  std::vector<PwmLevel> levels(unsigned phase) const;
  void drop();
  void command(const std::vector<std::pair<unsigned, int>>& values);
  void zero();
  void configure(unsigned limit, unsigned other, unsigned phase_divider, unsigned servo_divider, unsigned dead);
  void invert(const std::vector<unsigned>& values);
  bool find_triangle();
  Comparison differences(unsigned places);
  void on_times(const std::string& what, unsigned places);
  void judge(const std::string& what, unsigned places = 2);  // of as many ICs as there are
  int random_command(unsigned place);

  OutputHost host_;
  BenchReport& report_ = host_.report();
  PwmRule rule_;
  std::vector<std::vector<PwmCommand>> commands_;  // since the triangle was found
  std::vector<PwmChange> changes_;                 // of I7m00 of the first IC since then
  std::vector<unsigned> inverted_;                 // I7mn7
  std::array<unsigned, 2> limit_{6527, 6527};
  std::array<Tick, 2> bottom_{};
  std::array<unsigned, 2> limit_then_{};
  unsigned dead_ = 15;
  Comparison shorts_;
};

std::vector<PwmLevel> Pwm::levels(unsigned phase) const {
  std::vector<PwmLevel> list;
  const unsigned channel = phase / kPhases % kChannels, turn = inverted(phase) ? 3 : 0;
  for (const auto& c : host_.changes(place(phase))) {
    const unsigned pins =
        (c.pins.get(*kTop[phase % kPhases], channel) | c.pins.get(*kBottom[phase % kPhases], channel) << 1) ^ turn;
    if (list.empty() || list.back().pins != pins) list.push_back({c.tick, pins});
  }
  return list;
}

// Forgets the record; what was in it has shorted no phase.
void Pwm::drop() {
  for (unsigned p = 0; p < phases(); ++p) {
    for (const PwmLevel& l : levels(p))
      shorts_.judged(name(p), l.pins != kShort ? "" : fmt::format("both switches on at tick {}", l.tick));
  }
  host_.forget();
}

void Pwm::command(const std::vector<std::pair<unsigned, int>>& values) {
  std::vector<std::string> words;
  for (const auto& [phase, value] : values)
    words.push_back(fmt::format("M{}={}", 100 * (phase / kPhases + 1) + kVariable[phase % kPhases], value));
  host_.say(words);
  for (const auto& [phase, value] : values) {
    const Tick at = host_.written(phase / kPhases, kOut[phase % kPhases]);
    if (at < 0) report_.fail(name(phase), "the command never came to its word");
    commands_[phase].push_back({at + kCommandBeforeTurn, value});
  }
}

void Pwm::zero() {
  std::vector<std::pair<unsigned, int>> values;
  for (unsigned p = 0; p < phases(); ++p) values.emplace_back(p, 0);
  command(values);
}

// I7m00 of both ICs, dividers of the source, dead time of both; then until the second triangle has followed
// (servo-ic:5.1/6).
void Pwm::configure(unsigned limit, unsigned other, unsigned phase_divider, unsigned servo_divider, unsigned dead) {
  zero();
  host_.say({fmt::format("I7000={} I7001={} I7002={}", limit, phase_divider, servo_divider)});
  for (unsigned i = 0; i < host_.places(); ++i)
    host_.say({fmt::format("I{}={}", host_.i_global(i, 0), i == 0 ? limit : other),
               fmt::format("I{}={}", host_.i_global(i, 4), dead)});
  limit_ = {limit, other};
  dead_ = dead;
  rule_.dead = 16 * static_cast<Tick>(dead);
  host_.wait(8 * std::max(period(0), period(1)));
}

void Pwm::invert(const std::vector<unsigned>& values) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < host_.channels(); ++i)
    words.push_back(fmt::format("I{}={}", host_.i_channel(i, 7), values[i]));
  drop();
  host_.say(words);
  host_.forget();
  inverted_ = values;
}

// At command 0 the upper switch goes off when the counter comes up to 0, I7m00 + 2 ticks after the bottom turn. All
// turns here are later by kPwmDelay, as the switches are.
bool Pwm::find_triangle() {
  drop();
  host_.wait(2 * std::max(period(0), period(1)) + rule_.dead);
  for (unsigned i = 0; i < host_.places(); ++i) {
    const auto seen = levels(kPhases * kChannels * i);
    std::size_t last = seen.size() - 1;  // first level after the upper switch was on
    while (last > 0 && seen[last - 1].pins != kUpper) --last;
    if (last == 0) {
      report_.fail(name(kPhases * kChannels * i), "no falling edge at command 0");
      return false;
    }
    bottom_[i] = seen[last].tick - (limit_[i] + 2);
  }
  limit_then_ = limit_;
  changes_.clear();
  for (auto& list : commands_) list = {{0, 0}};
  return true;
}

Comparison Pwm::differences(unsigned places) {
  const Tick to = host_.now();
  Comparison same;
  for (unsigned p = 0; p < phases() && place(p) < places; ++p) {
    const auto seen = levels(p);
    const Tick from = bottom_[place(p)] + 1 + rule_.dead;
    const auto turns =
        pwm_turns(bottom_[place(p)], limit_then_[place(p)], to, place(p) == 0 ? changes_ : std::vector<PwmChange>{});
    const std::string difference = pwm_difference(seen, pwm_switches(turns, commands_[p], rule_), from, to);
    const auto edges = std::count_if(seen.begin(), seen.end(), [from](const PwmLevel& l) { return l.tick > from; });
    same.judged(name(p), difference, static_cast<unsigned>(edges));
  }
  return same;
}

// The same once more by the formula: on times of both switches in the last whole period.
void Pwm::on_times(const std::string& what, unsigned places) {
  Comparison same;
  Tick least = kNever, most = 0;
  for (unsigned p = 0; p < phases() && place(p) < places; ++p) {
    const Tick whole = period(place(p)), raw = pwm_on_time(limit_[place(p)], commands_[p].back().value);
    const Tick upper = raw == whole ? whole : std::max<Tick>(0, raw - rule_.dead);
    const Tick lower = raw == 0 ? whole : std::max<Tick>(0, whole - raw - rule_.dead);
    const auto seen = levels(p);
    const Tick from = host_.now() - whole, on = pwm_time(seen, kUpper, from, host_.now());
    least = std::min(least, on);
    most = std::max(most, on);
    const std::string where = fmt::format("{} at command {}", name(p), commands_[p].back().value);
    same.equal(where + " upper", on, upper);
    same.equal(where + " lower", pwm_time(seen, kLower, from, host_.now()), lower);
  }
  report_.step(what + ", on times in a period", same, 2 * kPhases * kChannels * places,
               fmt::format("upper switches {} to {} ticks", least, most));
}

// The window is two PWM periods of the slower IC or more, and at most three of its half periods make a PHASE period,
// but for the two at its ends.
void Pwm::judge(const std::string& what, unsigned places) {
  places = std::min(places, host_.places());
  host_.wait(2 * std::max(period(0), period(1)));
  const Comparison edges = differences(places);
  report_.step(what, edges, kPhases * kChannels * places, fmt::format("{} edges, each at its tick", edges.made()));
  on_times(what, places);

  Comparison rises;
  for (unsigned i = 0; i < places; ++i) {
    const auto turns = pwm_turns(bottom_[i], limit_then_[i], host_.now(), i == 0 ? changes_ : std::vector<PwmChange>{});
    for (const auto& edge : host_.phase()) {
      if (!edge.high || edge.tick < bottom_[i] || edge.tick > host_.now() - kNear) continue;
      Tick best = kNever;
      for (const PwmTurn& t : turns)
        if (std::abs(t.tick - edge.tick) < std::abs(best)) best = t.tick - edge.tick;
      rises.equal(fmt::format("{} ticks from PHASE at {} to a turn", servo_ic_scope(host_.ic(i)), edge.tick), best,
                  host_.behind(i) + kPwmDelay);
    }
  }
  report_.step("PHASE rises at a turn", rises, 2 * places, fmt::format("{} rises", rises.made()));
}

// Commands that matter: anywhere, about 0, at and beyond the ends of the triangle, and pulses about as long as the dead
// time.
int Pwm::random_command(unsigned place) {
  const int limit = static_cast<int>(limit_[place]);
  const int sign = host_.pick(2) == 0 ? 1 : -1;
  switch (host_.pick(6)) {
    case 0:
      return sign * static_cast<int>(host_.pick(20));
    case 1:
      return sign * (limit - 1 + static_cast<int>(host_.pick(5)));
    case 2:
      return sign > 0 ? 32767 : -32768;
    case 3:
      return sign * (limit + 1 - static_cast<int>(8 * dead_) + static_cast<int>(host_.pick(5)) - 2);
    default:
      return static_cast<int>(host_.pick(2 * limit + 4)) - limit - 2;
  }
}

// servo-ic:14/1 to servo-ic:14/3.
void Pwm::vectors() {
  constexpr std::array<int, 6> kCommands{0, 100, -100, 6528, 6529, -6529};
  constexpr std::array<Tick, 6> kHigh{13057, 13257, 12857, 26113, 26114, 0};
  configure(6527, 6527, 0, 3, 0);
  if (!find_triangle()) return;
  std::vector<std::pair<unsigned, int>> values;
  for (unsigned p = 0; p < phases(); ++p) values.emplace_back(p, kCommands[(p + p / 6) % 6]);
  command(values);
  host_.wait(3 * period(0));
  for (unsigned v = 0; v < 6; ++v) {
    const Tick high = pwm_time(levels(v), kUpper, host_.now() - 26114, host_.now());
    report_.equal<std::int64_t>(fmt::format("I7000=6527, command {}: high ticks of 26114, {}", kCommands[v], name(v)),
                                high, kHigh[v]);
  }
  judge("I7004=0");

  configure(6527, 6527, 0, 3, 15);
  if (!find_triangle()) return;
  const auto seen = levels(0);
  Tick shortest = kNever, longest = 0;
  for (std::size_t i = 1; i + 1 < seen.size(); ++i)
    if (seen[i].pins == kOff) {
      shortest = std::min(shortest, seen[i + 1].tick - seen[i].tick);
      longest = std::max(longest, seen[i + 1].tick - seen[i].tick);
    }
  report_.step("I7004=15: both switches off for 240 ticks at each edge", shortest == 240 && longest == 240,
               fmt::format("{} to {}", shortest, longest));
  judge("command 0");
}

void Pwm::round(unsigned number) {
  std::vector<unsigned> inversions;
  for (unsigned i = 0; i < host_.channels(); ++i) inversions.push_back(host_.pick(4));
  invert(inversions);
  // The second IC may have any PWM frequency with a whole number of half periods in a PHASE period (servo-ic:3.1): one
  // or three.
  const unsigned limit = 3200 + host_.pick(3000), slow = (number + static_cast<unsigned>(host_.bench().seed)) % 2,
                 divider = slow != 0 ? 2 : 0;
  configure(limit, slow != 0 ? 3 * limit + 3 : limit, divider, slow != 0 ? 1 : 5, host_.pick(200) + 1);
  if (!find_triangle()) return;
  for (unsigned set = 0; set < 3; ++set) {  // the second and third while the first runs
    std::vector<std::pair<unsigned, int>> values;
    for (unsigned p = 0; p < phases(); ++p)
      if (set == 0 || host_.pick(2) == 0) values.emplace_back(p, random_command(place(p)));
    command(values);
    host_.wait(host_.pick(static_cast<unsigned>(period(0))));
  }
  const std::string second = host_.places() < 2 ? "" : fmt::format(" I{}={}", host_.i_global(1, 0), limit_[1]);
  judge(fmt::format("round {}: I7000={}{} I7004={}", number, limit_[0], second, dead_));
}

// The source's I7000 changes while its PWM runs: from the next bottom turn on.
void Pwm::new_limits() {
  configure(5000, 5000, 0, 5, host_.pick(60));
  if (!find_triangle()) return;
  std::vector<std::pair<unsigned, int>> values;
  for (unsigned p = 0; p < phases() / 2; ++p) values.emplace_back(p, random_command(0));
  command(values);
  std::string list;
  for (unsigned i = 0; i < 4; ++i) {
    limit_[0] = 3500 + host_.pick(3500);
    host_.say({fmt::format("I7000={}", limit_[0])});
    changes_.push_back({host_.written(0, regs::servo_ic::kPwmControl) + kLimitBeforeTurn, limit_[0]});
    list += fmt::format("{}{}", i == 0 ? "" : ", ", limit_[0]);
    host_.wait(period(0) + host_.pick(static_cast<unsigned>(period(0))));
  }
  judge("I7000=" + list + " while running", 1);
}

void run(BenchContext& b) {
  Pwm pwm(b);
  pwm.vectors();
  for (unsigned i = 1; i <= 3; ++i) pwm.round(i);
  pwm.new_limits();
  pwm.total();
}

}  // namespace

// covers: CLK-6 CARD-1 CARD-2
Bench pwm_bench() {
  return {"pwm",
          "commands on 24 phases: on times, dead time, inversion, new commands and I7000 while running, every edge at "
          "its tick",
          {"the scoreboard compares with >= instead of >", "I7004=0", "expected tick"},
          run,
          kServoIc0};
}

}  // namespace brick
