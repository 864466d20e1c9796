#include "systemc/machine/board_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace brick {

namespace {

constexpr unsigned kServoIcs = 10, kFirstMacroIc = 18,
                   kMacroIcs = 4;  // bits of BoardInputs::fitted: 10..17 are servo IC 2*..9*
constexpr const char* kServoIcNames = "servo IC numbers 0 to 9, or \"2*\" to \"9*\" in quotes";
constexpr const char* kMacroIcNames = "MACRO IC numbers 0 to 3";
constexpr std::size_t kInterruptLines = 3, kShownCharacters = 40;
const std::vector<std::string> kKeys{"title",       "family",     "bus",       "axes",
                                     "card",        "servo_ics",  "macro_ics", "macro_gates",
                                     "dpram_words", "interrupts", "jpan",      "feedback_option_2",
                                     "notes"};
const std::vector<std::string> kBuses{"isa", "pci", "pc104", "internal"};

// As the file has it, on one line and not too long.
std::string found_text(const toml::node& node) {
  std::ostringstream out;
  if (const auto quoted = node.value_exact<std::string>())
    out << '"' << *quoted << '"';
  else
    node.visit([&](const auto& n) { out << n; });
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > kShownCharacters) text = text.substr(0, kShownCharacters) + "...";
  return text;
}

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
    only_known_keys();
    BoardConfig board;
    board.name = std::filesystem::path(path_).stem().string();
    board.title = text("title");
    family_ = find_board_family(text("family"));
    if (family_ == nullptr)
      fail(need("family"), "family", fmt::format("one of {}", fmt::join(board_family_names(), ", ")));
    board.family = family_->name;
    board.card = static_cast<std::uint32_t>(
        integer("card", 100'000, 999'999, "a card number of six digits, for example 603382"));
    read_ics(board);
    board.axes = default_axes(board.fitted);
    if (has("axes")) board.axes = static_cast<unsigned>(integer("axes", 1, board.axes, axes_text(board)));
    board.dpram_words = static_cast<std::uint32_t>(integer("dpram_words", 0, 65'536, "8192 or 32768"));
    if (board.dpram_words != 8192 && board.dpram_words != 32768)
      fail(need("dpram_words"), "dpram_words", "8192 or 32768");
    read_options(board);
    if (has("interrupts")) board.line_select = interrupts(board.fitted);
    if (has("notes")) board.notes = texts("notes");
    return board;
  }

 private:
  [[noreturn]] void fail(const toml::node& at, const std::string& key, const std::string& expected) const {
    throw BoardFileError(
        fmt::format("{}:{}: {}: found {}; expected {}", path_, at.source().begin.line, key, found_text(at), expected));
  }

  void only_known_keys() const {
    for (const auto& [key, value] : table_) {
      const std::string name(key.str());
      if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end())
        throw BoardFileError(fmt::format("{}:{}: unknown key {}; expected {}", path_, key.source().begin.line, name,
                                         fmt::join(kKeys, ", ")));
    }
  }

  bool has(const char* key) const { return table_.get(key) != nullptr; }

  const toml::node& need(const std::string& key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) throw BoardFileError(fmt::format("{}: key {} is missing; expected {} = ...", path_, key, key));
    return *node;
  }

  std::string text(const std::string& key) const {
    const auto value = need(key).value_exact<std::string>();
    if (!value) fail(need(key), key, "a text in quotes");
    return *value;
  }

  std::vector<std::string> texts(const std::string& key) const {
    std::vector<std::string> list;
    for (const toml::node& item : array(key)) {
      const auto value = item.value_exact<std::string>();
      if (!value) fail(item, key, "texts in quotes");
      list.push_back(*value);
    }
    return list;
  }

  bool flag(const std::string& key) const {
    if (table_.get(key) == nullptr) return false;
    const auto value = need(key).value_exact<bool>();
    if (!value) fail(need(key), key, "true or false");
    return *value;
  }

  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high, const std::string& expected) const {
    const auto value = need(key).value_exact<std::int64_t>();
    if (!value || *value < low || *value > high) fail(need(key), key, expected);
    return *value;
  }

  const toml::array& array(const std::string& key) const {
    const toml::array* list = need(key).as_array();
    if (list == nullptr) fail(need(key), key, "a list in brackets");
    return *list;
  }

  // Which ICs there are, and whether a product of the family can have them.
  void read_ics(BoardConfig& board) const {
    board.fitted = ics("servo_ics", kServoIcNames);
    board.macro_gate = 0;
    if (has("macro_ics")) board.fitted |= ics("macro_ics", kMacroIcNames);
    if (has("macro_gates")) {
      const std::uint32_t gates = ics("macro_gates", kMacroIcNames);
      if ((gates & ~board.fitted) != 0) fail(need("macro_gates"), "macro_gates", "MACRO ICs that macro_ics lists too");
      board.macro_gate = gates >> kFirstMacroIc;
    }
    if (board.fitted == 0)
      fail(need("servo_ics"), "servo_ics", "a list of one IC or more, for example [0, 1], or macro_ics");
    if (default_clock_source(board.fitted, board.macro_gate) == 0)
      fail(need("macro_gates"), "macro_gates",
           "one servo IC or DSPGATE2 at least, because a MACROGATE cannot make the servo clock");
  }

  // Four axes a servo IC; on boards without one, the eight servo nodes of each MACRO IC.
  static unsigned default_axes(std::uint32_t fitted) {
    const auto servo = static_cast<unsigned>(__builtin_popcount(fitted & ((1u << kFirstMacroIc) - 1)));
    const auto macro = static_cast<unsigned>(__builtin_popcount(fitted >> kFirstMacroIc));
    return std::min(32u, servo != 0 ? 4 * servo : 8 * macro);
  }
  static std::string axes_text(const BoardConfig& board) {
    return fmt::format("1 to {}: four a servo IC, or eight a MACRO IC where there is no servo IC", board.axes);
  }

  void read_options(BoardConfig& board) const {
    board.product = family_->product;
    board.jpan = flag("jpan");
    if (board.jpan && !family_->jpan)
      fail(need("jpan"), "jpan", fmt::format("false: a {} has no control panel port", family_->name));
    board.feedback_option_2 = flag("feedback_option_2");
    if (board.feedback_option_2 && !family_->feedback_option_2)
      fail(need("feedback_option_2"), "feedback_option_2", "false: that is an option of a geo-pmac only");
    if (board.feedback_option_2) board.product |= kProductFeedback2;
    board.bus = text("bus");
    if (std::find(kBuses.begin(), kBuses.end(), board.bus) == kBuses.end())
      fail(need("bus"), "bus", fmt::format("one of {}", fmt::join(kBuses, ", ")));
  }

  // Sources of IR5, IR6 and IR7 as digits of BoardInputs::line_select.
  std::uint32_t interrupts(std::uint32_t fitted) const {
    const toml::array& list = array("interrupts");
    if (list.size() != kInterruptLines) fail(list, "interrupts", "three sources: of IR5, IR6 and IR7");
    std::uint32_t select = 0;
    for (std::size_t line = 0; line < kInterruptLines; ++line) {
      const std::string name = list[line].value_exact<std::string>().value_or("");
      const auto* source = std::find(kInterruptSources.begin(), kInterruptSources.end(), name);
      if (source == kInterruptSources.end())
        fail(list[line], "interrupts", fmt::format("{}", fmt::join(kInterruptSources, ", ")));
      const auto code = static_cast<std::uint32_t>(source - kInterruptSources.begin());
      if (code != 0 && code <= kSourceEqu8 && (fitted >> ((code - 1) / 4) & 1) == 0)
        fail(list[line], "interrupts",
             fmt::format("a compare output that is there: servo IC {} is not fitted", (code - 1) / 4));
      if (code >= kSourceCtrl0 && !family_->control_outputs)
        fail(list[line], "interrupts",
             fmt::format("a compare output, WDO or none: a {} has no CTRL outputs", family_->name));
      select |= code << 4 * line;
    }
    return select;
  }

  // A list of ICs as bits of BoardInputs::fitted.
  std::uint32_t ics(const std::string& key, const std::string& expected) const {
    std::uint32_t fitted = 0;
    for (const toml::node& item : array(key)) {
      const std::optional<unsigned> place = key == "servo_ics" ? servo_ic(item) : macro_ic(item);
      if (!place) fail(item, key, expected);
      const std::uint32_t bit = 1u << *place;
      if ((fitted & bit) != 0)
        fail(item, key, fmt::format("each IC once; {} is there twice", fitted_ic_names(bit).front()));
      if ((family_->allowed & bit) == 0)
        fail(item, key, fmt::format("what a {} can have: {}", family_->name, family_->ics));
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
  const BoardFamily* family_ = nullptr;
};

}  // namespace

BoardConfig read_board_file(const std::string& path) { return Reader(path).read(); }

}  // namespace brick
