#include "app/regress/slurm.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/regress/result.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause{200};
constexpr std::chrono::seconds kLongestEnd{60};       // of a job that was cancelled
constexpr std::chrono::seconds kLongestSilence{300};  // a controller that starts anew is back before
constexpr const char* kName = "brick-regress";
constexpr double kSpareSeconds = 60;  // of a task's limit, for a slow start

struct Said {
  std::string text;
  bool good = false;
};

Said ask(const std::vector<std::string>& words) {
  FILE* program = popen((command_text(words) + " 2>&1").c_str(), "r");
  if (program == nullptr) return {};
  Said said;
  for (int c = 0; (c = std::fgetc(program)) != EOF;) said.text += static_cast<char>(c);
  said.good = pclose(program) == 0;
  return said;
}

std::string as_pattern(const std::string& name) {  // of a file, for --output
  std::string pattern;
  for (const char c : name) pattern += c == '%' ? "%%" : std::string(1, c);
  return pattern;
}

std::string job_file(const std::string& folder) { return folder + "/slurm/job.txt"; }

bool unknown(const Said& said) { return !said.good && said.text.find("Invalid job id") != std::string::npos; }

// Whether something of it waits or runs; nothing: the cluster does not answer.
std::optional<bool> works(const std::string& job) {
  const Said said = ask({"squeue", "--noheader", "--format=%A", std::string("--name=") + kName, "--jobs=" + job});
  if (!said.good && !unknown(said)) return std::nullopt;
  return said.good && !said.text.empty();
}

// Throws UsageError when it may go on. By name too: a cluster that was set up anew gives the number to somebody else.
void end_job(const std::string& job) {
  const Said said = ask({"scancel", std::string("--name=") + kName, job});
  if (!said.good && !unknown(said))
    throw UsageError(fmt::format("scancel: {}; expected a cluster that answers, job {} may still run",
                                 said.text.substr(0, said.text.find('\n')), job));
  const auto end = std::chrono::steady_clock::now() + kLongestEnd;
  while (works(job).value_or(true)) {
    if (std::chrono::steady_clock::now() >= end)
      throw UsageError(
          fmt::format("squeue: job {} was cancelled; expected its end within {} s", job, kLongestEnd.count()));
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

void Cluster::submit(const std::vector<Task>& tasks, double longest) {
  const std::string name = fmt::format("{}/slurm/{}", folder_, ++arrays_);
  fs::create_directories(folder_ + "/slurm");
  for (std::size_t t = 0; t < tasks.size(); ++t) write_task(tasks[t], fmt::format("{}-{}.json", name, t));
  const Said said = ask(
      {"sbatch", "--parsable", std::string("--job-name=") + kName, "--no-requeue", "--ntasks=1", "--cpus-per-task=1",
       fmt::format("--array=0-{}{}", tasks.size() - 1, at_once_ == 0 ? "" : fmt::format("%{}", at_once_)),
       fmt::format("--time={}", std::ceil((longest + kSpareSeconds) / 60)),
       fmt::format("--output={}-%a.txt", as_pattern(name)),
       fmt::format("--wrap=exec {}-$SLURM_ARRAY_TASK_ID.json",
                   command_text({this_executable(), "regress", "--task", name}))});
  const std::size_t digits = said.text.find_first_not_of("0123456789");
  if (!said.good || digits == 0)
    throw UsageError(
        fmt::format("sbatch: {}; expected a cluster that takes job arrays", said.text.substr(0, said.text.find('\n'))));
  job_ = said.text.substr(0, digits);
  std::ofstream(job_file(folder_)) << job_ << '\n';
  heard_ = std::chrono::steady_clock::now();
}

bool Cluster::working() {
  const std::optional<bool> works = regress::works(job_);
  if (works) heard_ = std::chrono::steady_clock::now();
  return works.value_or(answers());
}

bool Cluster::answers() const { return std::chrono::steady_clock::now() - heard_ < kLongestSilence; }

void Cluster::cancel() {
  if (job_.empty()) return;
  try {
    end_job(std::exchange(job_, ""));
    std::error_code ignored;
    fs::remove(job_file(folder_), ignored);
  } catch (const UsageError& left) { std::cerr << "brick regress: " << left.what() << '\n'; }
}

void Cluster::cancel_left_over(const std::string& folder) {
  std::string job;
  if (!(std::ifstream(job_file(folder)) >> job)) return;
  end_job(job);
  std::error_code ignored;
  fs::remove_all(folder + "/slurm", ignored);
}

}  // namespace brick::regress
