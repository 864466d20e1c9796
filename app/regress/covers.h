// What the runs that passed have exercised: the covers of their results together, and which runs it takes to reach them
// (docs/regress.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/regress/plan.h"
#include "app/regress/result.h"

namespace brick::regress {

struct MergedCover {
  std::uint64_t least = 0;                      // of all runs together, on each engine
  std::map<std::string, std::uint64_t> counts;  // by engine; of a command by its name
  bool reached() const;
};

struct Ranked {
  std::size_t run;      // of the plan
  double adds;          // covers that are new with it; a part where it brings a part of what is asked for
  std::size_t reached;  // with it and those before
};

class Coverage {
 public:
  // `results`: one run.json of `brick run --json` each, of the folder that `folder_of` a run names.
  template <class FolderOf>
  Coverage(const std::vector<Run>& runs, const std::vector<std::optional<Result>>& results, FolderOf folder_of) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (results[i] && results[i]->passed())
        add(i, runs[i].bench() ? runs[i].engine : runs[i].group, folder_of(runs[i]));
  }

  const std::map<std::string, MergedCover>& merged() const { return merged_; }
  std::vector<Ranked> rank() const;  // the run that adds most first, until none adds anything

 private:
  struct Of {
    std::size_t run;
    std::string engine;
    std::map<std::string, std::uint64_t> counts;
  };
  void add(std::size_t run, const std::string& engine, const std::string& folder);

  std::vector<Of> runs_;
  std::map<std::string, MergedCover> merged_;
};

nlohmann::json covers_json(const Coverage& coverage);
nlohmann::json ranked_json(const std::vector<Ranked>& ranked, const std::vector<Run>& runs);

}  // namespace brick::regress
