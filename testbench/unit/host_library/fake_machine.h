// A machine of pins alone, linked instead of the real one: records when the host changes a pin, and answers I/O reads
// from a host port with a scripted controller behind it. Outputs appear at once.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"

namespace brick {

struct FakeMachine {
  struct Change {
    Tick seen;
    BoardInputs before, after;
  };  // `seen`: the first edge that sees it
  std::vector<Change> changes;
  bool records = true;                                        // them
  std::deque<std::uint8_t> to_host;                           // characters of the controller
  bool takes = true;                                          // TXDE: the host may send
  std::optional<std::uint8_t> port_status;                    // read in place of the host port's
  std::string line;                                           // characters of the host up to CR
  std::function<std::string(const std::string&)> controller;  // line without CR -> bytes of the answer
  std::function<std::string(char)> control;                   // other control characters -> bytes of the answer
  Tick thinking = 0;                   // from a line to its answer; what is asked meanwhile is answered behind it
  std::function<std::string()> sends;  // what a program does, for ever: behind answers and where nothing else is said
  Tick sends_every = 0;
  std::deque<std::pair<Tick, std::string>> later;  // answers that are being thought of
  std::map<std::uint32_t, std::uint8_t> io;        // other I/O bytes by offset, written and read back
  std::map<std::uint32_t, std::uint16_t> memory;
  std::vector<std::pair<Tick, BoardOutputs>> planned;   // outputs from that edge on, in order
  Tick ready_low_from = kNever, ready_low_to = kNever;  // IOCHRDY
  PciBridge* bridge = nullptr;                          // of a board that has one

  static FakeMachine& last();  // of the Machine made last
};

}  // namespace brick
