#include "app/signal_watch.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr Tick kLook = 16;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string shown(const Signals::Info& info, std::uint64_t value) {
  if (info.radix == Radix::kHex) return fmt::format("${:0{}X}", value, (info.width + 3) / 4);
  if (info.radix == Radix::kReal) return fmt::format("{:.6g}", real_of(value));
  if (info.radix == Radix::kSigned) {
    const std::uint64_t sign = std::uint64_t{1} << (info.width - 1);
    return std::to_string(static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign));
  }
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
    for (const auto id : found) {
      if (like.size() == 8) break;
      like.push_back(signals.info(id).name);
    }
    throw UsageError(
        fmt::format("{} is not one signal; expected one of {}{}", beginning_of(name), fmt::join(like, ", "),
                    like.size() < found.size() ? fmt::format(" and {} more", found.size() - like.size()) : ""));
  }
  if (like.empty()) like = {"host.breq", "host.irq", "clock.phase", "clock.source", "cpu.task"};
  throw UsageError(fmt::format("no signal {}; expected one like {}", beginning_of(name), fmt::join(like, ", ")));
}

std::optional<bool HostInputs::*> find_connector_pin(const Signals& signals, const std::string& name) {
  static const std::pair<std::string_view, bool HostInputs::*> kPins[] = {{"host.mi1", &HostInputs::mi1},
                                                                          {"host.mi2", &HostInputs::mi2},
                                                                          {"host.axexp0", &HostInputs::axexp0},
                                                                          {"host.axexp1", &HostInputs::axexp1},
                                                                          {"watchdog.pwr_good", &HostInputs::pwr_good}};
  const std::string& found = signals.info(find_signal(signals, name)).name;
  for (const auto& [pin, place] : kPins)
    if (found == pin) return place;
  return std::nullopt;
}

ChannelPinPlace find_channel_pin(const Signals& signals, const std::string& name) {
  const std::string& found = signals.info(find_signal(signals, name)).name;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    for (unsigned channel = 0; channel < kChannels; ++channel)
      for (unsigned pin = 0; pin < kChannelPins; ++pin)
        if (found == fmt::format("{}.ch{}.{}", servo_ic_scope(ic), channel + 1, kChannelPinNames[pin]))
          return {ic, channel, pin};
  throw UsageError(fmt::format("`{}` is no input pin; expected one like servo_ic0.ch1.{}, or host.mi1", found,
                               fmt::join(kChannelPinNames, ", ")));
}

std::string signal_text(const Signals& signals, Signals::Id id) {
  const Signals::Info& info = signals.info(id);
  return info.radix == Radix::kText ? signals.text(id) : shown(info, signals.value(id));
}

std::string signal_value_text(const Signals& signals, Signals::Id id, const std::string& value) {
  const Signals::Info& info = signals.info(id);
  if (info.radix == Radix::kText) return value;
  if (info.radix == Radix::kReal)
    throw UsageError(fmt::format("{} is never exactly a number; expected a signal of whole numbers", info.name));
  if (info.radix == Radix::kSigned && value.size() > 1 && value[0] == '-') {
    const std::uint64_t lowest = std::uint64_t{1} << (info.width - 1);
    try {
      std::size_t used = 0;
      const std::uint64_t number = std::stoull(value.substr(1), &used);
      if (used + 1 == value.size() && std::isdigit(static_cast<unsigned char>(value[1])) && number <= lowest)
        return shown(info, (2 * lowest - number) & (2 * lowest - 1));
    } catch (const std::exception&) {}
    throw UsageError(
        fmt::format("{} is no value of {}; expected -{} to {}", beginning_of(value), info.name, lowest, lowest - 1));
  }
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
  throw UsageError(fmt::format("{} is no value of {}; expected 0 to {} (decimal, or hex with $)", beginning_of(value),
                               info.name, largest));
}

namespace {

// Ends the machine's runs at each change of the motor output of this name, for as long as it lives.
class MotorStop {
 public:
  MotorStop(Machine& machine, const std::string& name) : machine_(machine) {
    for (ic_ = 0; ic_ < kMaxServoIcs; ++ic_)
      for (unsigned channel = 0; channel < kChannels; ++channel)
        for (const MotorField& field : motor_pin::kAll)
          if (name == fmt::format("{}.ch{}.{}", servo_ic_scope(ic_), channel + 1, field.name)) {
            MotorOutputs select;
            select.set(field, channel, ~0u);
            machine_.stop_on_motor(ic_, select);
            return;
          }
  }
  ~MotorStop() {
    if (found()) machine_.stop_on_motor(ic_, {});
  }
  MotorStop(const MotorStop&) = delete;
  MotorStop& operator=(const MotorStop&) = delete;
  bool found() const { return ic_ < kMaxServoIcs; }

 private:
  Machine& machine_;
  unsigned ic_ = 0;
};

}  // namespace

bool wait_signal(HostBus& bus, Signals::Id id, const std::string& value, Tick timeout) {
  Machine& machine = bus.machine();
  const Tick limit = bus.now() + timeout;
  const MotorStop motor(machine, machine.signals().info(id).name);
  const auto* pin = std::find_if(pin::kAll.begin(), pin::kAll.end(),
                                 [&](const PinField& f) { return f.name == machine.signals().info(id).name; });
  while (signal_text(machine.signals(), id) != value) {
    if (bus.now() >= limit) return false;
    if (motor.found())
      bus.advance_to_stop(limit);
    else if (pin == pin::kAll.end())
      bus.advance_to(std::min(limit, bus.now() + kLook));
    else
      bus.wait_change(*pin, limit);
  }
  return true;
}

}  // namespace brick
