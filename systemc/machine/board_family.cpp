// Families of products, see board_family.h.
#include "systemc/machine/board_family.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/machine/machine_signals.h"

namespace brick {

namespace {

constexpr unsigned kServoIcs = 18, kFirstStarred = 10, kIcs = 22;
constexpr std::uint32_t kServo01 = 0x3, kServo0To9 = 0x3FF, kRack = 0x3FFFC, kMacro0 = 1u << 18, kMacros = 0xFu << 18;

constexpr BoardFamily kFamilies[] = {
    {"geo-brick-lv", kServo01 | kMacro0, "servo ICs 0, 1 and MACRO IC 0", false, false, kSsiGeoBrick, 0, "TURBO2",
     false, false, true},
    {"turbo-pmac2", kServo0To9 | kMacro0, "servo ICs 0 to 9 and MACRO IC 0", false, false, 0, 0, "TURBO2", false, false,
     false},
    {"turbo-pmac2-ultralite", kMacros, "MACRO ICs 0 to 3", false, false, 0, kProductUltralite, "TURBOU", true, false,
     false},
    {"umac-turbo", kRack | kMacros, "servo ICs 2 to 9, 2* to 9* and MACRO ICs 0 to 3", false, false, 0, kProductUmac,
     "TURBO2", true, false, false},
    {"turbo-pmac", kServo0To9, "servo ICs 0 to 9", true, false, 0, kProductTurboPmac1, "TURBO1", false, true, false},
    {"geo-pmac", 0x1, "servo IC 0", false, true, kSsiGeoPmac, kProductGeoPmac, "TURBO2", false, false, true},
    {"any", kServo0To9 | kRack | kMacros, "every IC", true, false, kSsiGeoBrick, 0, "TURBO2", true, true, false},
};

std::string ic_number(unsigned ic) {
  if (ic >= kServoIcs) return std::to_string(ic - kServoIcs);
  return ic < kFirstStarred ? std::to_string(ic) : std::to_string(ic - 8) + "*";
}

// Three or more in a row as "0-9".
std::string numbers(std::uint32_t fitted, std::initializer_list<unsigned> ends) {
  std::vector<std::string> names;
  unsigned ic = 0;
  for (const unsigned end : ends)
    for (; ic < end; ++ic) {
      if ((fitted >> ic & 1) == 0) continue;
      unsigned last = ic;
      while (last + 1 < end && (fitted >> (last + 1) & 1) != 0) ++last;
      if (last < ic + 2) last = ic;
      names.push_back(last == ic ? ic_number(ic) : ic_number(ic) + "-" + ic_number(last));
      ic = last;
    }
  return names.empty() ? "-" : fmt::format("{}", fmt::join(names, " "));
}

}  // namespace

const BoardFamily* find_board_family(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kFamilies), std::end(kFamilies), [&](const BoardFamily& f) { return f.name == name; });
  return found == std::end(kFamilies) ? nullptr : found;
}

std::vector<std::string> board_family_names() {
  std::vector<std::string> names;
  for (const BoardFamily& family : kFamilies) names.emplace_back(family.name);
  return names;
}

std::vector<std::string> fitted_ic_names(std::uint32_t fitted) {
  std::vector<std::string> names;
  for (unsigned ic = 0; ic < kIcs; ++ic)
    if ((fitted >> ic & 1) != 0) names.push_back((ic < kServoIcs ? "servo IC " : "MACRO IC ") + ic_number(ic));
  return names;
}

std::string servo_ic_numbers(std::uint32_t fitted) {
  return numbers(fitted & ((1u << kServoIcs) - 1), {kFirstStarred, kServoIcs});
}
std::string macro_ic_numbers(std::uint32_t fitted) { return numbers(fitted & kMacros, {kIcs}); }

unsigned default_clock_source(std::uint32_t fitted, std::uint32_t macro_gate) {
  const std::uint32_t sources = fitted & ~(macro_gate << kServoIcs);
  const auto can = [&](unsigned ic) { return (sources >> ic & 1) != 0; };
  if (can(0)) return clock_source_variable(0);
  if (can(kServoIcs)) return clock_source_variable(kServoIcs);
  for (unsigned ic = 1; ic < kIcs; ++ic)
    if (can(ic)) return clock_source_variable(ic);
  return 0;
}

}  // namespace brick
