// What the tests of fixed motion programs share: programs of &1 stored as a host does, run until they stop.
#pragma once

#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace motion_program {

using platform::host;
using Lines = std::vector<std::string>;

class MotionProgram : public FirmwareTest {
 protected:
  static void store(unsigned number, const Lines& lines) {
    ASSERT_EQ(host("OPEN PROG " + std::to_string(number) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  // Until it has stopped; false: it has not in `ticks` servo interrupts.
  static bool finish(unsigned ticks = 20000) {
    for (unsigned i = 0; i < ticks && run_is_running(0); i += 3) platform::servo_ticks(3);
    return !run_is_running(0);
  }
  static void run(const Lines& lines) {
    store(1, lines);
    ASSERT_EQ(host("B1R"), "");
    ASSERT_TRUE(finish());
  }
  static double p(unsigned number) { return p_variable_read(number); }
  static double q(unsigned number) { return q_variable_read(0, number); }
  static double x() { return coordinate_systems[0].position[AXIS_X]; }
  static bool error() { return (motion_cs_status(0, 1) >> 22 & 1u) != 0; }
};

}  // namespace motion_program
