// A host on the ISA / PC104 pins: time, and single cycles with real edges (host-bus:3.4). It knows the board by its
// pins alone: data by what is driven on SD, the width of memory by MEMCS16#, waiting by IOCHRDY. Every call advances
// the machine; pins are read and driven only while the board stands at that time, so the result is the same on every
// engine.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>

#include "systemc/host/local_bus.h"
#include "systemc/machine/machine.h"
#include "testbench/host/isa_timing.h"

namespace brick {

// The board broke a rule of the bus cycle, e.g. held IOCHRDY low for longer than t10.
class HostBusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class IsaHost : public LocalBus {
 public:
  explicit IsaHost(Machine& machine);

  // Bus cycles ------------------------------------------------------------------------------------------------------
  std::uint8_t read_io(std::uint32_t port) override;
  void write_io(std::uint32_t port, std::uint8_t value) override;
  std::uint16_t read_memory(std::uint32_t address, unsigned lanes) override;
  void write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) override;
  bool irq() const override { return machine_.outputs().get(pin::kIsaIrq) != 0; }

  void set_times(const isa::HostTimes& times) { times_ = times; }
  const isa::HostTimes& times() const { return times_; }
  void set_width(unsigned bits) { width_ = bits; }  // 8: no SBHE#, nobody looks at MEMCS16#

  // Pins one by one, for hosts that keep no rule. `time` is not before now; the cycles above start after it.
  void drive_at(TimeFs time, const std::function<void(HostInputs&)>& edit);
  std::uint16_t data_bus() const;  // lanes that nobody drives are pulled up
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
  }  // called often, for progress

  Machine& machine() { return machine_; }

 protected:
  void pause(TimeFs time) { free_at_ += time; }
  const BoardOutputs& pins() const { return machine_.outputs(); }
  const IsaStraps& switches() const { return machine_.inputs(); }

 private:
  enum class Command { kIoRead, kIoWrite, kMemoryRead, kMemoryWrite };
  struct Cycle {
    Command command;
    std::uint32_t address;
    std::uint16_t data;
    bool sbhe;
    bool memory() const { return command == Command::kMemoryRead || command == Command::kMemoryWrite; }
    bool write() const { return command == Command::kIoWrite || command == Command::kMemoryWrite; }
  };
  struct Result {
    std::uint16_t data;
    bool narrow;  // a memory cycle of eight bits
  };
  Result cycle(const Cycle& c);
  template <class Edit>
  void drive(TimeFs time, const Edit& edit);
  std::uint8_t cycle8(Command command, std::uint32_t address, std::uint8_t data);
  bool not_ready(const isa::CycleTimes& times, TimeFs end);
  TimeFs stretch(const Cycle& c, TimeFs start, TimeFs low, TimeFs end);
  TimeFs cycle_start();
  void step_to(Tick limit, const BoardOutputs& stop_on);

  Machine& machine_;
  isa::HostTimes times_ = isa::kTypical;
  unsigned width_;
  TimeFs free_at_ = 0;  // the bus is free for the next cycle
  BoardOutputs watched_{};
  EdgeHook on_edge_;
  std::function<unsigned()> pace_;
  std::function<void()> heartbeat_;
};

}  // namespace brick
