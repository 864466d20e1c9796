#include "testbench/unit/component/rig.h"

#include <fmt/format.h>
#include <sysc/kernel/sc_dynamic_processes.h>

#include <utility>

namespace brick::component {
namespace {

// What happens in the last instant is seen by one and not by the other.
template <class List, class TimeOf>
void cut(List& list, Picoseconds end, TimeOf time_of) {
  while (!list.empty() && time_of(list.back()) >= end - 1) list.pop_back();
}

std::string text(const Change& c) {
  return fmt::format("{} ps: {} = {}", std::get<0>(c), std::get<1>(c), std::get<2>(c));
}
std::string text(const Answer& a) { return fmt::format("{} ps: ${:X}", a.first, a.second); }

template <class List>
std::string first_difference(const char* what, const List& component, const List& block) {
  const auto place = std::mismatch(
      component.begin(), component.begin() + static_cast<std::ptrdiff_t>(std::min(component.size(), block.size())),
      block.begin());
  if (place.first == component.end() && place.second == block.end()) return "";
  const auto one = [](auto at, const List& list) { return at == list.end() ? "none" : text(*at); };
  return fmt::format("{} {}: component {}, block {}", what, place.first - component.begin(),
                     one(place.first, component), one(place.second, block));
}

}  // namespace

// Here and not in the header, because the signals of 32 widths are seconds of the compiler's time.
void Rig::connect(Pin& pin) { connect(pin, std::make_integer_sequence<unsigned, 32>()); }

template <unsigned... kWidth>
void Rig::connect(Pin& pin, std::integer_sequence<unsigned, kWidth...>) {
  (connect_width<kWidth + 1>(pin), ...);
}

template <unsigned kWidth>
void Rig::connect_width(Pin& pin) {
  const PinInfo& info = pin.info();
  if (info.width != kWidth) return;
  using Value = PinValue<kWidth>;
  auto signal = std::make_shared<sc_core::sc_signal<Value>>(("s_" + info.name).c_str(), static_cast<Value>(info.idle));
  if (info.direction == PinDirection::kIn) {
    dynamic_cast<In<kWidth>&>(pin).bind(*signal);
    writes_[info.name] = [s = signal.get()](std::uint32_t value) { s->write(static_cast<Value>(value)); };
  } else {
    dynamic_cast<Out<kWidth>&>(pin).bind(*signal);
    sc_core::sc_spawn_options process;
    process.spawn_method();
    process.dont_initialize();
    process.set_sensitivity(&signal->value_changed_event());
    sc_core::sc_spawn(
        [this, name = info.name, s = signal.get()] { changed(name, static_cast<std::uint32_t>(s->read())); },
        ("see_" + info.name).c_str(), &process);
  }
  if constexpr (kWidth == 1) bits_[info.name] = signal.get();
  signals_.push_back(std::move(signal));
}

std::string difference(Seen component, Seen block, Picoseconds end, const Binds& binds) {
  for (Seen* seen : {&component, &block}) {
    auto& changes = seen->changes;
    changes.erase(
        std::remove_if(changes.begin(), changes.end(), [&binds](const Change& c) { return !binds(std::get<1>(c)); }),
        changes.end());
    std::sort(changes.begin(), changes.end());
    cut(changes, end, [](const Change& c) { return std::get<0>(c); });
    for (std::vector<Answer>* answers : {&seen->answers, &seen->others})
      cut(*answers, end, [](const Answer& a) { return a.first; });
  }
  std::string changes = first_difference("change", component.changes, block.changes);
  if (!changes.empty()) return changes;
  const std::string answers = first_difference("access", component.answers, block.answers);
  return answers.empty() ? first_difference("other access", component.others, block.others) : answers;
}

void counts(const Seen& seen, const std::vector<std::string>& pins, std::size_t least) {
  std::map<std::string, std::size_t> count;
  for (const Change& c : seen.changes) ++count[std::get<1>(c)];
  for (const std::string& pin : pins) EXPECT_GE(count[pin], least) << pin;
}

}  // namespace brick::component
