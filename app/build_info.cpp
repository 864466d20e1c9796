#include "app/build_info.h"

#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <systemc>

#include "app/byte_text.h"
#include "build_commit.h"

namespace brick {

nlohmann::json build_info() {
  return {{"version", BRICK_VERSION},
          {"commit", BRICK_COMMIT},
          {"dirty", BRICK_DIRTY != 0},
          {"tools",
           {{"compiler", BRICK_COMPILER},
            {"verilator", BRICK_VERILATOR},
            {"systemc", fmt::format("{}.{}.{}", SC_VERSION_MAJOR, SC_VERSION_MINOR, SC_VERSION_PATCH)},
            {"build_type", BRICK_BUILD_TYPE}}}};
}

std::string version_text(const std::string& firmware) {
  const nlohmann::json build = build_info();
  const std::string commit = build.at("commit");
  std::string text = fmt::format("brick {}\n", build.at("version").get<std::string>());
  if (!commit.empty())
    text += fmt::format("commit {}{}\n", commit, build.at("dirty").get<bool>() ? ", with changes" : "");
  if (!firmware.empty()) text += fmt::format("image {}\n", file_hash(firmware));
  for (const auto& [tool, version] : build.at("tools").items())
    text += fmt::format("{} {}\n", tool, version.get<std::string>());
  text.pop_back();
  return text;
}

void add_origin(nlohmann::json& results, const std::string& firmware) {
  std::ifstream words("/proc/self/cmdline", std::ios::binary);
  nlohmann::json command = nlohmann::json::array();
  for (std::string word; std::getline(words, word, '\0');) command.push_back(utf8_text(word));
  results["build"] = build_info();
  results["command"] = command;
  if (!firmware.empty()) results["image"] = {{"file", utf8_text(firmware)}, {"hash", file_hash(firmware)}};
}

std::string text_hash(const std::string& bytes) {
  constexpr std::uint64_t kOffset = 0xcbf29ce484222325, kPrime = 0x100000001b3;
  std::uint64_t hash = kOffset;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return fmt::format("{:016x}", hash);
}

std::string file_hash(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return file ? text_hash({std::istreambuf_iterator<char>(file), {}}) : "";
}

}  // namespace brick
