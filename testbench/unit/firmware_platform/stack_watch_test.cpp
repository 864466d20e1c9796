// Guards and high-water marks of the stacks (firmware:1.10/20, firmware:8.4/10), on stacks that the test writes itself.
#include <gtest/gtest.h>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/hal/stacks.h"
#include "firmware/kernel/stack_watch.h"
}

namespace brick {
namespace {

constexpr unsigned kBytes = 4 * FAKE_STACK_WORDS;

void pass_all() {
  for (unsigned i = 0; i < FAKE_STACK_WORDS; ++i) stack_watch_pass();
}

TEST(StackWatch, ShowsTheBytesThatWereNeverUsed) {
  Controller c;
  pass_all();
  EXPECT_EQ(c.line("RX$73 RY$73"), std::to_string(kBytes) + "|" + std::to_string(kBytes));
  fake_hal_stack(STACK_MAIN)[FAKE_STACK_WORDS - 1] = 5;
  fake_hal_stack(STACK_MAIN)[100] = 7;  // words above it, as those of a large local variable, may never be written
  fake_hal_stack(STACK_SLICES)[200] = 0;
  pass_all();
  EXPECT_EQ(c.line("RX$73 RY$73"), "400|800");
  fake_hal_stack(STACK_MAIN)[100] = fake_hal_stack(STACK_SLICES)[199] = STACK_MARK;
  pass_all();
  EXPECT_EQ(c.line("RX$73 RY$73"), "400|800") << "the least stays";
  c.line("$$$");
  pass_all();
  EXPECT_EQ(c.line("RX$73 RY$73"), "400|800") << "also over a restart";
}

// A look is worth its time each eighth pass only.
TEST(StackWatch, LooksEachEighthPass) {
  Controller c;
  const auto looks = [] {
    *hal_x(MEMORY_STACKS) = 1;
    stack_watch_pass();
    return *hal_x(MEMORY_STACKS) != 1;
  };
  while (!looks()) {}
  for (int pass = 1; pass <= 40; ++pass) EXPECT_EQ(looks(), pass % 8 == 0) << pass;
}

TEST(StackWatch, AWordOfAGuardIsAFault) {
  for (const unsigned stack : {STACK_MAIN, STACK_SLICES})
    for (unsigned word = 0; word < STACK_GUARD_WORDS + 2u; ++word) {
      Controller c;
      fake_hal_stack(stack)[word] = 0;
      stack_watch_check();
      EXPECT_EQ(fake_hal_stack_faults(), word < STACK_GUARD_WORDS ? 1u : 0u) << stack << ", word " << word;
    }
}

}  // namespace
}  // namespace brick
