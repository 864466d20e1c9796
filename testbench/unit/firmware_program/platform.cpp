#include "testbench/unit/firmware_program/platform.h"

#include <cctype>
#include <cstdio>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

extern "C" {
#include "firmware/hal/gate_ic.h"
#include "firmware/host/line_input.h"
#include "firmware/image/background_pass.h"
#include "firmware/image/start.h"
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

// Nothing is connected: fault inputs are pulled up (servo-ic:5.15/6), which is no fault for Ixx24 bit 23 = 0.
void no_amplifiers() {
  for (unsigned ic = 0; ic < 2; ++ic)
    for (std::uint32_t channel = 0; channel < GATE_IC_CHANNELS; ++channel)
      *hal_x(gate_ic_base(ic) + 8 * channel) |= SERVO_CHANNEL_STATUS_FAULT_MASK;
}

void power_up() {
  fake_hal_power_on(0x3);
  no_amplifiers();
  host_port_initialize();  // as the image's main program
  line_input_initialize();
  start(START_SAVED);
  output();
  fake_hal_set_look(0);
  clear_edges();
  longest_mask_us();
}

void reset(const std::string& command) {
  fake_hal_set_look(100);  // the start waits for clocks
  EXPECT_EQ(host(command), "");
  fake_hal_set_look(0);
}

std::vector<std::string> host_lines(const std::string& line) {
  std::string text = line;
  bool quoted = false;
  for (char& c : text) {  // as firmware/host/line_input.c
    if (c == '"') quoted = !quoted;
    if (!quoted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  const error_t error = command_line(text.c_str());
  EXPECT_FALSE(fake_hal_masked()) << "a section that holds a task off was not left: " << line;
  std::vector<std::string> lines;
  std::string reply;
  for (const char c : output()) {
    if (c == '\r') lines.push_back(reply);
    if (c == '\r')
      reply.clear();
    else if (c != '\n')
      reply += c;
  }
  if (error == ERR_NONE) return lines;
  char number[16];
  std::snprintf(number, sizeof number, "ERR%03d", static_cast<int>(error));
  return {number};
}

std::string host(const std::string& line) {
  std::string reply;
  for (const std::string& part : host_lines(line)) reply += (reply.empty() ? "" : "|") + part;
  return reply;
}

void pass_us(double us) { fake_hal_pass(static_cast<std::uint32_t>(us * kCyclesPerUs)); }

void background(unsigned passes) {
  for (unsigned i = 0; i < passes; ++i) background_pass();
}

std::string sent() { return output(); }

void real_time() {
  EXPECT_FALSE(fake_hal_masked()) << "a section that holds a task off was not left";
  unsigned slices = 0;  // the round of an endless program does not end
  do { fake_task_run_real_time(); } while (fake_hal_slice_is_left() && fake_interrupts_are_on() && ++slices < 500);
}

void real_time_in_slices(const std::function<void()>& between) {
  static const std::function<void()>* action;
  action = &between;
  fake_hal_on_pause([] { (*action)(); });
  real_time();
  fake_hal_on_pause(nullptr);
}

void servo_ticks(unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    fake_task_run_servo();
    if (hal_real_time_pending()) real_time();
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
  i_variable_restore_float(number, value);  // takes what is no integer, the other the rest
  i_variable_restore_integer(number, static_cast<std::int32_t>(value));
}

}  // namespace platform
