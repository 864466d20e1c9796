#include "systemc/core/trace_groups.h"

#include <fnmatch.h>

#include <algorithm>

#include "systemc/core/signals.h"

namespace brick {
namespace {

// Bit clocks of the serial DACs and ADCs: 96 edges a period of PHASE and IC, whether anything hangs on them or not.
// Nothing else in an idle machine costs as much.
const std::vector<std::string> kFreeRunning{"dac_clk", "adc_clk"};

const std::string kTopScope = "brick.";

bool matches(const std::string& pattern, const std::string& name) {
  if (pattern == "all") return true;
  if (pattern.compare(0, kTopScope.size(), kTopScope) == 0) return matches(pattern.substr(kTopScope.size()), name);
  for (std::size_t start = 0;; ++start) {
    if (fnmatch(pattern.c_str(), name.c_str() + start, 0) == 0) return true;
    start = name.find('.', start);
    if (start == std::string::npos) return false;
  }
}

bool any(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& p) { return matches(p, name); });
}

}  // namespace

bool TraceGroups::select(const std::string& name) const {
  return patterns_.empty() ? !any(kFreeRunning, name) : any(patterns_, name);
}

std::optional<std::string> TraceGroups::unmatched(const Signals& signals) const {
  for (const std::string& pattern : patterns_) {
    bool found = false;
    for (Signals::Id id = 0; id < signals.size() && !found; ++id) found = matches(pattern, signals.info(id).name);
    if (!found) return pattern;
  }
  return std::nullopt;
}

}  // namespace brick
