#include "app/paths.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace fs = std::filesystem;

namespace {

fs::path executable_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }
fs::path share_folder() { return executable_folder().parent_path() / "share" / "brick"; }
fs::path built_image() { return executable_folder() / "turbo.elf"; }
fs::path installed_image() { return share_folder() / "turbo.elf"; }

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<std::string> names_in(const fs::path& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code none;  // a folder that is not there has no names
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ending) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::string default_firmware_if_any() {
  for (const auto& path : {built_image(), installed_image()})
    if (fs::exists(path)) return path.string();
  return "";
}

std::string default_firmware() {
  std::string file = default_firmware_if_any();
  if (file.empty())
    throw UsageError(fmt::format("no firmware image; expected {} or {}, or --firmware FILE.elf", built_image().string(),
                                 installed_image().string()));
  return file;
}

std::string boards_folder() {
  const fs::path folder = share_folder() / "boards";
  if (!fs::is_directory(folder)) throw UsageError(fmt::format("no boards folder; expected {}", folder.string()));
  return folder.string();
}

std::vector<std::string> board_names() { return names_in(boards_folder(), ".toml"); }

std::string board_path(const std::string& name_or_file, const std::string& option) {
  if (ends_with(name_or_file, ".toml")) return name_or_file;
  const auto names = board_names();
  if (std::find(names.begin(), names.end(), name_or_file) == names.end())
    throw UsageError(
        fmt::format("{} {}: no such board; expected {} or FILE.toml", option, name_or_file, fmt::join(names, ", ")));
  return (fs::path(boards_folder()) / (name_or_file + ".toml")).string();
}

std::vector<std::string> plant_names() { return names_in(share_folder() / "plants", ".toml"); }

std::string plant_path(const std::string& name_or_file) {
  if (ends_with(name_or_file, ".toml")) return name_or_file;
  const auto names = plant_names();
  if (std::find(names.begin(), names.end(), name_or_file) == names.end())
    throw UsageError(
        fmt::format("--plant {}: no such plant; expected none, {} or FILE.toml", name_or_file, fmt::join(names, ", ")));
  return (share_folder() / "plants" / (name_or_file + ".toml")).string();
}

std::string setup_path(const std::string& name_or_file) {
  if (name_or_file.find_first_of("./") != std::string::npos) return name_or_file;
  const auto names = names_in(share_folder() / "setups", ".pmc");
  if (std::find(names.begin(), names.end(), name_or_file) == names.end())
    throw UsageError(fmt::format("--load {}: no such set-up; expected {} or a file such as ./{}.pmc", name_or_file,
                                 fmt::join(names, ", "), name_or_file));
  return (share_folder() / "setups" / (name_or_file + ".pmc")).string();
}

std::string view_path(const std::string& bench) {
  const fs::path view = share_folder() / "waves" / (bench + ".gtkw");
  return fs::exists(view) ? view.string() : "";
}

}  // namespace brick
