#include "app/page/executing_line.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "app/byte_text.h"

namespace brick {

using nlohmann::json;

namespace {

constexpr std::uint32_t kMostWords = 300;  // words of a line
constexpr std::uint32_t kMostCalls = 16;   // of programs by programs
constexpr std::uint32_t kMotionProgram = 0;
constexpr std::uint32_t kLine = 2;  // of the words that a function can be given: where the line begins

// A word of 48 bits of the line.
void put_word(ImageCalls& image, std::uint32_t index, std::uint64_t value) {
  image.set_word(kLine + 2 * index, static_cast<std::uint32_t>(value));
  image.set_word(kLine + 2 * index + 1, static_cast<std::uint32_t>(value >> 32));
}

std::string words_text(ImageCalls& image, std::uint32_t count) {
  if (count == 0) return "";
  image.take_text();
  if (!image.call("lister_line", {ImageCalls::kWords + 4 * kLine, count, 0, ImageCalls::kPut})) return "";
  return utf8_text(image.take_text());
}

json stored_line(ImageCalls& image, const std::string& at, std::uint32_t program, std::uint32_t offset) {
  if ((image.call("program_password_protects", {kMotionProgram, program}).value_or(1) & 0xFF) != 0)
    return {{"at", at}, {"text", ""}};
  const auto found =
      static_cast<std::uint32_t>(image.call("fixed_program_find", {kMotionProgram, program}).value_or(0));
  if (found == 0) return nullptr;
  const auto words = static_cast<std::uint32_t>(image.call("fixed_program_line", {found, offset}).value_or(0));
  const std::uint32_t count = std::min(words, kMostWords);
  for (std::uint32_t i = 0; i < count; ++i)
    put_word(image, i, image.call("fixed_program_word", {found, offset + i}).value_or(0));
  return {{"at", at}, {"text", words_text(image, count)}};
}

json ring_line(ImageCalls& image, const std::string& at, std::uint32_t cs) {
  const std::uint64_t ahead = image.call("rotary_lines_ahead", {cs}).value_or(0);
  const auto first = static_cast<std::uint32_t>(ahead), words = static_cast<std::uint32_t>(ahead >> 32);
  std::uint32_t count = 0;
  for (; count < words && count < kMostWords; ++count) {
    const auto place = static_cast<std::uint32_t>(image.call("rotary_offset", {cs, first, count}).value_or(0));
    const std::uint64_t value = image.call("rotary_word", {cs, place}).value_or(0);
    if (count != 0 && (value >> 47 & 1) != 0) break;  // the next line begins
    put_word(image, count, value);
  }
  if (count == 0) return nullptr;
  return {{"at", at}, {"text", words_text(image, count)}};
}

}  // namespace

json executing_line(ImageCalls& image, unsigned system) {
  const std::uint32_t cs = system - 1;
  if (!image.call("run_executing", {cs, ImageCalls::kWords})) return nullptr;
  const std::uint32_t depth = image.word(0);
  std::string at;
  std::uint32_t program = 0, offset = 0;
  for (std::uint32_t i = 0; i <= depth && i < kMostCalls; ++i) {
    program = image.word(1 + i) & 0xFFFF;
    offset = image.word(1 + i) >> 16;
    at += fmt::format("{}P{}:{}", i == 0 ? "" : ">", program, offset);
  }
  return program != 0 ? stored_line(image, at, program, offset) : ring_line(image, at, cs);
}

}  // namespace brick
