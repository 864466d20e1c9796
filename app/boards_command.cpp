// `brick boards`: a table of what is fitted on each board, or all about one.
#include <algorithm>
#include <functional>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/paths.h"
#include "systemc/machine/board_file.h"

namespace brick {

namespace {

constexpr std::array<std::string_view, 5> kFixedLines{"IPOS", "BREQ", "EROR", "F1ER", "HREQ"};
constexpr unsigned kFirstSelected = 5, kLines = 8;

std::vector<std::string> interrupt_lines(const BoardConfig& board) {
  std::vector<std::string> lines(kFixedLines.begin(), kFixedLines.end());
  for (unsigned line = kFirstSelected; line < kLines; ++line)
    lines.emplace_back(kInterruptSources.at(board.line_select >> 4 * (line - kFirstSelected) & 0xF));
  return lines;
}

unsigned clock_source(const BoardConfig& board) { return default_clock_source(board.fitted, board.macro_gate); }
std::string_view type(const BoardConfig& board) { return find_board_family(board.family)->type; }

std::vector<std::string> kinds(const BoardConfig& board) {
  std::vector<std::string> names = fitted_ic_names(board.fitted);
  for (std::string& name : names)
    if (name.rfind("MACRO", 0) == 0 && (board.macro_gate >> (name.back() - '0') & 1) != 0) name += " (MACROGATE)";
  return names;
}

nlohmann::json board_json(const BoardConfig& b) {
  return {{"name", b.name},
          {"title", b.title},
          {"family", b.family},
          {"bus", b.bus},
          {"axes", b.axes},
          {"ics", fitted_ic_names(b.fitted)},
          {"macro_gates",
           b.macro_gate == 0 ? nlohmann::json::array() : nlohmann::json(fitted_ic_names(b.macro_gate << 18))},
          {"clock_source", clock_source(b)},
          {"dpram_words", b.dpram_words},
          {"interrupts", interrupt_lines(b)},
          {"pic", b.pic_8259 ? "8259" : "pic"},
          {"jpan", b.jpan},
          {"feedback_option_2", b.feedback_option_2},
          {"type", type(b)},
          {"card", b.card},
          {"notes", b.notes}};
}

// Switches and window of a card have the names of their keys in the board file.
bool is_card(const BoardConfig& b) { return b.bus == "isa" || b.bus == "pc104"; }
unsigned io_bits(const BoardConfig& b) { return b.io_decode16 ? 16 : 10; }
unsigned slot_bits(const BoardConfig& b) { return b.slot8 ? 8 : 16; }
std::uint32_t window_kib(const BoardConfig& b) { return b.window_flat ? 64 : 16; }

nlohmann::json as_json(const BoardConfig& b) {
  nlohmann::json json = board_json(b);
  if (!is_card(b)) return json;
  json.update({{"io_base", b.io_base},
               {"io_decode", io_bits(b)},
               {"dpram_window", b.window},
               {"dpram_window_kib", window_kib(b)},
               {"slot", slot_bits(b)}});
  return json;
}

void print_host_bus(const BoardConfig& b, const std::function<void(const char*, const std::string&)>& line) {
  if (!is_card(b)) {
    line("host bus", b.bus + " (the model has the pins of the ISA bus)");
    return;
  }
  line("host bus", fmt::format("{}, {} bits", b.bus, slot_bits(b)));
  line("host I/O", fmt::format("0x{:03X}..0x{:03X}, {} address bits", b.io_base, b.io_base + 15, io_bits(b)));
  line("host memory", fmt::format("0x{:05X}..0x{:05X}, {}", b.window, b.window + 1024 * window_kib(b) - 1,
                                  b.window_flat ? "flat" : "16 KiB a page"));
}

void print_table(const std::vector<BoardConfig>& boards) {
  std::size_t name = 5, servo = 9;
  for (const BoardConfig& b : boards) {
    name = std::max(name, b.name.size());
    servo = std::max(servo, servo_ic_numbers(b.fitted).size());
  }
  const auto row = [&](const auto&... cells) {
    std::string text =
        fmt::format("{:<{}}  {:>4}  {:<{}}  {:<9}  {:>5}  {:<8}  {:<4}  {:>6}  {:<6}  {:<8}  {}", cells...);
    std::cout << text << '\n';
  };
  row("BOARD", name, "AXES", "SERVO ICS", servo, "MACRO ICS", "I19", "DPRAM", "JPAN", "CARD", "TYPE", "BUS", "TITLE");
  for (const BoardConfig& b : boards)
    row(b.name, name, b.axes, servo_ic_numbers(b.fitted), servo, macro_ic_numbers(b.fitted), clock_source(b),
        fmt::format("{} k x16", b.dpram_words / 1024), b.jpan ? "yes" : "-", b.card, type(b), b.bus, b.title);
}

void print_all(const BoardConfig& b) {
  const auto line = [](const char* what, const std::string& text) {
    std::cout << fmt::format("{:<16} {}\n", what, text);
  };
  std::vector<std::string> lines = interrupt_lines(b);
  for (unsigned i = 0; i < kLines; ++i) lines[i] = fmt::format("IR{} {}", i, lines[i]);
  std::cout << fmt::format("{}: {}\n", b.name, b.title);
  line("family", b.family);
  print_host_bus(b, line);
  line("axes", std::to_string(b.axes));
  line("ICs", fmt::format("{}", fmt::join(kinds(b), ", ")));
  line("clock source", fmt::format("I19={} after re-initialisation", clock_source(b)));
  line("dual-ported RAM", fmt::format("{} x 16 bits, PMAC $060000..${:06X}, host 0x0000..0x{:04X}", b.dpram_words,
                                      0x060000 + b.dpram_words / 2 - 1, 2 * b.dpram_words - 1));
  line("interrupts", fmt::format("{}{}", fmt::join(lines, ", "), b.pic_8259 ? ", by an 8259" : ""));
  line("control panel", b.jpan ? "JPAN, Y:$078800" : "none");
  if (b.feedback_option_2) line("options", "Feedback Option 2 (SSI inputs)");
  line("answers", fmt::format("TYPE {}, CID {}", type(b), b.card));
  for (const std::string& note : b.notes) line("note", note);
}

}  // namespace

int boards_command(const std::string& name_or_file, bool json) {
  if (!name_or_file.empty()) {
    const BoardConfig board = read_board_file(board_path(name_or_file, "board"));
    if (json)
      std::cout << as_json(board).dump(2) << '\n';
    else
      print_all(board);
    return 0;
  }
  std::vector<BoardConfig> boards;
  for (const std::string& name : board_names()) boards.push_back(read_board_file(board_path(name)));
  if (!json) {
    print_table(boards);
    return 0;
  }
  nlohmann::json list = nlohmann::json::array();
  for (const BoardConfig& board : boards) list.push_back(as_json(board));
  std::cout << list.dump(2) << '\n';
  return 0;
}

}  // namespace brick
