// A host on the ISA / PC104 pins of a machine: time, and the cycles of the bus master (systemc/host/isa_master.h).
// Every call advances the machine; pins are read and driven only while the board stands at that time, so the result is
// the same on every engine.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>

#include "systemc/host/isa_cycles.h"
#include "systemc/host/isa_timing.h"
#include "systemc/machine/machine.h"

namespace brick {

// The board broke a rule of the bus cycle, e.g. held IOCHRDY low for longer than t10.
class HostBusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class IsaHost : public IsaCycles {
 public:
  explicit IsaHost(Machine& machine);

  // Bus cycles ------------------------------------------------------------------------------------------------------
  bool irq() const override { return machine_.outputs().get(pin::kIsaIrq) != 0; }

  void set_times(const isa::HostTimes& times) { times_ = times; }
  const isa::HostTimes& times() const { return times_; }
  unsigned width() const override { return width_; }
  void set_width(unsigned bits) { width_ = bits; }  // 8: no SBHE#, nobody looks at MEMCS16#

  // Pins one by one, for hosts that keep no rule. `time` is not before now; the cycles above start after it.
  void drive_at(TimeFs time, const std::function<void(HostInputs&)>& edit);
  std::uint16_t data_bus() const { return IsaMaster::data_bus(pins()); }
  TimeFs free_at() const { return free_at_; }

  // Time --------------------------------------------------------------------------------------------------------------
  Tick now() const { return machine_.now(); }
  void advance_to(Tick tick);
  void advance_to_stop(Tick limit);  // or to the end of the run that an edge ends (Machine::stop_on_motor)
  void wait(Tick ticks) { advance_to(now() + ticks); }
  void wait_change(const PinField& pin, Tick limit);  // to the pin's next change, or to tick `limit`
  bool wait_pin(const PinField& pin, std::uint32_t value, Tick timeout);  // stops at the edge; false at the time-out

  // Hooks -------------------------------------------------------------------------------------------------------------
  // `on_edge` is called at each change of a pin selected by `pins`, whatever the host does meanwhile.
  using EdgeHook = std::function<void(Tick, const BoardOutputs& before, const BoardOutputs& after)>;
  void watch(const BoardOutputs& pins, EdgeHook on_edge);
  void set_pace(std::function<unsigned()> idle) { pace_ = std::move(idle); }  // periods of the grid before each cycle
  void set_heartbeat(std::function<void()> heartbeat) {
    heartbeat_ = std::move(heartbeat);
  }                         // called often, for progress
  void heartbeat() const {  // to be called by whoever lets no time pass for long
    if (heartbeat_) heartbeat_();
  }

  Machine& machine() { return machine_; }

 protected:
  void pause(TimeFs time) { free_at_ += time; }
  const BoardOutputs& pins() const { return machine_.outputs(); }
  const IsaStraps& switches() const { return machine_.inputs(); }

 private:
  IsaResult cycle(const IsaCycle& c) override;
  template <class Edit>
  void drive(TimeFs time, const Edit& edit);
  TimeFs cycle_start();
  void beat() const;
  void step_to(Tick limit, const BoardOutputs& stop_on);

  Machine& machine_;
  IsaMaster isa_;
  isa::HostTimes times_ = isa::kTypical;
  unsigned width_;
  TimeFs free_at_ = 0;  // the bus is free for the next cycle
  BoardOutputs watched_{};
  EdgeHook on_edge_;
  std::function<unsigned()> pace_;
  std::function<void()> heartbeat_;
};

}  // namespace brick
