// Integer divisions, roots and directions of the planner against doubles of the machine.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "testbench/unit/firmware_paths/pi.h"
#include "testbench/unit/random_seed.h"
extern "C" {
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_ratio.h"
#include "firmware/motion/fixed_turn.h"
}

namespace {

constexpr double kPart = 4611686018427387904.0;  // 2^62

TEST(Fixed, SharesAreRoundedToNearest) {
  std::mt19937_64 random(brick::random_seed(1));
  for (int i = 0; i < 20000; ++i) {
    const auto value = static_cast<std::int64_t>(random()) >> (3 + random() % 60);
    const auto part = static_cast<std::int64_t>(random()) >> (1 + random() % 3);
    const __int128 exact = static_cast<__int128>(value) * part;
    const auto expected = static_cast<std::int64_t>((exact + (static_cast<__int128>(1) << 61)) >> 62);
    ASSERT_EQ(fixed_share(value, part), expected) << value << " " << part;
  }
  EXPECT_EQ(fixed_share(1000, std::int64_t{1} << 62), 1000);
  EXPECT_EQ(fixed_share(-1000, std::int64_t{1} << 61), -500);
}

TEST(Fixed, Ratios) {
  std::mt19937_64 random(brick::random_seed(2));
  for (int i = 0; i < 20000; ++i) {
    const auto by = static_cast<std::int64_t>((random() >> (2 + random() % 60)) + 1);
    const auto value = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(by + 1));
    const double expected = static_cast<double>(value) / static_cast<double>(by);
    ASSERT_NEAR(static_cast<double>(fixed_ratio(value, by)) / kPart, expected, 1e-15) << value << " / " << by;
  }
  for (int bit = 0; bit < 62; ++bit) {
    const std::int64_t by = std::int64_t{1} << bit;
    EXPECT_NEAR(static_cast<double>(fixed_ratio(by, by)) / kPart, 1, 1e-16);
  }
}

TEST(Fixed, Fractions) {
  std::mt19937 random(brick::random_seed(5));
  for (int i = 0; i < 40000; ++i) {
    const std::uint32_t by =
        (i % 2 == 0 ? static_cast<std::uint32_t>(random()) | 0xFFFFu : random()) >> (random() % 30);
    if (by < 3) continue;
    const auto value = static_cast<std::uint32_t>(random() % ((by + 1) / 2));
    const double exact = static_cast<double>(value) * 4294967296.0 / by;
    const auto found = static_cast<double>(fixed_fraction(value, by));
    ASSERT_LE(found, exact + exact / (1 << 30)) << value << " / " << by;
    ASSERT_GE(found, exact - exact / (1 << 28) - 2) << value << " / " << by;
  }
  EXPECT_EQ(fixed_fraction(0, 5), 0u);
}

TEST(Fixed, Roots) {
  std::mt19937 random(brick::random_seed(3));
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t square = static_cast<std::uint32_t>(random()) >> (2 + random() % 30);
    const double expected = std::sqrt(square / 1073741824.0) * 1073741824.0;
    ASSERT_NEAR(fixed_root(square), expected, expected / (1 << 26) + 1) << square;
  }
  EXPECT_EQ(fixed_root(1 << 30), 1u << 30);
  EXPECT_EQ(fixed_root(0), 0u);
}

TEST(Fixed, Directions) {
  constexpr double kTurn = 288230376151711744.0;  // 2^58
  std::mt19937_64 random(brick::random_seed(4));
  for (int i = 0; i < 20000; ++i) {
    const auto angle = static_cast<std::int64_t>(random() >> (2 + random() % 20));
    const double radian = std::remainder(static_cast<double>(angle) / kTurn, 1) * 2 * kPi;
    const fixed_direction d = fixed_direction_of(angle);
    ASSERT_NEAR(static_cast<double>(d.cosine) / kPart, std::cos(radian), 1e-12) << angle;
    ASSERT_NEAR(static_cast<double>(d.sine) / kPart, std::sin(radian), 1e-12) << angle;
  }
}

}  // namespace
