#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/image/background_pass.h"
#include "firmware/image/start.h"
}

namespace brick {
namespace {

std::string output() {
  std::uint32_t length = 0;
  const char* text = fake_host_output(&length);
  return std::string(text, length);
}

}  // namespace

Controller::Controller(unsigned fitted, bool client_settings) {
  fake_hal_power_on(fitted);
  start();
  if (client_settings) send("I6=1 I3=2\r");
}

void Controller::start() {
  hal_interrupts_off();  // as a reset does
  host_port_initialize();
  line_input_initialize();
  ::start(START_SAVED);
  output();
}

std::string Controller::restart() {
  start();
  return output();
}

std::string Controller::send(const std::string& characters) {
  if (fake_interrupts_are_on()) return send_by_interrupts(characters);
  for (const char c : characters) {
    host_port_character(static_cast<std::uint8_t>(c));
    if (c == '\r') background_pass();
  }
  do { background_pass(); } while (host_port_waiting());
  return output();
}

// Each character comes when its interrupt does, whatever the firmware is at then.
std::string Controller::send_by_interrupts(const std::string& characters) {
  for (const char c : characters) fake_host_input(static_cast<std::uint8_t>(c));
  do { background_pass(); } while (fake_host_input_waits() || host_port_waiting());
  return output();
}

std::string Controller::line(const std::string& text) {
  std::string reply;
  for (const char c : send(text + "\r")) {
    if (c == '\r')
      reply += '|';
    else if (c >= ' ')
      reply += c;
  }
  if (!reply.empty() && reply.back() == '|') reply.pop_back();
  return reply;
}

void Controller::servo(unsigned interrupts) {
  for (unsigned i = 0; i < interrupts; ++i) {
    fake_task_run_servo();
    if (hal_real_time_pending()) fake_task_run_real_time();
  }
}

}  // namespace brick
