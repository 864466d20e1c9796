#include "app/line_cover.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/paths.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr const char* kDisassembler = "riscv64-unknown-elf-objdump";

using Lines = std::map<std::string, std::map<unsigned, bool>>;  // file, line: executed

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

// binutils read the line table: each instruction of the image with the line that it was made of.
Lines lines_of(const std::string& image, const std::vector<std::uint32_t>& executed) {
  std::string quoted;
  for (const char c : image) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  FILE* program = popen(fmt::format("exec {} -d -l --no-show-raw-insn '{}'", kDisassembler, quoted).c_str(), "r");
  if (program == nullptr) throw UsageError("--cover: no process; expected room for one more");
  Lines lines;
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
      const auto address = static_cast<std::uint32_t>(std::stoul(text.substr(0, tab), nullptr, 16));
      bool& seen = lines[path][number];
      seen = seen || std::binary_search(executed.begin(), executed.end(), address);
    }
    text.clear();
  }
  const int status = pclose(program);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw UsageError(
        fmt::format("--cover: {} failed; expected Debian's package binutils-riscv64-unknown-elf", kDisassembler));
  return lines;
}

void write(const std::string& file, const Lines& lines) {
  std::ofstream out(file);
  for (const auto& [path, of_file] : lines) {
    if (!std::filesystem::exists(path)) continue;  // of the compiler's library
    out << "TN:\nSF:" << path << '\n';
    unsigned hit = 0;
    for (const auto& [number, seen] : of_file) {
      out << "DA:" << number << ',' << (seen ? 1 : 0) << '\n';
      hit += seen ? 1u : 0u;
    }
    out << "LF:" << of_file.size() << "\nLH:" << hit << "\nend_of_record\n";
  }
  out.close();
  if (!out) throw UsageError(fmt::format("--cover {}: cannot be written; expected a file", file));
}

}  // namespace

RunExtras line_cover(const std::string& file, const RunOptions& options) {
  RunExtras extras;
  if (file.empty()) return extras;
  need_folder("--cover", file);
  const std::string image = options.firmware.empty() ? default_firmware() : options.firmware;
  extras.after = [file, image](Simulation& simulation, nlohmann::json& results) {
    write(file, lines_of(image, simulation.machine().cpu().executed()));
    results["cover"] = file;
  };
  return extras;
}

}  // namespace brick
