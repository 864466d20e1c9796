// The command interpreter: lines and control characters as a host sends them. 0xFF lets three servo cycles pass. After
// whatever it was, the controller answers.
#include <string>

#include "testbench/fuzz/target.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/image/background_pass.h"
#include "firmware/image/start.h"
}

namespace {

constexpr std::size_t kLongest = 4096;
constexpr std::uint8_t kTimePasses = 0xFF;
constexpr std::uint32_t kErased = 0xFFFFFFFF;

// As after power-on, but for the content of the dual-ported RAM. All of it only if the last input has SAVEd.
void begin() {
  static bool powered = false;
  if (!powered || hal_flash()[0] != kErased) fake_hal_power_on(0x3);
  powered = true;
  host_port_initialize();
  line_input_initialize();
  start(START_DEFAULTS);
  fake_hal_slices_leave(true);
}

void passes() {
  do { background_pass(); } while (host_port_waiting());
}

std::string output() {
  std::uint32_t length = 0;
  const char* text = fake_host_output(&length);
  return std::string(text, length);
}

void time_passes() {
  for (int i = 0; i < 3; ++i) {
    fake_task_run_servo();
    if (hal_real_time_pending()) fake_task_run_real_time();
  }
}

std::string answer(const char* characters) {
  passes();
  (void)output();
  for (; *characters != '\0'; ++characters) host_port_character(static_cast<std::uint8_t>(*characters));
  passes();
  return output();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLongest) return 0;
  begin();
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == kTimePasses) {
      time_passes();
      continue;
    }
    host_port_character(data[i]);
    if (data[i] == '\r') passes();
    if (i % 256 == 255) passes();  // the queue holds 2048
  }
  (void)answer("\x18");
  (void)answer("\x01\rCLOSE\rI4=0 I6=1 I3=2\r");
  require(answer("VER\r") == "1.947\r\x06", "the controller does not answer");
  return 0;
}
