// Nothing that a host sends reaches past a table or lets the controller act on what it did not get: words of memory
// that a host has written over, computed indices, lines that are too long.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/firmware_platform/framing.h"
#include "testbench/unit/random_lines.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/buffers/rotary_ring.h"
#include "firmware/hal/hal.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/program_output.h"
}

namespace brick {
namespace {

std::string format(const char* text, unsigned number) {
  char line[64];
  std::snprintf(line, sizeof line, text, number);
  return line;
}

// The definition of M1 is the word at $004001: form in bits 23..20 of X, then places that a command would refuse.
TEST(Survival, DefinitionsThatAHostWroteOverAreReadAsSomeDefinition) {
  Controller c;
  for (unsigned form = 0; form < 16; ++form) {
    for (const unsigned rest : {0x00000u, 0x01F1Fu, 0xFFFFFu}) {
      EXPECT_EQ(c.line(format("WX$4001,$%X", form << 20 | rest)), "");
      EXPECT_NE(c.line("M1->"), "") << form;
      EXPECT_NE(c.line("M1"), "");
      EXPECT_EQ(c.line("M1=5"), "");
      EXPECT_EQ(c.line("P1=M1"), "");
    }
  }
  EXPECT_EQ(c.line("WX$4001,$F00000"), "") << "no such form";
  EXPECT_EQ(c.line("M1->"), "*");
}

TEST(Survival, DefinitionThatPointsAtItself) {
  Controller c;
  EXPECT_EQ(c.line("M1->X:$4001"), "");
  for (const char* value : {"$700000", "$FFFFFF", "0", "-1", "$5FFFFF"}) {
    EXPECT_EQ(c.line("M1->X:$4001"), "");
    EXPECT_EQ(c.line(std::string("M1=") + value), "");
    EXPECT_NE(c.line("M1->"), "") << value;
    EXPECT_NE(c.line("M1"), "") << value;
  }
  EXPECT_EQ(c.line("VER"), "1.947");
}

// P1 = 2^560 after four squarings of 2^35; its square is beyond a double. Nothing on the stack is infinite, so no
// difference is undefined: P(0) gets the 5.
TEST(Survival, ComputedIndexIsANumber) {
  Controller c;
  EXPECT_EQ(c.line("P1=34359738368"), "");
  for (int i = 0; i < 4; ++i) EXPECT_EQ(c.line("P1=P1*P1"), "");
  EXPECT_EQ(c.line("P0=7 P(P1*P1-P1*P1)=5"), "");
  EXPECT_EQ(c.line("P0"), "5");
  EXPECT_EQ(c.line("P(P1*P1)"), "ERR003");
  EXPECT_EQ(c.line("P(-P1*P1)=1"), "ERR003");
  EXPECT_EQ(c.line("P2=SIN(P1*P1)+COS(P1*P1)%(P1*P1)-INT(P1*P1)"), "");
  EXPECT_NE(c.line("P2"), "");
}

TEST(Survival, LineThatWasTooLongIsTheLineThatIsLeft) {
  Controller c;
  const std::string start = "P1=1";
  const auto blanks = [&start](unsigned length) { return start + std::string(length - start.size(), ' '); };
  EXPECT_EQ(c.line("P1=5"), "");
  EXPECT_EQ(c.line(blanks(300) + std::string(44, '\b')), "ERR003") << "256 characters are left";
  EXPECT_EQ(c.line("P1"), "5");
  EXPECT_EQ(c.line(blanks(300) + std::string(45, '\b')), "") << "255";
  EXPECT_EQ(c.line("P1"), "1");
  EXPECT_EQ(c.line(blanks(300) + std::string(299, '\b') + "1=2"), "") << "P is left";
  EXPECT_EQ(c.line("P1"), "2");
  EXPECT_EQ(c.line(blanks(255) + "\"" + std::string(255, '\b') + "3=8 p3=9"), "") << "the quote was not kept";
  EXPECT_EQ(c.line("P3"), "9");
}

// Words of a rotary buffer with marks where no line starts and without marks where one does.
TEST(Survival, RotaryWordsThatAHostWroteOver) {
  for (const unsigned mark : {0u, 0x800000u, 0xFFFFFFu, 0x7FFFFFu, 0x712345u}) {
    Controller c;
    EXPECT_EQ(c.line("&1DEF ROT 100 B0 OPEN ROT"), "");
    for (int i = 0; i < 8; ++i) EXPECT_EQ(c.line("P1=P1+0.1*2 X(P2+0.3)"), "");
    EXPECT_EQ(c.line("CLOSE"), "");
    for (unsigned word = 0; word < 60; word += 3)
      EXPECT_EQ(c.line(format("WX$%X", 0x10800 - 100 + word) + format(",$%X", mark)), "");
    for (int turn = 0; turn < 100; ++turn) {
      EXPECT_EQ(c.line("R"), "");
      c.servo(30);
      EXPECT_EQ(c.line("A"), "");
      c.servo(3);
    }
    EXPECT_EQ(c.line("PR"), "0");
    EXPECT_EQ(rotary_buffers[0].used, 0u);
  }
}

TEST(Survival, AxisDefinitionsAreSaved) {
  Controller c;
  EXPECT_EQ(c.line("&1#1->1000X-0.25Y+500 #2->100A &3#32->I"), "");
  EXPECT_EQ(c.line("SAVE"), "");
  EXPECT_EQ(c.line("&1#1->0 #2->0 &3#32->0"), "");
  c.restart();
  c.send("I6=1 I3=2\r");
  EXPECT_EQ(c.line("&1#1-> #2-> &3#32->"), "1000X-0.25Y+500|100A|I");
  EXPECT_EQ(c.line("&1#2->7A $$$***"), "");
  c.send("I6=1 I3=2\r");
  EXPECT_EQ(c.line("&1#1-> #2-> &3#32->"), "1000X-0.25Y+500|7A|I") << "as they were, firmware:5.10/2";
}

// What programs have queued may start them again; where they do so for ever, $$$*** takes them away.
void stop_programs(Controller& c) {
  for (unsigned round = 0; round < TEXT_QUEUE_BYTES; ++round) {
    c.send("\x18\x01\x04");
    bool waits = plc_enabled() != 0;
    for (const text_queue& queue : command_queues) waits = waits || !text_queue_is_empty(&queue);
    if (!waits) return;
  }
  c.send("\r$$$***\r");
}

// The image natively, under the address and undefined-behaviour sanitizers: an index past a table ends the test.
// BRICK_RANDOM_LINES: lines of each seed.
TEST(Survival, RandomLinesStayInsideEveryTable) {
  const char* wanted = std::getenv("BRICK_RANDOM_LINES");
  const long lines = wanted != nullptr ? std::strtol(wanted, nullptr, 10) : 4000;
  unsigned long answered = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    Controller c;
    RandomLines random(random_seed(seed));
    for (long i = 0; i < lines; ++i) {
      const std::string line = random.next();
      SCOPED_TRACE(line);
      if (!c.send(line + "\r").empty()) ++answered;
      c.servo(3);
      if (::testing::Test::HasFailure()) return;
    }
    stop_programs(c);
    c.send("\rCLOSE\r");
    c.send("I4=0 I6=1 I3=2\r");
    EXPECT_EQ(c.line("VER"), "1.947");
  }
  EXPECT_GT(answered, 2 * static_cast<unsigned long>(lines)) << "of three times as many";
}

}  // namespace
}  // namespace brick
