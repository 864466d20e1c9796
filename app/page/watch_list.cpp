#include "app/page/watch_list.h"

#include <iterator>
#include <utility>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

void WatchList::set(const std::set<std::string>& items) {
  for (auto at = watched_.begin(); at != watched_.end();)
    at = items.count(at->first) == 0 ? watched_.erase(at) : std::next(at);
  for (const std::string& item : items) {
    if (watched_.count(item) != 0) continue;
    Watched one;
    try {
      one.columns = record_columns(machine_, item);
    } catch (const UsageError& e) { one.mistake = utf8_text(e.what()); }
    if (one.columns.size() > 1) one.mistake = "expected one value";
    watched_.emplace(item, std::move(one));
  }
}

nlohmann::json WatchList::values() const {
  const RecordRow row{static_cast<double>(machine_.now_fs()) * 1e-12};
  nlohmann::json values = nlohmann::json::object();
  for (const auto& [item, one] : watched_) {
    if (one.mistake.empty())
      values[item] = one.columns.front().value(row);
    else
      values[item] = one.mistake;
  }
  return values;
}

}  // namespace brick
