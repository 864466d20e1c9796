#include "app/regress/covers.h"

#include <algorithm>

namespace brick::regress {

bool MergedCover::reached() const {
  return std::all_of(counts.begin(), counts.end(), [this](const auto& c) { return c.second >= least; });
}

void Coverage::add(std::size_t run, const std::string& engine, const std::string& folder) {
  const nlohmann::json result = json_of(folder + "/run.json");
  if (!result.is_object() || !result.contains("covers")) return;
  Of of{run, engine, {}};
  std::map<std::string, std::uint64_t> least;
  try {
    for (const auto& [name, cover] : result.at("covers").items()) {
      of.counts[name] = cover.value("count", std::uint64_t{0});
      least[name] = cover.value("least", std::uint64_t{1});
    }
  } catch (const nlohmann::json::exception&) { return; }  // a file of another form tells of none
  for (const auto& [name, count] : of.counts) {
    MergedCover& merged = merged_[name];
    merged.least = std::max(merged.least, least[name]);
    merged.counts[engine] += count;
  }
  runs_.push_back(std::move(of));
}

// An engine is a cover's own: what one has shown is still new on another.
std::vector<Ranked> Coverage::rank() const {
  std::map<std::pair<std::string, std::string>, std::uint64_t> had;  // by engine and name, up to its least
  const auto adds = [&](const Of& of) {
    double sum = 0;
    for (const auto& [name, count] : of.counts) {
      const std::uint64_t least = merged_.at(name).least;
      if (least == 0) continue;  // asks for none
      const auto before = had.find({of.engine, name});
      const std::uint64_t missing = least - (before == had.end() ? 0 : before->second);
      sum += static_cast<double>(std::min(count, missing)) / static_cast<double>(least);
    }
    return sum;
  };
  struct Candidate {
    const Of* of;
    double adds;  // at most: it only falls
  };
  std::vector<Candidate> left;
  for (const Of& of : runs_) left.push_back({&of, adds(of)});
  std::vector<Ranked> ranked;
  std::size_t reached = 0;
  while (!left.empty()) {
    const auto more = [](const Candidate& a, const Candidate& b) { return a.adds > b.adds; };
    std::stable_sort(left.begin(), left.end(), more);
    Candidate& first = left.front();
    const double now = adds(*first.of);
    if (now < first.adds && left.size() > 1 && now < left[1].adds) {
      first.adds = now;
      continue;
    }
    if (now <= 0) break;
    for (const auto& [name, count] : first.of->counts) {
      const std::uint64_t least = merged_.at(name).least;
      std::uint64_t& so_far = had[{first.of->engine, name}];
      const bool before = so_far >= least;
      so_far = std::min(least, so_far + count);
      if (!before && so_far >= least) ++reached;
    }
    ranked.push_back({first.of->run, now, reached});
    left.erase(left.begin());
  }
  return ranked;
}

nlohmann::json covers_json(const Coverage& coverage) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, cover] : coverage.merged())
    list.push_back({{"name", name}, {"least", cover.least}, {"counts", cover.counts}, {"reached", cover.reached()}});
  return list;
}

nlohmann::json ranked_json(const std::vector<Ranked>& ranked, const std::vector<Run>& runs) {
  nlohmann::json list = nlohmann::json::array();
  for (const Ranked& r : ranked)
    list.push_back({{"run", runs[r.run].name}, {"seed", runs[r.run].seed}, {"adds", r.adds}, {"reached", r.reached}});
  return list;
}

}  // namespace brick::regress
