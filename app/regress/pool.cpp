#include "app/regress/pool.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

constexpr int kCannotRun = 127;  // as a shell has it

[[noreturn]] void no_process(const char* what) {
  throw UsageError(fmt::format("{}: {}; expected a system with room for one more process, or fewer --jobs", what,
                               std::strerror(errno)));
}

// Only what may be called between fork and exec stands in these two.
[[noreturn]] void become(char* const* words, const char* folder, int output) {
  setpgid(0, 0);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGXFSZ, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  if (chdir(folder) == 0) execvp(words[0], words);
  const char* why = strerrordesc_np(errno);
  const char* const said[] = {words[0], ": cannot be run: ", why, "\n"};
  for (const char* text : said)
    if (write(output, text, std::strlen(text)) < 0) break;
  _exit(kCannotRun);
}

[[noreturn]] void watch(char* const* words, const char* folder, int output, int alive, int told, int limit_ms) {
  setpgid(0, 0);  // the keys of the terminal are for the one who started us
  const pid_t child = fork();
  if (child == 0) become(words, folder, output);
  Ended ended{0, Ended::How::kExit, kCannotRun, 0};
  if (child > 0) {
    setpgid(child, child);
    const int of_child = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
    pollfd both[2] = {{of_child, POLLIN, 0}, {alive, POLLIN, 0}};
    int seen = 0;
    do seen = poll(both, 2, limit_ms);
    while (seen < 0 && errno == EINTR);
    const bool alone = seen > 0 && both[1].revents != 0, late = seen == 0;
    if (alone || late) kill(-child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    kill(-child, SIGKILL);  // what it has left behind
    ended.how = late ? Ended::How::kLimit : WIFSIGNALED(status) ? Ended::How::kSignal : Ended::How::kExit;
    ended.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  }
  if (write(told, &ended, sizeof ended) < 0) _exit(1);
  _exit(0);
}

int milliseconds(double seconds) { return static_cast<int>(std::min(seconds * 1e3, static_cast<double>(INT_MAX))); }

}  // namespace

Pool::Pool(unsigned jobs) : jobs_(jobs) {
  if (pipe2(alive_, O_CLOEXEC) != 0) no_process("pipe");
}

Pool::~Pool() {
  close(alive_[1]);
  for (const Running& r : running_) {
    while (waitpid(r.watcher, nullptr, 0) < 0 && errno == EINTR) {}
    close(r.told);
  }
  close(alive_[0]);
}

void Pool::start(std::size_t id, const std::vector<std::string>& words, const std::string& folder, double limit) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int output = open((folder + "/output.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (output < 0) throw UsageError(fmt::format("{}/output.txt: {}; expected a file", folder, std::strerror(errno)));
  int told[2];
  if (pipe2(told, O_CLOEXEC) != 0) no_process("pipe");
  const pid_t watcher = fork();
  if (watcher == 0) {
    close(alive_[1]);
    close(told[0]);
    watch(arguments.data(), folder.c_str(), output, alive_[0], told[1], milliseconds(limit));
  }
  close(output);
  close(told[1]);
  if (watcher < 0) {
    close(told[0]);
    no_process("fork");
  }
  running_.push_back({id, watcher, told[0], std::chrono::steady_clock::now()});
}

std::optional<Ended> Pool::wait(std::chrono::milliseconds patience) {
  std::vector<pollfd> all;
  for (const Running& r : running_) all.push_back({r.told, POLLIN, 0});
  if (poll(all.data(), all.size(), static_cast<int>(patience.count())) <= 0) return std::nullopt;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].revents == 0) continue;
    const Running r = running_[i];
    Ended ended{0, Ended::How::kSignal, SIGKILL, 0};  // of a watcher that was killed itself
    if (read(r.told, &ended, sizeof ended) < 0) ended.code = SIGKILL;
    while (waitpid(r.watcher, nullptr, 0) < 0 && errno == EINTR) {}
    close(r.told);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    ended.id = r.id;
    ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - r.begin).count();
    return ended;
  }
  return std::nullopt;
}

}  // namespace brick::regress
