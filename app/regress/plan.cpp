#include "app/regress/plan.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/build_info.h"
#include "app/options.h"
#include "app/regress/result.h"
#include "app/time_text.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"
#include "systemc/machine/toml_table.h"

namespace brick::regress {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kPlanKeys{"title", "row"};
const std::vector<std::string> kBenchKeys{"bench",    "engine",   "board", "seeds",    "fresh", "size",
                                          "aperture", "firmware", "limit", "negative", "skew"};
const std::vector<std::string> kCommandKeys{"name", "command", "seeds", "fresh", "repeat", "limit", "alone"};

constexpr std::size_t kMostRuns = 1'000'000;
constexpr std::size_t kLongestName = 200;     // of a run: a folder's name has 255 letters, and a hash may come behind
constexpr std::int64_t kMostSeeds = 100'000;  // of a row
constexpr std::uint64_t kLargestFreshSeed = 1'000'000'000;
constexpr std::uint64_t kLargestUsualSeed = 30;  // those of the test suite and of people: none of them is fresh
constexpr double kUsualLimit = 600, kLongestLimit = 7 * 86400.0;

constexpr const char* kSeedsText = "seeds: 1, [1, 2, 7] or \"1-50\", up to 100000 of them";
constexpr const char* kLimitText = "a time of the wall in quotes up to a week, for example \"120s\"";

// One text, or a list of them; `otherwise` where the key is missing.
std::vector<std::string> one_or_more(const TomlTable& row, const std::string& key, const std::string& otherwise) {
  if (!row.has(key)) return {otherwise};
  if (!row.need(key).is_array()) return {row.text(key)};
  std::vector<std::string> texts = row.texts(key);
  if (texts.empty()) row.fail(row.need(key), key, "one or more");
  return texts;
}

constexpr const char* kSkewText = "true, false or [false, true]";

std::vector<bool> skews_of(const TomlTable& row) {
  if (!row.has("skew")) return {false};
  const toml::node& node = row.need("skew");
  if (!node.is_array()) return {row.flag("skew")};
  std::vector<bool> skews;
  for (const toml::node& item : *node.as_array()) {
    const auto skew = item.value_exact<bool>();
    if (!skew) row.fail(item, "skew", kSkewText);
    skews.push_back(*skew);
  }
  if (skews.empty()) row.fail(node, "skew", kSkewText);
  return skews;
}

void add_seeds(const TomlTable& row, const toml::node& node, std::vector<std::uint64_t>& seeds) {
  if (const auto one = node.value_exact<std::int64_t>(); one && *one >= 0) {
    seeds.push_back(static_cast<std::uint64_t>(*one));
    return;
  }
  const auto text = node.value_exact<std::string>();
  const std::size_t dash = text ? text->find('-') : std::string::npos;
  if (dash == std::string::npos) row.fail(node, "seeds", kSeedsText);
  std::uint64_t first = 0, last = 0;
  try {
    first = parse_count("seeds", text->substr(0, dash));
    last = parse_count("seeds", text->substr(dash + 1));
  } catch (const UsageError&) { row.fail(node, "seeds", kSeedsText); }
  if (last < first || last - first >= kMostSeeds) row.fail(node, "seeds", kSeedsText);
  for (std::uint64_t behind = 0; behind <= last - first; ++behind) seeds.push_back(first + behind);
}

std::vector<std::uint64_t> seeds_of(const TomlTable& row, std::mt19937_64& draw) {
  std::vector<std::uint64_t> seeds;
  if (row.has("seeds")) {
    const toml::node& node = row.need("seeds");
    if (const toml::array* list = node.as_array())
      for (const toml::node& item : *list) add_seeds(row, item, seeds);
    else
      add_seeds(row, node, seeds);
    if (seeds.empty() || seeds.size() > kMostSeeds) row.fail(node, "seeds", kSeedsText);
  }
  if (row.has("fresh")) {
    const auto count =
        row.integer("fresh", 1, kMostSeeds, fmt::format("how many seeds nobody has used, 1 to {}", kMostSeeds));
    std::uniform_int_distribution<std::uint64_t> any(kLargestUsualSeed + 1, kLargestFreshSeed);
    for (std::int64_t i = 0; i < count; ++i) seeds.push_back(any(draw));
  }
  if (seeds.empty()) seeds.push_back(1);
  std::set<std::uint64_t> known;
  seeds.erase(std::remove_if(seeds.begin(), seeds.end(), [&](std::uint64_t s) { return !known.insert(s).second; }),
              seeds.end());
  return seeds;
}

double limit_of(const TomlTable& row) {
  if (!row.has("limit")) return kUsualLimit;
  double seconds = 0;
  try {
    seconds = static_cast<double>(parse_time(row.text("limit"))) * 1e-15;
  } catch (const UsageError&) {}
  if (!(seconds >= 0.001 && seconds <= kLongestLimit)) row.fail(row.need("limit"), "limit", kLimitText);
  return seconds;
}

bool is_board_file(const std::string& name) { return fs::path(name).extension() == ".toml"; }

bool is_pattern(const std::string& name) { return name.find_first_of("*?[") != std::string::npos; }

std::vector<const Bench*> named(const TomlTable& row, const std::vector<Bench>& benches, const std::string& name) {
  std::vector<const Bench*> found;
  for (const Bench& bench : benches)
    if (fnmatch(name.c_str(), bench.name.c_str(), 0) == 0) found.push_back(&bench);
  if (found.empty()) {
    std::vector<std::string> names;
    for (const Bench& bench : benches) names.push_back(bench.name);
    row.fail(row.need("bench"), "bench", fmt::format("one of {}, or a pattern such as \"*\"", fmt::join(names, ", ")));
  }
  return found;
}

// What may stand in the name of a folder.
std::string folder_text(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::string("._-").find(c) == std::string::npos) c = '_';
  return text;
}

class Reader {
 public:
  Reader(const std::string& path, const std::vector<Bench>& benches, std::uint64_t fresh_from)
      : path_(path), benches_(benches), draw_(fresh_from) {}

  Plan read() {
    const toml::table content = parse_toml(read_input_file(path_, "a plan in TOML"), path_);
    const TomlTable top(path_, content, kPlanKeys);
    plan_.title = top.has("title") ? top.text("title") : fs::path(path_).stem().string();
    for (const toml::node& row : top.array("row")) {
      const bool command = row.is_table() && row.as_table()->contains("command");
      const TomlTable table = top.table("row", row, command ? kCommandKeys : kBenchKeys);
      if (command)
        add_command(table);
      else
        add_benches(table);
    }
    if (plan_.runs.empty()) top.fail(top.need("row"), "row", "rows that make one run or more");
    return std::move(plan_);
  }

 private:
  void add(Run run) {
    if (run.name.size() > kLongestName) run.name = run.name.substr(0, kLongestName) + "." + text_hash(run.name);
    const auto other = [&](const auto& at) { return at != names_.end() && plan_.runs[at->second].words != run.words; };
    auto at = names_.find(run.name);
    for (; other(at); at = names_.find(run.name)) run.name += "." + text_hash(command_text(run.words));
    if (at != names_.end()) {  // two rows ask for it
      Run& before = plan_.runs[at->second];
      before.limit_seconds = std::max(before.limit_seconds, run.limit_seconds);
      before.alone = before.alone || run.alone;
      return;
    }
    names_.emplace(run.name, plan_.runs.size());
    if (plan_.runs.size() == kMostRuns)
      throw UsageError(fmt::format("{}: makes more than {} runs; expected fewer", path_, kMostRuns));
    plan_.runs.push_back(std::move(run));
  }

  // A mistake in what the run's options say, with the place of its row.
  MachineConfig checked(const TomlTable& row, const RunOptions& options) const {
    try {
      return machine_config(options);
    } catch (const UsageError& e) {
      throw UsageError(fmt::format("{}:{}: {}", path_, TomlTable::line(row.entries()), e.what()));
    }
  }

  void add_benches(const TomlTable& row) {
    const std::vector<std::uint64_t> seeds = seeds_of(row, draw_);
    const double limit = limit_of(row);
    row.need("bench");
    for (const std::string& name : one_or_more(row, "bench", ""))
      for (const Bench* bench : named(row, benches_, name))
        for (const std::string& board : one_or_more(row, "board", bench->board))
          for (const std::string& aperture : one_or_more(row, "aperture", ""))
            for (const bool skew : skews_of(row))
              for (const std::string& firmware : one_or_more(row, "firmware", ""))
                for (const std::string& engine : one_or_more(row, "engine", "systemc"))
                  add_seeds_of(row, *bench, is_pattern(name), {engine, board, aperture, firmware, skew}, seeds, limit);
  }

  struct Choice {
    std::string engine, board, aperture, firmware;
    bool skew;
  };

  void add_seeds_of(const TomlTable& row, const Bench& bench, bool by_pattern, const Choice& choice,
                    const std::vector<std::uint64_t>& seeds, double limit) {
    RunOptions options;
    options.engine = choice.engine;
    options.board = is_board_file(choice.board) ? file_path(choice.board) : choice.board;
    if (!choice.aperture.empty()) options.aperture = choice.aperture;
    options.skew = choice.skew;
    options.firmware = choice.firmware.empty() ? "" : file_path(choice.firmware);
    const MachineConfig config = checked(row, options);
    if (!bench.need.met(config.board)) {
      if (by_pattern) return;
      row.fail(row.need("bench"), "bench",
               fmt::format("a board such as {} for {}: it needs {}", bench.board, bench.name, bench.need.what));
    }
    const bool sized = row.has("size") && (bench.least_size != 0 || !by_pattern);
    if (sized && bench.least_size == 0)
      row.fail(row.need("size"), "size", fmt::format("no size: {} has an end of its own", bench.name));
    Run run;
    run.group = bench.name;
    run.engine = choice.engine;
    run.limit_seconds = limit;
    constexpr std::size_t kEngineWord = 4;
    std::vector<std::string> words{"brick", "run", bench.name, "--engine", choice.engine, "--board", options.board};
    std::string others = config.board.name;
    const auto also = [&](const std::string& option, const std::string& value, const std::string& shown) {
      words.insert(words.end(), {option, value});
      others += fmt::format(" {} {}", option.substr(2), shown);
    };
    if (!choice.aperture.empty()) also("--aperture", choice.aperture, choice.aperture);
    if (!choice.firmware.empty()) also("--firmware", options.firmware, fs::path(choice.firmware).filename().string());
    if (sized) {
      const std::string size =
          std::to_string(row.integer("size", static_cast<std::int64_t>(bench.least_size), INT64_MAX,
                                     fmt::format("{} or more for {}", bench.least_size, bench.name)));
      also("--size", size, size);
    }
    for (const auto& [given, flag] : {std::pair(choice.skew, "skew"), std::pair(row.flag("negative"), "negative")})
      if (given) {
        words.push_back(fmt::format("--{}", flag));
        others += fmt::format(" {}", flag);
      }
    run.column = fmt::format("{} {}", choice.engine, others);
    for (const std::uint64_t seed : seeds) {
      run.seed = seed;
      run.words = words;
      run.words.insert(run.words.end(), {"--seed", std::to_string(seed)});
      std::vector<std::string> same = run.words;
      same[kEngineWord] = "";
      run.choice = command_text(same);
      run.name = folder_text(fmt::format("{}.{}.seed-{}", bench.name, run.column, seed));
      add(run);
    }
  }

  // A file beside the plan, or where the caller stands.
  std::string file_path(const std::string& file) const {
    const fs::path beside = fs::path(path_).parent_path() / file;
    return fs::absolute(fs::exists(beside) ? beside : fs::path(file)).string();
  }

  void add_command(const TomlTable& row) {
    const std::vector<std::string> words = row.texts("command");
    if (words.empty() || words[0].empty()) row.fail(row.need("command"), "command", "a program and its arguments");
    Run run;
    run.group = row.has("name") ? row.text("name") : fs::path(words[0]).filename().string();
    if (run.group.empty()) row.fail(row.need("name"), "name", "a name");
    run.column = "command";
    run.limit_seconds = limit_of(row);
    run.alone = row.flag("alone");
    const std::int64_t times = row.has("repeat") ? row.integer("repeat", 1, kMostSeeds, "1 to 100000 times") : 1;
    for (const std::uint64_t seed : seeds_of(row, draw_))
      for (std::int64_t time = 1; time <= times; ++time) {
        run.seed = seed;
        run.words = words;
        for (std::string& word : run.words) {
          replace(word, "{seed}", std::to_string(seed));
          replace(word, "{plan}", fs::absolute(fs::path(path_)).parent_path().string());
        }
        run.choice = run.group;
        run.name = folder_text(fmt::format("{}.seed-{}", run.group, seed));
        if (times > 1) run.name += fmt::format(".time-{}", time);
        add(run);
      }
  }

  static void replace(std::string& text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
      text.replace(at, what.size(), by);
  }

  const std::string path_;
  const std::vector<Bench>& benches_;
  std::mt19937_64 draw_;
  std::map<std::string, std::size_t> names_;
  Plan plan_;
};

}  // namespace

Plan read_plan(const std::string& path, const std::vector<Bench>& benches, std::uint64_t fresh_from) {
  return Reader(path, benches, fresh_from).read();
}

}  // namespace brick::regress
