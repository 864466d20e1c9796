// Steps of a bench as they are printed, and what every bench asks of the controller.
#include "app/bench.h"

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <utility>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"

namespace brick {

bool BenchReport::step(const std::string& name, bool passed, const std::string& detail) {
  steps_.push_back({machine_.now(), name, passed, detail});
  const TimeFs time = machine_.now_fs();
  out_ << fmt::format("{:>6}.{:03} ms  {}  {}{}{}\n", time / 1'000'000'000'000, time / 1'000'000'000 % 1000,
                      passed ? "ok  " : "FAIL", name, detail.empty() ? "" : ": ", detail)
       << std::flush;
  return passed;
}

bool BenchReport::step(const std::string& name, const Comparison& compared, unsigned least, const std::string& detail) {
  if (least != 0) cover(name, compared.made(), least);
  if (!compared.difference().empty()) return step(name, false, compared.difference());
  if (compared.made() < least)
    return step(name, false, fmt::format("{} compared, expected {} or more", compared.made(), least));
  return step(name, true, detail);
}

bool BenchReport::reached(const std::string& name, std::uint64_t count, std::uint64_t least) {
  cover(name, count, least);
  return step(name, count >= least, fmt::format("{}, at least {}", count, least));
}

void BenchReport::cover(const std::string& name, std::uint64_t count, std::uint64_t least) {
  Cover& cover = covers_[name];
  cover.count += count;
  cover.least = least;
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

std::vector<long> BenchContext::numbers(const std::string& line) const {
  std::vector<long> values;
  for (const auto& l : link.command(line).lines) values.push_back(std::strtol(l.c_str(), nullptr, 10));
  return values;
}

unsigned BenchContext::clock_variable(unsigned k) const {
  constexpr unsigned kDirection = 7;  // which I19 names
  return default_clock_source(board.fitted, board.macro_gate) - kDirection + k;
}

std::string BenchContext::problems() const {
  constexpr std::pair<unsigned, const char*> kBits[] = {
      {10, "flash error"}, {7, "configuration error"}, {3, "no phase clock"}};  // of the first word
  const std::string answer = ask("???");
  if (answer.size() < 6) return "`" + answer + "`, no status";
  const long word = std::strtol(answer.substr(0, 6).c_str(), nullptr, 16);
  std::string text;
  for (const auto& [bit, name] : kBits)
    if ((word >> bit & 1) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  return text.empty() ? "none" : text;
}

Tick BenchContext::next_fall(const PinField& pin, Tick limit) const {
  return bus.wait_pin(pin, 1, limit) && bus.wait_pin(pin, 0, limit) ? bus.now() : -1;
}

namespace {

constexpr std::uint32_t kServoIcMask = (1u << kMaxServoIcs) - 1;
int count(std::uint32_t ics) { return __builtin_popcount(ics); }

}  // namespace

std::uint32_t clock_ics(const BoardConfig& board) { return board.fitted & ~(board.macro_gate << kMaxServoIcs); }

const BenchNeed kAnyBoard{};
const BenchNeed kAServoIc{"a servo IC", [](const BoardConfig& b) { return (b.fitted & kServoIcMask) != 0; }};
const BenchNeed kServoIc0{"servo IC 0", [](const BoardConfig& b) { return (b.fitted & 1) != 0; }};
const BenchNeed kServoIcs01{"servo ICs 0 and 1", [](const BoardConfig& b) { return (b.fitted & 3) == 3; }};
const BenchNeed kTwoIcs{"two ICs that can make the clocks",
                        [](const BoardConfig& b) { return count(clock_ics(b)) >= 2; }};
const BenchNeed kAMacroIc{"a MACRO IC that is no MACROGATE",
                          [](const BoardConfig& b) { return (clock_ics(b) & ~kServoIcMask) != 0; }};
const BenchNeed kASlotOf16Bits{"a slot of 16 bits", [](const BoardConfig& b) { return !b.slot8; }};
const BenchNeed kSerialInputs{"serial encoder inputs", [](const BoardConfig& b) {
                                return b.ssi_kind == kSsiGeoPmac || b.ssi_kind == kSsiGeoBrick;
                              }};

BenchNeed without_8259(const BenchNeed& need) {
  const std::string controller = "an interrupt controller that is no 8259";
  return {need.what.empty() ? controller : need.what + " and " + controller,
          [met = need.met](const BoardConfig& b) { return met(b) && !b.pic_8259; }};
}

const Bench* find_bench(const std::vector<Bench>& benches, const std::string& name) {
  for (const Bench& bench : benches)
    if (bench.name == name) return &bench;
  return nullptr;
}

}  // namespace brick
