// The binary rotary transfer on the native firmware, as its tests see it: buffers in the dual-ported RAM, rings,
// passes.
#pragma once

#include <cctype>
#include <cstdlib>
#include <random>

#include "testbench/host/binary_commands.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_program/binary_buffer.h"
#include "testbench/unit/firmware_program/program_generator.h"

extern "C" {
#include "firmware/host/binary_rotary.h"
#include "firmware/language/binary_word.h"
}

namespace binary_rotary {

using brick::binary_line;
using brick::BinaryCommand;
using brick::BinaryLine;
using brick::BinaryResult;
using platform::host;

using Buffer = platform::BinaryBuffer;
inline constexpr BinaryCommand kEnd = Buffer::kEnd;

inline std::vector<word48_t> ring(unsigned cs = 1) {
  const rotary& r = rotary_buffers[cs - 1];
  std::vector<word48_t> words;
  for (std::uint32_t i = 0; i < r.used; ++i) words.push_back(user_memory_read(r.base + (r.read + i) % r.size));
  return words;
}

class BinaryRotary : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    period();
  }
  // Servo interrupts and one real-time task; a slice is half of this time.
  static void period() {
    for (int i = 0; i < (fake_interrupts_are_on() ? 300 : 3); ++i) {
      platform::pass_us(442);
      platform::servo_ticks(1);
    }
  }
  static void open(const std::string& definitions = "DEF ROT 100") {
    ASSERT_EQ(host(definitions), "");
    ASSERT_EQ(host("OPEN BINARY ROTARY"), "");
  }
  // With interrupts anywhere there is next to no time between them: a pass looks at one header, and at one command.
  static void pass() { platform::background(fake_interrupts_are_on() ? 300 : 1); }
};

inline constexpr std::uint32_t kHalf = 0x400000;  // 0.5 x 2^n

inline constexpr std::uint32_t kError = 0x8000, kBusy = 0x4000;

}  // namespace binary_rotary
