#include "systemc/component/scheduler.h"

#include <sysc/kernel/sc_dynamic_processes.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "systemc/component/client.h"
#include "systemc/component/error.h"

namespace brick::component {
namespace {
using sc_core::sc_time;
const TimeBase* the_one = nullptr;  // of this simulation

constexpr unsigned kMostDeltas = 100'000;  // of one instant with changes of pins; no design needs so many
constexpr unsigned kAsked = 16;            // delta cycles in which an instant is asked for its end before it is left
[[noreturn]] void out_of_time() {
  raise_error("/brick/time", "beyond the end of the kernel's time, or before the epoch");
}

// Of the kernel, checked before anything is counted in it: its last instant would be beyond the last tick.
TimeFs resolution() {
  const TimeFs unit = std::llround(sc_core::sc_get_time_resolution().to_seconds() * 1e15);
  if (unit > kFsPerNs)
    raise_error("/brick/resolution", "the kernel's time resolution is coarser than 1 ns: edges would fall together");
  return unit;
}
}  // namespace

Scheduler::Scheduler(const TimeOptions& options)
    : epoch_(options.epoch.value()),
      grid_(std::max<Units>(options.grid.value(), 1)),
      unit_(resolution()),
      last_tick_(fs_to_tick((kLastTime - epoch_) * unit_) - 1) {}

sc_time Scheduler::time_of(Tick edge) const {
  if (edge < 0 || edge > last_tick_) out_of_time();
  return sc_time::from_value(instant_of(edge));
}
Scheduler::Units Scheduler::instant_of(Tick edge) const { return instant_at(tick_to_fs(edge)).value(); }
sc_time Scheduler::instant_at(TimeFs time) const {
  return sc_time::from_value(epoch_ + static_cast<Units>(time / unit_) + 1);
}
sc_time Scheduler::settled() const { return left_ == kNoTime ? sc_core::sc_time_stamp() : sc_time::from_value(left_); }
TimeFs Scheduler::time() const {
  const Units now = settled().value();
  return now <= epoch_ ? 0 : static_cast<TimeFs>(now - epoch_) * unit_;
}

// The last edge whose true time is before `instant`.
Tick Scheduler::tick_at(const sc_time& instant) const {
  if (instant.value() <= epoch_) return 0;
  if (instant.value() > kLastTime) out_of_time();
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

// Sensitive to events of our own, which costs the kernel much less than next_trigger().
void Scheduler::spawn() {
  sc_core::sc_spawn_options process;
  process.spawn_method();
  process.set_sensitivity(&changed_);
  for (Timer& timer : timers_) process.set_sensitivity(&timer.event);
  sc_core::sc_spawn([self = shared_from_this()] { self->step(); }, "step", &process);
}

void Scheduler::check() const {
  if (stopped_) raise_error("/brick/time_base", "the time base of a component is gone: it is made first and goes last");
}

// Runs in this same delta cycle, after all that is runnable in it.
void Scheduler::touched() {
  touched_ = true;
  changed_.notify();
}

void Scheduler::step() {
  if (stopped_) return;
  if (!started_) start();
  const sc_time& now = sc_core::sc_time_stamp();
  const Tick tick = tick_at(now);
  if (left_ != kNoTime && left_ < now.value()) settle_left(now);
  for (Client* client : clients_) {
    if (client->due() <= tick) client->show(tick);
    touched_ = touched_ || client->touched();  // the next cycle waits for the one that has ended
  }
  // An input may still change in a later delta cycle of this instant, by our own outputs too: the last one counts. If
  // all foresee their outputs and nobody is touched, there is nothing to wait for: a touch wakes us again.
  if ((touched_ || !eager_.empty()) && instant_goes_on()) return;
  left_ = kNoTime;
  Tick next = kNever;
  for (Client* client : clients_) {
    if (touched_ && client->touched()) client->take(tick);
    next = std::min(next, client->due());
  }
  touched_ = false;
  Units wake = next > last_tick_ ? kNoTime : instant_of(next);
  if (!eager_.empty()) {
    cancel_timers();  // they are not what we run up to
    const Units since = now.value() % grid_, grid = now.value() + std::min(grid_ - since, kLastTime - now.value());
    const sc_time pending = sc_core::sc_time_to_pending_activity();  // nothing can change before that
    wake = std::min({wake, grid, now.value() + std::min(pending.value(), kLastTime - now.value())});
    const Tick changed = run_ahead(tick, tick_at(sc_time::from_value(wake)));
    if (changed != kNever) wake = time_of(changed).value();
  }
  if (wake == kNoTime || now.value() == kLastTime)  // the kernel's time ends
    cancel_timers();
  else
    sleep_until(wake);
}

// Something is pending in this instant: true, and we are woken in its next delta cycle, or when it is over.
bool Scheduler::instant_goes_on() {
  const Units now = sc_core::sc_time_stamp().value();
  if (counted_ != now) deltas_ = 0;
  counted_ = now;
  if (!sc_core::sc_pending_activity_at_current_time()) {
    deltas_ = 0;
    return false;
  }
  if (delta_ != sc_core::sc_delta_count()) ++deltas_;
  delta_ = sc_core::sc_delta_count();
  if (deltas_ > kMostDeltas)
    raise_error("/brick/instant", "no end of this instant after " + std::to_string(kMostDeltas) +
                                      " delta cycles in which pins of components change: do signals go round in a "
                                      "circle?");
  if (deltas_ <= kAsked) {
    changed_.notify(sc_core::SC_ZERO_TIME);
  } else {
    left_ = now;
    sleep_until(now + 1);
  }
  return true;
}

// The instant that was left has ended: no pin has changed since, but an access may have come in this one.
void Scheduler::settle_left(const sc_time& now) {
  const Tick then = tick_at(sc_time::from_value(left_));
  touched_ = false;
  for (Client* client : clients_) {
    if (client->touched()) client->take(then);
    touched_ = touched_ || client->touched();
  }
  left_ = kNoTime;
  if (!eager_.empty() && tick_at(now) > then) run_ahead(then, tick_at(now));
}

void Scheduler::sleep_until(Units wake) {
  const Units now = sc_core::sc_time_stamp().value();
  for (Timer& timer : timers_)
    if (timer.at <= now) timer.at = kNoTime;
  if (std::min(timers_[0].at, timers_[1].at) <= wake) return;
  Timer& timer = timers_[timers_[0].at == kNoTime ? 0 : 1];
  timer.at = wake;
  timer.event.notify(sc_time::from_value(wake - now));  // the kernel keeps the earlier of two
}

void Scheduler::cancel_timers() {
  for (Timer& timer : timers_) {
    if (timer.at != kNoTime) timer.event.cancel();
    timer.at = kNoTime;
  }
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
  scheduler_ = std::make_shared<Scheduler>(options);
  scheduler_->spawn();
  the_one = this;
}
TimeBase::~TimeBase() {
  scheduler_->stop();
  if (the_one == this) the_one = nullptr;
}
sc_time TimeBase::time_of(Tick edge) const { return scheduler_->time_of(edge); }
Tick TimeBase::tick_at(const sc_time& instant) const { return scheduler_->tick_at(instant); }

}  // namespace brick::component
