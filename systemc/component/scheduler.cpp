#include "systemc/component/scheduler.h"

#include <sysc/kernel/sc_dynamic_processes.h>

#include <algorithm>
#include <cmath>

#include "systemc/component/client.h"
#include "systemc/component/error.h"

namespace brick::component {
namespace {
using sc_core::sc_time;
const TimeBase* the_one = nullptr;  // of this simulation

// The end of time: 2.5 hours, which 64 bits of femtoseconds hold.
constexpr TimeFs kLastFs = 9'000'000 * (kFsPerNs * 1'000'000);
constexpr Tick kLastTick = fs_to_tick(kLastFs) - 1;
[[noreturn]] void out_of_time() { raise_error("/brick/time", "beyond 2.5 hours after the epoch, or before it"); }
}  // namespace

Scheduler::Scheduler(const TimeOptions& options)
    : epoch_(options.epoch.value()),
      grid_(std::max<sc_time::value_type>(options.grid.value(), 1)),
      unit_(std::llround(sc_core::sc_get_time_resolution().to_seconds() * 1e15)) {
  if (unit_ > kFsPerNs)
    raise_error("/brick/resolution", "the kernel's time resolution is coarser than 1 ns: edges would fall together");
}

sc_time Scheduler::time_of(Tick edge) const {
  if (edge < 0 || edge > kLastTick) out_of_time();
  return instant_of(edge);
}
sc_time Scheduler::instant_of(Tick edge) const { return instant_at(tick_to_fs(edge)); }
sc_time Scheduler::instant_at(TimeFs time) const {
  return sc_time::from_value(epoch_ + static_cast<sc_time::value_type>(time / unit_) + 1);
}
TimeFs Scheduler::time() const {
  const sc_time::value_type now = sc_core::sc_time_stamp().value();
  return now <= epoch_ ? 0 : static_cast<TimeFs>(now - epoch_) * unit_;
}

// The last edge whose true time is before `instant`.
Tick Scheduler::tick_at(const sc_time& instant) const {
  if (instant.value() <= epoch_) return 0;
  if (instant.value() - epoch_ > static_cast<sc_time::value_type>(kLastFs / unit_)) out_of_time();
  return fs_to_tick(static_cast<TimeFs>(instant.value() - epoch_) * unit_) - 1;
}

void Scheduler::remove(Client& client) { clients_.erase(std::find(clients_.begin(), clients_.end(), &client)); }

void Scheduler::start() {
  started_ = true;
  for (Client* client : clients_) {
    client->start();
    if (client->eager()) eager_.push_back(client);
  }
}

void Scheduler::step() {
  if (!started_) start();
  const sc_time now = sc_core::sc_time_stamp();
  const Tick tick = tick_at(now);
  for (Client* client : clients_)
    if (client->due() <= tick) client->show(tick);
  // An input may still change in a later delta cycle of this instant, by our own outputs too: the last one counts.
  if (sc_core::sc_pending_activity_at_current_time()) return sc_core::next_trigger(sc_core::SC_ZERO_TIME);
  Tick next = kNever;
  for (Client* client : clients_) {
    if (client->touched()) client->take(tick);
    next = std::min(next, client->due());
  }
  sc_time wake = next == kNever ? sc_core::sc_max_time() : instant_of(std::min(next, kLastTick + 1));
  if (!eager_.empty()) {
    // Nothing is pending before that time.
    const sc_time grid = sc_time::from_value((now.value() / grid_ + 1) * grid_);
    wake = std::min({wake, grid, now + sc_core::sc_time_to_pending_activity()});
    const Tick changed = run_ahead(tick, tick_at(wake));
    if (changed != kNever) wake = time_of(changed);
  }
  if (wake == sc_core::sc_max_time())
    sc_core::next_trigger(changed_);
  else
    sc_core::next_trigger(wake - now, changed_);
}

// Returns the first edge at which an output changed, and nobody stands beyond it.
Tick Scheduler::run_ahead(Tick from, Tick limit) {
  if (eager_.size() == 1) return eager_.front()->run(limit) ? eager_.front()->due() : kNever;
  for (Tick to = from; to < limit;) {
    Tick quiet = kNever;
    for (const Client* client : eager_) quiet = std::min(quiet, client->quiet_until());
    to = std::min(limit, std::max(quiet, to) + 1);
    bool changed = false;
    for (Client* client : eager_) changed = client->run(to) || changed;
    if (changed) return to;
  }
  return kNever;
}

TimeBase::TimeBase(const sc_core::sc_module_name& name, const TimeOptions& options) : sc_module(name) {
  if (the_one != nullptr) raise_error("/brick/time_base", "a simulation has one time base: share it");
  the_one = this;
  scheduler_ = std::make_unique<Scheduler>(options);
  sc_core::sc_spawn_options process;
  process.spawn_method();
  sc_core::sc_spawn([this] { scheduler_->step(); }, "step", &process);
}
TimeBase::~TimeBase() {
  if (the_one == this) the_one = nullptr;
}
sc_time TimeBase::time_of(Tick edge) const { return scheduler_->time_of(edge); }
Tick TimeBase::tick_at(const sc_time& instant) const { return scheduler_->tick_at(instant); }

}  // namespace brick::component
