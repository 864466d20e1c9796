#include "testbench/checkers/ssi_scoreboard.h"

#include <fmt/format.h>

namespace brick {

Tick SsiSetting::after(std::int64_t count) const {
  return cycles ? (count * 18432 + 15624) / 15625 : count;  // servo-ic:11.3/3
}

SsiResult ssi_result(const SsiSetting& setting, std::uint64_t word, unsigned length, bool missing) {
  SsiResult result;
  bool above = false, odd = false;  // the bit of the position before, and whether the ones are odd in number
  const unsigned taken = setting.clocks() - 1;
  for (unsigned i = 0; i < taken; ++i) {
    const bool line = missing || (i < length && (word >> (length - 1 - i) & 1) != 0);
    odd = odd != line;
    if (i >= setting.bits) continue;
    above = setting.gray ? above != line : line;
    result.position = result.position << 1 | (above ? 1u : 0u);
  }
  result.parity_error = (setting.parity == 1 && !odd) || (setting.parity == 2 && odd);
  return result;
}

std::string ssi_clock_difference(const SsiSetting& setting, Tick trigger, const std::vector<Tick>& edges) {
  if (edges.size() != 2 * setting.clocks())
    return fmt::format("{} edges, expected {}", edges.size(), 2 * setting.clocks());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto clock = static_cast<std::int64_t>(i / 2) + setting.delay;
    const Tick expected = trigger + setting.after(clock * setting.period + (i % 2 != 0 ? setting.period / 2 : 0));
    if (edges[i] != expected)
      return fmt::format("{} {} at tick {}, expected {}", i % 2 != 0 ? "rise" : "fall", i / 2 + 1, edges[i], expected);
  }
  return "";
}

}  // namespace brick
