#include "app/simulation_loop.h"

#include <algorithm>
#include <utility>

namespace brick {

namespace {
constexpr Tick kPiece = ns_to_ticks(500'000);          // between two looks at what others have posted
constexpr std::chrono::milliseconds kLongestSleep{5};  // and at the signals
}  // namespace

void SimulationLoop::post(std::function<void()> work) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    work_.push_back(std::move(work));
  }
  posted_.notify_one();
}

void SimulationLoop::work() {
  std::vector<std::function<void()>> work;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    work.swap(work_);
  }
  for (const auto& one : work) one();
}

void SimulationLoop::sleep_until(Pacing::Clock::time_point time) {
  std::unique_lock<std::mutex> lock(mutex_);
  posted_.wait_until(lock, std::min(time, Pacing::Clock::now() + kLongestSleep), [this] { return !work_.empty(); });
  lock.unlock();
  bus_.heartbeat();
}

void SimulationLoop::run(const std::function<bool()>& busy, const std::function<void(Tick)>& run_until) {
  const Tick lead = ns_to_ticks(std::chrono::nanoseconds(Pacing::kLead).count());
  const Tick nap = ns_to_ticks(std::chrono::nanoseconds(kLongestSleep).count());
  Pacing pacing(bus_.now());
  Tick goal = bus_.now();  // of time that passes while nobody waits, in steps of a nap
  for (;;) {
    work();
    if (on_turn) on_turn();
    const Tick now = bus_.now(), due = free_ ? now : pacing.due(now);
    if (due >= now + nap) goal = due;
    const Tick limit = !busy() ? goal : free_ ? kNever : due + lead;
    if (now < limit) {
      if (on_speed) on_speed(free_ ? 1 : pacing.speed());
      const Pacing::Clock::time_point begin = Pacing::Clock::now();
      run_until(std::min(limit, now + kPiece));
      pacing.ran(bus_.now() - now, Pacing::Clock::now() - begin);
    } else
      sleep_until(pacing.when(busy() ? now + 1 - lead : now + nap));
  }
}

}  // namespace brick
