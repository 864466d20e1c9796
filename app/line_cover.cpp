#include "app/line_cover.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/image_lines.h"
#include "app/paths.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

using Lines = std::map<std::string, std::map<unsigned, bool>>;  // file, line: executed

Lines lines_of(const std::string& image, const std::vector<std::uint32_t>& executed) {
  Lines lines;
  image_lines("--cover", image, [&](std::uint32_t address, const std::string& path, unsigned number) {
    bool& seen = lines[path][number];
    seen = seen || std::binary_search(executed.begin(), executed.end(), address);
  });
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
  need_disassembler("--cover");
  const std::string image = options.firmware.empty() ? default_firmware() : options.firmware;
  extras.after = [file, image](Simulation& simulation, nlohmann::json& results) {
    write(file, lines_of(image, simulation.machine().cpu().executed()));
    results["cover"] = file;
  };
  return extras;
}

}  // namespace brick
