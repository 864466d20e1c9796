#include "app/regress/slurm.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "app/regress/result.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPatience{200};
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

std::string job_file(const std::string& folder) { return folder + "/slurm/job.txt"; }

// A cluster that does not answer now has not lost the job.
bool works(const std::string& job) {
  const Said said = ask({"squeue", "--noheader", "--format=%A", "--jobs=" + job});
  return said.good ? !said.text.empty() : said.text.find("Invalid job id") == std::string::npos;
}

void end_job(const std::string& job) {
  if (!ask({"scancel", job}).good) return;
  while (works(job)) std::this_thread::sleep_for(kPatience);
}

}  // namespace

void Cluster::submit(const std::vector<Task>& tasks, double longest) {
  const std::string name = fmt::format("{}/slurm/{}", folder_, ++arrays_);
  fs::create_directories(folder_ + "/slurm");
  for (std::size_t t = 0; t < tasks.size(); ++t) write_task(tasks[t], fmt::format("{}-{}.json", name, t));
  const Said said =
      ask({"sbatch", "--parsable", "--job-name=brick-regress", "--ntasks=1", "--cpus-per-task=1",
           fmt::format("--array=0-{}{}", tasks.size() - 1, at_once_ == 0 ? "" : fmt::format("%{}", at_once_)),
           fmt::format("--time={}", std::ceil((longest + kSpareSeconds) / 60)), fmt::format("--output={}-%a.txt", name),
           fmt::format("--wrap=exec {} \"{}-$SLURM_ARRAY_TASK_ID.json\"",
                       command_text({this_executable(), "regress", "--task"}), name)});
  const std::size_t digits = said.text.find_first_not_of("0123456789");
  if (!said.good || digits == 0)
    throw UsageError(
        fmt::format("sbatch: {}; expected a cluster that takes job arrays", said.text.substr(0, said.text.find('\n'))));
  job_ = said.text.substr(0, digits);
  std::ofstream(job_file(folder_)) << job_ << '\n';
}

bool Cluster::working() const { return !job_.empty() && works(job_); }

void Cluster::cancel() {
  if (job_.empty()) return;
  end_job(job_);
  job_.clear();
  std::error_code ignored;
  fs::remove(job_file(folder_), ignored);
}

void Cluster::cancel_left_over(const std::string& folder) {
  std::string job;
  if (!(std::ifstream(job_file(folder)) >> job)) return;
  end_job(job);
  std::error_code ignored;
  fs::remove_all(folder + "/slurm", ignored);
}

}  // namespace brick::regress
