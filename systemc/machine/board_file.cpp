#include "systemc/machine/board_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace brick {

namespace {

constexpr unsigned kServoIcs = 10, kFirstMacroIc = 18, kMacroIcs = 4;  // bits of BoardInputs::fitted: 10..17 are servo IC 2*..9*
constexpr const char* kServoIcNames = "servo IC numbers 0 to 9, or \"2*\" to \"9*\" in quotes";

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {
    if (!std::ifstream(path) || std::filesystem::is_directory(path))
      throw BoardFileError(fmt::format("{}: cannot be read; expected a board file in TOML", path));
    try {
      table_ = toml::parse_file(path);
    } catch (const toml::parse_error& e) {
      throw BoardFileError(fmt::format("{}:{}: {}; expected TOML", path, e.source().begin.line, e.description()));
    }
  }

  BoardConfig read() {
    keys(table_, {"title", "card", "servo_ics", "macro_ics", "macro_gates", "dpram_words"}, "");
    BoardConfig board;
    board.name = std::filesystem::path(path_).stem().string();
    board.title = text("title");
    board.card = static_cast<std::uint32_t>(integer("card", 100'000, 999'999, "a card number of six digits, for example 603382"));
    board.fitted = ics("servo_ics", kServoIcNames);
    board.macro_gate = 0;
    if (table_.get("macro_ics") != nullptr) board.fitted |= ics("macro_ics", "MACRO IC numbers 0 to 3");
    if (table_.get("macro_gates") != nullptr) {
      const std::uint32_t gates = ics("macro_gates", "MACRO IC numbers 0 to 3");
      if ((gates & ~board.fitted) != 0) fail(need("macro_gates"), "macro_gates", "MACRO ICs that macro_ics lists too");
      board.macro_gate = gates >> kFirstMacroIc;
    }
    if (board.fitted == 0) fail(need("servo_ics"), "servo_ics", "a list of one IC or more, for example [0, 1], or macro_ics");
    board.dpram_words = static_cast<std::uint32_t>(integer("dpram_words", 0, 65'536, "8192 or 32768"));
    if (board.dpram_words != 8192 && board.dpram_words != 32768) fail(need("dpram_words"), "dpram_words", "8192 or 32768");
    return board;
  }

 private:
  [[noreturn]] void fail(const toml::node& at, const std::string& key, const std::string& expected) const {
    throw BoardFileError(fmt::format("{}:{}: {} is not right; expected {}", path_, at.source().begin.line, key, expected));
  }

  void keys(const toml::table& table, const std::vector<std::string>& known, const std::string& where) const {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw BoardFileError(
            fmt::format("{}:{}: unknown key {}{}; expected {}", path_, value.source().begin.line, where, name, fmt::join(known, ", ")));
    }
  }

  const toml::node& need(const std::string& key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) throw BoardFileError(fmt::format("{}: key {} is missing", path_, key));
    return *node;
  }

  std::string text(const std::string& key) const {
    const auto value = need(key).value_exact<std::string>();
    if (!value) fail(need(key), key, "a text in quotes");
    return *value;
  }

  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high, const std::string& expected) const {
    const auto value = need(key).value_exact<std::int64_t>();
    if (!value || *value < low || *value > high) fail(need(key), key, expected);
    return *value;
  }

  // A list of ICs as bits of BoardInputs::fitted.
  std::uint32_t ics(const std::string& key, const std::string& expected) const {
    const toml::node& node = need(key);
    const toml::array* array = node.as_array();
    if (array == nullptr) fail(node, key, "a list, for example [0, 1]");
    std::uint32_t fitted = 0;
    for (const toml::node& item : *array) {
      const std::optional<unsigned> place = key == "servo_ics" ? servo_ic(item) : macro_ic(item);
      if (!place) fail(item, key, expected);
      const std::uint32_t bit = 1u << *place;
      if (fitted & bit) fail(item, key, fmt::format("each IC once ({} is there twice)", fitted_ic_names(bit).front()));
      fitted |= bit;
    }
    return fitted;
  }

  static std::optional<unsigned> servo_ic(const toml::node& item) {
    if (const auto number = item.value_exact<std::int64_t>(); number && *number >= 0 && *number < kServoIcs)
      return static_cast<unsigned>(*number);
    const auto name = item.value_exact<std::string>();
    if (name && name->size() == 2 && (*name)[0] >= '2' && (*name)[0] <= '9' && (*name)[1] == '*')
      return kServoIcs + static_cast<unsigned>((*name)[0] - '2');
    return std::nullopt;
  }

  static std::optional<unsigned> macro_ic(const toml::node& item) {
    const auto number = item.value_exact<std::int64_t>();
    if (!number || *number < 0 || *number >= kMacroIcs) return std::nullopt;
    return kFirstMacroIc + static_cast<unsigned>(*number);
  }

  std::string path_;
  toml::table table_;
};

}  // namespace

BoardConfig read_board_file(const std::string& path) { return Reader(path).read(); }

std::vector<std::string> fitted_ic_names(std::uint32_t fitted) {
  std::vector<std::string> names;
  for (unsigned i = 0; i < 22; ++i) {
    if (!((fitted >> i) & 1)) continue;
    if (i < 10)
      names.push_back(fmt::format("servo IC {}", i));
    else if (i < 18)
      names.push_back(fmt::format("servo IC {}*", i - 8));
    else
      names.push_back(fmt::format("MACRO IC {}", i - 18));
  }
  return names;
}

}  // namespace brick
