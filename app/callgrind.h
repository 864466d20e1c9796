// Writer of callgrind's profile format, which callgrind_annotate and KCachegrind read: a column of cycles for all tasks
// together and one for each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "app/profiled_task.h"

namespace brick {

class Callgrind {
 public:
  explicit Callgrind(const std::string& image);  // reads its line table; throws UsageError

  void cost(std::uint32_t pc, const TaskCycles& cycles);  // each address once
  void call(std::uint32_t site, std::uint32_t callee, std::uint64_t count, const TaskCycles& inclusive);

  // `about` stands in the head, `function` names who holds an address.
  void write(std::ostream& out, const std::string& about,
             const std::function<std::string(std::uint32_t)>& function) const;

 private:
  struct Call {
    std::uint32_t callee;
    std::uint64_t count;
    TaskCycles inclusive;
  };
  struct Place {
    std::string path = "???";
    unsigned line = 0;
  };
  Place place_of(std::uint32_t pc) const;

  std::string image_;
  std::map<std::uint32_t, Place> places_;
  std::map<std::uint32_t, TaskCycles> costs_;         // by address
  std::map<std::uint32_t, std::vector<Call>> calls_;  // by call site
};

}  // namespace brick
