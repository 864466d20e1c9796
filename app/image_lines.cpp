#include "app/image_lines.h"

#include <sys/wait.h>

#include <cstdio>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr const char* kDisassembler = "riscv64-unknown-elf-objdump";

// Of a line `PATH:NUMBER` or `PATH:NUMBER (discriminator N)`, which stands before the instructions made of it.
bool read_place(std::string text, std::string& path, unsigned& number) {
  if (const std::size_t behind = text.find(" (discriminator "); behind != std::string::npos) text.resize(behind);
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size() ||
      text.find_first_not_of("0123456789", colon + 1) != std::string::npos)
    return false;
  path = text.substr(0, colon);
  number = static_cast<unsigned>(std::stoul(text.substr(colon + 1)));
  return true;
}

[[noreturn]] void no_disassembler(const std::string& option) {
  throw UsageError(
      fmt::format("{}: {} failed; expected Debian's package binutils-riscv64-unknown-elf", option, kDisassembler));
}

}  // namespace

void need_disassembler(const std::string& option) {
  FILE* program = popen(fmt::format("exec {} --version >/dev/null 2>&1", kDisassembler).c_str(), "r");
  if (program == nullptr || pclose(program) != 0) no_disassembler(option);
}

void image_lines(const std::string& option, const std::string& image,
                 const std::function<void(std::uint32_t address, const std::string& path, unsigned line)>& take) {
  std::string quoted;
  for (const char c : image) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  FILE* program =
      popen(fmt::format("exec {} -d -l --no-show-raw-insn '{}' 2>/dev/null", kDisassembler, quoted).c_str(), "r");
  if (program == nullptr) throw UsageError(fmt::format("{}: no process; expected room for one more", option));
  std::string text, path;
  unsigned number = 0;
  for (int c = 0; (c = std::fgetc(program)) != EOF;) {
    if (c != '\n') {
      text += static_cast<char>(c);
      continue;
    }
    const std::size_t tab = text.find(":\t");
    if (tab == std::string::npos) {
      read_place(text, path, number);
    } else if (number != 0) {
      take(static_cast<std::uint32_t>(std::stoul(text.substr(0, tab), nullptr, 16)), path, number);
    }
    text.clear();
  }
  const int status = pclose(program);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) no_disassembler(option);
}

}  // namespace brick
