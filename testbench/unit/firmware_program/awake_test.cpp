// When the background asks for another pass at once, and when it sleeps until an interrupt has something for it
// (docs/firmware.md, Tasks; docs/dpram-functions.md).
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/binary_buffer.h"
#include "testbench/unit/firmware_program/dpram_host.h"

extern "C" {
#include "firmware/kernel/background.h"
}

namespace {

using platform::background;
using platform::host;

class Awake : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1"), "");
    background(50);
  }
  // A pass as the main program makes it: did it ask for the next?
  static bool goes_on() {
    background_work = 0;
    background(1);
    return background_work != 0;
  }
  static unsigned passes_until_it_sleeps() {
    unsigned passes = 1;
    while (goes_on() && passes < 1000) ++passes;
    return passes;
  }

  platform::NativeDpram ram;
};

TEST_F(Awake, NothingToDo) { EXPECT_EQ(passes_until_it_sleeps(), 1u); }

// host-bus:6.5/2: a coordinate system a pass.
TEST_F(Awake, UntilASetOfCoordinateSystemsIsWhole) {
  for (const unsigned systems : {1u, 2u, 5u, 16u}) {
    ASSERT_EQ(host("I49=0 I50=255"), "");
    background(1);
    platform::servo_ticks(1);
    ram.write(DPRAM_BACKGROUND_COUNT, static_cast<std::uint16_t>(systems));
    ASSERT_EQ(host("I49=1"), "");
    EXPECT_EQ(passes_until_it_sleeps(), systems);
    EXPECT_EQ(passes_until_it_sleeps(), 1u) << "the next is not due";
  }
}

// host-bus:6.4/6: two motors a pass.
TEST_F(Awake, UntilASetOfMotorsIsWhole) {
  for (const unsigned motors : {1u, 2u, 3u, 8u}) {
    ASSERT_EQ(host("I57=0 I50=255"), "");
    background(1);
    platform::servo_ticks(1);
    dpram_write_item(DPRAM_MOTOR_MASK, (1u << motors) - 1u);
    ASSERT_EQ(host("I57=1"), "");
    EXPECT_EQ(passes_until_it_sleeps(), (motors + 1) / 2);
    EXPECT_EQ(passes_until_it_sleeps(), 1u) << "the next is not due";
  }
}

// host-bus:6.7/6: 16 entries a pass.
TEST_F(Awake, UntilAListOfWordsIsRead) {
  ASSERT_EQ(host("I55=1"), "");
  for (const unsigned entries : {1u, 16u, 17u, 128u}) {
    ram.write(DPRAM_READ_CONTROL, 0);
    ram.write(DPRAM_READ_START, 0x100);
    ram.write(DPRAM_READ_SIZE, static_cast<std::uint16_t>(entries));
    EXPECT_EQ(passes_until_it_sleeps(), (entries + 15) / 16);
  }
}

// For 2 ms after its last use, and while a response waits for its host, half a second at most.
TEST_F(Awake, WhileTheHostOfTheRamIsThere) {
  ASSERT_EQ(host("I58=1"), "");
  EXPECT_EQ(passes_until_it_sleeps(), 1u) << "it has not been used";
  platform::DpramHost ram_host(ram);
  const std::uint32_t ms = hal_cycles_per_ms();
  for (const char* line : {"P1=1", "P1"}) {
    EXPECT_TRUE(ram_host.send(line));
    while (ram_host.take(3)) {}
    EXPECT_TRUE(goes_on());
    fake_hal_pass(2 * ms);
    EXPECT_TRUE(goes_on());
    fake_hal_pass(1);
    EXPECT_FALSE(goes_on());
    EXPECT_FALSE(goes_on());
  }
  ASSERT_TRUE(ram_host.control(0x10));
  background(1);
  fake_hal_pass(500 * ms);
  EXPECT_TRUE(goes_on()) << "a response stands there";
  fake_hal_pass(2 * ms + 1);
  EXPECT_FALSE(goes_on()) << "nobody takes it";
  while (ram_host.take(3)) {}
  ASSERT_EQ(host("I58=0"), "");
  EXPECT_FALSE(goes_on());
}

// docs/rotary.md: a header that is enabled and not held.
TEST_F(Awake, WhileABinaryHeaderIsEnabled) {
  for (int i = 0; i < 3; ++i) {  // a pass may take a slice, half of a real-time period
    platform::pass_us(442);
    platform::servo_ticks(1);
  }
  platform::BinaryBuffer buffer;
  buffer.set_up();
  EXPECT_FALSE(goes_on()) << "nothing is open";
  ASSERT_EQ(host("DEF ROT 5 OPEN BIN ROT"), "");
  EXPECT_TRUE(goes_on());
  EXPECT_TRUE(goes_on());
  for (const char* line : {"X1 Y1 Z1", "X2 Y2 Z2"}) buffer.put(line);
  background(2);
  EXPECT_FALSE(goes_on()) << "the ring is full";
  ASSERT_EQ(host("CLEAR"), "");
  EXPECT_TRUE(goes_on());
  buffer.write(DPRAM_ROTARY_ENABLE, 0);
  background(1);
  EXPECT_FALSE(goes_on());
}

// A command of a program a pass.
TEST_F(Awake, UntilCommandsOfProgramsAreExecuted) {
  for (const char* line : {"OPEN PLC 1 CLEAR", "CMD\"P1=P1+1\"", "CMD\"P1=P1+1\"", "CMD\"P1=P1+1\"", "SEND\"A\"",
                           "DISABLE PLC 1", "CLOSE I5=2"})
    ASSERT_EQ(host(line), "") << line;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(host("P1=0 ENABLE PLC 1"), "");
    EXPECT_LT(passes_until_it_sleeps(), 20u) << "a statement a pass, then the commands";
    EXPECT_EQ(platform::sent(), "A\r");
    EXPECT_EQ(host("P1"), "3");
    EXPECT_FALSE(goes_on());
  }
}

// Its characters bring the interrupts that wake.
TEST_F(Awake, NotForAHostThatDoesNotRead) {
  for (const char* line : {"OPEN PLC 1 CLEAR", "SEND\"A\"", "DISABLE PLC 1", "CLOSE I5=2 ENABLE PLC 1"})
    ASSERT_EQ(host(line), "") << line;
  host_port_open_output();
  while (host_port_room() != 0) host_port_send('x');
  background(5);
  ASSERT_FALSE(text_queue_is_empty(&send_queues[PROGRAM_BACKGROUND]));
  EXPECT_FALSE(goes_on());
  EXPECT_EQ(platform::sent().size(), 4096u);
  background(1);
  EXPECT_EQ(platform::sent(), "A\r");
}

}  // namespace
