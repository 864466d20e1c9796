// Who drives D on Port A, judged at the board's pins as each edge and each line that moves leaves them: the board, from
// the edge that host-bus:2.6 and host-bus:6.9/8 name to the end of /RD without a clock, in reads of its own; and nobody
// of the board in any other cycle or between two. Nothing is shared with the board: strobes are told apart by their
// order, edges are counted from the one that finds /RD low.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "systemc/core/board_pins.h"
#include "systemc/core/ticks.h"

namespace brick {

class PortADrive {
 public:
  enum Cycle { kOther, kRegisters, kRam };  // who has it: another device, or a page without pins; registers; the RAM

  // The next strobe of that direction that comes to the board is of this cycle. A register's read comes to nothing if
  // /RD ends before its sample.
  void cycle(Cycle of, bool write) { (write ? writes_ : reads_).push_back(of); }
  // Lines have moved at the board after edge `now`; so does it drive D at once.
  void lines(Tick now, const PortAPins& pins, const BoardOutputs& at_once);
  void edge(Tick tick, const BoardOutputs& shown);

  unsigned faults() const { return faults_; }
  std::string text() const;  // of each kind how often, and the first
  unsigned driven(Cycle of) const { return driven_[of]; }
  unsigned met() const { return met_; }  // cycles of others that began within three ticks of an own read's end

 private:
  Tick late() const;
  void missing(Tick now);
  bool due(Tick now) const { return low_[0] && now >= on_; }
  void judge(Tick now, const BoardOutputs& shown);
  void fault(Tick now, const std::string& what);
  std::string where() const;

  std::deque<Cycle> reads_, writes_;
  bool low_[2] = {};                    // /RD, /WR
  Tick first_low_[2] = {-1000, -1000};  // the edges that found their last falls
  Cycle of_[2] = {kOther, kOther};      // of the last strobe of each
  Tick on_ = kNever, off_ = -1000;      // D by the board, as it must be; its last end
  bool drives_ = false, told_ = false;  // as it is within what is due; that it does not
  std::uint32_t word_ = 0;
  unsigned faults_ = 0, met_ = 0, driven_[3] = {};
  std::map<std::string, unsigned> kinds_;
  std::string first_;
};

}  // namespace brick
