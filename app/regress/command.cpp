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
#include <map>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "app/options.h"
#include "app/paths.h"
#include "app/regress/plan.h"
#include "app/regress/pool.h"
#include "app/regress/report.h"
#include "app/regress/result.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

using namespace regress;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kReplayedMs = 1.0;  // of waveform before the step that failed
constexpr std::size_t kMostReplays = 20;
constexpr std::chrono::milliseconds kPatience{200};

volatile std::sig_atomic_t asked_to_stop = 0;
void stop(int signal) { asked_to_stop = signal; }

std::string this_executable() { return fs::read_symlink("/proc/self/exe").string(); }

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
    for (const Run& run : plan_.runs) images_[firmware_of(run)];
    for (auto& [file, hash] : images_)
      if (!file.empty()) hash = file_hash(file);
  }

  int run() {
    take_over();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, stop);
    make();
    clear_line();
    buckets_ = buckets_of(plan_.runs, results_);
    if (!options_.no_replay && asked_to_stop == 0) replay();
    const Report report{plan_, results_, buckets_, replays_, build_, fresh_from_, seconds()};
    write_reports(report, folder_);
    return tell(report);
  }

 private:
  static std::string firmware_of(const Run& run) {
    const auto at = std::find(run.words.begin(), run.words.end(), "--firmware");
    return run.bench() && at != run.words.end() ? *(at + 1) : "";
  }

  // With the image of this run.
  nlohmann::json build_of(const Run& run) const {
    nlohmann::json build = build_;
    if (const std::string file = firmware_of(run); !file.empty()) build["image"] = images_.at(file);
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
    done_ = taken_over_;
    while (asked_to_stop == 0) {
      while (!pool.full() && next < plan_.runs.size() && !late()) {
        if (!results_[next]) start(pool, next);
        ++next;
      }
      if (pool.empty()) break;
      show(pool.size());
      if (const auto ended = pool.wait(kPatience)) take(*ended);
    }
  }

  void start(Pool& pool, std::size_t number) {
    const Run& run = plan_.runs[number];
    const std::string folder = folder_of(run);
    std::error_code failed;
    fs::remove_all(folder, failed);
    fs::create_directories(folder, failed);
    if (failed) throw UsageError(fmt::format("{}: {}; expected room for results", folder, failed.message()));
    std::vector<std::string> words = run.words;
    if (run.bench()) words.insert(words.end(), {"--json", "run.json"});
    if (words[0] == "brick")
      words[0] = this_executable();
    else if (words[0].find('/') != std::string::npos)
      words[0] = fs::absolute(words[0]).string();  // from where the caller is, not the run
    pool.start(number, words, folder, run.limit_seconds);
  }

  void take(const Ended& ended) {
    const Run& run = plan_.runs[ended.id];
    results_[ended.id] = judge(run, ended, folder_of(run));
    const Result& result = *results_[ended.id];
    keep(run, result, build_of(run), folder_of(run));
    ++done_;
    if (result.passed()) return;
    ++failed_;
    clear_line();
    std::cout << fmt::format("FAIL {}: {}{}\n     {}\n", result.verdict, result.step.empty() ? "" : result.step + ": ",
                             result.says, command_text(run.words))
              << std::flush;
  }

  // The first run of each kind again, with the last millisecond before the failure as a waveform and the view of its
  // bench beside it.
  void replay() {
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
                           (again.passed() ? "passed this time" : fmt::format("failed elsewhere: {}", again.step));
      if (fs::exists(beside + "/" + name + ".fst")) replays_[b].wave = name + "/" + name + ".fst";
      if (const std::string view = view_path(run.group); !view.empty()) {
        fs::copy_file(view, beside + "/" + name + ".gtkw", fs::copy_options::overwrite_existing);
        replays_[b].view = name + "/" + name + ".gtkw";
      }
    }
  }

  void show(std::size_t running) {
    if (!terminal_) return;
    const double left = done_ > taken_over_ ? seconds() / static_cast<double>(done_ - taken_over_) *
                                                  static_cast<double>(plan_.runs.size() - done_)
                                            : 0;
    std::cerr << fmt::format("\r\033[K{}/{} runs, {} failed, {} running, {:.0f} s, {:.0f} s left", done_,
                             plan_.runs.size(), failed_, running, seconds(), left)
              << std::flush;
    line_shown_ = true;
  }

  void clear_line() {
    if (line_shown_) std::cerr << "\r\033[K" << std::flush;
    line_shown_ = false;
  }

  int tell(const Report& report) const {
    const nlohmann::json counts = report_json(report).at("counts");
    for (std::size_t b = 0; b < buckets_.size(); ++b) {
      const Bucket& bucket = buckets_[b];
      std::cout << fmt::format("{} x {}: {}{}{}\n", bucket.runs.size(), bucket.group, bucket.verdict,
                               bucket.step.empty() ? "" : ", " + bucket.step,
                               bucket.says.empty() ? "" : ": " + bucket.says);
      if (b < replays_.size() && !replays_[b].wave.empty())
        std::cout << fmt::format("    gtkwave {}/{}{}\n", folder_, replays_[b].wave,
                                 replays_[b].view.empty() ? "" : " " + folder_ + "/" + replays_[b].view);
    }
    const auto missing = counts.at("not_run").get<std::size_t>();
    const bool passed = counts.at("passed").get<std::size_t>() == plan_.runs.size();
    std::cout << fmt::format("{} {}: {} runs, {} failed", passed ? "PASS" : "FAIL", plan_.title, plan_.runs.size(),
                             counts.at("failed").get<std::size_t>());
    if (missing != 0) std::cout << fmt::format(", {} not run: --resume makes them", missing);
    if (taken_over_ != 0) std::cout << fmt::format(", {} taken over", taken_over_);
    std::cout << fmt::format("; {:.1f} s\n{}/report.html\n", seconds(), folder_);
    return passed ? 0 : 1;
  }

  bool late() const { return options_.minutes && seconds() >= 60 * *options_.minutes; }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  const Plan& plan_;
  const RegressOptions& options_;
  const std::string folder_;
  const std::uint64_t fresh_from_;
  std::vector<std::optional<Result>> results_;
  nlohmann::json build_;
  std::map<std::string, std::string> images_;
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

void prepare(const RegressOptions& options, const std::string& folder, std::uint64_t fresh_from) {
  std::error_code failed;
  const bool used = fs::exists(folder + "/runs", failed), ours = fs::exists(folder + "/fresh_from.txt", failed);
  if (used && !ours)
    throw UsageError(fmt::format("--output {}: has a folder `runs` of somebody else; expected another folder", folder));
  if (used && !options.resume && !options.rerun_failed) fs::remove_all(folder + "/runs", failed);
  fs::create_directories(folder + "/runs", failed);
  std::ofstream note(folder + "/fresh_from.txt");
  note << fresh_from << '\n';
  note.close();
  if (failed || !note)
    throw UsageError(fmt::format("--output {}: cannot be written; expected a folder with room for results", folder));
}

}  // namespace

int regress_command(const std::vector<Bench>& benches, const RegressOptions& options) {
  const std::string folder = options.output.empty() ? "waves/out/regress/" + fs::path(options.plan).stem().string()
                                                    : fs::path(options.output).lexically_normal().string();
  const std::uint64_t fresh_from = origin_of_seeds(options, folder);
  const Plan plan = read_plan(options.plan, benches, fresh_from);
  if (options.list) {
    for (const Run& run : plan.runs) std::cout << command_text(run.words) << '\n';
    return 0;
  }
  prepare(options, folder, fresh_from);
  return Regression(plan, options, folder, fresh_from).run();
}

}  // namespace brick
