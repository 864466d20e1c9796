// Binary lines from a host on the bus to the ring of a machine with the real firmware (host-bus:7).
#include "testbench/host/binary_rotary.h"

#include <sstream>

#include "testbench/benchmark/routes.h"
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

// As a program that feeds a file: as many lines as there is room for, and it goes on where it stopped.
TEST_P(BinaryTransfer, FileIsFed) {
  BRICK_COVERS("BIN-3 BIN-6");
  if (GetParam() != Engine::kSystemC) return;
  start();
  ASSERT_EQ(ask("DEF ROT 9 B0 OPEN BIN ROT"), "");
  BinaryRotary rotary(bus(), 1);
  EXPECT_EQ(rotary.put("X1"), BinaryResult::kError) << "no size";
  EXPECT_EQ(rotary.define(0, 5), BinaryResult::kError);
  EXPECT_EQ(rotary.define(15280 - 10, 12), BinaryResult::kAllocation);
  ASSERT_EQ(rotary.define(15280 - 12, 12), BinaryResult::kOk) << "the last items of the RAM";
  rotary.enable();
  std::istringstream file("X1\n; nothing\nX2\nX3\nX4\nX5\nX6\nX7\nX8\nX9\nX10\nX11\nX12\nX0.3\nX13\n");
  EXPECT_EQ(rotary.put("X1Y1Z1A1B1"), BinaryResult::kError) << "longer than the buffer";
  EXPECT_EQ(rotary.feed(file), BinaryResult::kBusy);
  wait(ms_to_ticks(1));
  EXPECT_EQ(rotary.feed(file), BinaryResult::kBusy);
  EXPECT_EQ(rotary.feed(file), BinaryResult::kBusy) << "nothing more fits until the program runs";
  ASSERT_EQ(ask("TM1 TA0"), "ERR005") << "text";
  ASSERT_EQ(ask("I5187=0 I5188=0 I5189=1000000 R"), "");
  BinaryResult result = BinaryResult::kBusy;
  for (unsigned tries = 0; result == BinaryResult::kBusy && tries < 200; ++tries) {
    wait(ms_to_ticks(5));
    result = rotary.feed(file);
  }
  EXPECT_EQ(result, BinaryResult::kFloat) << "X0.3";
  wait(ms_to_ticks(5));
  EXPECT_EQ(rotary.feed(file), BinaryResult::kEndOfFile);
  wait(ms_to_ticks(100));
  EXPECT_TRUE(rotary.empty());
  EXPECT_EQ(ask("PR"), "0");
}

// Into a large ring with the program stopped (host-bus:7.1/2): many times as fast.
TEST_P(BinaryTransfer, IsFasterThanText) {
  BRICK_COVERS("BIN-4");
  const auto speed = [](Route route) { return measure_lines_per_second(route, 4, 24, GetParam(), BRICK_FIRMWARE); };
  EXPECT_GT(speed(Route::kBinary0), 2 * speed(Route::kHostPort));
}

// The three reasons apart: characters, parsing, lines of one pass. And what I45 = 1 is for: PLCs do not delay it.
TEST_P(BinaryTransfer, ReasonsWhyItIsFaster) {
  BRICK_COVERS("BIN-4 BIN-5");
  if (GetParam() != Engine::kSystemC) return;
  const RouteSpeed text = measure_route(Route::kHostPort, 4, 24, GetParam(), BRICK_FIRMWARE);
  const RouteSpeed binary = measure_route(Route::kBinary0, 4, 24, GetParam(), BRICK_FIRMWARE);
  EXPECT_LT(2 * binary.bus_us, text.bus_us) << "four commands of 16 bytes in 21 words, for 26 characters";
  EXPECT_LT(2 * binary.cpu_cycles, text.cpu_cycles);
  EXPECT_GT(binary.lines_per_second, 1.5 * binary.lines_one_by_one);
  EXPECT_GT(measure_breq_us(Route::kBinary0, 6, true, BRICK_FIRMWARE).back(), 4000) << "a scan of a PLC";
  EXPECT_LT(measure_breq_us(Route::kBinary1, 6, true, BRICK_FIRMWARE).back(), 1600) << "a real-time interrupt";
}

BRICK_ON_ENGINES(BinaryTransfer, Engine::kRtl, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
