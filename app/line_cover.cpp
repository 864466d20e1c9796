#include "app/line_cover.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/image_lines.h"
#include "app/paths.h"
#include "app/simulation.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

using Lines = std::map<std::string, std::map<unsigned, std::vector<std::uint32_t>>>;  // file, line: its instructions

// Of the sources that are there: those of the compiler's library are not. Throws UsageError when that leaves nothing.
Lines lines_of(const std::string& file, const std::string& image) {
  Lines lines;
  std::string first;  // for the message: that of the start-up code
  image_lines("--cover", image, [&](std::uint32_t address, const std::string& path, unsigned number) {
    if (first.empty()) first = path;
    lines[path][number].push_back(address);
  });
  if (lines.empty())
    throw UsageError(
        fmt::format("--cover {}: {} has no line table; expected an image with debug information (-g)", file, image));
  for (auto source = lines.begin(); source != lines.end();)
    source = std::filesystem::exists(source->first) ? std::next(source) : lines.erase(source);
  if (lines.empty())
    throw UsageError(
        fmt::format("--cover {}: no source of {} is there, {} for example; expected them where they were when the "
                    "image was made",
                    file, image, first));
  return lines;
}

void write(const std::string& file, const Lines& lines, const std::vector<std::uint32_t>& executed) {
  std::ofstream out(file);
  for (const auto& [path, of_file] : lines) {
    out << "TN:\nSF:" << path << '\n';
    unsigned hit = 0;
    for (const auto& [number, addresses] : of_file) {
      const bool seen = std::any_of(addresses.begin(), addresses.end(), [&](std::uint32_t address) {
        return std::binary_search(executed.begin(), executed.end(), address);
      });
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
  extras.of_firmware = "--cover " + file;
  const std::string image = options.firmware.empty() ? default_firmware() : options.firmware;
  const auto lines = std::make_shared<Lines>();
  extras.before = [file, image, lines](Simulation&) {
    *lines = lines_of(file, image);
    need_writable("--cover", file);
  };
  extras.after = [file, lines](Simulation& simulation, nlohmann::json& results) {
    write(file, *lines, simulation.machine().cpu().executed());
    results["cover"] = file;
  };
  return extras;
}

}  // namespace brick
