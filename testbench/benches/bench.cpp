#include "testbench/benches/bench.h"

#include <algorithm>
#include <ostream>

#include <fmt/format.h>

#include "testbench/benches/benches.h"

namespace brick {

bool BenchReport::step(const std::string& name, bool passed, const std::string& detail) {
  steps_.push_back({machine_.now(), name, passed, detail});
  const TimeFs time = machine_.now_fs();
  out_ << fmt::format("{:>6}.{:03} ms  {}  {}{}{}\n", time / 1'000'000'000'000, time / 1'000'000'000 % 1000,
                      passed ? "ok  " : "FAIL", name, detail.empty() ? "" : ": ", detail)
       << std::flush;
  return passed;
}

bool BenchReport::passed() const {
  return !steps_.empty() && std::all_of(steps_.begin(), steps_.end(), [](const BenchStep& s) { return s.passed; });
}

std::string BenchContext::ask(const std::string& line) const {
  const Reply reply = link.command(line);
  std::string text = reply.complete ? "" : "no reply";
  for (const auto& l : reply.lines) text += (text.empty() ? "" : "|") + l;
  return text;
}

namespace {

constexpr std::uint32_t kServoIcMask = (1u << kMaxServoIcs) - 1;
int count(std::uint32_t ics) { return __builtin_popcount(ics); }

}  // namespace

const BenchNeed kAnyBoard{};
const BenchNeed kAServoIc{"a servo IC", [](const BoardConfig& b) { return (b.fitted & kServoIcMask) != 0; }};
const BenchNeed kServoIc0{"servo IC 0", [](const BoardConfig& b) { return (b.fitted & 1) != 0; }};
const BenchNeed kServoIcs01{"servo ICs 0 and 1", [](const BoardConfig& b) { return (b.fitted & 3) == 3; }};
const BenchNeed kTwoIcs{"two servo or MACRO ICs", [](const BoardConfig& b) { return count(b.fitted) >= 2; }};
const BenchNeed kAMacroIc{"a MACRO IC", [](const BoardConfig& b) { return (b.fitted & ~kServoIcMask) != 0; }};

const std::vector<Bench>& all_benches() {
  static const std::vector<Bench> benches{
      smoke_bench(),        breq_rotary_bench(), watchdog_bench(),      reinit_e3_bench(),       clock_select_bench(),
      clock_faults_bench(), clock_macro_bench(), encoder_bench(),       capture_compare_bench(), flags_bench(),
      pwm_bench(),          pfm_bench(),         serial_dac_adc_bench()};
  return benches;
}

const Bench* find_bench(const std::string& name) {
  for (const Bench& bench : all_benches())
    if (bench.name == name) return &bench;
  return nullptr;
}

std::string printed(const std::string& value) { return value; }
std::string printed(std::int64_t value) { return std::to_string(value); }

}  // namespace brick
