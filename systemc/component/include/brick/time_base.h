// The time that all components of a simulation share: when edge t of their clocks is, in kernel time, and the one
// process that moves them. One is made per simulation, before the components, which get it by reference.
//
// A tick is one period of clk_pwm (117.9648 MHz): 78125/9216 ns, seldom a whole number of the kernel's units. Edge t
// has its true time at epoch + t x 78125/9216 ns and acts at the first kernel instant after that: at most one unit of
// the kernel's resolution late, and nothing adds up. The rule for pins follows from it:
//  - outputs of edge t change in that instant,
//  - an input that changes before that instant is seen by edge t, one that changes in it or later by edge t + 1 or a
//    later one. What an input shows at the end of an instant, after all delta cycles, is what counts.
// clk_ref (39.3216 MHz) rises with every third edge: 3, 6, 9, ...
#pragma once

#include <cstdint>
#include <memory>

#include <systemc>

namespace brick {
using Tick = std::int64_t;  // periods of clk_pwm since the epoch
}

namespace brick::component {

class Scheduler;

struct TimeOptions {
  sc_core::sc_time epoch = sc_core::SC_ZERO_TIME;  // kernel time of tick 0, which is power-on
  // An engine that cannot foresee its outputs (Verilated RTL, lock-step) executes edges ahead of kernel time as long as
  // no event of the kernel is pending before them. It does so up to the next multiple of `grid` at most. So whoever
  // changes pins from sc_main() between two calls of sc_start() does it at a multiple of `grid`, or gets the error
  // /brick/ahead. The model foresees its outputs and knows no such limit.
  sc_core::sc_time grid = sc_core::sc_time(1, sc_core::SC_US);
};

class TimeBase : public sc_core::sc_module {
 public:
  // The kernel's resolution must be 1 ns or finer: an error /brick/resolution else. A second one in the same
  // simulation, and a component that outlives its own: /brick/time_base.
  explicit TimeBase(const sc_core::sc_module_name& name, const TimeOptions& options = TimeOptions{});
  ~TimeBase() override;

  // Edges before the epoch or beyond the end of the kernel's time (213 days of picoseconds) are the error /brick/time.
  sc_core::sc_time time_of(Tick edge) const;            // instant in which the outputs of this edge change
  Tick tick_at(const sc_core::sc_time& instant) const;  // last edge that has happened at this instant; 0: none yet

  Scheduler& scheduler() { return *scheduler_; }

 private:
  std::shared_ptr<Scheduler> scheduler_;  // with the components, whoever goes last
};

}  // namespace brick::component
