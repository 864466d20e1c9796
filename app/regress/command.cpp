#include "app/regress/command.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "app/byte_text.h"
#include "app/options.h"
#include "app/paths.h"
#include "app/regress/covers.h"
#include "app/regress/folder_lock.h"
#include "app/regress/inputs.h"
#include "app/regress/picture.h"
#include "app/regress/plan.h"
#include "app/regress/pool.h"
#include "app/regress/report.h"
#include "app/regress/result.h"
#include "app/regress/slurm.h"
#include "app/regress/task.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

using namespace regress;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kReplayedMs = 1.0;  // of waveform before the step that failed
constexpr std::size_t kMostReplays = 20;
constexpr const char* kUsualView = "smoke";  // of a bench that has none of its own
constexpr std::chrono::milliseconds kPatience{200}, kMostPatience{5000};
constexpr double kUnknownOfTask = 4;  // so many runs whose length nobody knows fill a task

volatile std::sig_atomic_t asked_to_stop = 0;
void stop_when_asked() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, [](int which) { asked_to_stop = which; }) == SIG_IGN)  // as of nohup
      std::signal(signal, SIG_IGN);
}

class Regression {
 public:
  Regression(const Plan& plan, const RegressOptions& options, std::string folder, std::uint64_t fresh_from)
      : plan_(plan),
        options_(options),
        folder_(std::move(folder)),
        fresh_from_(fresh_from),
        results_(plan.runs.size()),
        build_(build_info()),
        terminal_(isatty(STDERR_FILENO) == 1) {
    build_["image"] = file_hash(default_firmware());
    build_["executable"] = file_hash("/proc/self/exe");
    for (const Run& run : plan_.runs) inputs_.of(run);  // before any runs: what changes meanwhile is not what they had
  }

  int run() {
    take_over();
    stop_when_asked();
    if (options_.slurm)
      make_on_cluster();
    else
      make();
    clear_line();
    buckets_ = buckets_of(plan_.runs, results_);
    if (!options_.no_replay && asked_to_stop == 0) replay();
    const Coverage coverage(plan_.runs, results_, [this](const Run& run) { return folder_of(run); });
    const Report report{plan_,
                        results_,
                        buckets_,
                        replays_,
                        build_of_all(),
                        coverage,
                        options_.rank ? coverage.rank() : std::vector<Ranked>{},
                        fresh_from_,
                        seconds()};
    write_reports(report, folder_);
    return tell(report);
  }

 private:
  static std::string firmware_of(const Run& run) {
    const auto at = std::find(run.words.begin(), run.words.end(), "--firmware");
    return run.bench() && at != run.words.end() ? *(at + 1) : "";
  }

  // With the image of this run, and what else it depends on.
  nlohmann::json build_of(const Run& run) {
    nlohmann::json build = build_;
    build["files"] = inputs_.of(run);
    build["image"] = image_of(run, build["files"]);
    return build;
  }

  std::string image_of(const Run& run, const nlohmann::json& files) const {
    const std::string file = firmware_of(run);
    return file.empty() ? build_.at("image").get<std::string>() : files.value(utf8_text(file), "");
  }

  // With the images of all benches.
  nlohmann::json build_of_all() {
    std::set<std::string> images;
    for (const Run& run : plan_.runs)
      if (run.bench()) images.insert(image_of(run, inputs_.of(run)));
    nlohmann::json build = build_;
    if (!images.empty()) build["image"] = fmt::format("{}", fmt::join(images, ", "));
    return build;
  }

  std::string folder_of(const Run& run) const { return folder_ + "/runs/" + run.name; }

  void take_over() {
    if (!options_.resume && !options_.rerun_failed) return;
    for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
      results_[i] = kept(plan_.runs[i], build_of(plan_.runs[i]), folder_of(plan_.runs[i]));
      if (results_[i] && options_.rerun_failed && !results_[i]->passed()) results_[i].reset();
      taken_over_ += results_[i].has_value() ? 1u : 0u;
    }
  }

  void make() {
    const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
    Pool pool(options_.jobs != 0 ? options_.jobs : processors);
    std::size_t next = 0;
    bool alone = false;  // what runs
    done_ = taken_over_;
    while (asked_to_stop == 0) {
      while (!pool.full() && next < plan_.runs.size() && !late()) {
        const Run& run = plan_.runs[next];
        if (!results_[next]) {
          if (!pool.empty() && (alone || run.alone)) break;
          begin(pool, next, run, folder_of(run));
          alone = run.alone;
        }
        ++next;
      }
      if (pool.empty()) break;
      show(fmt::format("{} running", pool.size()));
      if (const auto ended = pool.wait(kPatience)) take(*ended);
    }
  }

  void take(const Ended& ended) {
    const Run& run = plan_.runs[ended.id];
    const Result result = judge(run, ended, folder_of(run));
    keep(run, result, build_of(run), folder_of(run));
    take(ended.id, result);
  }

  void take(std::size_t number, const Result& result) {
    const Run& run = plan_.runs[number];
    results_[number] = result;
    ++done_;
    if (result.passed()) return;
    failed_ += result.skipped() ? 0u : 1u;
    clear_line();
    std::cout << fmt::format("{}: {}{}\n     {}\n", result.skipped() ? "SKIP" : "FAIL " + result.verdict,
                             result.step.empty() ? "" : result.step + ": ", result.says, command_text(run.words))
              << std::flush;
  }

  // In arrays of tasks, each as long as asked for, until nothing is left that no task has begun. How long a run takes
  // is known from those of its kind; a task that was wrong about it leaves runs for the next array. What has begun and
  // left no result was lost with its task and is not begun again: it may be what the machine died of. What runs alone
  // comes last, one task an array.
  void make_on_cluster() {
    done_ = taken_over_;
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < plan_.runs.size(); ++i)
      if (!results_[i]) {
        fs::remove_all(folder_of(plan_.runs[i]));
        waiting.push_back(i);
      }
    Cluster cluster(fs::absolute(folder_).string(), options_.jobs);
    while (!waiting.empty() && asked_to_stop == 0 && !late() && cluster.answers()) {
      const std::size_t before = waiting.size();
      double longest = 0;
      for (const std::size_t i : waiting) longest = std::max(longest, plan_.runs[i].limit_seconds);
      cluster.submit(tasks_of(waiting), options_.task_seconds + longest);
      std::chrono::milliseconds patience = kPatience;
      bool working = true;
      while (working && !waiting.empty() && asked_to_stop == 0) {
        std::this_thread::sleep_for(patience);
        working = cluster.working();  // before the results: what ends between them counts
        patience = collect(waiting) ? kPatience : std::min(2 * patience, kMostPatience);
        show(fmt::format("{} on the cluster", waiting.size()));
      }
      if (working) cluster.cancel();
      collect(waiting);  // what has ended until then
      waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                                   [this](std::size_t i) { return fs::exists(folder_of(plan_.runs[i])); }),
                    waiting.end());
      if (waiting.size() == before) break;  // tasks that begin nothing
    }
  }

  std::vector<Task> tasks_of(const std::vector<std::size_t>& waiting) {
    std::map<std::string, std::pair<double, double>> seconds;  // sum and count of each kind
    const auto kind = [](const Run& run) { return run.group + "\n" + run.column; };
    for (std::size_t i = 0; i < plan_.runs.size(); ++i)
      if (results_[i]) {
        auto& [sum, count] = seconds[kind(plan_.runs[i])];
        sum += results_[i]->wall_seconds;
        count += 1;
      }
    std::vector<Task> tasks;
    double length = options_.task_seconds;
    const bool alone =
        std::all_of(waiting.begin(), waiting.end(), [this](std::size_t i) { return plan_.runs[i].alone; });
    for (const std::size_t i : waiting) {
      if (plan_.runs[i].alone != alone) continue;
      if (length >= options_.task_seconds) {
        if (tasks.size() == (alone ? 1 : Cluster::kMostTasks)) break;
        tasks.push_back({{}, options_.task_seconds, until()});
        length = 0;
      }
      const Run& run = plan_.runs[i];
      const auto known = seconds.find(kind(run));
      length +=
          known == seconds.end() ? options_.task_seconds / kUnknownOfTask : known->second.first / known->second.second;
      tasks.back().parts.push_back({run, fs::absolute(folder_of(run)).string(), build_of(run)});
    }
    return tasks;
  }

  // Takes what has a result now from those that wait; whether there was any.
  bool collect(std::vector<std::size_t>& waiting) {
    const std::size_t before = waiting.size();
    waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                                 [this](std::size_t i) {
                                   const Run& run = plan_.runs[i];
                                   const std::optional<Result> result = kept(run, build_of(run), folder_of(run));
                                   if (!result) return false;
                                   take(i, *result);
                                   return true;
                                 }),
                  waiting.end());
    return waiting.size() != before;
  }

  // Those of an earlier call, which would pass for one of a run that leaves no waveform.
  void remove_replays() const {
    std::error_code failed;
    for (std::size_t b = 1; b <= kMostReplays; ++b) fs::remove_all(fmt::format("{}/bucket-{}", folder_, b), failed);
  }

  // The first run of each kind again, with the last millisecond before the failure as a waveform and the view of its
  // bench beside it.
  void replay() {
    remove_replays();
    replays_.resize(buckets_.size());
    Pool pool(1);
    for (std::size_t b = 0; b < std::min(buckets_.size(), kMostReplays) && asked_to_stop == 0; ++b) {
      const Bucket& bucket = buckets_[b];
      const Run& run = plan_.runs[bucket.runs[0]];
      const Result& result = *results_[bucket.runs[0]];
      if (!run.bench() || result.verdict != "failed" || result.step.empty()) continue;
      const std::string name = fmt::format("bucket-{}", b + 1), beside = folder_ + "/" + name;
      fs::create_directories(beside);
      std::vector<std::string> words = run.words;
      words.insert(words.end(), {"--wave", name + ".fst", "--wave-from",
                                 fmt::format("{:.0f}us", std::max(0.0, result.at_ms - kReplayedMs) * 1e3), "--wave-to",
                                 fmt::format("{:.0f}us", result.at_ms * 1e3 + 1.0)});
      replays_[b].command = command_text(words);
      words.insert(words.end(), {"--json", "run.json"});
      words[0] = this_executable();
      pool.start(0, words, beside, run.limit_seconds);
      std::optional<Ended> ended;
      while (!ended && asked_to_stop == 0) ended = pool.wait(kPatience);
      if (!ended) return;
      const Result again = judge(run, *ended, beside);
      if (again.step != result.step)
        replays_[b].note = "the run that was to be replayed " +
                           (again.passed()       ? "passed this time"
                            : again.step.empty() ? fmt::format("ended otherwise: {}: {}", again.verdict, again.says)
                                                 : fmt::format("failed elsewhere: {}", again.step));
      if (fs::exists(beside + "/" + name + ".fst")) replays_[b].wave = name + "/" + name + ".fst";
      const std::string own = view_path(run.group), view = own.empty() ? view_path(kUsualView) : own;
      if (view.empty()) continue;
      fs::copy_file(view, beside + "/" + name + ".gtkw", fs::copy_options::overwrite_existing);
      replays_[b].view = name + "/" + name + ".gtkw";
      if (!replays_[b].wave.empty())
        replays_[b].picture = picture_of(folder_ + "/" + replays_[b].wave, view, result.at_ms);
    }
  }

  void show(const std::string& others) {
    if (!terminal_) return;
    const double left = done_ > taken_over_ ? seconds() / static_cast<double>(done_ - taken_over_) *
                                                  static_cast<double>(plan_.runs.size() - done_)
                                            : 0;
    std::cerr << fmt::format("\r\033[K{}/{} runs, {} failed, {}, {:.0f} s, {:.0f} s left", done_, plan_.runs.size(),
                             failed_, others, seconds(), left)
              << std::flush;
    line_shown_ = true;
  }

  void clear_line() {
    if (line_shown_) std::cerr << "\r\033[K" << std::flush;
    line_shown_ = false;
  }

  int tell(const Report& report) const {
    const nlohmann::json content = report_json(report);
    const nlohmann::json& counts = content.at("counts");
    for (std::size_t b = 0; b < buckets_.size(); ++b) {
      const Bucket& bucket = buckets_[b];
      std::cout << fmt::format("{} x {}: {}{}{}\n", bucket.runs.size(), readable_text(bucket.group), bucket.verdict,
                               bucket.step.empty() ? "" : ", " + readable_text(bucket.step),
                               bucket.says.empty() ? "" : ": " + bucket.says);
      if (b < replays_.size() && !replays_[b].wave.empty())
        std::cout << fmt::format("    gtkwave {}/{}{}\n", folder_, replays_[b].wave,
                                 replays_[b].view.empty() ? "" : " " + folder_ + "/" + replays_[b].view);
    }
    for (const Ranked& r : report.ranked)
      std::cout << fmt::format("{:8.1f} new, {} covers: {}\n", r.adds, r.reached,
                               command_text(plan_.runs[r.run].words));
    tell(report.coverage);
    const auto missing = counts.at("not_run").get<std::size_t>(), skipped = counts.at("skipped").get<std::size_t>();
    const bool passed = content.at("verdict") == "passed";
    std::cout << fmt::format("{} {}: {} runs, {} failed", passed ? "PASS" : "FAIL", readable_text(plan_.title),
                             plan_.runs.size(), counts.at("failed").get<std::size_t>());
    if (skipped != 0) std::cout << fmt::format(", {} skipped", skipped);
    if (missing != 0) std::cout << fmt::format(", {} not run: --resume makes them", missing);
    if (skipped == plan_.runs.size()) std::cout << ", none passed";
    if (taken_over_ != 0) std::cout << fmt::format(", {} taken over", taken_over_);
    std::cout << fmt::format("; {:.1f} s\n{}/report.html\n", seconds(), folder_);
    return passed ? 0 : 1;
  }

  static void tell(const Coverage& coverage) {
    std::size_t reached = 0;
    for (const auto& [name, cover] : coverage.merged()) {
      reached += cover.reached() ? 1u : 0u;
      for (const auto& [engine, count] : cover.counts)
        if (count < cover.least)
          std::cout << fmt::format("cover {} on {}: {}, expected {} or more\n", name, engine, count, cover.least);
    }
    if (!coverage.merged().empty()) std::cout << fmt::format("{} of {} covers\n", reached, coverage.merged().size());
  }

  bool late() const { return options_.minutes && seconds() >= 60 * *options_.minutes; }

  // Second of the clock after which nothing begins.
  std::int64_t until() const {
    if (!options_.minutes) return std::numeric_limits<std::int64_t>::max();
    return std::time(nullptr) + static_cast<std::int64_t>(60 * *options_.minutes - seconds());
  }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  const Plan& plan_;
  const RegressOptions& options_;
  const std::string folder_;
  const std::uint64_t fresh_from_;
  std::vector<std::optional<Result>> results_;
  nlohmann::json build_;
  Inputs inputs_;
  std::vector<Bucket> buckets_;
  std::vector<Replay> replays_;
  const Clock::time_point begin_ = Clock::now();
  std::size_t done_ = 0, failed_ = 0, taken_over_ = 0;
  const bool terminal_;
  bool line_shown_ = false;
};

// Seeds nobody has used are the same again when results are gone on with.
std::uint64_t origin_of_seeds(const RegressOptions& options, const std::string& folder) {
  if (options.fresh_from) return parse_count("--fresh-from", *options.fresh_from);
  std::uint64_t before = 0;
  if ((options.resume || options.rerun_failed) && std::ifstream(folder + "/fresh_from.txt") >> before) return before;
  return static_cast<std::uint64_t>(std::time(nullptr));
}

bool has_runs(const std::string& folder) {
  std::error_code failed;
  const bool used = fs::exists(folder + "/runs", failed), ours = fs::exists(folder + "/fresh_from.txt", failed);
  if (used && !ours)
    throw UsageError(fmt::format("--output {}: has a folder `runs` of somebody else; expected another folder", folder));
  return used;
}

void prepare(const RegressOptions& options, const std::string& folder, std::uint64_t fresh_from) {
  std::error_code failed;
  if (has_runs(folder) && !options.resume && !options.rerun_failed) fs::remove_all(folder + "/runs", failed);
  fs::create_directories(folder + "/runs", failed);
  std::ofstream note(folder + "/fresh_from.txt");
  note << fresh_from << '\n';
  note.close();
  if (failed || !note)
    throw UsageError(fmt::format("--output {}: cannot be written; expected a folder with room for results", folder));
}

}  // namespace

int regress_command(const std::vector<Bench>& benches, const RegressOptions& options) {
  if (options.task) return task_command(options.plan);
  const std::string folder = options.output.empty() ? "waves/out/regress/" + fs::path(options.plan).stem().string()
                                                    : fs::path(options.output).lexically_normal().string();
  const std::uint64_t fresh_from = origin_of_seeds(options, folder);
  const Plan plan = read_plan(options.plan, benches, fresh_from);
  if (options.list) {
    for (const Run& run : plan.runs) std::cout << command_text(run.words) << '\n';
    return 0;
  }
  has_runs(folder);  // of somebody else: nothing is made there
  const FolderLock lock(folder);
  Cluster::cancel_left_over(folder);
  prepare(options, folder, fresh_from);
  return Regression(plan, options, folder, fresh_from).run();
}

}  // namespace brick
