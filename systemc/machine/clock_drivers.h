// Who drives PHASE and SERVO: follows the direction bits that the CPU writes into the gate ICs, so that a contention on
// the nets (pin clock.conflict, docs/clock.md) can be told with the names of the ICs and of their variables.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "systemc/core/ticks.h"
#include "systemc/machine/machine_signals.h"

namespace brick {

class ClockDrivers {
 public:
  void reset() { inputs_.fill(3); }

  // A write cycle to a gate IC; anything but a clock word is ignored.
  void write(bool x, std::uint32_t address, std::uint32_t value) {
    for (unsigned ic = 0; x && ic < kIcs; ++ic)
      if (clock_word(ic) == address) inputs_[ic] = value >> 12 & 3;
  }

  // "servo IC 0 (I7007) and MACRO IC 0 (I6807)": all that drive one of the nets, and the jumper.
  std::string names(std::uint32_t fitted, bool external) const {
    std::string text;
    for (unsigned ic = 0; ic < kIcs; ++ic)
      if ((fitted >> ic & 1) != 0 && inputs_[ic] != 3)
        text += fmt::format("{}{} (I{})", joint(text), name(ic), clock_source_variable(ic));
    return external ? text + joint(text) + "the external clocks (E1)" : text;
  }

  // `tick` is that of the pin's rise, the third after the first disagreement.
  std::string contention(Tick tick, std::uint32_t fitted, bool external) const {
    const Tick first = tick - kDelay;
    return fmt::format(
        "clock contention from tick {} ({:.3f} us): {} drive PHASE or SERVO and disagree for more than 2 ticks; "
        "expected one source",
        first, static_cast<double>(tick_to_fs(first)) * 1e-9, names(fitted, external));
  }

 private:
  static constexpr unsigned kIcs = 22, kFirstStarred = 10, kFirstMacro = 18;
  static constexpr Tick kDelay = 3;

  static const char* joint(const std::string& before) { return before.empty() ? "" : " and "; }
  static std::string name(unsigned ic) {
    if (ic >= kFirstMacro) return fmt::format("MACRO IC {}", ic - kFirstMacro);
    return ic < kFirstStarred ? fmt::format("servo IC {}", ic) : fmt::format("servo IC {}*", ic - 8);
  }
  // X address of the word with the direction bits, servo-ic:1.2, servo-ic:1.3, servo-ic:2.6, servo-ic:6.2.
  static std::uint32_t clock_word(unsigned ic) {
    if (ic >= kFirstMacro) return 0x7840C + 0x1000 * (ic - kFirstMacro);
    if (ic < 2) return 0x78004 + 0x100 * ic;
    const std::uint32_t number = ic < kFirstStarred ? ic : ic - 8;  // m of m and m*
    return 0x78004 + 0x1000 * ((number - 2) / 2) + (number % 2 == 0 ? 0x200 : 0x300) + (ic < kFirstStarred ? 0 : 0x20);
  }

  std::array<unsigned, kIcs> inputs_{};  // bit 0 PHASE, bit 1 SERVO: 1 = taken from the net
};

}  // namespace brick
