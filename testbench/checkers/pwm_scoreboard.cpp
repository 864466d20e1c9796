#include "testbench/checkers/pwm_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
// Pins as they stand after tick `at`; nothing is known before the first level.
unsigned pins_at(const std::vector<PwmLevel>& levels, Tick at) {
  const auto next =
      std::upper_bound(levels.begin(), levels.end(), at, [](Tick t, const PwmLevel& l) { return t < l.tick; });
  return next == levels.begin() ? 4 : std::prev(next)->pins;
}

void add(std::vector<PwmLevel>& levels, Tick tick, unsigned pins) {
  if (levels.empty() || levels.back().pins != pins) levels.push_back({tick, pins});
}

std::int32_t command_at(const std::vector<PwmCommand>& commands, Tick turn) {
  std::int32_t value = commands.front().value;
  for (const PwmCommand& c : commands)
    if (c.tick <= turn) value = c.value;
  return value;
}
}  // namespace

std::vector<PwmTurn> pwm_turns(Tick bottom, unsigned limit, Tick to, const std::vector<PwmChange>& changes) {
  std::vector<PwmTurn> turns{{bottom, -static_cast<std::int32_t>(limit + 2)}};
  while (turns.back().tick <= to) {
    const PwmTurn from = turns.back();
    for (const PwmChange& c : changes)
      if (c.tick <= from.tick) limit = c.limit;
    const auto top = static_cast<std::int32_t>(limit + 1), low = -static_cast<std::int32_t>(limit + 2);
    turns.push_back({from.tick + (top - from.count), top});
    turns.push_back({turns.back().tick + (top - low), low});
  }
  return turns;
}

std::vector<PwmLevel> pwm_switches(const std::vector<PwmTurn>& turns, const std::vector<PwmCommand>& commands,
                                   const PwmRule& rule) {
  // Changes of the comparison: from `tick` on it is `up`.
  struct Raw {
    Tick tick;
    bool up;
  };
  std::vector<Raw> raw;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const PwmTurn& a = turns[i];
    const PwmTurn& b = turns[i + 1];
    const std::int32_t command = command_at(commands, a.tick) + (rule.greater ? 0 : 1);  // c >= n is c + 1 > n
    const bool rising = b.count > a.count;
    // On the way up it is true for counts below the command, so until `cross`; on the way down from `cross` on.
    const Tick cross = a.tick + (rising ? command - a.count : a.count - command + 1);
    const bool first = rising ? cross > a.tick + 1 : cross <= a.tick + 1;
    if (raw.empty() || raw.back().up != first) raw.push_back({a.tick + 1, first});
    if (cross > a.tick + 1 && cross <= b.tick) raw.push_back({cross, !first});
  }
  std::vector<PwmLevel> levels;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Tick on = raw[i].tick + rule.dead;
    if (rule.dead > 0) add(levels, raw[i].tick, 0);
    if (i + 1 == raw.size() || on < raw[i + 1].tick) add(levels, on, raw[i].up ? 1 : 2);
  }
  return levels;
}

std::string pwm_difference(const std::vector<PwmLevel>& seen, const std::vector<PwmLevel>& expected, Tick from,
                           Tick to) {
  const auto text = [](unsigned pins) {
    return pins == 0 ? "both off" : pins == 1 ? "upper on" : pins == 2 ? "lower on" : "both on";
  };
  if (pins_at(seen, from) != pins_at(expected, from))
    return fmt::format("tick {}: {}, expected {}", from, text(pins_at(seen, from)), text(pins_at(expected, from)));
  const auto later = [from](const PwmLevel& l) { return l.tick > from; };
  auto s = std::find_if(seen.begin(), seen.end(), later), e = std::find_if(expected.begin(), expected.end(), later);
  for (;; ++s, ++e) {
    const bool more_seen = s != seen.end() && s->tick <= to, more_expected = e != expected.end() && e->tick <= to;
    if (!more_seen && !more_expected) return "";
    if (more_seen && more_expected && s->tick == e->tick && s->pins == e->pins) continue;
    return fmt::format("{}, expected {}", more_seen ? fmt::format("tick {}: {}", s->tick, text(s->pins)) : "no change",
                       more_expected ? fmt::format("tick {}: {}", e->tick, text(e->pins)) : "none");
  }
}

Tick pwm_time(const std::vector<PwmLevel>& levels, unsigned pins, Tick from, Tick to) {
  Tick sum = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Tick begin = std::max(from, levels[i].tick),
               end = i + 1 < levels.size() ? std::min(to, levels[i + 1].tick) : to;
    if (levels[i].pins == pins && end > begin) sum += end - begin;
  }
  return sum;
}

Tick pwm_on_time(unsigned limit, std::int32_t command) {
  const Tick period = 4 * static_cast<Tick>(limit) + 6;
  return std::clamp<Tick>(2 * static_cast<Tick>(command) + 2 * static_cast<Tick>(limit) + 3, 0, period);
}

}  // namespace brick
