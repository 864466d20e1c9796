// Power-up and re-initialisation of the real image.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class StartUp : public Controller {};

TEST_P(StartUp, FirstReplyComesWithin20Milliseconds) {
  BRICK_COVERS("CARD-3");
  start();
  EXPECT_EQ(ask("VERSION"), "1.947");
  EXPECT_LE(machine().now(), ms_to_ticks(20));
}

TEST_P(StartUp, BrickTakesItsClocksFromServoIc0) {
  BRICK_COVERS("I19-1 I19-2 I19-3 CLK-6");
  start();
  EXPECT_EQ(ask("I19"), "7007");
  EXPECT_EQ(ask("I7007"), "0");
  EXPECT_EQ(ask("I7107"), "3");
  EXPECT_EQ(ask("I9=1"), "");
  EXPECT_EQ(ask("I19"), "I19=7007") << "I19 is decimal in every I9 mode";
  const auto source = machine().signals().find("clock.source");
  ASSERT_TRUE(source.has_value());
  EXPECT_EQ(machine().signals().value(*source), 7007u);
}

TEST_P(StartUp, GlobalStatusShowsNoHardwareProblem) {
  start();
  const std::string status = ask("???");
  ASSERT_EQ(status.size(), 12u);
  const unsigned long word1 = std::stoul(status.substr(0, 6), nullptr, 16);
  // Bits 20, 15, 13, 11, 10, 9 are problems for hosts; 7 is a configuration error, 3 a missing phase clock.
  EXPECT_EQ(word1 & ((1ul << 20) | (1ul << 15) | (1ul << 13) | (1ul << 11) | (1ul << 10) | (1ul << 9) | (1ul << 7) |
                     (1ul << 3)),
            0u)
      << status;
}

TEST_P(StartUp, ReinitialisationRestoresDefaults) {
  BRICK_COVERS("I17-1");
  start();
  ask("I16=3 I17=4 P7=11");
  EXPECT_EQ(ask("I16 I17"), "3|4");
  link().command("$$$***");
  ASSERT_TRUE(link().connect(ms_to_ticks(100)));
  EXPECT_EQ(ask("I16 I17"), "5|10");
}

TEST_P(StartUp, ResetLineStartsTheFirmwareAgain) {
  start();
  ask("&2");
  EXPECT_EQ(ask("&"), "2");
  machine().reset();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("&"), "1");
  EXPECT_EQ(ask("I19"), "7007");
}

TEST_P(StartUp, HostDoesNotWaitForATrippedController) {
  start();
  link().command("I7007=3");  // no servo clock any more: the circuit trips after 25 ms
  wait(ms_to_ticks(30));
  ASSERT_EQ(machine().outputs().get(pin::kWdo), 1u);
  const Tick begin = machine().now();
  EXPECT_FALSE(link().command("VERSION").complete);
  EXPECT_LT(machine().now() - begin, ms_to_ticks(1));
  machine().reset();
  EXPECT_TRUE(link().connect(ms_to_ticks(50))) << "the reset line brings it back";
}

BRICK_ON_ENGINES(StartUp, at_night(Engine::kRtl), Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
