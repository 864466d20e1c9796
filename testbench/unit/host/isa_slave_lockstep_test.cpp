// The ISA slave and its model through random cycles, switches and resets; and that the comparison sees a slave that is
// wired wrongly.
#include "testbench/unit/host/isa_slave_fixture.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

TEST_F(IsaSlaveTest, RandomCyclesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    random_run(random_seed(seed), 6000);
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

TEST(IsaSlaveOnABoard, RandomCyclesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    IsaBench board(true);
    board.random_run(random_seed(seed), 3000);
    ASSERT_EQ(board.both.difference(), "") << "seed " << seed;
  }
}

TEST_F(IsaSlaveTest, ComparisonSeesAWrongBaseAddress) {
  both.mutate = [](Inputs& in) { in.io_base ^= 0x80; };
  io_read(0x212);
  EXPECT_NE(both.difference(), "");
}

TEST_F(IsaSlaveTest, ComparisonSeesAnAddressBitThatIsNotCompared) {
  both.mutate = [](Inputs& in) { in.io_decode16 = false; };
  both.ref(2);
  io_read(0x210 ^ 0x8000);
  EXPECT_NE(both.difference(), "");
}

TEST_F(IsaSlaveTest, ComparisonSeesLaThatIsNotCompared) {
  both.mutate = [](Inputs& in) { in.slot8 = true; };
  both.ref(2);
  mem_write(0x1D0000, 1);
  EXPECT_NE(both.difference(), "");
}

}  // namespace
}  // namespace brick
