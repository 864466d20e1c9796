// What became of a run, and what those that failed have in common.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/regress/plan.h"
#include "app/regress/pool.h"

namespace brick::regress {

struct Result {
  std::string verdict;  // passed, failed, bad (usage or input), limit, crashed, skipped (something is missing)
  std::string step;     // of a bench: the first that failed
  std::string says;     // what it measured, or what the run said last
  double at_ms = 0;     // simulated time of that step
  double simulated_ms = 0, wall_seconds = 0;
  std::string host{};  // the machine that made it
  bool passed() const { return verdict == "passed"; }
  bool skipped() const { return verdict == "skipped"; }
};

// What a run has left: null where it is no file, discarded where it is no JSON.
nlohmann::json json_of(const std::string& file);

// Of a run that has ended in `folder`.
Result judge(const Run& run, const Ended& ended, const std::string& folder);

// `folder`/result.json, whole or not at all. `build`: who has made it (app/build_info.h).
void keep(const Run& run, const Result& result, const nlohmann::json& build, const std::string& folder);
// Nothing where there is none of the same command and the same build.
std::optional<Result> kept(const Run& run, const nlohmann::json& build, const std::string& folder);

nlohmann::json result_json(const Run& run, const Result& result);
// A folder's name may be no UTF-8, and stands in commands.
std::string text_of(const nlohmann::json& content, int indent = -1);

// Failures, or what was skipped, of one kind: bench, step, and what was said but for its numbers.
struct Bucket {
  std::string group, verdict, step, says;  // says: with # for numbers
  std::vector<std::size_t> runs;           // of the plan
};

// The largest first. Runs that differ in nothing but the engine and whose verdicts differ make one more of their own.
std::vector<Bucket> buckets_of(const std::vector<Run>& runs, const std::vector<std::optional<Result>>& results);

std::string command_text(const std::vector<std::string>& words);  // for a shell

}  // namespace brick::regress
