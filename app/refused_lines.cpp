#include "app/refused_lines.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/command_file.h"

namespace brick {

std::string_view error_meaning(std::string_view error) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 22> kMeanings{{
      {"ERR", "an error without its number, see I6"},
      {"ERR001", "not allowed while a program runs"},
      {"ERR002", "protected by a password"},
      {"ERR003", "unknown command, wrong data, or wrong order of buffers"},
      {"ERR004", "illegal character"},
      {"ERR005", "text of a program, but no buffer is open"},
      {"ERR006", "no room left in the buffer"},
      {"ERR007", "a buffer is open already, or none to CLEAR"},
      {"ERR008", "no answer on the MACRO ring"},
      {"ERR009", "IF, WHILE and their ends do not match"},
      {"ERR010", "a motor of the coordinate system has both limits set"},
      {"ERR011", "the move before is not completed"},
      {"ERR012", "a motor of the coordinate system is open-loop"},
      {"ERR013", "a motor of the coordinate system is not activated"},
      {"ERR014", "no motors in the coordinate system"},
      {"ERR015", "the coordinate system does not point to a program"},
      {"ERR016", "the program is improperly structured"},
      {"ERR017", "the motors have left the place where the program was stopped"},
      {"ERR018", "not while a phase reference or a move is going on"},
      {"ERR019", "not with moves in the buffer of cutter compensation"},
      {"ERR021", "the flash is being cleared"},
      {"ERR022", "the flash is bad"},
  }};
  const auto found =
      std::find_if(kMeanings.begin(), kMeanings.end(), [&](const auto& meaning) { return meaning.first == error; });
  return found == kMeanings.end() ? "not a known error" : found->second;
}

std::string RefusedLines::add(const std::string& place, const std::string& line, const std::string& error) {
  ++by_error_[error];
  if (++count_ > kTold) return "";
  std::string text =
      fmt::format("{}: {}: {}: {}", place, beginning_of(line, kControllerLine), error, error_meaning(error));
  if (line.size() > kControllerLine)
    text += fmt::format("; the line has {} characters, expected at most {}", line.size(), kControllerLine);
  return text;
}

std::string RefusedLines::summary(std::size_t lines) const {
  if (count_ == 0) return "";
  std::string text = fmt::format("{} of {} lines refused:", count_, lines);
  const char* between = " ";
  for (const auto& [error, count] : by_error_)
    text += fmt::format("{}{} x {}", std::exchange(between, ", "), count, error);
  if (count_ > kTold) text += fmt::format("; the first {} are told above", kTold);
  return text;
}

}  // namespace brick
