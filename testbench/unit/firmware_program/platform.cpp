#include "testbench/unit/firmware_program/platform.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "testbench/unit/firmware_platform/fake_hal.h"

extern "C" {
#include "firmware/image/start.h"
#include "firmware/kernel/tasks.h"
#include "rtl/regs/brick_regs.h"
}

namespace platform {
namespace {

std::string output() {
  std::uint32_t length = 0;
  const char* text = fake_host_output(&length);
  return std::string(text, length);
}

}  // namespace

void power_up() {
  fake_hal_power_on(0x3);
  start(START_SAVED);
  output();
  fake_hal_set_look(0);
  clear_edges();
  longest_mask_us();
}

std::string host(const std::string& line) {
  std::string text = line, reply;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const error_t error = command_line(text.c_str());
  for (const char c : output())
    if (c != '\n') reply += c == '\r' ? '|' : c;
  if (error != ERR_NONE) {
    char number[16];
    std::snprintf(number, sizeof number, "ERR%03d", static_cast<int>(error));
    return number;
  }
  if (!reply.empty()) reply.pop_back();
  return reply;
}

void pass_us(double us) { fake_hal_pass(static_cast<std::uint32_t>(us * kCyclesPerUs)); }

void real_time() {
  EXPECT_FALSE(fake_hal_masked()) << "a section that holds a task off was not left";
  tasks_real_time_interrupt();
}

void servo_ticks(unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    tasks_servo_interrupt();
    if (!hal_real_time_pending()) continue;
    fake_hal_real_time_taken();
    real_time();
  }
}

bool breq() { return (fake_hal_signals() & HAL_SIGNAL_BREQ) != 0; }

std::vector<Edge> edges() {
  const fake_edge* list = nullptr;
  const unsigned count = fake_hal_breq_edges(&list);
  std::vector<Edge> found;
  for (unsigned i = 0; i < count; ++i) found.push_back({list[i].high, list[i].cycles / kCyclesPerUs});
  return found;
}

void clear_edges() { fake_hal_clear_breq_edges(); }
double longest_mask_us() { return fake_hal_longest_mask() / kCyclesPerUs; }

void fit_panel() {
  fake_hal_set_strap(HAL_STRAP_PRODUCT, HAL_PRODUCT_JPAN);
  *hal_y(JPAN_Y_INPUTS) = JPAN_INPUTS_RESET;
  panel_initialize();
  i_variable_write(I2_CONTROL_PANEL_DISABLE, 0);
}

void pull_panel(std::uint32_t low) { *hal_y(JPAN_Y_INPUTS) = JPAN_INPUTS_RESET & ~low; }

void panel(std::uint32_t low) {
  pull_panel(low);
  panel_pass();
  real_time();
}

void set_i(std::uint32_t number, double value) {
  const i_saved saved{value, static_cast<std::int32_t>(value)};
  i_variable_restore(number, &saved);
}

}  // namespace platform
