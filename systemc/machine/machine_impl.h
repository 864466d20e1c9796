// Inside of the machine: the parts, and the state of the run-ahead rule. Private to this folder.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <deque>
#include <memory>
#include <optional>

#include "systemc/cpu/gdb_server.h"
#include "systemc/cpu/port_a.h"
#include "systemc/host/pci_bridge.h"
#include "systemc/machine/clock_drivers.h"
#include "systemc/machine/cpu_faults.h"
#include "systemc/machine/machine.h"
#include "systemc/machine/machine_signals.h"
#include "systemc/machine/memory.h"
#include "systemc/machine/motor_side.h"

namespace brick {

// The CPU sees an interrupt pin this many ticks after the edge that changes it: 136 ns, the order of a DSP563xx's own
// recognition and fetch. Within this time board and CPU may run one after the other.
constexpr Tick kInterruptLatency = 16;

// The reset line is held for about a microsecond.
constexpr Tick kResetTicks = 120;

// INIT/ of the control panel must be low for about a microsecond to be taken for more than a spike.
constexpr Tick kInitTicks = 120;

// Turns device accesses of the CPU into transactions on Port A.
class PortAInitiator : public sc_core::sc_module, public DeviceBus {
 public:
  PortAInitiator(sc_core::sc_module_name name, PortA& port_a);
  ~PortAInitiator() override;
  Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) override;
  bool under_way() const { return under_way_; }
  void forget() { under_way_ = false; }  // reset in the middle of an access

  tlm_utils::simple_initiator_socket<PortAInitiator> socket{"socket"};
  Cpu* cpu = nullptr;
  bool by_master = false;  // not the CPU asks

 private:
  PortA& port_a_;
  PortARequest request_;  // extension of payload_, which would delete it
  tlm::tlm_generic_payload payload_;
  std::uint32_t data_ = 0;
  bool under_way_ = false;
};

struct Machine::Impl {
  Impl(Machine& machine, const MachineConfig& machine_config);
  ~Impl();

  // machine.cpp: the parts and how they are joined
  void power_on();
  void start_cpu();
  void begin_reset(bool power);
  void board_changed(Tick tick, const BoardOutputs& before, const BoardOutputs& after);
  void cycle_done(const PortACycle& cycle);
  void main_memory_wait() { memory.set_main_wait(memory_wait(port_a.wait_states(0))); }
  void trace_cpu(bool on);
  void take_host_inputs();
  void apply_host_inputs(TimeFs time);
  void host_bus_moved(TimeFs time);
  void see_init();
  void drive_ssi();
  void keep_flash();
  void exception(std::uint32_t cause, std::uint32_t pc, TimeFs time);

  // run.cpp: the run-ahead rule
  Tick run_until(Tick limit, const BoardOutputs& stop_on);
  void run_cpu(Tick known);
  void run_master();
  bool deliver_due();
  Tick board_limit(Tick limit, Tick now) const;
  void keep_kernel_time(Tick from);
  TimeFs cpu_time() const;

  const MachineConfig config;
  bool jumper_e3;  // stays put over a power cycle
  Machine& owner;
  Signals signals;
  MachineSignals named{signals};
  std::unique_ptr<Board> board;
  MotorSide motors;
  Aperture aperture;
  PortA port_a{"port_a", signals};
  PortAInitiator initiator{"cpu_bus", port_a};
  Cpu cpu{&initiator};
  PortAWatch* port_a_watch = nullptr;
  BusMaster* master = nullptr;                     // makes the bus cycles when there is one
  std::optional<BusMaster::Access> master_access;  // under way
  GdbServer* debugger = nullptr;                   // runs the CPU when there is one
  MachineMemory memory;
  std::unique_ptr<PciBridge> pci;
  std::unique_ptr<ElfFile> elf;
  std::uint64_t power_ons = 0;

  HostInputs host_inputs;   // as the host edits them
  bool host_moves = false;  // of a move that is in doubt the board has a part
  BoardInputs inputs;       // as the board has them

  struct Event {
    Tick tick;
    enum Kind { kPhase, kServo, kHostPortOn, kHostPortOff, kStop } kind;
  };
  std::deque<Event> events;  // pin changes that the CPU has not seen yet
  bool cpu_runs = false;     // false: reset, watchdog, or no firmware
  Tick reset_until = kNever;
  bool init_low = false, init_holds = false;  // INIT/ is low; it holds the reset line
  Tick init_at = kNever;                      // INIT/ will have been low for long enough
  bool stopped = false;                       // the present run came to a selected edge
  BoardOutputs stop_on;
  bool tracing_cpu = false;
  std::vector<BusCycle> bus_cycles;
  ClockDrivers clock_drivers;
  std::vector<std::string> run_errors;  // but for exceptions
  CpuFaults faults;
  std::optional<TimeFs> kernel_offset;  // kernel time at the machine's tick 0
};

}  // namespace brick
