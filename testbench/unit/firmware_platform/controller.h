// The firmware on fake hardware, as a host sees it: characters in, characters out. Every line is given to the receive
// queue as the host port interrupt would, then background passes run until the queue is empty.
#pragma once

#include <string>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

namespace brick {

class Controller {
 public:
  // Powers on with the ICs of BoardInputs::fitted and starts up. Then I3=2, I6=1, as every client sets them.
  explicit Controller(unsigned fitted = 0x3, bool client_settings = true);

  std::string send(const std::string& characters);  // as they are; returns every byte answered
  std::string line(
      const std::string& text);     // with CR; framing replaced: ACK dropped, CR between lines -> '|', BELL dropped
  std::string restart();            // reset line: start-up from flash
  void servo(unsigned interrupts);  // runs the servo task, and the real-time task when it is due

 private:
  void start();
  std::string send_by_interrupts(const std::string& characters);
};

}  // namespace brick
