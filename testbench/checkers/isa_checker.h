// Checker of the host bus: every row of host-bus:3.4, the strobes of the host port (host-bus:3.3) and what no sound
// host or board does (host-bus:3.9), evaluated from the pins with the times in femtoseconds at which they moved. It
// keeps nothing of the board but what its switches say, and counts the cycles that it has seen.
#pragma once

#include <array>
#include <functional>

#include "systemc/core/board_pins.h"
#include "testbench/checkers/timing_rules.h"

namespace brick {

class IsaChecker {
 public:
  enum Rule : unsigned {
    kT1,
    kT2,
    kT3,
    kT4,
    kT5,
    kT5Off,
    kT6,
    kT7,
    kT8,
    kT9,
    kT10,
    kT11,  // rows 1 to 11
    kT12,
    kT13,
    kT14,
    kT15,
    kT16,  // rows 12 to 16; row 17 is 8 to 10 again
    kT18,  // row 18
    kH1,
    kH2,
    kH3,
    kH4,
    kH5,
    kH6,  // host-bus:3.3
    kOneCommand,
    kAddressStands,
    kRoomInTx,
    kWholeCycle,
    kOursOnly,  // host-bus:3.9
    kRules
  };
  enum Region : unsigned { kIo, kMemory16, kMemory8, kRegions };
  enum Kind : unsigned { kIoRead, kIoWrite, kMemoryRead, kMemoryWrite, kKinds };

  IsaChecker();

  // Pins as they stand from `time` on; times never fall.
  void pins(TimeFs time, const BoardInputs& in, const BoardOutputs& out);
  // For host-bus:3.3; the default is 80 MHz.
  void set_cpu_period(std::function<TimeFs()> period) { cpu_period_ = std::move(period); }

  TimingLedger& ledger() { return ledger_; }
  const TimingLedger& ledger() const { return ledger_; }

  // Cycles that have ended, by kind, width (0: 8 bits, 1: 16) and whether IOCHRDY was low for longer than it is in each
  // access to the RAM, a period of clk_ref (host-bus:3.4): this one had to wait.
  std::uint64_t cycles(Kind kind, unsigned wide, unsigned waited) const { return cycles_[kind][wide][waited]; }
  std::uint64_t read_cycles_answered() const { return answered_; }  // that got data from the board

 private:
  static constexpr TimeFs kNone = -1;
  struct Cycle {
    Kind kind = kIoRead;
    std::uint32_t address = 0;
    bool wide = false, alone = true, whole = true, moved = false;
    bool unsure = false;                 // the address moved where the board may take either (host-bus:3.9/2)
    unsigned lanes = 0;                  // of SD that it uses
    bool due = false, answered = false;  // a sound read of the board's own; all its lanes have been driven
    TimeFs low = 0, ready_low = kNone, ready_high = kNone;
    TimeFs data_valid = kNone, data_gone = kNone;  // last moves: on all lanes; of one of them away
    bool write() const { return kind == kIoWrite || kind == kMemoryWrite; }
    bool memory() const { return kind == kMemoryRead || kind == kMemoryWrite; }
  };
  // What a port access must keep its distance from (host-bus:3.3).
  struct PortAccess {
    TimeFs end = kNone;
    bool slow = false;
  };

  static unsigned commands(const BoardInputs& in);
  static std::uint32_t address(const BoardInputs& in, bool memory);
  static unsigned lanes(const BoardInputs& in, bool memory);
  bool ours(const BoardInputs& in, const Cycle& c) const;
  int port_byte(const BoardInputs& in, const Cycle& c) const;
  TimingPlace place(TimeFs time) const { return place(time, cycle_); }
  static TimingPlace place(TimeFs time, const Cycle& c);
  Region region(const Cycle& c) const { return !c.memory() ? kIo : c.wide ? kMemory16 : kMemory8; }
  void enter(Rule rule, TimeFs required, TimeFs measured, TimeFs time) {
    ledger_.enter(rule, region(cycle_), required, measured, place(time));
  }

  void block_select(TimeFs t, const BoardInputs& before, const BoardOutputs& shown);
  void block_overdue(TimeFs t, const BoardInputs& in);
  void block_selected(TimeFs t, const BoardInputs& in);
  void address_moved(TimeFs t);
  void host_data_moved(TimeFs t);
  void begin(TimeFs t, unsigned commands, const BoardInputs& in, const BoardOutputs& out);
  void end(TimeFs t, const BoardInputs& in, const BoardOutputs& out);
  TimeFs data_limit() const;
  void end_read(TimeFs t);
  void end_write(TimeFs t, const BoardInputs& in, const BoardOutputs& out);
  void port_strobe(TimeFs t, const BoardInputs& in);
  void ready_moved(TimeFs t, bool ready);
  void board_data(TimeFs t, const BoardInputs& in, const BoardOutputs& out);

  TimingLedger ledger_;
  std::function<TimeFs()> cpu_period_;
  BoardInputs in_;
  BoardOutputs out_;
  bool known_ = false;     // the first pins have come
  bool in_cycle_ = false;  // a command is low
  Cycle cycle_;            // the present one, or the last
  TimeFs la_at_ = 0, sa_at_ = 0, data_at_ = 0, high_at_ = kNone;
  TimeFs awake_at_ = 0;       // the board answers from then on, when it is not in reset
  TimeFs block_due_ = kNone;  // LA selected the block of the window then, and MEMCS16# has still to fall
  bool hold_address_ = false, hold_data_ = false, read_floats_ = false;  // rules of the last cycle still to be judged
  PortAccess port_read_, port_write_;
  std::array<std::array<std::array<std::uint64_t, 2>, 2>, kKinds> cycles_{};
  std::uint64_t answered_ = 0;
};

}  // namespace brick
