// Moves all components of a simulation, in one process; the rules are in brick/time_base.h and docs/architecture.md.
// A component that foresees its outputs is woken for their next change. The others execute edges ahead of kernel time:
// in one go when there is one, in turn when there are several, so that none passes an edge at which another changes.
// All ports are written here, so that a signal has one driver. Outputs change in the first delta cycle of their
// instant, inputs are taken in its last, when nothing is pending in it any more. To ask for that in each delta cycle is
// pending itself: a process that waits for the last one in the same way would never see it. So an instant that goes on
// is left to the others after some delta cycles, and settled, as it then was, at the kernel's next unit of time.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <systemc>

#include "systemc/component/include/brick/time_base.h"
#include "systemc/core/ticks.h"

namespace brick::component {

class Client;

class Scheduler : public std::enable_shared_from_this<Scheduler> {
 public:
  explicit Scheduler(const TimeOptions& options);

  sc_core::sc_time time_of(Tick edge) const;
  Tick tick_at(const sc_core::sc_time& instant) const;
  sc_core::sc_time instant_at(TimeFs time) const;  // in which what has this true time acts
  TimeFs time() const;                             // what has this true time or a later one acts after this instant
  Tick tick() const { return tick_at(sc_core::sc_time_stamp()); }
  sc_core::sc_time settled() const;  // the instant whose inputs and accesses are taken: that before, if it was left

  void add(Client& client) { clients_.push_back(&client); }
  void remove(Client& client);
  void touched();  // by each client once until it is taken: an input has changed or an access has come
  bool has_left() const { return left_ != kNoTime; }  // each time then: nobody else counts the delta cycles

  void spawn();                     // the process
  void stop() { stopped_ = true; }  // the time base is gone
  void check() const;               // it is not: /brick/time_base else

 private:
  using Units = sc_core::sc_time::value_type;  // of the kernel's time
  static constexpr Units kNoTime = ~Units{}, kLastTime = kNoTime - 1;

  void step();
  void start();
  bool instant_goes_on();
  void settle_left(const sc_core::sc_time& now);
  void sleep_until(Units wake);
  void cancel_timers();
  Units instant_of(Tick edge) const;
  Tick run_ahead(Tick from, Tick limit);

  Units epoch_, grid_;
  TimeFs unit_;     // of the kernel's resolution
  Tick last_tick_;  // that the kernel's time reaches
  std::vector<Client*> clients_, eager_;
  // A timer that has been put off leaves a dead entry in the kernel's queue until its time. So a wake-up before the one
  // that is pending gets the second timer, and one that turns out too early is let come.
  struct Timer {
    sc_core::sc_event event;
    Units at = kNoTime;
  };
  std::array<Timer, 2> timers_;
  sc_core::sc_event changed_;
  Units left_ = kNoTime;     // the instant that is left to the others
  Units counted_ = 0;        // the instant of deltas_
  unsigned deltas_ = 0;      // of it, that have been looked at
  std::uint64_t delta_ = 0;  // the last one of them
  bool started_ = false, stopped_ = false, touched_ = true;
};

}  // namespace brick::component
