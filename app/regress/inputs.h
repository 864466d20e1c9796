// What the result of a run depends on besides build and image: the contents of files. Another content, and `--resume`
// makes the run again (docs/regress.md).
#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "app/regress/plan.h"

namespace brick::regress {

class Inputs {
 public:
  nlohmann::json of(const Run& run);  // {file: hash} of the files that its words name, as they were at the first call

 private:
  const std::string& hash(const std::string& file);  // "" of none

  std::map<std::string, std::string> known_;
};

}  // namespace brick::regress
