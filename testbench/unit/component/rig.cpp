#include "testbench/unit/component/rig.h"

#include <fmt/format.h>

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
  const std::string changes = first_difference("change", component.changes, block.changes);
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
