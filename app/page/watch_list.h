// What the page's watch list reads by the back door: items as `--record-of` takes them (docs/record.md).
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/record_column.h"

namespace brick {

class WatchList {
 public:
  explicit WatchList(Machine& machine) : machine_(machine) {}

  // What is watched already stays as it is.
  void set(const std::set<std::string>& items);

  // Item to number, or to a text that says what is wrong with it.
  nlohmann::json values() const;

 private:
  struct Watched {
    std::string mistake;
    std::vector<RecordColumn> columns;
  };

  Machine& machine_;
  std::map<std::string, Watched> watched_;
};

}  // namespace brick
