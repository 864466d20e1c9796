#include "systemc/machine/toml_table.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace {

// On one line and not too long; at a NUL the message would end.
std::string shown(std::string text) {
  constexpr std::size_t kShownCharacters = 40;
  const std::string as_written = "\\u0000";
  std::replace(text.begin(), text.end(), '\n', ' ');
  for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos; at += as_written.size())
    text.replace(at, 1, as_written);
  return text.size() > kShownCharacters ? text.substr(0, kShownCharacters) + "..." : text;
}

// As the file has it.
std::string found_text(const toml::node& node) {
  std::ostringstream out;
  if (const auto quoted = node.value_exact<std::string>())
    out << '"' << *quoted << '"';
  else
    node.visit([&](const auto& n) { out << n; });
  return shown(out.str());
}

// Behind the string that begins at `at`; up to two more of its quotation marks belong to one in three.
std::size_t string_end(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const bool of_lines = text.compare(at, 3, std::string(3, quote)) == 0;
  const std::string end = of_lines ? std::string(3, quote) : std::string(1, quote);
  for (at += end.size(); at < text.size(); ++at) {
    if (text.compare(at, end.size(), end) == 0) {
      at += end.size();
      for (int more = 0; of_lines && more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;
    }
    if (text[at] == '\n' && !of_lines) return at;
    if (text[at] == '\\' && quote == '"') ++at;
  }
  return text.size();
}

// toml++ counts brackets, but not the parts of a key: it goes one call deeper for each until the stack ends.
void check_depth(const std::string& text, const std::string& path) {
  constexpr std::size_t kMostDots = 64;  // in a row: a.b.c, "a" . 'b'
  std::size_t dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '.' && ++dots > kMostDots)
      throw UsageError(fmt::format("{}:{}: a key of more than {} parts; expected fewer", path,
                                   1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'),
                                   kMostDots));
    if (std::string_view("\n,=[]{}#").find(c) != std::string_view::npos) dots = 0;
    at = c == '"' || c == '\'' ? string_end(text, at) : c == '#' ? std::min(text.find('\n', at), text.size()) : at + 1;
  }
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& path) {
  check_depth(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& e) {
    throw UsageError(fmt::format("{}:{}: {}; expected TOML", path, e.source().begin.line, e.description()));
  }
}

TomlTable::TomlTable(std::string path, const toml::table& table, const std::vector<std::string>& known)
    : path_(std::move(path)), table_(&table) {
  for (const auto& [key, value] : table) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      throw UsageError(fmt::format("{}:{}: unknown key {}; expected {}", path_, key.source().begin.line,
                                   shown(std::string(key.str())), fmt::join(known, ", ")));
  }
}

void TomlTable::fail(const toml::node& at, const std::string& key, const std::string& expected) const {
  throw UsageError(fmt::format("{}:{}: {}: found {}; expected {}", path_, line(at), key, found_text(at), expected));
}

const toml::node& TomlTable::need(const std::string& key) const {
  if (const toml::node* node = table_->get(key)) return *node;
  const auto at = line(*table_) > 1 ? fmt::format("{}:{}", path_, line(*table_)) : path_;
  throw UsageError(fmt::format("{}: key {} is missing; expected {} = ...", at, key, key));
}

std::string TomlTable::text(const std::string& key) const { return text_in(key, need(key)); }

std::string TomlTable::text_in(const std::string& key, const toml::node& item) const {
  const auto value = item.value_exact<std::string>();
  if (!value) fail(item, key, "a text in quotes");
  if (value->find('\0') != std::string::npos) fail(item, key, "a text without NUL");  // where names of files end
  return *value;
}

std::vector<std::string> TomlTable::texts(const std::string& key) const {
  std::vector<std::string> list;
  for (const toml::node& item : array(key)) list.push_back(text_in(key, item));
  return list;
}

bool TomlTable::flag(const std::string& key) const {
  if (!has(key)) return false;
  const auto value = need(key).value_exact<bool>();
  if (!value) fail(need(key), key, "true or false");
  return *value;
}

std::int64_t TomlTable::integer(const std::string& key, std::int64_t low, std::int64_t high,
                                const std::string& expected) const {
  const auto value = need(key).value_exact<std::int64_t>();
  if (!value || *value < low || *value > high) fail(need(key), key, expected);
  return *value;
}

double TomlTable::real(const std::string& key, double low, double high, const std::string& expected) const {
  const toml::node& node = need(key);
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !(*value >= low && *value <= high)) fail(node, key, expected);
  return *value;
}

const toml::array& TomlTable::array(const std::string& key) const {
  const toml::array* list = need(key).as_array();
  if (list == nullptr) fail(need(key), key, "a list in brackets");
  return *list;
}

TomlTable TomlTable::table(const std::string& key, const toml::node& item,
                           const std::vector<std::string>& known) const {
  if (!item.is_table()) fail(item, key, "a table");
  return {path_, *item.as_table(), known};
}

}  // namespace brick
