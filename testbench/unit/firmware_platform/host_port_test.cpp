// The host port's queues (host-bus:8.7, host-bus:8.5/3, motion:1.6/3): how much goes at once, when a full queue is open
// again, and a host that does not read.
#include <gtest/gtest.h>

#include <algorithm>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/image/background_pass.h"
#include "firmware/motion/motor.h"
}

namespace brick {
namespace {

class HostPort : public ::testing::Test {
 protected:
  void SetUp() override { waits = 0; }
  void TearDown() override {
    motors_enabled = 0;
    fake_hal_on_wait(nullptr);
  }
  // What the host port's interrupts take and send until none comes any more.
  struct Traffic {
    unsigned taken = 0, sent = 0;
  };
  static Traffic interrupts() {
    const std::uint32_t received = host_port_received_count, room = host_port_room();
    while (fake_task_take(FAKE_HOST)) {}
    return {host_port_received_count - received, host_port_room() - room};
  }
  static std::string read_all() {
    std::uint32_t length = 0;
    const char* text = fake_host_output(&length);
    return {text, length};
  }
  static void host_sends(unsigned count) {
    for (unsigned i = 0; i < count; ++i) fake_host_input('x');
  }
  static void reply_of(unsigned count) {
    host_port_open_output();
    for (unsigned i = 0; i < count; ++i) host_port_send('y');
  }
  static std::uint32_t waiting() { return host_port_received_count - host_port_taken_count; }
  // A line, while the host reads nothing but what it reads in `waits`.
  static void unread_line(const std::string& line) {
    for (const char one : line + "\r") host_port_character(static_cast<std::uint8_t>(one));
    do { background_pass(); } while (host_port_waiting());
  }
  static unsigned waits;  // of a millisecond each

  Controller c;
};
unsigned HostPort::waits;

// motion:1.6/3: both ways together, however full the queue is.
TEST_F(HostPort, EightCharactersAPhasePeriodWhileAMotorIsEnabled) {
  const struct {
    unsigned waiting, input, output;
  } cases[] = {{0, 100, 0},    {0, 0, 100},    {0, 5, 100},    {2000, 100, 0},  {2032, 8, 100}, {2040, 0, 100},
               {2041, 0, 100}, {2045, 0, 100}, {2041, 7, 100}, {2045, 20, 100}, {2048, 0, 100}};
  for (const auto& on : cases) {
    SCOPED_TRACE(std::to_string(on.waiting) + " wait, " + std::to_string(on.input) + " come, " +
                 std::to_string(on.output) + " go");
    Controller anew;
    host_sends(on.waiting);
    EXPECT_EQ(interrupts().taken, on.waiting) << "no motor is enabled";
    motors_enabled = 1;
    host_sends(on.input);
    reply_of(on.output);
    ASSERT_TRUE(fake_task_take(FAKE_PHASE));
    const bool gets_full = on.waiting + std::min(on.input, 24u) >= 2048;
    for (int period = 0; period < 3; ++period) {
      const Traffic t = interrupts();
      EXPECT_LE(t.taken + t.sent, 8u);
      if (!gets_full && on.input + on.output >= 24) { EXPECT_EQ(t.taken + t.sent, 8u); }
      EXPECT_EQ(interrupts().taken, 0u) << "until the next phase interrupt";
      host_port_reserve();
      EXPECT_FALSE(fake_task_take(FAKE_HOST)) << "a servo interrupt is none";
      ASSERT_TRUE(fake_task_take(FAKE_PHASE));
    }
    motors_enabled = 0;
    host_port_reserve();
    const Traffic rest = interrupts();
    EXPECT_EQ(read_all().size(), on.output) << rest.sent;
  }
}

TEST_F(HostPort, WhatIsHeldGoesOnWhenTheLastMotorIsKilled) {
  motors_enabled = 1;
  host_sends(30);
  ASSERT_TRUE(fake_task_take(FAKE_PHASE));
  EXPECT_EQ(interrupts().taken, 8u);
  motors_enabled = 0;
  EXPECT_EQ(interrupts().taken, 0u);
  host_port_reserve();
  EXPECT_EQ(interrupts().taken, 22u);
}

// host-bus:8.7/2. It is open again when fewer than half of them wait, whoever takes them.
TEST_F(HostPort, AFullQueueIsOpenAgainWhenHalfOfItIsTaken) {
  host_sends(2050);
  EXPECT_EQ(interrupts().taken, 2048u);
  std::uint8_t one = 0;
  bool flushed = false;
  for (unsigned calls = 1; calls <= 1025; ++calls) {  // the first of them find 2048, 2047 ... 1024
    ASSERT_TRUE(host_port_take(&one, &flushed));
    ASSERT_EQ(interrupts().taken, 0u) << waiting();
  }
  ASSERT_TRUE(host_port_take(&one, &flushed));
  EXPECT_EQ(interrupts().taken, 2u);

  Controller anew;
  host_sends(2050);
  EXPECT_EQ(interrupts().taken, 2048u);
  const std::uint8_t* text = nullptr;
  EXPECT_GE(host_port_text(&text, &flushed), 1024u);
  host_port_text_taken(1023);
  EXPECT_EQ(interrupts().taken, 0u);
  EXPECT_GE(host_port_text(&text, &flushed), 1u);
  host_port_text_taken(1);
  EXPECT_EQ(interrupts().taken, 0u) << "half of it";
  EXPECT_GE(host_port_text(&text, &flushed), 1u);
  host_port_text_taken(1);
  EXPECT_EQ(interrupts().taken, 2u);
  host_port_text_taken(waiting());
}

// host-bus:8.5/3. It is not waited for again until it has read.
TEST_F(HostPort, AHostThatWasGivenUpIsWaitedForAgainWhenItReads) {
  fake_hal_set_look(0);  // no time but that of the waits
  fake_hal_on_wait([] { ++waits; });
  unread_line("P0..8191");
  EXPECT_GE(waits, 500u);
  waits = 0;
  unread_line("VER");
  unread_line("P0..100");
  EXPECT_EQ(waits, 0u);
  EXPECT_EQ(host_port_room(), 0u) << "what was queued stays";
  std::uint8_t first = 0;
  ASSERT_TRUE(host_port_next_output(&first));
  unread_line("P0..100");
  EXPECT_GE(waits, 500u) << "it has read one";
  waits = 0;
  unread_line("VER");
  EXPECT_EQ(waits, 0u);
  EXPECT_EQ(read_all().size(), 4096u);
  unread_line("VER");
  EXPECT_EQ(read_all(), "1.947\r\x06");
}

// Wherever in the queue of what is sent.
TEST_F(HostPort, ControlXIsEchoedBehindAnyReply) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(c.send("P0..8191\r").size(), 8192u * 2 + 1);
    EXPECT_EQ(c.send("\x18"), "\x18");
    EXPECT_EQ(c.send("VER\r"), "1.947\r\x06");
    EXPECT_EQ(c.send("\x18"), "\x18");
  }
}

// firmware:6.1/3: ^A ^D ^K ^O ^Q are not left to the background.
TEST_F(HostPort, FiveControlCharactersAskForTheRealTimeTask) {
  for (unsigned character = 0; character < 256; ++character) {
    fake_task_run_real_time();
    ASSERT_FALSE(hal_real_time_pending());
    host_port_character(static_cast<std::uint8_t>(character));
    const bool urgent = std::string("\x01\x04\x0B\x0F\x11").find(static_cast<char>(character)) != std::string::npos;
    EXPECT_EQ(hal_real_time_pending(), urgent) << character;
    EXPECT_EQ(host_port_urgent(), urgent ? 1u << character : 0u) << character;
  }
}

}  // namespace
}  // namespace brick
