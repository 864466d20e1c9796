// Checker of the CPU's bus: every row of host-bus:2.2 and the conditions of host-bus:2.5, evaluated for the CPU clock
// and the wait states of each cycle from what the lines showed (timing_pins.h). The formulas are written out here from
// the data sheet; nothing is shared with the bus master (systemc/cpu/port_a_timing.h).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "testbench/checkers/timing_pins.h"
#include "testbench/checkers/timing_rules.h"

namespace brick {

// Wait states and CPU clock that a formula is for.
struct PortAConditions {
  unsigned multiplier = 8;   // I52 + 1
  unsigned wait_states = 1;  // programmed: they choose the form
  unsigned stretched = 0;    // clocks added by /TA: they lengthen what contains the strobe
};

class PortATiming {
 public:
  enum Rule : unsigned {
    k100,
    k101,
    k102,
    k103,
    k104,
    k105,
    k106,
    k107,
    k108,
    k109,
    k110,
    k111,
    k112,
    k113,
    k114,
    k115,
    k116,
    k117,
    k118,
    k119,
    kW1,
    kW2,
    kS1,
    kOneStrobe,
    kAddressStands,
    kBoardLetsGo,
    kCpuLetsGo,
    kDrivesInside,
    kEnoughWaitStates,
    kRules
  };
  enum Region : unsigned { kGateIcs, kDpram, kDefaultArea, kRegions };

  PortATiming();

  static Region region(std::uint8_t aa) { return aa == 2 ? kGateIcs : aa == 4 ? kDpram : kDefaultArea; }

  void cycle(const PinCycle& c);
  void forget();  // all evaluations, and the cycle before

  TimingLedger& ledger() { return ledger_; }
  const TimingLedger& ledger() const { return ledger_; }

  // The read with the least margin for the data (rows 104 to 106), which the board and the wait states decide.
  const std::optional<PinCycle>& worst_read() const { return worst_read_; }

  // /TA moved between a sample and the end of the strobe (rows 118, 119) and was taken as it stood after, or before.
  struct TaMoves {
    std::uint64_t seen = 0, missed = 0;
  };
  const TaMoves& ta_moves() const { return ta_moves_; }

  // What the board needs of a write, and of two strobes in a row (host-bus:2.6, host-bus:6.9/8).
  static std::optional<TimeFs> needed(Rule rule, Region region);

  // So many quarters of TC in femtoseconds, rounded down.
  static TimeFs quarters(std::int64_t count, unsigned multiplier);
  // What the formula asks for in femtoseconds, less than one in favour of the part; none: the row does not apply.
  static std::optional<TimeFs> required(Rule rule, const PortAConditions& at);

 private:
  struct Limits {
    std::array<std::optional<TimeFs>, k119 + 1> row;
  };
  const Limits& limits(const PortAConditions& at);  // until the next call
  void read(const PinCycle& c, const Limits& limits);
  void write(const PinCycle& c, const Limits& limits);
  void acknowledge(const PinCycle& c, const Limits& limits);
  void enter(Rule rule, const Limits& limits, TimeFs measured) {
    if (limits.row[rule]) ledger_.enter(rule, region_, *limits.row[rule], measured, place_);
  }
  void need(Rule rule, TimeFs measured) {
    if (const auto time = needed(rule, static_cast<Region>(region_)))
      ledger_.enter(rule, region_, *time, measured, place_);
  }
  // Between two cycles the fewer wait states count, and the faster clock.
  void between(Rule rule, const PinCycle& first, const PinCycle& c, TimeFs measured);

  TimingLedger ledger_;
  std::vector<std::optional<Limits>> cache_;  // by CPU clock and wait states, without /TA
  Limits stretched_, mixed_;                  // by the cycle with /TA that is judged
  std::optional<PinCycle> last_read_, last_write_;
  TaMoves ta_moves_;
  std::optional<PinCycle> worst_read_;
  TimeFs worst_margin_ = kForever;
  unsigned region_ = 0;  // of the cycle in hand
  TimingPlace place_;
};

}  // namespace brick
