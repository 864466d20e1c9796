// The command interpreter: lines and control characters as a host sends them. 0xFF lets three servo cycles pass. Inputs
// of an odd length come while eight motors move. After whatever it was, programs can be stopped, and then the
// controller answers with nothing between.
#include <algorithm>
#include <iterator>
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
#include "firmware/run/plc_control.h"
#include "firmware/run/program_output.h"
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
  (void)output();
  for (; *characters != '\0'; ++characters) host_port_character(static_cast<std::uint8_t>(*characters));
  passes();
  return output();
}

// Eight motors whose loops are closed jog for ever, whatever comes then; their encoders stand still.
void move_motors() {
  (void)answer("I192,8,100=0 I111,8,100=0 I124,8,100=$120001 I100,8,100=1\r");
  for (const char* line : {"#1J+#2J-#3J+#4J-\r", "#5J+#6J-#7J+#8J-\r"})
    require(answer(line) == "\x06", "the motors do not jog");
  time_passes();
  time_passes();
}

bool command_waits() {
  return std::any_of(std::begin(command_queues), std::end(command_queues),
                     [](const text_queue& queue) { return !text_queue_is_empty(&queue); });
}

// A command that a program has queued may start it again behind ^D. Where one queues the next for ever, $$$*** takes
// the programs away.
void stop_programs() {
  constexpr int kMostQueued = TEXT_QUEUE_BYTES;
  passes();
  for (int round = 0; round < kMostQueued; ++round) {
    const bool may_start = command_waits();
    (void)answer("\x18\x01\x04");
    if (plc_enabled() == 0 && !command_waits()) return;
    require(may_start, "^D leaves a PLC running");
  }
  (void)answer("\r$$$***\r");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLongest) return 0;
  begin();
  if (size % 2 == 1) move_motors();
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == kTimePasses) {
      time_passes();
      continue;
    }
    host_port_character(data[i]);
    if (data[i] == '\r') passes();
    if (i % 256 == 255) passes();  // the queue holds 2048
  }
  stop_programs();
  (void)answer("\rCLOSE\rI4=0 I6=1 I3=2\r");
  require(answer("VER\r") == "1.947\r\x06", "the controller does not answer");
  return 0;
}
