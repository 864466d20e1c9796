// Pins that move too close to the clock edge that samples them. Within the aperture, before the edge or after it, the
// move is taken early or late at random; the lines of a bus resolve one by one, so that for one tick some show the old
// level and some the new. It decides what both engines get as inputs, from the time of the move and the seed alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "systemc/core/ticks.h"

namespace brick {

class Aperture {
 public:
  static constexpr TimeFs kMost = kFsPerNs;  // more would eat the hold times of the bus (row 106: 0)

  struct Counts {
    std::uint64_t moves = 0, early = 0, late = 0, split = 0;  // split: a bus, of which a part was early
    std::uint64_t inside() const { return early + late + split; }
  };

  Aperture() = default;  // none: a move is seen by the first edge that is not before it
  Aperture(TimeFs width, std::uint64_t seed) : width_(width), seed_(seed) {}

  TimeFs width() const { return early_ ? kMost : width_; }
  void set_width(TimeFs width) { width_ = width; }
  bool on() const { return width() > 0; }
  // Until called again: all moves within the greatest width are taken early, late; none: as above.
  void take(std::optional<bool> early) { early_ = early; }
  const Counts& counts() const { return counts_; }

  // The first edge that may see a move at `time`, and the first that surely does.
  Tick first(TimeFs time) const { return fs_to_tick(std::max<TimeFs>(0, time - width())); }
  Tick last(TimeFs time) const { return fs_to_tick(time + width()); }

  bool in_doubt(TimeFs time) {
    ++counts_.moves;
    return first(time) != last(time);
  }

  // A line: the edge that sees it move. Lines that resolve one by one say which they are.
  Tick taken(TimeFs time, unsigned line) const {
    const Tick may = first(time), will = last(time);
    return may != will && (early_ ? *early_ : (draw(time + line) & 1) != 0) ? may : will;
  }
  // Lines that move together, as they were taken: some of those in doubt early, some late.
  void count(bool early, bool late) {
    ++counts_.moves;
    if (early || late) ++(early && late ? counts_.split : early ? counts_.early : counts_.late);
  }

  // A bus whose move at `time` is in doubt: what the edge first(time) sees. Lines that stay are nobody's choice.
  template <class Pins>
  Pins mixed(const Pins& from, const Pins& to, TimeFs time) {
    static_assert(std::is_trivially_copyable_v<Pins>);
    unsigned char before[sizeof(Pins)], after[sizeof(Pins)], now[sizeof(Pins)];
    std::memcpy(before, &from, sizeof from);
    std::memcpy(after, &to, sizeof to);
    bool any = false, all = true;
    for (std::size_t i = 0; i < sizeof(Pins); ++i) {
      const auto moves = static_cast<unsigned char>(before[i] ^ after[i]);
      const std::uint64_t chosen = early_ ? *early_ ? ~0ull : 0 : draw(time + static_cast<TimeFs>(i) + 1);
      const auto moved = static_cast<unsigned char>(moves & chosen);
      now[i] = static_cast<unsigned char>(before[i] ^ moved);
      any = any || moved != 0;
      all = all && moved == moves;
    }
    if (any || !all) ++(all ? counts_.early : any ? counts_.split : counts_.late);
    Pins pins;
    std::memcpy(&pins, now, sizeof pins);
    return pins;
  }

 private:
  // The finalizer of splitmix64: every bit of what comes out hangs on every bit of what goes in.
  std::uint64_t draw(TimeFs time) const {
    std::uint64_t x = seed_ * 0x9E3779B97F4A7C15 + static_cast<std::uint64_t>(time);
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9;
    x = (x ^ x >> 27) * 0x94D049BB133111EB;
    return x ^ x >> 31;
  }

  TimeFs width_ = 0;
  std::optional<bool> early_;
  std::uint64_t seed_ = 0;
  Counts counts_;
};

}  // namespace brick
