// Binary lines from a host on the bus to the ring of a machine with the real firmware (host-bus:7).
#include "testbench/host/binary_rotary.h"

#include "rtl/regs/dpram_map.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class BinaryTransfer : public Controller {
 protected:
  bool breq() { return machine().outputs().get(pin::kBreq) != 0; }
  // Until all has been copied.
  void settle(BinaryRotary& rotary) {
    for (unsigned tries = 0; !rotary.empty(); ++tries) {
      ASSERT_LT(tries, 1000u) << "status " << rotary.status();
      wait(ns_to_ticks(10'000));
    }
  }
};

TEST_P(BinaryTransfer, LinesAreStoredListedAndExecuted) {
  BRICK_COVERS("BIN-3 BIN-5 BIN-6");
  for (const bool foreground : {false, true}) {
    start();
    ASSERT_EQ(ask(foreground ? "I45=1" : "I45=0"), "");
    ASSERT_EQ(ask("DEF ROT 200 B0 OPEN BIN ROT"), "");
    BinaryRotary rotary(bus(), 1);
    ASSERT_EQ(rotary.define(0, 64), BinaryResult::kOk);
    rotary.enable();
    for (const char* line : {"INC TA0 TS0 TM5", "X10 Y-2.5", "P1=7 P5000=-3", "F100 X1"})
      ASSERT_EQ(rotary.put(line), BinaryResult::kOk) << line;
    ASSERT_NO_FATAL_FAILURE(settle(rotary));
    EXPECT_EQ(rotary.status(), 0u);
    EXPECT_EQ(ask("PR"), "4");
    EXPECT_EQ(ask("LIST ROT"), "INC TA0TS0TM5|X10Y-2.5|P1=7P5000=-3|F100X1");
    ASSERT_EQ(ask("R"), "");
    wait(ms_to_ticks(15));
    EXPECT_EQ(ask("P1 P5000 PR"), "7|-3|0");
  }
}

BRICK_ON_ENGINES(BinaryTransfer, Engine::kRtl, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
