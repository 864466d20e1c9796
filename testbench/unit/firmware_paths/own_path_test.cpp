// The path of a motor that moves on its own (firmware/motion/own_path.h): where a stay is after any number of its
// parts, and the place and speed that a plan begins with, by places that the test makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // in C a function may have the name of a struct
extern "C" {
#include "firmware/motion/own_path.h"
}
#pragma GCC diagnostic pop

namespace {

constexpr std::int64_t kStayPart = std::int64_t{1} << 36;  // 8192 ms
constexpr double kUnitsOfMs = 8388608.0;

// A way of n (whole + 1 - 2^-34) units, whose fraction is that of 32 bits but for three quarters of the last: each part
// of the stay carries on what the one before has of a unit, and no more than that.
class OwnStay : public ::testing::TestWithParam<std::int64_t> {
 protected:
  static std::int64_t way(std::int64_t parts) { return parts == 0 ? 0 : parts * (GetParam() + 1) - 1; }
  static double speed() { return (static_cast<double>(GetParam()) + 1 - 0x1p-34) / 8192; }
  own_path path{};
};

INSTANTIATE_TEST_SUITE_P(Ways, OwnStay, ::testing::Values(0, 5, 70000, -1, -2, -70000));

TEST_P(OwnStay, EachPartCarriesOnWhatTheOneBeforeHasOfAUnit) {
  for (const std::int64_t parts : {1, 2, 3, 7}) {
    own_path_begin(&path, 1000);
    own_path_stay(&path, speed(), 8192.0 * static_cast<double>(parts));
    ASSERT_EQ(path.count, 1u);
    EXPECT_EQ(path.repeats, parts - 1);
    EXPECT_EQ(path.end, 1000 + way(parts));
    path.shift = 50;
    for (std::int64_t n = 0; n < parts; ++n) {
      struct own_path_place place;
      own_path_place(&place, &path, n * kStayPart);
      EXPECT_EQ(place.cubic.start, 1050 + way(n)) << n;
      EXPECT_EQ(place.elapsed, 0);
      EXPECT_EQ(place.time, kStayPart);
      EXPECT_EQ(own_path_state(&place).speed, speed());
      own_path_place(&place, &path, (n + 1) * kStayPart - 1);
      EXPECT_EQ(place.cubic.start, 1050 + way(n)) << n;
      EXPECT_EQ(place.elapsed, kStayPart - 1);
    }
    struct own_path_place end;
    own_path_place(&end, &path, parts * kStayPart);
    EXPECT_EQ(own_path_state(&end).position, 1050.0 + static_cast<double>(way(parts)));
    EXPECT_EQ(own_path_state(&end).speed, 0);
    std::int64_t position = 0;
    for (std::int64_t n = 0; n < parts; ++n) {
      for (int i = 0; i < 64; ++i) {
        if (i == 0 && n != 0) { EXPECT_EQ(position, 1050 + way(n)) << "at the begin of part " << n; }
        ASSERT_EQ(own_path_advance(&path, 1 << 30, &position), n + 1 != parts || i != 63);
      }
    }
    EXPECT_EQ(position, 1050 + way(parts));
  }
}

TEST_P(OwnStay, WithoutAnEndToo) {
  own_path_begin(&path, -300);
  own_path_stay_for_ever(&path, speed());
  std::int64_t position = 0;
  for (std::int64_t n = 1; n <= 9; ++n) {
    struct own_path_place place;
    own_path_place(&place, &path, 20 * kStayPart);
    EXPECT_EQ(place.cubic.start, -300 + way(n - 1 + 20)) << "twenty parts ahead of " << n - 1;
    EXPECT_EQ(place.elapsed, 0);
    EXPECT_EQ(own_path_state(&place).speed, speed());
    for (int i = 0; i < 64; ++i) ASSERT_TRUE(own_path_advance(&path, 1 << 30, &position));
    EXPECT_EQ(position, -300 + way(n));
    EXPECT_EQ(path.count, 1u);
    EXPECT_EQ(path.executing, 0u);
  }
}

// A stay of three parts and 100 ms between ramps of 10 ms: where each of them begins and ends it is that one, at its
// own time, and the speed is that of the line between its ends.
TEST(OwnPlace, EachMomentLiesInItsPiece) {
  own_path path{};
  own_path_begin(&path, 7);
  const speed_limits limits = speed_limits_make(1, 10, 0);
  own_path_change(&path, &limits, 0, 8);
  own_path_stay(&path, 8, 3 * 8192 + 100);
  own_path_change(&path, &limits, 8, 0);
  ASSERT_EQ(path.count, 4u);
  const auto ms = [](double t) { return static_cast<std::int64_t>(t * kUnitsOfMs); };
  const struct {
    double at;  // ms
    double elapsed, time, start, from, to;
  } cases[] = {{0, 0, 10, 7, 0, 8},
               {9, 9, 10, 7, 0, 8},
               {10, 0, 8192, 47, 8, 8},
               {10 + 8191, 8191, 8192, 47, 8, 8},
               {10 + 8192, 0, 8192, 47 + 65536, 8, 8},
               {10 + 3 * 8192 - 1, 8191, 8192, 47 + 2 * 65536, 8, 8},
               {10 + 3 * 8192, 0, 100, 47 + 3 * 65536, 8, 8},
               {10 + 3 * 8192 + 99, 99, 100, 47 + 3 * 65536, 8, 8},
               {10 + 3 * 8192 + 100, 0, 10, 47 + 3 * 65536 + 800, 8, 0},
               {10 + 3 * 8192 + 109, 9, 10, 47 + 3 * 65536 + 800, 8, 0}};
  for (const bool goes : {false, true}) {  // from its begin, and from moment to moment
    path.shift = goes ? 1000000 : 0;
    std::int64_t now = 0, position = 0;
    for (const auto& c : cases) {
      SCOPED_TRACE(c.at);
      struct own_path_place place;
      own_path_place(&place, &path, ms(c.at) - now);
      EXPECT_EQ(place.elapsed, ms(c.elapsed));
      EXPECT_EQ(place.time, ms(c.time));
      EXPECT_EQ(static_cast<double>(place.cubic.start - path.shift), c.start);
      EXPECT_EQ(place.warp, 0);
      EXPECT_EQ(place.from, 0);
      EXPECT_EQ(place.to, PIECE_PARTS);
      const double u = c.elapsed / c.time, speed = c.from + (c.to - c.from) * u,
                   moved = (c.from + speed) / 2 * c.elapsed;
      EXPECT_NEAR(own_path_state(&place).speed, speed, 1e-9);
      EXPECT_NEAR(own_path_state(&place).position, static_cast<double>(path.shift) + c.start + moved, 1);
      for (const std::int64_t next = ms(c.at); goes && now < next;) {
        const std::int64_t step = std::min<std::int64_t>(next - now, INT32_MAX);
        ASSERT_TRUE(own_path_advance(&path, static_cast<std::int32_t>(step), &position));
        now += step;
      }
      if (goes && now != 0) { EXPECT_NEAR(static_cast<double>(position), 1000000 + c.start + moved, 2); }
    }
    if (!goes) continue;
    EXPECT_FALSE(own_path_advance(&path, static_cast<std::int32_t>(ms(1)), &position));
    EXPECT_EQ(position, 1000000 + 7 + 3 * 65536 + 800 + 80);
  }
}

struct own_path_place cubic_place(std::int64_t time, cubic c) {
  struct own_path_place place = {};
  place.cubic = c;
  place.time = time;
  place.to = PIECE_PARTS;
  place.shape = SHAPE_OF_CUBIC;
  return place;
}

// What the roundings of a cubic leave is no motion: a speed below half a unit a ms.
TEST(OwnPlace, ACubicStandsBelowHalfAUnitAMs) {
  const struct {
    std::int64_t way;
    double speed;
  } cases[] = {{0, 0}, {1, 0}, {3, 0}, {4, 0.5}, {5, 0.625}, {8, 1}, {11, 1.375}};
  for (const auto& c : cases)
    for (const int sign : {1, -1}) {
      struct own_path_place place = cubic_place(8 << 23, {100, sign * c.way, 0, 0});
      EXPECT_EQ(own_path_state(&place).speed, sign * c.speed) << c.way;
      EXPECT_EQ(own_path_state(&place).position, 100);
    }
}

// Position and velocity of start + linear u + square u^2 + cube u^3 with u = p + warp p (1 - p), from one sixteenth to
// another, by their derivatives.
TEST(OwnPlace, WarpAndSixteenthsOfACubic) {
  const cubic c = {-5000, 300000, -170000, 90000};
  const double ms = 12.5;
  for (const double warp : {-1.0, -0.25, 0.0, 0.5, 1.0})
    for (const auto& way : {std::pair{0, 16}, {16, 0}, {0, 4}, {4, 16}, {12, 8}, {16, 12}, {0, 15}, {1, 16}})
      for (const double part : {0.0, 0.125, 0.5, 0.9375}) {
        struct own_path_place place = cubic_place(static_cast<std::int64_t>(ms * kUnitsOfMs), c);
        place.elapsed = static_cast<std::int64_t>(part * ms * kUnitsOfMs);
        place.warp = static_cast<std::int32_t>(warp * PIECE_WARP_ONE);
        place.from = static_cast<std::uint8_t>(way.first);
        place.to = static_cast<std::uint8_t>(way.second);
        const double share = (way.second - way.first) / 16.0;
        const double u = way.first / 16.0 + share * (part + warp * part * (1 - part));
        const double rate = share * (1 + warp * (1 - 2 * part));
        const double slope = 300000 - 2 * 170000 * u + 3 * 90000 * u * u;
        const struct own_path_state state = own_path_state(&place);
        EXPECT_NEAR(state.position, -5000 + 300000 * u - 170000 * u * u + 90000 * u * u * u, 1e-6)
            << warp << " " << way.first << " to " << way.second << " at " << part;
        EXPECT_NEAR(state.speed, rate * slope / ms, 1e-6)
            << warp << " " << way.first << " to " << way.second << " at " << part;
      }
}

// Its exact speeds: straight it stays, at one acceleration it changes evenly, from or to an acceleration of 0 with the
// square of the time from there.
TEST(OwnPlace, TheSpeedOfEachShape) {
  for (const double part : {0.0, 0.25, 0.5, 0.75}) {
    struct own_path_place place = cubic_place(1 << 20, {3, 4, 5, 6});
    place.elapsed = static_cast<std::int64_t>(part * (1 << 20));
    place.speed = -3;
    place.then = 9;
    const double left = 1 - part;
    const std::pair<own_shape, double> shapes[] = {{SHAPE_STRAIGHT, -3},
                                                   {SHAPE_EVEN, -3 + 12 * part},
                                                   {SHAPE_FROM_0, -3 + 12 * part * part},
                                                   {SHAPE_TO_0, 9 - 12 * left * left}};
    for (const auto& [shape, speed] : shapes) {
      place.shape = static_cast<std::uint8_t>(shape);
      EXPECT_DOUBLE_EQ(own_path_state(&place).speed, speed) << shape << " at " << part;
      EXPECT_DOUBLE_EQ(own_path_state(&place).position, 3 + 4 * part + 5 * part * part + 6 * part * part * part);
    }
  }
}

// At its end and behind it a place stands, whatever its shape says.
TEST(OwnPlace, BehindItsEndItStands) {
  struct own_path_place place = cubic_place(100, {10, 200, 30, 4});
  place.speed = place.then = 5;
  for (const std::int64_t elapsed : {99, 100, 101})
    for (const own_shape shape : {SHAPE_STRAIGHT, SHAPE_OF_CUBIC}) {
      place.elapsed = elapsed;
      place.shape = static_cast<std::uint8_t>(shape);
      const struct own_path_state state = own_path_state(&place);
      EXPECT_EQ(state.position == 244 && state.speed == 0, elapsed >= 100) << elapsed;
    }
  own_path_stands(&place, -77);
  EXPECT_EQ(own_path_state(&place).position, -77);
  EXPECT_EQ(own_path_state(&place).speed, 0);
}

}  // namespace
