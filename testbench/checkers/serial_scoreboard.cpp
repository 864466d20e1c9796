#include "testbench/checkers/serial_scoreboard.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr unsigned kBits = 24;
constexpr Tick kLatency = 15;  // PHASE from another IC passes two flip-flops, then one for each clock; generous

// One stream: the levels after `phase` up to `end`.
std::string decode(SerialStream& s, const std::vector<SerialLevel>& levels, Tick end, Tick bit, unsigned lines) {
  const auto at = [&](const SerialLevel& l, const char* what) {
    return fmt::format("{} at tick {}, PHASE rose at {}", what, l.tick, s.phase);
  };
  auto l = std::upper_bound(levels.begin(), levels.end(), s.phase,
                            [](Tick t, const SerialLevel& level) { return t < level.tick; });
  if (l == levels.begin()) return "pins before PHASE are not known";
  unsigned rises = 0;
  Tick start = -1, rise = -1, strobe_up = -1;
  std::vector<std::uint32_t> shift(lines);
  for (SerialLevel before = *std::prev(l); l != levels.end() && l->tick <= end; before = *l++) {
    const bool up = l->clock && !before.clock, down = !l->clock && before.clock;
    if (l->strobe != before.strobe || l->data != before.data) {
      if (rises == 0 && start < 0) start = l->tick;
      if (rises == 0 ? l->tick != start || l->clock : !down)
        return at(*l, "a line changes without a fall of the clock");
      if (rises == kBits && l->strobe != before.strobe) return at(*l, "the strobe does not keep its last bit");
    }
    if (l->strobe && !before.strobe && strobe_up < 0) strobe_up = l->tick;
    if (!l->strobe && before.strobe && rises > 0 && s.received.empty()) {
      s.received = shift;
      s.strobe_high = strobe_up < 0 ? 0 : l->tick - strobe_up;
    }
    if (!up) continue;
    if (rises == kBits) return at(*l, "a clock too many");
    if (rises == 0 && l->tick - s.phase > kLatency + 3 * bit / 2) return at(*l, "the first clock comes late");
    if (rises > 0 && l->tick - rise != bit)
      return at(*l, fmt::format("clock period {}, expected {}", l->tick - rise, bit).c_str());
    if (rises++ == 0) s.first = l->tick;
    s.last = rise = l->tick;
    s.strobe = s.strobe << 1 | (l->strobe ? 1u : 0u);
    for (unsigned i = 0; i < lines; ++i) shift[i] = shift[i] << 1 | (l->data >> i & 1);
  }
  if (std::prev(l)->clock) return at(*std::prev(l), "the clock does not go low at the end, last edge");
  s.data = shift;
  return rises == kBits ? "" : fmt::format("{} clocks, expected {}, PHASE rose at {}", rises, kBits, s.phase);
}
}  // namespace

SerialRecord serial_streams(const std::vector<SerialLevel>& levels, const std::vector<Tick>& phase_rises, Tick bit,
                            unsigned lines) {
  SerialRecord record;
  for (std::size_t i = 0; i + 1 < phase_rises.size(); ++i) {
    SerialStream s;
    s.phase = phase_rises[i];
    const std::string error = decode(s, levels, phase_rises[i + 1], bit, lines);
    if (record.error.empty()) record.error = error;
    record.streams.push_back(s);
  }
  return record;
}

std::uint32_t dac_stream(std::uint32_t command, bool invert) { return (invert ? ~command : command) & kDacBits; }

std::uint32_t adc_word(std::uint32_t sent) { return (sent >> 2 & 0x3FFFF) << 6; }

unsigned dac_strobe_bits(std::uint32_t strobe) {
  unsigned ones = 0;
  while (ones < kBits - 2 && (strobe >> (kBits - 2 - ones) & 1) != 0) ++ones;
  const std::uint32_t same = ((1u << ones) - 1) << (kBits - 1 - ones);
  return ones > 0 && strobe == same ? ones + 1 : 0;
}

}  // namespace brick
