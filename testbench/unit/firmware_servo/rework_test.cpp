// Settings that the background makes anew while the real-time task comes in between (firmware/base/rework.h).
#include <gtest/gtest.h>

extern "C" {
#include "firmware/base/rework.h"
}

namespace brick {
namespace {

TEST(Rework, WhoComesInBetweenLeavesANote) {
  struct rework r = {};
  ASSERT_TRUE(rework_begin(&r, 1));
  EXPECT_FALSE(rework_begin(&r, 4)) << "the real-time task";
  EXPECT_FALSE(rework_begin(&r, 8));
  EXPECT_EQ(rework_end(&r), 12u) << "what the background makes once more";
  EXPECT_FALSE(rework_begin(&r, 2)) << "it is at it still";
  EXPECT_EQ(rework_end(&r), 2u);
  EXPECT_EQ(rework_end(&r), 0u);
  EXPECT_TRUE(rework_begin(&r, 1)) << "it is over";
  EXPECT_EQ(rework_end(&r), 0u);
}

}  // namespace
}  // namespace brick
