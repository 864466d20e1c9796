#include "systemc/machine/board_file.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/input_file.h"
#include "systemc/machine/toml_table.h"

namespace brick {

namespace {

constexpr unsigned kServoIcs = 10, kFirstMacroIc = 18,
                   kMacroIcs = 4;  // bits of BoardInputs::fitted: 10..17 are servo IC 2*..9*
constexpr const char* kServoIcNames = "servo IC numbers 0 to 9, or \"2*\" to \"9*\" in quotes";
constexpr const char* kMacroIcNames = "MACRO IC numbers 0 to 3";
constexpr std::size_t kInterruptLines = 3;
constexpr std::uint32_t kCardWindow = 0xD4000;
const std::vector<std::string> kKeys{"title",       "family",     "bus",          "axes",
                                     "card",        "servo_ics",  "macro_ics",    "macro_gates",
                                     "dpram_words", "interrupts", "jpan",         "feedback_option_2",
                                     "io_base",     "io_decode",  "dpram_window", "dpram_window_kib",
                                     "slot",        "pic",        "notes"};
const std::vector<std::string> kBuses{"isa", "pci", "pc104", "internal"};
const std::vector<std::string> kInterruptControllers{"pic", "8259"};

class Reader {
 public:
  explicit Reader(const std::string& path)
      : root_(parse_toml(read_input_file(path, "a board file in TOML"), path)), file_(path, root_, kKeys) {}

  BoardConfig read() {
    BoardConfig board;
    board.name = std::filesystem::path(file_.path()).stem().string();
    board.title = file_.text("title");
    family_ = find_board_family(file_.text("family"));
    if (family_ == nullptr)
      file_.fail(file_.need("family"), "family", fmt::format("one of {}", fmt::join(board_family_names(), ", ")));
    board.family = family_->name;
    board.card = static_cast<std::uint32_t>(
        file_.integer("card", 100'000, 999'999, "a card number of six digits, for example 603382"));
    read_ics(board);
    board.axes = default_axes(board.fitted);
    if (file_.has("axes")) board.axes = static_cast<unsigned>(file_.integer("axes", 1, board.axes, axes_text(board)));
    board.dpram_words = static_cast<std::uint32_t>(file_.integer("dpram_words", 0, 65'536, "8192 or 32768"));
    if (board.dpram_words != 8192 && board.dpram_words != 32768)
      file_.fail(file_.need("dpram_words"), "dpram_words", "8192 or 32768");
    read_options(board);
    board.line_select = file_.has("interrupts") ? interrupts(board.fitted) : default_interrupts(board);
    if (file_.has("pic")) board.pic_8259 = is_8259(board.bus);
    if (file_.has("notes")) board.notes = file_.texts("notes");
    return board;
  }

 private:
  // Which ICs there are, and whether a product of the family can have them.
  void read_ics(BoardConfig& board) const {
    board.fitted = ics("servo_ics", kServoIcNames);
    board.macro_gate = 0;
    if (file_.has("macro_ics")) board.fitted |= ics("macro_ics", kMacroIcNames);
    if (file_.has("macro_gates")) {
      const std::uint32_t gates = ics("macro_gates", kMacroIcNames);
      if ((gates & ~board.fitted) != 0)
        file_.fail(file_.need("macro_gates"), "macro_gates", "MACRO ICs that macro_ics lists too");
      board.macro_gate = gates >> kFirstMacroIc;
    }
    if (board.fitted == 0)
      file_.fail(file_.need("servo_ics"), "servo_ics", "a list of one IC or more, for example [0, 1], or macro_ics");
    if (default_clock_source(board.fitted, board.macro_gate) == 0)
      file_.fail(file_.need("macro_gates"), "macro_gates",
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
    board.amplifiers = family_->amplifiers;
    board.jpan = file_.flag("jpan");
    if (board.jpan && !family_->jpan)
      file_.fail(file_.need("jpan"), "jpan", fmt::format("false: a {} has no control panel port", family_->name));
    board.feedback_option_2 = file_.flag("feedback_option_2");
    if (board.feedback_option_2 && !family_->feedback_option_2)
      file_.fail(file_.need("feedback_option_2"), "feedback_option_2", "false: that is an option of a geo-pmac only");
    if (board.feedback_option_2) board.product |= kProductFeedback2;
    const bool page_alone = family_->ssi_kind == kSsiGeoPmac && !board.feedback_option_2;
    board.ssi_kind = page_alone ? kSsiGeoPmac | kSsiGeoBrick : family_->ssi_kind;
    board.bus = file_.text("bus");
    if (std::find(kBuses.begin(), kBuses.end(), board.bus) == kBuses.end())
      file_.fail(file_.need("bus"), "bus", fmt::format("one of {}", fmt::join(kBuses, ", ")));
    read_host_bus(board);
  }

  // Switches and window of a card. A PCI bridge and the processor inside a Brick have places of their own.
  void read_host_bus(BoardConfig& board) const {
    const bool card = board.bus == "isa" || board.bus == "pc104";
    if (!card) {
      for (const char* key : {"io_base", "io_decode", "dpram_window", "dpram_window_kib", "slot"})
        if (file_.has(key)) file_.fail(file_.need(key), key, "nothing: only isa and pc104 boards have it");
      return;
    }
    board.window = kCardWindow;
    board.window_flat = false;
    board.io_decode16 = choice("io_decode", 16, 10) == 16;
    board.window_flat = choice("dpram_window_kib", 16, 64) == 64;
    board.slot8 = choice("slot", 16, 8) == 8;
    if (board.window_flat) board.window = regs::kDpramWindowBase;
    if (file_.has("io_base"))
      board.io_base = place("io_base", board.io_decode16 ? 0x1000 : 0x400, 16,
                            board.io_decode16 ? "as the eight switches can say" : "as io_decode = 10 can tell apart");
    if (file_.has("dpram_window"))
      board.window = place("dpram_window", board.slot8 ? 0x10'0000 : 0x100'0000, board.window_flat ? 0x10000 : 0x4000,
                           board.slot8 ? "below 1 MiB, as a slot of 8 bits has no LA" : "below 16 MiB");
  }
  // An address from 0 to the last multiple of `step` below `end`.
  std::uint32_t place(const std::string& key, std::uint32_t end, std::uint32_t step, const char* why) const {
    const std::string expected = fmt::format("a multiple of 0x{:X} from 0 to 0x{:X}, {}", step, end - step, why);
    const auto value = static_cast<std::uint32_t>(file_.integer(key, 0, end - step, expected));
    if (value % step != 0) file_.fail(file_.need(key), key, expected);
    return value;
  }
  std::int64_t choice(const std::string& key, std::int64_t usual, std::int64_t other) const {
    if (!file_.has(key)) return usual;
    const std::string expected = fmt::format("{} or {}", std::min(usual, other), std::max(usual, other));
    const std::int64_t value = file_.integer(key, 0, 1'000'000, expected);
    if (value != usual && value != other) file_.fail(file_.need(key), key, expected);
    return value;
  }

  static unsigned servo_ic_of_equ(std::uint32_t code) { return (code - 1) / 4; }
  static bool is_missing(std::uint32_t code, std::uint32_t fitted) {
    return code != 0 && code <= kSourceEqu8 && (fitted >> servo_ic_of_equ(code) & 1) == 0;
  }

  // `none` for the compare outputs that are not fitted.
  static std::uint32_t default_interrupts(const BoardConfig& board) {
    std::uint32_t select = board.line_select;
    for (std::size_t line = 0; line < kInterruptLines; ++line)
      if (is_missing(select >> 4 * line & 0xF, board.fitted)) select &= ~(0xFu << 4 * line);
    return select;
  }

  // Sources of IR5, IR6 and IR7 as digits of BoardInputs::line_select.
  std::uint32_t interrupts(std::uint32_t fitted) const {
    const toml::array& list = file_.array("interrupts");
    if (list.size() != kInterruptLines) file_.fail(list, "interrupts", "three sources: of IR5, IR6 and IR7");
    std::uint32_t select = 0;
    for (std::size_t line = 0; line < kInterruptLines; ++line) {
      const std::string name = list[line].value_exact<std::string>().value_or("");
      const auto* source = std::find(kInterruptSources.begin(), kInterruptSources.end(), name);
      if (source == kInterruptSources.end())
        file_.fail(list[line], "interrupts", fmt::format("{}", fmt::join(kInterruptSources, ", ")));
      const auto code = static_cast<std::uint32_t>(source - kInterruptSources.begin());
      if (is_missing(code, fitted))
        file_.fail(list[line], "interrupts",
                   fmt::format("a compare output that is there: servo IC {} is not fitted", servo_ic_of_equ(code)));
      if (code >= kSourceMi1 && !family_->outside_lines)
        file_.fail(list[line], "interrupts",
                   fmt::format("a compare output, WDO or none: a {} has no MI or AXEXP lines", family_->name));
      if ((code == kSourceCtrl0 || code == kSourceCtrl1) && !family_->control_outputs)
        file_.fail(list[line], "interrupts",
                   fmt::format("a compare output, WDO or none: a {} has no CTRL outputs", family_->name));
      select |= code << 4 * line;
    }
    return select;
  }

  // An 8259 asks for the register addresses of an ISA card.
  bool is_8259(const std::string& bus) const {
    const std::string name = file_.text("pic");
    if (std::find(kInterruptControllers.begin(), kInterruptControllers.end(), name) == kInterruptControllers.end())
      file_.fail(file_.need("pic"), "pic", fmt::format("one of {}", fmt::join(kInterruptControllers, ", ")));
    if (name == "8259" && bus != "isa" && bus != "pc104")
      file_.fail(file_.need("pic"), "pic", "pic: only a board for the isa or pc104 bus can have an 8259");
    return name == "8259";
  }

  // A list of ICs as bits of BoardInputs::fitted.
  std::uint32_t ics(const std::string& key, const std::string& expected) const {
    std::uint32_t fitted = 0;
    for (const toml::node& item : file_.array(key)) {
      const std::optional<unsigned> place = key == "servo_ics" ? servo_ic(item) : macro_ic(item);
      if (!place) file_.fail(item, key, expected);
      const std::uint32_t bit = 1u << *place;
      if ((fitted & bit) != 0)
        file_.fail(item, key, fmt::format("each IC once; {} is there twice", fitted_ic_names(bit).front()));
      if ((family_->allowed & bit) == 0)
        file_.fail(item, key, fmt::format("what a {} can have: {}", family_->name, family_->ics));
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

  toml::table root_;
  TomlTable file_;
  const BoardFamily* family_ = nullptr;
};

}  // namespace

BoardConfig read_board_file(const std::string& path) { return Reader(path).read(); }

}  // namespace brick
