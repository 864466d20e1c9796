#include "app/regress/inputs.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "app/build_info.h"
#include "app/byte_text.h"
#include "app/paths.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// As begin() and execvp find it; `brick` is this one, which every result has.
fs::path program_file(const std::string& name) {
  if (name == "brick") return {};
  if (name.find('/') != std::string::npos) return fs::absolute(name);
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; is_file(file)) return file;
  return {};
}

// An option of brick whose value may be the name of a file of ours.
std::string file_of_option(const std::string& option, const std::string& value) {
  try {
    if (option == "--board") return board_path(value);
    if (option == "--plant") return plant_path(value);
    if (option == "--load") return setup_path(value);
  } catch (const UsageError&) {}  // the run will say it
  return value;
}

}  // namespace

// A run stands in a fresh folder, so that only an absolute path is a file that was there before.
nlohmann::json Inputs::of(const Run& run) {
  nlohmann::json files = nlohmann::json::object();
  const auto add = [&](const std::string& file) {
    if (const std::string& content = hash(file); !content.empty()) files[utf8_text(file)] = content;
  };
  const bool ours = run.words[0] == "brick";
  add(program_file(run.words[0]).string());
  for (std::size_t i = 1; i < run.words.size(); ++i) {
    std::string option = run.words[i - 1], value = run.words[i];
    if (const std::size_t equals = value.find('='); value.compare(0, 2, "--") == 0 && equals != std::string::npos) {
      option = value.substr(0, equals);
      value = value.substr(equals + 1);
    }
    if (ours) value = file_of_option(option, value);
    if (value[0] == '/') add(value);
  }
  return files;
}

const std::string& Inputs::hash(const std::string& file) {
  const auto [at, fresh] = known_.try_emplace(file);
  if (fresh && is_file(file)) at->second = file_hash(file);
  return at->second;
}

}  // namespace brick::regress
