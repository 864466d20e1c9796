// Talks to the controller as host software does: sends command lines, collects replies, understands the framing of
// I3 and I6 (firmware.md section 6).
#pragma once

#include <string>
#include <vector>

#include "testbench/host/host_bus.h"

namespace brick {

struct Reply {
  std::vector<std::string> lines;  // data lines without framing, error as "ERRnnn" in the last one
  std::string raw;                 // every byte received
  bool error = false;              // BELL was received
  bool complete = false;           // false: time-out
};

class HostLink {
 public:
  explicit HostLink(HostBus& bus) : bus_(bus) {}

  // Waits for the firmware and selects I3=2, I6=1, I4=0 as host programs do. False when nothing answers within `timeout`.
  bool connect(Tick timeout);
  // Sends `line` and CR, returns the reply. Control characters may be inside.
  Reply command(const std::string& line);
  Reply command(const std::string& line, Tick timeout);
  HostBus& bus() { return bus_; }

 private:
  HostBus& bus_;
};

}  // namespace brick
