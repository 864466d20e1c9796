// Where flip-flops and memory start (testbench/unit/rtl/verilated_shell.h): at random, by the seed. A reset takes that
// away; what has none keeps it, and is found by the comparison with the model.
#include <gmock/gmock.h>

#include "testbench/unit/host/dpram_bench.h"

namespace brick {
namespace {

TEST(StartValues, AreGoneAfterReset) {
  const Outputs from_zero = make_rtl_interrupt_controller(0).outputs();
  for (int seed = 1; seed < 20; ++seed)
    EXPECT_EQ(make_rtl_interrupt_controller(seed).outputs(), from_zero) << "seed " << seed;
}

// The memory of the DPRAM is all that a board has without reset.
TEST(StartValues, OfWhatIsNotResetAreFound) {
  DpramBench at_random(false, 7);
  at_random.cpu_write(5, 0x1234);
  at_random.cpu_read(5);
  EXPECT_LOCKSTEP(at_random.both) << "written";
  at_random.cpu_read(6);
  EXPECT_THAT(at_random.both.difference(), ::testing::HasSubstr(": cpu_rdata: RTL ")) << "never written";
}

}  // namespace
}  // namespace brick
