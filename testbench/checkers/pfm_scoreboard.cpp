#include "testbench/checkers/pfm_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

void PfmScoreboard::step(Variant& v, const PfmRule& rule, const std::vector<PfmCommand>& commands, unsigned pins,
                         Tick grid, Tick to) {
  constexpr std::int64_t kRange = 1 << 24;
  v.levels = {{commands.front().tick, pins}};
  v.pulses = {};
  bool pulse = false, down = (pins & 2) != 0;
  Tick ends = 0;
  std::size_t next = 0;
  std::int64_t command = 0;
  const Tick first = commands.front().tick;
  for (Tick t = first + ((grid - first) % rule.clock + rule.clock) % rule.clock; t <= to; t += rule.clock) {
    for (; next < commands.size() && commands[next].tick + v.late <= t; ++next)
      command = std::clamp(commands[next].value, -rule.largest, rule.largest);
    v.acc += command;
    if (v.acc < 0 || v.acc >= kRange) {
      down = v.acc < 0;
      v.acc += down ? kRange : -kRange;
      v.pulses.overlap = v.pulses.overlap || (pulse && t <= ends);
      pulse = true;
      ends = t + std::max(1u, rule.width) * rule.clock;
      ++(down ? v.pulses.down : v.pulses.up);
    } else if (t >= ends) {
      pulse = false;
    }
    const unsigned now = (pulse ? 1u : 0u) | (down ? 2u : 0u);
    if (now != v.levels.back().pins) v.levels.push_back({t, now});
  }
}

std::string PfmScoreboard::judge(const PfmRule& rule, const std::vector<PfmCommand>& commands,
                                 const std::vector<PfmLevel>& seen, Tick grid, Tick to) {
  std::string text;
  std::vector<Variant> agree;
  for (Variant& v : variants_) {
    step(v, rule, commands, seen.front().pins, grid, to);
    const auto same = [](const PfmLevel& a, const PfmLevel& b) { return a.tick == b.tick && a.pins == b.pins; };
    const auto [s, e] = std::mismatch(seen.begin() + 1, seen.end(), v.levels.begin() + 1, v.levels.end(), same);
    if (s == seen.end() && e == v.levels.end()) {
      agree.push_back(v);
    } else if (text.empty()) {
      const auto words = [](bool any, const PfmLevel& l) {
        return any ? fmt::format("pulse {} direction {} at tick {}", l.pins & 1, l.pins >> 1, l.tick)
                   : std::string("no change");
      };
      text = fmt::format("{}, expected {}", words(s != seen.end(), s != seen.end() ? *s : PfmLevel{}),
                         words(e != v.levels.end(), e != v.levels.end() ? *e : PfmLevel{}));
    }
  }
  pulses_ = agree.empty() ? variants_.front().pulses : agree.front().pulses;
  if (agree.empty()) return text;
  variants_ = agree;
  return "";
}

}  // namespace brick
