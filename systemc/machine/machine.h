// The whole controller: a board (any engine), the CPU with its Port A bus, and the rule of who may run ahead of whom
// (docs/architecture.md). A host (script, bench, socket) owns the Machine and advances it; between two calls the board
// stands exactly at now() and the CPU at most kInterruptLatency ticks later.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <systemc>

#include "systemc/core/aperture.h"
#include "systemc/core/board.h"
#include "systemc/core/signals.h"
#include "systemc/cpu/cpu.h"
#include "systemc/cpu/port_a_wires.h"
#include "systemc/machine/motor_peer.h"

namespace brick {

class GdbServer;
class PciBridge;
class PortAWatch;
struct PortACycle;

enum class Engine { kRtl, kSystemC, kLockstep };

// Board description as far as the machine needs it (boards/*.toml, read by app/ through systemc/machine/board_file.h).
struct BoardConfig {
  std::string name = "geobrick-lv-8";
  std::string title;
  std::uint32_t fitted = 0x3;         // as BoardInputs::fitted
  std::uint32_t macro_gate = 0;       // as BoardInputs::macro_gate
  std::uint32_t dpram_words = 32768;  // 16-bit words: 8192 or 32768
  bool jpan = false;                  // Turbo PMAC control panel port fitted
  bool pic_8259 = false;              // the interrupt controller is an 8259
  std::uint32_t card = 603382;        // CID reply
  std::uint32_t product = 0;          // other bits of word 5 of the straps page, systemc/machine/board_family.h
  std::uint32_t line_select = 0x951;  // sources of IR5 (low digit), IR6, IR7: kInterruptSources of board_family.h
  std::string family = "geo-brick-lv", bus = "internal";
  std::uint32_t io_base = 0x210;   // of the host's I/O block
  bool io_decode16 = true;         // false: the host's I/O addresses have ten bits
  std::uint32_t window = 0xD0000;  // of the dual-ported RAM in the host's memory
  bool window_flat = true;         // 64 KiB; false: 16 KiB with a page register
  bool slot8 = false;              // in a slot of eight bits
  unsigned axes = 8;
  bool feedback_option_2 = false;
  bool amplifiers = true;          // built in: they hold FAULT low
  std::uint8_t ssi_kind = 2;       // as Straps::ssi_kind: kSsiGeoPmac, kSsiGeoBrick of board_family.h
  std::vector<std::string> notes;  // what differs from the product, for the user
};

// The input pins of a channel where nothing is connected, bits as ChannelPin (servo-ic:5.15/6).
constexpr std::uint16_t idle_channel_pins(const BoardConfig& board) {
  return static_cast<std::uint16_t>(kIdleChannelPins & ~(board.amplifiers ? 1u << kFault : 0u));
}

struct MachineConfig {
  Engine engine = Engine::kSystemC;
  BoardConfig board;
  std::string firmware;    // ELF path
  std::string flash_file;  // "" = flash content is lost at the end
  bool jumper_e3 = false;
  std::uint64_t seed = 1;            // content of RAM, DPRAM (1: zero) and of RTL flip-flops before the reset
  TimeFs aperture = 0;               // of the board's inputs, systemc/core/aperture.h; 0 = none
  bool skew = false;                 // each line of Port A has a delay, by the seed: systemc/cpu/port_a_wires.h
  Tick batch = 0;                    // 0 = as long as the rule allows; else no advance longer than this many ticks
  std::optional<std::uint32_t> bcr;  // wait states, whatever the firmware writes to BCR
  std::function<std::unique_ptr<Board>(std::unique_ptr<Board>)> rewire;  // negative controls: a board that is faulty
  bool seeded_bug = false;  // lock-step negative control: the RTL gets a deliberate bug (rtl/board/board_sim.sv)
};

// Makes bus cycles in the CPU's place, for tests of the bus itself. BCR and PCTL are written like any other word.
class BusMaster {
 public:
  struct Access {
    bool x = false;
    std::uint32_t address = 0;
    bool write = false;
    std::uint32_t data = 0;
    unsigned idle = 0;  // CPU clocks to let pass before it begins
    // It begins in a CPU clock whose number, CpuClock::number(), is `slot` modulo `slots`.
    unsigned slot = 0, slots = 1;
    std::optional<bool> moving_ta = {};  // a moving /TA is taken as it stands after, before its move; none: by the seed
    // Moves up to Aperture::kMost from an edge are taken early, late; none: by the machine's aperture.
    std::optional<bool> early = {};
  };
  virtual ~BusMaster() = default;
  virtual std::optional<Access> next() = 0;  // none: asked again when the machine is advanced again
  virtual void done(const Access& access, std::uint32_t data) = 0;
};

class Machine : public sc_core::sc_module {
 public:
  Machine(sc_core::sc_module_name name, const MachineConfig& config);
  ~Machine() override;

  Tick now() const;
  TimeFs now_fs() const { return tick_to_fs(now()); }

  // Advances everything to `limit`, or to the first edge at which an output selected by `stop_on` changes.
  // Throws LockstepDifference (systemc/cosim/engines.h) at the first difference of the two engines.
  Tick run_until(Tick limit, const BoardOutputs& stop_on = {});

  // The pins that the host owns. The host edits them and calls apply(); edge now()+1 is the first to see them.
  HostInputs& inputs();
  void apply() { apply(now_fs()); }
  void apply(TimeFs time);  // the same with the exact time, which that edge is the first not to be before
  void apply_partly();      // some lines of a move that is in doubt (systemc/core/aperture.h): outside all move later
  const BoardOutputs& outputs() const;
  BoardOutputs port_a_at_once()
      const;            // with what follows a pin of Port A without a clock, before the next edge shows it
  PortAPins& port_a();  // of a machine without firmware: the pins of its CPU's bus, which nobody else drives
  PciBridge* pci();     // between the host and these pins on boards with a PCI connector, else nullptr

  std::uint32_t fitted() const;  // ICs of the board, as BoardInputs::fitted

  // The motor side (systemc/machine/motor_peer.h). Pins are edited and applied as inputs(); a stop edge ends
  // run_until().
  MotorInputPins& motor_inputs();
  void apply_motor_inputs();
  std::uint16_t driven_motor_inputs(unsigned ic, unsigned channel) const;  // by peers, bits as ChannelPin
  std::uint16_t idle_channel_pins() const;  // of a channel where nothing is connected, bits as ChannelPin
  MotorOutputs motor_outputs(unsigned ic) const;
  void stop_on_motor(unsigned ic, const MotorOutputs& select);  // until called again; an empty selection ends it
  void attach(MotorPeer& peer);  // not owned; detach() it before it goes; told the outputs at once
  void detach(MotorPeer& peer);

  const PinSkew& skew() const;  // of the lines of Port A
  Aperture& aperture();         // of the pins that CPU and host drive; a host's pins move by it

  Signals& signals();  // every named signal of docs/signals.md
  Cpu& cpu();
  std::uint64_t instructions() const;
  void attach_debugger(GdbServer* debugger);  // not owned; nullptr = none
  // Not owned. The CPU stops where it is and takes the bus again, after nullptr, at the next reset only.
  void attach_bus_master(BusMaster* master);
  // Not owned; nullptr = none. It sees the lines of Port A move (systemc/cpu/port_a_watch.h).
  void attach_port_a_watch(PortAWatch* watch);
  std::string function_at(std::uint32_t pc) const;  // name of the firmware's function, "" if none holds pc
  std::string cpu_place() const;                    // where the CPU stands: pc and its function
  std::string last_exception() const;               // of the CPU, "" = none yet, or taken
  unsigned task() const;                            // cpu.task

  void reset();                 // pulls the reset line: board and CPU start again, RAM and flash keep their content
  void power_cycle();           // RAM content is lost, flash stays
  void set_jumper_e3(bool on);  // read by the firmware at start

  // Bus cycles of the CPU, newest last, for reports.
  struct BusCycle {
    Tick tick;
    char space;
    std::uint32_t address;
    bool write;
    std::uint32_t data;
    std::uint32_t pc;
  };
  const std::vector<BusCycle>& last_bus_cycles() const;  // the last 16 or more

  // What no sound set-up does, one line each, oldest first: two sources of the clocks (docs/clock_select.md), a flash
  // file that cannot be written; behind them exceptions of the CPU (docs/firmware.md). A caller that provokes it on
  // purpose takes the list; `brick run` and `brick exec` fail when something is left in it.
  std::vector<std::string> run_errors() const;
  std::vector<std::string> take_run_errors();

  // Called at the end of each Port A cycle with the exact times of all its edges (systemc/cpu/port_a.h), for checkers.
  std::function<void(const PortACycle&)> on_bus_cycle;
  std::function<void(const PortACycle&)> check_bus_cycle;  // the same, for what judges every run

  // Called after each edge that changes an output of the board, and as the CPU takes or leaves a trap.
  std::function<void(Tick, const BoardOutputs& before, const BoardOutputs& after)> on_outputs;
  std::function<void(TimeFs)> on_task;

  // Called when pins of the host bus or the reset line may have moved, and when: of the board's at the edge that moved
  // them, of the host's as it said. For checkers (testbench/checkers/isa_checker.h).
  std::function<void(TimeFs, const BoardInputs&, const BoardOutputs&)> on_host_bus;

  TimeFs cpu_period() const;  // of the CPU clock as it stands
  bool forced_bcr_acted() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
