// The firmware natively, function by function: one host line, one servo interrupt, one background pass at a time, on
// the fake hardware of testbench/unit/firmware_platform. Time stands still but where a test or a busy wait passes it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#define error_t firmware_error_t  // the C library has a type of this name
extern "C" {
#include "firmware/base/mathematics.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/program_password.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/command/command.h"
#include "firmware/command/session.h"
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/panel.h"
#include "firmware/language/axis_constant.h"
#include "firmware/language/evaluator.h"
#include "firmware/language/expression.h"
#include "firmware/language/operators.h"
#include "firmware/language/statement.h"
#include "firmware/language/statement_key.h"
#include "firmware/language/statement_table.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motion_status.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/program_output.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"
#include "firmware/variables/pq_variables.h"
}

namespace platform {

constexpr double kCyclesPerUs = 78.6432;  // 117.9648 MHz * 8/12, I52 = 7
constexpr std::int32_t kDefaultI10 = 3713991;

struct Edge {
  bool high;
  double us;
};

void power_up();                                               // a Geo Brick, as after power-on
void reset(const std::string& command = "$$$");                // memory is as saved
std::string host(const std::string& line);                     // reply lines joined by `|`, or `ERRnnn`
std::vector<std::string> host_lines(const std::string& line);  // the same, a string a reply line
void pass_us(double us);                                       // time passes in the background task
void background(unsigned passes);  // of the background task; sent() has what programs have sent
std::string sent();                // every byte since the last reply or call
void servo_ticks(unsigned count);  // servo interrupts, the real-time task after every third (I8 = 2)
void real_time();                  // one real-time interrupt alone
void real_time_in_slices(const std::function<void()>& between);  // the same, left wherever it can be: `between` acts
bool breq();                                                     // level of the pin
std::vector<Edge> edges();                                       // since the last clear_edges()
void clear_edges();
double longest_mask_us();                        // longest time that a task was held off
void fit_panel();                                // a Turbo PMAC with JPAN; I2 = 0
void pull_panel(std::uint32_t low);              // inputs pulled low, as 1
void panel(std::uint32_t low);                   // the same, a background pass and a real-time task
void set_i(std::uint32_t number, double value);  // without telling anybody

}  // namespace platform

class FirmwareTest : public ::testing::Test {
 protected:
  void SetUp() override { platform::power_up(); }
};
