#include "app/regress/task.h"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "app/regress/result.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace fs = std::filesystem;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, name, group, column, engine, choice, seed, words, limit_seconds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Task::Part, run, folder, build)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Task, parts, seconds, until)

std::string this_executable() { return fs::read_symlink("/proc/self/exe").string(); }

void begin(Pool& pool, std::size_t id, const Run& run, const std::string& folder) {
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
  pool.start(id, words, folder, run.limit_seconds);
}

void write_task(const Task& task, const std::string& file) {
  std::ofstream out(file);
  out << nlohmann::json(task);
  out.close();
  if (!out) throw UsageError(fmt::format("{}: cannot be written; expected room for tasks", file));
}

int task_command(const std::string& file) {
  constexpr std::chrono::milliseconds kPatience{1000};
  // The cluster ends a task process by process, a run perhaps just before us: no verdict comes of that.
  constexpr std::chrono::milliseconds kEndOfTask{300};
  Task task;
  try {
    task = nlohmann::json::parse(read_input_file(file, "a file that `brick regress --slurm` wrote"));
  } catch (const nlohmann::json::exception&) {
    throw UsageError(fmt::format("{}: is no task; expected a file that `brick regress --slurm` wrote", file));
  }
  const auto begun = std::chrono::steady_clock::now();
  Pool pool(1);
  for (const Task::Part& part : task.parts) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (seconds >= task.seconds || std::time(nullptr) >= task.until) break;
    if (kept(part.run, part.build, part.folder)) continue;  // the cluster has begun the task anew
    begin(pool, 0, part.run, part.folder);
    std::optional<Ended> ended;
    while (!ended) ended = pool.wait(kPatience);
    const Result result = judge(part.run, *ended, part.folder);
    if (!result.passed()) std::this_thread::sleep_for(kEndOfTask);
    keep(part.run, result, part.build, part.folder);
  }
  return 0;
}

}  // namespace brick::regress
