#include "app/signal_watch.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/usage_error.h"

namespace brick {

namespace {

constexpr Tick kLook = 16;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string shown(const Signals::Info& info, std::uint64_t value) {
  if (info.radix == Radix::kHex) return fmt::format("${:0{}X}", value, (info.width + 3) / 4);
  return std::to_string(value);
}

}  // namespace

Signals::Id find_signal(const Signals& signals, const std::string& name) {
  if (const auto id = signals.find(name)) return *id;
  std::vector<Signals::Id> found;
  std::vector<std::string> like;
  for (Signals::Id id = 0; id < signals.size(); ++id) {
    const std::string& candidate = signals.info(id).name;
    if (ends_with(candidate, "." + name)) found.push_back(id);
    if (candidate.find(name) != std::string::npos && like.size() < 8) like.push_back(candidate);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    like.clear();
    for (const auto id : found) like.push_back(signals.info(id).name);
    throw UsageError(fmt::format("`{}` is not one signal; expected one of {}", name, fmt::join(like, ", ")));
  }
  if (like.empty()) like = {"host.breq", "host.irq", "clock.phase", "clock.source", "cpu.task"};
  throw UsageError(fmt::format("no signal `{}`; expected one like {}", name, fmt::join(like, ", ")));
}

std::string signal_text(const Signals& signals, Signals::Id id) {
  const Signals::Info& info = signals.info(id);
  return info.radix == Radix::kText ? signals.text(id) : shown(info, signals.value(id));
}

std::string signal_value_text(const Signals& signals, Signals::Id id, const std::string& value) {
  const Signals::Info& info = signals.info(id);
  if (info.radix == Radix::kText) return value;
  const bool dollar = value.size() > 1 && value[0] == '$';
  const bool prefixed = value.size() > 2 && value[0] == '0' && (value[1] == 'x' || value[1] == 'X');
  const std::string digits = value.substr(dollar ? 1 : prefixed ? 2 : 0);
  const int base = dollar || prefixed ? 16 : 10;
  const std::uint64_t largest = info.width >= 64 ? UINT64_MAX : (std::uint64_t{1} << info.width) - 1;
  try {
    std::size_t used = 0;
    const std::uint64_t number = std::stoull(digits, &used, base);
    if (used == digits.size() && digits[0] != '-' && number <= largest) return shown(info, number);
  } catch (const std::exception&) {}
  throw UsageError(fmt::format("`{}` is no value of {}; expected 0 to {} (decimal, or hex with $)", value, info.name, largest));
}

bool wait_signal(HostBus& bus, Signals::Id id, const std::string& value, Tick timeout) {
  Machine& machine = bus.machine();
  const Tick limit = bus.now() + timeout;
  const auto* pin =
      std::find_if(pin::kAll.begin(), pin::kAll.end(), [&](const PinField& f) { return f.name == machine.signals().info(id).name; });
  while (signal_text(machine.signals(), id) != value) {
    if (bus.now() >= limit) return false;
    if (pin == pin::kAll.end())
      bus.advance_to(std::min(limit, bus.now() + kLook));
    else
      bus.wait_change(*pin, limit);
  }
  return true;
}

}  // namespace brick
