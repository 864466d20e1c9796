// Who made a result: version, commit, tools. It stands in every result as JSON and decides which results of `brick
// regress` are still good.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace brick {

// version, commit ("" of a tree without git), dirty (tracked files differed from it when this was built), tools: names
// and versions.
nlohmann::json build_info();
// The same as lines, the first `brick VERSION`; with the hash of the image that is used without another ("": none).
std::string version_text(const std::string& firmware = "");

// What made the results of a run: build, image ("" for none) and command line.
void add_origin(nlohmann::json& results, const std::string& firmware);

// FNV-1a of 64 bits, in hexadecimal.
std::string text_hash(const std::string& bytes);
std::string file_hash(const std::string& path);  // "" of one that cannot be read

}  // namespace brick
