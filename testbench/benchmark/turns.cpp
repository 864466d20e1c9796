#include "testbench/benchmark/turns.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "testbench/benchmark/measure.h"

namespace brick {
namespace {

constexpr double kGoal = 20;  // percent
constexpr int kTurns = 20;
constexpr double kTurnSeconds = 0.05;

class Run {
 public:
  explicit Run(const std::function<void()>& run) {
    if (pipe(go_) != 0 || pipe(spent_) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ != 0) {
      close(go_[0]), close(spent_[1]);
      return;
    }
    close(go_[1]), close(spent_[0]);
    here_ = this;
    run();
  }
  ~Run() {
    close(go_[1]), close(spent_[0]);
    waitpid(child_, nullptr, 0);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  double turn() {  // seconds of processor time a tick
    const char go = 0;
    double spent = 0;
    if (write(go_[1], &go, 1) != 1 || read(spent_[0], &spent, sizeof spent) != sizeof spent)
      throw std::runtime_error("a run has failed");
    return spent;
  }

  static Run* here() { return here_; }
  bool wait_for_turn() {
    char go;
    return read(go_[0], &go, 1) == 1;
  }
  bool answer(double spent) { return write(spent_[1], &spent, sizeof spent) == sizeof spent; }

 private:
  static inline Run* here_ = nullptr;  // in its process
  int go_[2], spent_[2];
  pid_t child_;
};

}  // namespace

void take_turns(const std::function<void(Tick)>& run_until) {
  constexpr Tick kSlice = 100'000;
  Tick end = 10 * kSlice;
  run_until(end);
  while (Run::here()->wait_for_turn()) {
    const Tick begin = end;
    double spent = 0;
    while (spent < kTurnSeconds) spent += seconds([&] { run_until(end += kSlice); });
    if (!Run::here()->answer(spent / static_cast<double>(end - begin))) break;
  }
  _exit(0);
}

void measure(const Row& r) {
  Run faces(r.face), shells(r.shell);
  std::optional<Run> kernels;
  if (r.kernel) kernels.emplace(r.kernel);
  std::vector<double> face_rate, shell_rate, more, change, kernel_change;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> face_turns, kernel_turns, shell_turns;  // seconds a tick
    for (int turn = 0; turn < kTurns; ++turn) {
      face_turns.push_back(faces.turn());
      if (kernels) kernel_turns.push_back(kernels->turn());
      shell_turns.push_back(shells.turn());
    }
    const double face = median(face_turns), shell = median(shell_turns);
    face_rate.push_back(1e-6 / face);
    shell_rate.push_back(1e-6 / shell);
    more.push_back((shell - face) / face * 100);
    change.push_back((shell - face) * 1e9 / r.changes_a_tick);
    if (kernels) kernel_change.push_back(median(kernel_turns) * 1e9 / r.changes_a_tick);
  }
  const auto all = [](const std::vector<double>& v, int digits) {
    const auto [least, most] = std::minmax_element(v.begin(), v.end());
    return fmt::format("{:.{}f} ({:.{}f}..{:.{}f})", median(v), digits, *least, digits, *most, digits);
  };
  row(r.name,
      fmt::format("{:>22} M ticks/s, face {:>25}: {:>15} %; a change {:>18} ns, the kernel {:>15}", all(shell_rate, 1),
                  all(face_rate, 1), all(more, 0), all(change, 0), kernels ? all(kernel_change, 0) : "-"),
      r.judged ? fmt::format("<= {:.0f} %", kGoal) : "", median(more) <= kGoal);
}

}  // namespace brick
