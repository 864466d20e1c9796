// Geometry of CIRCLE1 and CIRCLE2 (motion:7.2) against arithmetic of the test: turned with rotation matrices, not with
// the planner's vectors.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "testbench/unit/firmware_paths/pi.h"

extern "C" {
#include "firmware/motion/circle.h"
}

namespace {

struct Point {
  double x, y, z;
};

circle_line line_of(const Point& start, const Point& end) {
  circle_line line = {};
  line.start[0] = start.x, line.start[1] = start.y, line.start[2] = start.z;
  line.end[0] = end.x, line.end[1] = end.y, line.end[2] = end.z;
  line.normal[2] = -1.0;  // the default, K-1
  return line;
}

circle_line with_centre(circle_line line, double i, double j, double k = 0.0) {
  line.vector[0] = i, line.vector[1] = j, line.vector[2] = k;
  line.vectors = 7;
  return line;
}

circle_line with_radius(circle_line line, double radius) {
  line.by_radius = true;
  line.radius = radius;
  return line;
}

void expect_at(const circle& c, double part, const Point& p) {
  double at[3];
  circle_at(&c, part, at);
  EXPECT_NEAR(at[0], p.x, 1e-9) << part;
  EXPECT_NEAR(at[1], p.y, 1e-9) << part;
  EXPECT_NEAR(at[2], p.z, 1e-9) << part;
}

TEST(Circle, QuartersGoClockwiseAndCounterClockwise) {
  circle c;
  // From (1, 0) about the origin: clockwise to (0, -1), counter-clockwise to (0, 1).
  const circle_line first = with_centre(line_of({1, 0, 0}, {0, -1, 0}), -1, 0);
  ASSERT_EQ(circle_of(&first, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, kPi / 2, 1e-12);
  for (double part : {0.0, 0.25, 0.5, 1.0})
    expect_at(c, part, {std::cos(part * kPi / 2), -std::sin(part * kPi / 2), 0});
  circle_line line = with_centre(line_of({1, 0, 0}, {0, 1, 0}), -1, 0);
  line.counter = true;
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, kPi / 2, 1e-12);
  for (double part : {0.0, 0.25, 0.5, 1.0}) expect_at(c, part, {std::cos(part * kPi / 2), std::sin(part * kPi / 2), 0});
  double beside[3];
  EXPECT_NEAR(circle_length(&c, beside), kPi / 2, 1e-12);
  double direction[3];
  circle_direction(&c, 0.5, direction);
  EXPECT_NEAR(direction[1] / direction[0], -1.0, 1e-9);
  EXPECT_LT(direction[0], 0.0);
}

TEST(Circle, TheCentreMayBeAbsolute) {
  circle c;
  circle_line line = with_centre(line_of({12, 5, 0}, {10, 3, 0}), 10, 5);
  line.absolute = true;
  line.vectors = 3;
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.radius, 2, 1e-12);
  EXPECT_NEAR(c.angle, kPi / 2, 1e-12);  // clockwise from 0 to -90 degrees
}

// motion:7.2/2: what the line does not give is 0, absolute the start's, whatever the line before has left there.
TEST(Circle, WhatIsNotGivenIsNothingOrTheStarts) {
  circle c;
  for (const bool absolute : {false, true}) {
    circle_line line = with_centre(line_of({12, 5, 0}, {8, 5, 0}), absolute ? 10 : -2, 99, 99);
    line.absolute = absolute;
    line.vectors = 1;  // I
    ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
    EXPECT_NEAR(c.radius, 2, 1e-12) << absolute;
    EXPECT_NEAR(c.centre[0], 10, 1e-12);
    EXPECT_NEAR(c.centre[1], 5, 1e-12);
    line = with_centre(line_of({12, 5, 0}, {12, 9, 0}), 99, absolute ? 7 : 2, 99);
    line.absolute = absolute;
    line.vectors = 2;  // J
    ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
    EXPECT_NEAR(c.centre[0], 12, 1e-12) << absolute;
    EXPECT_NEAR(c.centre[1], 7, 1e-12);
  }
}

TEST(Circle, EndAtTheStartIsAFullTurn) {
  circle c;
  const circle_line line = with_centre(line_of({3, 4, 7}, {3, 4, 7}), 2, 0);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, 2 * kPi, 1e-12);
  expect_at(c, 0.5, {7, 4, 7});
  expect_at(c, 0.25, {5, 6, 7});  // clockwise: up first, from the left of the centre
}

// Isx97, in parts of pi.
TEST(Circle, ShortArcsGetATurnMore) {
  circle c;
  for (const double isx97 : {0.0, 0.01})
    for (const double part : {0.5, 2.0}) {
      const double least = isx97 > 0 ? isx97 : std::pow(2.0, -20), angle = part * least * kPi;
      circle_line line = with_centre(line_of({1, 0, 0}, {std::cos(angle), -std::sin(angle), 0}), -1, 0);
      line.least = isx97;
      ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
      EXPECT_NEAR(c.angle, part < 1 ? angle + 2 * kPi : angle, 1e-12);
    }
}

TEST(Circle, RadiusTakesTheShortOrTheLongWay) {
  circle c;
  circle_line line = with_radius(line_of({0, 0, 0}, {1, 1, 0}), 1);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, kPi / 2, 1e-12);
  expect_at(c, 0.5, {1 - std::sqrt(0.5), std::sqrt(0.5), 0});  // clockwise about (1, 0)
  line.radius = -1;
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, 3 * kPi / 2, 1e-12);
  expect_at(c, 0.5, {-std::sqrt(0.5), 1 + std::sqrt(0.5), 0});  // about (0, 1)
  line.radius = 1, line.counter = true;
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  expect_at(c, 0.5, {std::sqrt(0.5), 1 - std::sqrt(0.5), 0});  // counter-clockwise about (0, 1)
}

// R is the short way, 2 asin(chord / 2 R), or the rest of a turn: whatever Isx97 is, and however it is rounded.
TEST(Circle, AShortArcByRadiusStaysShort) {
  circle c;
  for (const double isx97 : {0.0, 0.01})
    for (const auto& [chord, radius] : {std::pair{1e-3, 1e3}, {1.0, 100.0}, {1e-3, 1e9}, {1e-6, 1e12}})
      for (const double sign : {1.0, -1.0}) {
        circle_line line = with_radius(line_of({7, 4, 0}, {7 + chord * 0.6, 4 + chord * 0.8, 0}), sign * radius);
        line.least = isx97;
        const double half = std::hypot(line.end[0] - line.start[0], line.end[1] - line.start[1]) / 2;
        const double angle = 2 * std::asin(half / radius);
        ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
        EXPECT_NEAR(c.angle, sign > 0 ? angle : 2 * kPi - angle, 1e-9 * angle + 4e-15 * (sign < 0)) << radius;
      }
}

// Isx96: how much further apart than 2 R the ends may be.
TEST(Circle, EndsTooFarForTheRadius) {
  circle c;
  circle_line line = with_radius(line_of({0, 0, 0}, {2.1, 0, 0}), 1);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC) << "no limit";
  expect_at(c, 0.5, {1.05, 1.05, 0});
  line.most = 0.11;
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  line.most = 0.09;
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_IMPOSSIBLE);
}

TEST(Circle, WhatIsNoArc) {
  circle c;
  circle_line line = line_of({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_STRAIGHT);  // neither centre nor radius
  line = with_radius(line_of({1, 1, 0}, {1, 1, 0}), 5);
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_STRAIGHT);  // no full turn by radius
  line = with_centre(line_of({0, 0, 0}, {1, 0, 0}), 0, 0);
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_IMPOSSIBLE);  // the start is the centre
  line = with_centre(line_of({0, 0, 0}, {1, 0, 0}), 1, 0);
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_IMPOSSIBLE);  // the end is
  line = with_radius(line_of({0, 0, 0}, {1, 0, 0}), 0);
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_IMPOSSIBLE);
  line = with_centre(line_of({0, 0, 0}, {1, 1, 0}), 1, 0);
  line.normal[2] = 0;
  EXPECT_EQ(circle_of(&line, &c), CIRCLE_STRAIGHT);  // no plane
}

TEST(Circle, UnequalRadiiMakeASpiral) {
  circle c;
  const circle_line line = with_centre(line_of({2, 0, 0}, {0, -5, 0}), -2, 0);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  for (double part : {0.0, 0.3, 0.7, 1.0}) {
    const double radius = 2 + 3 * part, angle = part * kPi / 2;
    expect_at(c, part, {radius * std::cos(angle), -radius * std::sin(angle), 0});
  }
}

TEST(Circle, AHelixAndOtherPlanes) {
  circle c;
  circle_line line = with_centre(line_of({1, 0, 0}, {0, -1, 8}), -1, 0);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  expect_at(c, 0.5, {std::sqrt(0.5), -std::sqrt(0.5), 4});
  // NORMAL I1 J1: the plane of Z and of (1, -1). CIRCLE1 turns about the normal by the right-hand rule.
  const double h = std::sqrt(0.5);
  line = with_centre(line_of({h, -h, 0}, {0, 0, 0}), -h, h);
  line.normal[0] = line.normal[1] = 3, line.normal[2] = 0;
  const Point a = {h, -h, 0}, n = {h, h, 0};
  const Point b = {n.y * a.z - n.z * a.y, n.z * a.x - n.x * a.z, n.x * a.y - n.y * a.x};
  const double angle = 1.0;
  line.end[0] = a.x * std::cos(angle) + b.x * std::sin(angle);
  line.end[1] = a.y * std::cos(angle) + b.y * std::sin(angle);
  line.end[2] = a.z * std::cos(angle) + b.z * std::sin(angle);
  ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
  EXPECT_NEAR(c.angle, angle, 1e-12);
  const double half = angle / 2;
  expect_at(c, 0.5,
            {a.x * std::cos(half) + b.x * std::sin(half), a.y * std::cos(half) + b.y * std::sin(half),
             a.z * std::cos(half) + b.z * std::sin(half)});
}

// motion:7.2/8, motion:7.1/8: of spirals within 10^-5, of what drifts too within 0.2 %. As polygons of 50,000 sides.
TEST(Circle, LengthsOfSpiralsAndOfWhatDrifts) {
  const struct {
    double radius, growth, turns, x, y, tolerance;
  } cases[] = {{.1, 2, .25, 0, 0, 1e-5},  {5, -4.9, .25, 0, 0, 1e-5}, {1, 15, .97, 0, 0, 1e-5},
               {1, 15, 1.97, 0, 0, 1e-5}, {1, 0, 1, 4, 0, 1e-5},      {1, 0, 1, 0, -4, 1e-5},
               {1, 0, 1.95, 12, 2, 2e-3}, {1, -.8, 1.6, 9, 3, 2e-3},  {1, 0, .3, 1e-7, 0, 1e-9}};
  for (const auto& one : cases) {
    SCOPED_TRACE(std::to_string(one.growth) + " " + std::to_string(one.turns) + " " + std::to_string(one.x));
    const double angle = 2 * kPi * one.turns, end = one.radius + one.growth;
    circle_line line =
        with_centre(line_of({one.radius, 0, 0}, {end * std::cos(angle), -end * std::sin(angle), 7}), -one.radius, 0);
    if (one.turns > 1) line.least = 2;
    circle c;
    ASSERT_EQ(circle_of(&line, &c), CIRCLE_ARC);
    ASSERT_NEAR(c.angle, angle, 1e-9);
    c.along[0] += one.x;
    c.along[1] += one.y;
    constexpr int kSides = 50000;
    double length = 0, before[3], at[3];
    circle_at(&c, 0, before);
    for (int i = 1; i <= kSides; ++i) {
      circle_at(&c, static_cast<double>(i) / kSides, at);
      length += std::hypot(at[0] - before[0], at[1] - before[1]);
      std::copy(at, at + 3, before);
    }
    double beside[3];
    EXPECT_NEAR(circle_length(&c, beside), length, one.tolerance * length);
    EXPECT_NEAR(beside[0], 0, 1e-6);
    EXPECT_NEAR(beside[1], 0, 1e-6);
    EXPECT_NEAR(beside[2], 7, 1e-12);
  }
}

}  // namespace
