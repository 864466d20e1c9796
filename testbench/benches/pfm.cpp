// pfm: OUT C of all channels as pulse trains, commands through M-variables, pulse and direction pins watched edge by
// edge, counters on their own pulses (I7mn0 = 8). The scoreboard (testbench/checkers/pfm_scoreboard.h) has the
// accumulator from power-up on, so every pulse has its tick whatever was commanded before.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/output_host.h"
#include "testbench/checkers/pfm_scoreboard.h"

namespace brick {
namespace {

constexpr unsigned kCommand = 7, kPosition = 1;  // M107: OUT C; M101: position at PHASE
constexpr unsigned kSclk = 2, kOthers = 2258 & ~077;
constexpr Tick kSclkPeriod = kTicksPerRef << kSclk;

class Pfm {
 public:
  explicit Pfm(BenchContext& b) : host_(b), boards_(host_.channels()), inverted_(host_.channels()) {
    if (b.negative) rule_[0].largest = rule_[1].largest = 1 << 23;
    host_.define(100 + kCommand, word::kOutC, true);
    host_.define(100 + kPosition, word::kPhasePosition, true);
    std::vector<std::string> words;
    for (unsigned i = 0; i < host_.channels(); ++i) {
      words.push_back(fmt::format("M{}=0", 100 * (i + 1) + kCommand));
      words.push_back(fmt::format("I{}=8", host_.i_channel(i, 0)));
      words.push_back(fmt::format("I{}=2", host_.i_channel(i, 6)));
    }
    host_.say(words);
  }

  void vector6();
  void ceiling();
  void round(unsigned number, unsigned width, unsigned other);

 private:
  struct Inversion {
    unsigned pulse = 0, direction = 0;  // I7mn7 bit 1, I7mn8
  };
  BenchReport& report() { return host_.report(); }
  const PfmRule& rule(unsigned channel) const { return rule_[channel / kChannels]; }

  void configure(std::array<unsigned, 2> divider, std::array<unsigned, 2> width);
  void invert(const std::vector<Inversion>& values);
  std::vector<PfmLevel> levels(unsigned channel) const;
  std::vector<Tick> rises(unsigned channel) const;
  void begin();
  void command(const std::vector<int>& values);  // of all channels
  void end(const std::string& what, unsigned least_alone);
  std::string count_difference(unsigned channel) const;
  int random_command();
  int slow_command(bool up);

  OutputHost host_;
  std::vector<PfmScoreboard> boards_;
  std::array<PfmRule, 2> rule_;
  std::vector<Inversion> inverted_;
  std::vector<std::vector<PfmCommand>> commands_;
  std::vector<long> position_;
};

void Pfm::configure(std::array<unsigned, 2> divider, std::array<unsigned, 2> width) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < host_.places(); ++i) {
    words.push_back(fmt::format("I{}={}", host_.i_global(i, 3), kOthers | divider[i] << 3 | kSclk));
    words.push_back(fmt::format("I{}={}", host_.i_global(i, 4), width[i]));
    rule_[i].clock = kTicksPerRef << divider[i];
    rule_[i].width = width[i];
  }
  host_.say(words);
}

void Pfm::invert(const std::vector<Inversion>& values) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < host_.channels(); ++i) {
    words.push_back(fmt::format("I{}={}", host_.i_channel(i, 7), 2 * values[i].pulse));
    words.push_back(fmt::format("I{}={}", host_.i_channel(i, 8), values[i].direction));
  }
  host_.say(words);
  inverted_ = values;
}

std::vector<PfmLevel> Pfm::levels(unsigned channel) const {
  std::vector<PfmLevel> list;
  const unsigned n = channel % kChannels, turn = inverted_[channel].pulse | inverted_[channel].direction << 1;
  for (const auto& c : host_.changes(channel / kChannels)) {
    const unsigned pins = (c.pins.get(motor_pin::kPfmPulse, n) | c.pins.get(motor_pin::kPfmDir, n) << 1) ^ turn;
    if (list.empty() || list.back().pins != pins) list.push_back({c.tick, pins});
  }
  return list;
}

std::vector<Tick> Pfm::rises(unsigned channel) const {
  std::vector<Tick> list;
  const auto seen = levels(channel);
  for (std::size_t i = 1; i < seen.size(); ++i)
    if ((seen[i].pins & 1) != 0 && (seen[i - 1].pins & 1) == 0) list.push_back(seen[i].tick);
  return list;
}

void Pfm::begin() {
  host_.wait(2 * 13'057);  // the position is latched with PHASE
  position_ = host_.numbers(fmt::format("M{},{},100", 100 + kPosition, host_.channels()));
  host_.forget();
  commands_.assign(host_.channels(), {});
}

void Pfm::command(const std::vector<int>& values) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < host_.channels(); ++i)
    words.push_back(fmt::format("M{}={}", 100 * (i + 1) + kCommand, values[i]));
  host_.say(words);
  for (unsigned i = 0; i < host_.channels(); ++i) {
    const Tick at = host_.written(i, word::kOutC);
    if (at < 0) report().fail(host_.name(i), "the command never came to its word");
    commands_[i].push_back({at, values[i]});
  }
}

// Every count is one pulse, at the first edge of SCLK after its leading edge.
std::string Pfm::count_difference(unsigned channel) const {
  const unsigned n = channel % kChannels;
  const auto& changes = host_.changes(channel / kChannels);
  const auto pulses = rises(channel);
  const auto seen = levels(channel);
  std::size_t i = 0, level = 0;
  for (std::size_t k = 1; k < changes.size(); ++k) {
    const auto before = changes[k - 1].pins.get(motor_pin::kCount, n),
               after = changes[k].pins.get(motor_pin::kCount, n);
    if (before == after) continue;
    if (i == pulses.size()) return fmt::format("count {} at tick {}, expected none", after, changes[k].tick);
    while (level + 1 < seen.size() && seen[level + 1].tick <= pulses[i]) ++level;
    const std::uint32_t expected = (before + ((seen[level].pins & 2) != 0 ? 0xFFFFFF : 1)) & 0xFFFFFF;
    if (after != expected || changes[k].tick <= pulses[i] || changes[k].tick > pulses[i] + kSclkPeriod)
      return fmt::format("count {} at tick {}, expected {} after tick {}", after, changes[k].tick, expected, pulses[i]);
    ++i;
  }
  return i == pulses.size() ? "" : fmt::format("{} counts, expected {}", i, pulses.size());
}

// No command any more; the last pulses end. Then the verdict on every edge, and the counters of the channels whose
// pulses do not run together: `least_alone` of them or more, each with a pulse at least.
void Pfm::end(const std::string& what, unsigned least_alone) {
  command(std::vector<int>(host_.channels(), 0));
  host_.wait(2 * 13'057 + 256 * std::max(rule_[0].clock, rule_[1].clock));
  const Tick to = host_.now();
  std::array<Tick, 2> grid{-1, -1};
  for (unsigned i = 0; i < host_.channels(); ++i)
    if (const auto pulses = rises(i); !pulses.empty() && grid[i / kChannels] < 0) grid[i / kChannels] = pulses.front();
  Comparison edges, counts;
  unsigned alone = 0;  // channels whose pulses can be told apart at the pin
  const auto position = host_.numbers(fmt::format("M{},{},100", 100 + kPosition, host_.channels()));
  for (unsigned i = 0; i < host_.channels(); ++i) {
    const auto seen = levels(i);
    edges.judged(host_.name(i), boards_[i].judge(rule(i), commands_[i], seen, grid[i / kChannels], to),
                 static_cast<unsigned>(seen.size()) - 1);
    const PfmScoreboard::Pulses& p = boards_[i].pulses();
    if (p.overlap) continue;  // pulses that run together
    if (p.up + p.down > 0) ++alone;
    counts.judged(host_.name(i), count_difference(i), static_cast<unsigned>(p.up + p.down));
    counts.equal(fmt::format("{} M{} less {}", host_.name(i), 100 * (i + 1) + kPosition, position_[i]),
                 position.at(i) - position_[i], p.up - p.down);
  }
  report().step(what, edges, 2 * host_.channels(), fmt::format("{} edges, each at its tick", edges.made()));
  counts.within("channels whose pulses can be told apart", alone, least_alone, host_.channels());
  report().step(what + ", one count a pulse", counts, 2 * least_alone + 1,
                fmt::format("{} channels with pulses that can be told apart, on the others they run together", alone));
}

// servo-ic:14/6; the same downwards on every second channel.
void Pfm::vector6() {
  configure({2, 2}, {15, 15});
  begin();
  std::vector<int> values;
  for (unsigned i = 0; i < host_.channels(); ++i) values.push_back(i % 2 == 0 ? 65'536 : -65'536);
  command(values);
  host_.wait(10 * 256 * 12);
  for (unsigned i = 0; i < 2; ++i) {
    const auto pulses = rises(i);
    const auto seen = levels(i);
    const std::string who = fmt::format("{} at ${:06X}, ", host_.name(i), values[i] & 0xFFFFFF);
    Comparison same;
    for (std::size_t k = 0; k + 1 < pulses.size(); ++k)
      same.equal(who + "period in ticks", pulses[k + 1] - pulses[k], 256 * 12);
    for (std::size_t k = 0; k + 1 < seen.size(); ++k)
      if ((seen[k].pins & 1) != 0)
        same.equal(who + "width in ticks, I7004=15", seen[k + 1].tick - seen[k].tick, 15 * 12);
    same.equal(who + "direction pin", seen.back().pins >> 1, i);
    report().step(who + "38.4 kHz, 180 ticks wide", same, 14, fmt::format("{} pulses", pulses.size()));
  }
  end("$010000 and -$010000", host_.channels());
}

// PFM_CLK / 4 is the most, whatever is commanded.
void Pfm::ceiling() {
  configure({3, 3}, {2, 2});
  begin();
  std::vector<int> values;
  for (unsigned i = 0; i < host_.channels(); ++i)
    values.push_back(std::array{8'388'607, -8'388'608, 4'194'305, -4'194'304}[i % 4] - (i > 4 && i % 2 == 0 ? 1 : 0));
  command(values);
  host_.wait(4'000);
  const auto pulses = rises(0);
  const Tick from = host_.now() - 2'400;
  const auto count = std::count_if(pulses.begin(), pulses.end(), [from](Tick t) { return t > from; });
  report().equal<std::int64_t>("pulses in 100 PFM_CLK at the highest command", count, 25);
  end("commands about 2^22 and far beyond", host_.channels());
}

int Pfm::random_command() {
  const int sign = host_.pick(2) == 0 ? 1 : -1;
  switch (host_.pick(5)) {
    case 0:
      return sign * static_cast<int>(host_.pick(3'000));
    case 1:
      return sign * static_cast<int>(1'000'000 + host_.pick(7'000'000));
    default:
      return sign * static_cast<int>(host_.pick(300'000));
  }
}

// 280 to 560 clocks from pulse to pulse, as long as the direction stays: more than the longest pulse, 255, and in the
// clocks that three sets of commands stand, 600 or more, at least one.
constexpr unsigned kSets = 3, kClocksOfASet = 200;
int Pfm::slow_command(bool up) { return (up ? 1 : -1) * static_cast<int>(30'000 + host_.pick(29'900)); }

void Pfm::round(unsigned number, unsigned width, unsigned other) {
  std::vector<Inversion> inversions;
  for (unsigned i = 0; i < host_.channels(); ++i) inversions.push_back({host_.pick(2), host_.pick(2)});
  invert(inversions);
  configure({2 + host_.pick(3), 2 + host_.pick(5)}, {width, other});
  begin();
  const bool up = host_.pick(2) == 0;
  const auto stands = static_cast<unsigned>(kClocksOfASet * std::max(rule_[0].clock, rule_[1].clock));
  for (unsigned set = 0; set < kSets; ++set) {
    std::vector<int> values;
    // The first makes a pulse every 56 PFM_CLK or more often, so that each channel has edges.
    const auto often = [this] {
      return (host_.pick(2) == 0 ? 1 : -1) * static_cast<int>(300'000 + host_.pick(700'000));
    };
    for (unsigned i = 0; i < host_.channels(); ++i)
      values.push_back(i % kChannels == 0 ? slow_command(up) : set == 0 ? often() : random_command());
    command(values);
    host_.wait(stands + host_.pick(stands));
  }
  end(fmt::format("round {}: PFM_CLK every {} and {} ticks, I7004={} I7104={}", number, rule_[0].clock, rule_[1].clock,
                  rule_[0].width, rule_[1].width),
      host_.places());  // the first channel of each IC
}

void run(BenchContext& b) {
  Pfm pfm(b);
  pfm.vector6();
  pfm.ceiling();
  const auto seed = static_cast<unsigned>(b.seed % 1'000);
  pfm.round(1, 0, 1);
  pfm.round(2, 2 + seed % 7, 3 + seed % 5);
  pfm.round(3, 40 + seed * 37 % 200, 255 - seed % 40);  // long pulses that run together
}

}  // namespace

// covers: CARD-1 CARD-2
Bench pfm_bench() {
  return {"pfm",
          "pulse trains on eight channels, every edge at its tick from power-up on; each pulse counted",
          {"the scoreboard knows no ceiling of PFM_CLK / 4", "commands about 2^22 and far beyond",
           "servo_ic*expected pulse"},
          run,
          kAServoIc};
}

}  // namespace brick
