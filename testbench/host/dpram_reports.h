// Reports in the dual-ported RAM as host software reads them (host-bus:6.4, host-bus:6.5): busy, wait for a ready set,
// read, release.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "testbench/host/dpram_port.h"

namespace brick {

struct MotorReport {
  std::int64_t following_error, bias, master, position;  // 48 bits
  std::int32_t output, velocity;
  std::uint32_t servo_status, status;
};

struct SystemReport {
  double feed_rate;
  std::uint32_t time_base, time_base_source, status[3], lines, move_ms_left, acceleration_ms_left, executing;
  std::array<double, 9> targets;  // A B C U V W X Y Z
};

class DpramReports {
 public:
  struct Motors {
    std::uint32_t timer;
    std::vector<MotorReport> motors;  // of the bits of the mask, lowest first
  };
  struct Systems {
    std::uint32_t timer, global[2];
    std::vector<SystemReport> systems;
  };

  // Without `heeds` it reads whenever it likes, as a host must not.
  explicit DpramReports(DpramAccess& ram, bool heeds = true) : ram_(ram), heeds_(heeds) {}

  void clear_handshakes();  // before a report is turned on: what the RAM held means nothing
  void choose_motors(std::uint32_t mask);
  void choose_systems(unsigned count);
  std::optional<Motors> read_motors(Tick timeout);  // nothing: no set was ready in time
  std::optional<Systems> read_systems(Tick timeout);

  std::uint32_t item(std::uint32_t offset);
  std::int64_t fixed_long(std::uint32_t offset);
  double float_long(std::uint32_t offset);

 private:
  bool begin(std::uint32_t busy, std::uint32_t ready, Tick timeout);
  MotorReport motor(unsigned number);
  SystemReport system(unsigned number);

  DpramAccess& ram_;
  bool heeds_;
  std::uint32_t mask_ = 0;
  unsigned count_ = 0;
};

}  // namespace brick
