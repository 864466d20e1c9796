#include "systemc/cpu/port_a_wires.h"

#include <algorithm>

namespace brick {

namespace {

constexpr PortALineBits bit(unsigned line) { return PortALineBits{1} << line; }
constexpr unsigned kXLine = 19, kDataLine = 27;
constexpr PortALineBits kStrobes = bit(kRdLine) | bit(kWrLine), kSelects = bit(kIntLine) | 0xFull << kAaLine;

std::uint64_t draw(std::uint64_t& state) {  // splitmix64
  std::uint64_t z = state += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace

PortALineBits port_a_lines(const PortAPins& pins) {
  const auto at = [](std::uint32_t value, unsigned line) { return PortALineBits{value} << line; };
  return at(pins.pa_addr & 0x7FFFF, 0) | at(pins.pa_x, kXLine) | at(pins.pa_aa & 0xFu, kAaLine) |
         at(pins.pa_int, kIntLine) | at(pins.pa_rd_n, kRdLine) | at(pins.pa_wr_n, kWrLine) |
         at(pins.pa_wdata & 0xFFFFFF, kDataLine);
}

void set_port_a_lines(PortAPins& pins, PortALineBits lines) {
  pins.pa_addr = static_cast<std::uint32_t>(lines & 0x7FFFF);
  pins.pa_x = (lines & bit(kXLine)) != 0;
  pins.pa_aa = static_cast<std::uint8_t>(lines >> kAaLine & 0xF);
  pins.pa_int = (lines & bit(kIntLine)) != 0;
  pins.pa_rd_n = (lines & bit(kRdLine)) != 0;
  pins.pa_wr_n = (lines & bit(kWrLine)) != 0;
  pins.pa_wdata = static_cast<std::uint32_t>(lines >> kDataLine & 0xFFFFFF);
}

PinSkew::PinSkew(std::uint64_t seed) : on_(true) {
  for (TimeFs& delay : delay_) {
    const std::uint64_t drawn = draw(seed);
    const bool end = (drawn & 1) != 0;
    delay = end ? ((drawn & 2) != 0 ? kMost : 0) : static_cast<TimeFs>((drawn >> 2) % (kMost + 1));
  }
}

Tick PortAWires::seen(unsigned line, TimeFs time) const {
  const TimeFs there = time + skew_.of(line);
  // Each line of a bus resolves for itself; both strobes by the time alone.
  const unsigned salt = (kStrobes & bit(line)) != 0 ? 0 : line + 1;
  return aperture_ != nullptr ? aperture_->taken(there, salt) : fs_to_tick(there);
}

void PortAWires::move(TimeFs time, const PortAPins& from, const PortAPins& to, Tick now) {
  const PortALineBits levels = port_a_lines(to);
  bool early = false, late = false;
  for (PortALineBits left = port_a_lines(from) ^ levels; left != 0; left &= left - 1) {
    const auto line = static_cast<unsigned>(__builtin_ctzll(left));
    const TimeFs there = time + skew_.of(line);
    const Tick edge = seen(line, time);
    Tick stand = std::max(edge - 1, now);
    for (const Move& m : moves_)
      if ((m.lines & bit(line)) != 0) stand = std::max(stand, m.stand);  // a line's moves keep their order
    if (aperture_ != nullptr && aperture_->first(there) != aperture_->last(there))
      (edge == aperture_->first(there) ? early : late) = true;
    const auto same = std::find_if(moves_.begin(), moves_.end(), [&](const Move& m) {
      return m.stand == stand && m.time == there && ((m.lines | bit(line)) & followed()) == 0;
    });
    if (same != moves_.end()) {
      same->lines |= bit(line);
      same->levels = (same->levels & ~bit(line)) | (levels & bit(line));
      continue;
    }
    const auto place = std::find_if(moves_.begin(), moves_.end(), [&](const Move& m) {
      return m.stand > stand || (m.stand == stand && m.time > there);
    });
    moves_.insert(place, {stand, there, bit(line), levels & bit(line)});
  }
  if (aperture_ != nullptr) aperture_->count(early, late);
}

PortAWires::Taken PortAWires::take(PortAPins& pins) {
  const Move move = moves_.front();
  moves_.erase(moves_.begin());
  set_port_a_lines(pins, (port_a_lines(pins) & ~move.lines) | move.levels);
  return {move.time, (move.lines & followed()) != 0};
}

// Lines that the board follows without a clock; one move each, since each has its own time.
PortALineBits PortAWires::followed() const { return kStrobes | (skew_.on() ? kSelects : 0); }

Tick PortAWires::followed_until(TimeFs time) const {
  Tick stand = 0;
  for (const Move& m : moves_)
    if (m.time <= time && (m.lines & followed()) != 0) stand = std::max(stand, m.stand);
  return stand;
}

}  // namespace brick
