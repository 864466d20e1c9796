#include "app/page/page_message.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace brick {

using nlohmann::json;

namespace {

constexpr std::size_t kLongestLine = 255, kLongestItem = 100, kMostItems = 32;
constexpr std::int64_t kLargestId = std::int64_t{1} << 53;  // a JavaScript number is exact up to there

bool is_plain(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= ' ' && c < 0x7F; });
}

const json& member(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) throw PageMistake(std::string(name) + " is missing");
  return *found;
}

PageCommand command_of(const json& message) {
  const json& id = member(message, "id");
  if (!id.is_number_integer() || id < 0 || id > kLargestId) throw PageMistake("id: expected a whole number from 0 on");
  const json& line = member(message, "line");
  const auto text = line.is_string() ? line.get<std::string>() : "";
  if (text.empty() || text.size() > kLongestLine || !is_plain(text))
    throw PageMistake("line: expected 1 to 255 characters of ASCII", id.get<std::int64_t>());
  return {id.get<std::int64_t>(), text};
}

PageWatch watch_of(const json& message) {
  const json& items = member(message, "items");
  if (!items.is_array() || items.size() > kMostItems) throw PageMistake("items: expected a list of up to 32");
  PageWatch watch;
  for (const json& item : items) {
    if (!item.is_string()) throw PageMistake("items: expected texts");
    watch.items.push_back(item.get<std::string>());
    const std::string& text = watch.items.back();
    if (text.empty() || text.size() > kLongestItem || !is_plain(text) || text.find_first_of(" ;") != std::string::npos)
      throw PageMistake("items: expected 1 to 100 characters of ASCII each, no blank, no semicolon");
  }
  return watch;
}

}  // namespace

PageMessage parse_page_message(const std::string& text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) throw PageMistake("expected an object of JSON");
  const json& kind = member(message, "kind");
  if (kind == "command") return command_of(message);
  if (kind == "watch") return watch_of(message);
  throw PageMistake("kind: expected command or watch");
}

}  // namespace brick
