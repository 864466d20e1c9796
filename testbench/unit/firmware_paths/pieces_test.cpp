// What the servo task goes along, to the unit: pieces of a ring (firmware/motion/piece.h), and the path of a motor that
// moves on its own (firmware/motion/own_path.h), against the same sums in the doubles of the machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "testbench/unit/random_seed.h"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // in C a function may have the name of a struct
extern "C" {
#include "firmware/motion/own_path.h"
#include "firmware/motion/piece.h"
}
#pragma GCC diagnostic pop

namespace {

constexpr double kMs = 8388608.0, kWhole = 4294967296.0;  // trajectory time; a fraction

class Ring : public ::testing::Test {
 protected:
  Ring() { piece_ring_initialize(&ring, cubics, 1); }
  void add(std::int64_t time) {
    piece_set_time(piece_ring_at(&ring, ring.added), time);
    piece_ring_add(&ring);
  }
  static std::uint32_t part(std::int64_t elapsed, std::int64_t time) {
    return static_cast<std::uint32_t>((static_cast<unsigned __int128>(elapsed) << 32) / time);
  }
  piece_ring ring{};
  cubic cubics[PIECES] = {};
};

// The part of a time is that of the machine's division, or one less, at both ends of all times and between.
TEST_F(Ring, PartsOfATimeAreExact) {
  std::mt19937_64 random(brick::random_seed(1));
  for (int i = 0; i < 3000; ++i) {
    const auto time = std::max<std::int64_t>(1, static_cast<std::int64_t>(random() >> (17 + random() % 46)));
    piece_ring_clear(&ring);
    add(time);
    for (const std::int64_t elapsed : {std::int64_t{0}, std::int64_t{1}, time / 2, time - 2, time - 1}) {
      if (elapsed < 0 || elapsed >= time) continue;
      ring.elapsed = 0;
      ASSERT_TRUE(piece_ring_advance(&ring, elapsed));
      EXPECT_EQ(ring.elapsed, elapsed);
      ASSERT_LE(ring.fraction, part(elapsed, time)) << elapsed << " of " << time;
      ASSERT_GE(ring.fraction + std::uint64_t{1}, part(elapsed, time)) << elapsed << " of " << time;
    }
    EXPECT_FALSE(piece_ring_advance(&ring, time));
    EXPECT_EQ(ring.elapsed, 0);
    EXPECT_EQ(ring.fraction, 0u);
  }
}

TEST_F(Ring, ATimeIsAtLeastOne) {
  for (const std::int64_t time : {-5, 0, 1}) {
    piece p = {};
    p.continues = true;
    p.warp = 5;
    piece_set_time(&p, time);
    EXPECT_EQ(p.time, 1);
    EXPECT_EQ(p.end, 1);
    EXPECT_EQ(p.from, 0);
    EXPECT_EQ(p.to, 16);
    EXPECT_EQ(p.warp, 0);
    EXPECT_FALSE(p.continues);
  }
}

// What is left of an increment goes on in the next piece, over as many as it covers.
TEST_F(Ring, TimeGoesOnFromPieceToPiece) {
  for (const std::int64_t time : {1000, 1, 500, 4000}) add(time);
  ASSERT_TRUE(piece_ring_advance(&ring, 999));
  EXPECT_EQ(ring.executing, 0u);
  ASSERT_TRUE(piece_ring_advance(&ring, 1));
  EXPECT_EQ(ring.executing, 1u);
  EXPECT_EQ(ring.elapsed, 0);
  ASSERT_TRUE(piece_ring_advance(&ring, 501));
  EXPECT_EQ(ring.executing, 3u);
  EXPECT_EQ(ring.elapsed, 0);
  EXPECT_EQ(ring.fraction, 0u);
  ASSERT_TRUE(piece_ring_advance(&ring, 3999));
  EXPECT_NEAR(ring.fraction, part(3999, 4000), 1);
  EXPECT_FALSE(piece_ring_advance(&ring, 1));
  EXPECT_EQ(ring.executing, 4u);
  EXPECT_TRUE(piece_ring_is_empty(&ring));
  EXPECT_FALSE(piece_ring_advance(&ring, 5));
  EXPECT_EQ(ring.elapsed, 0) << "what comes later begins at its begin";
}

TEST_F(Ring, PiecesAreTakenBackThatHaveNotBegun) {
  for (int i = 0; i < 5; ++i) add(100);
  ASSERT_TRUE(piece_ring_advance(&ring, 150));
  piece_ring_take_back(&ring, 0);
  EXPECT_EQ(ring.added, 5u) << "it is over";
  piece_ring_take_back(&ring, 6);
  EXPECT_EQ(ring.added, 5u) << "there is none";
  piece_ring_take_back(&ring, 5);
  EXPECT_EQ(ring.added, 5u);
  piece_ring_take_back(&ring, 3);
  EXPECT_EQ(ring.added, 3u);
  EXPECT_EQ(piece_ring_room(&ring), PIECES - 2u);
  piece_ring_clear(&ring);
  EXPECT_TRUE(piece_ring_is_empty(&ring));
  EXPECT_EQ(ring.added, 3u);
  EXPECT_EQ(ring.executing, 3u);
  EXPECT_EQ(ring.elapsed, 0);
  EXPECT_EQ(ring.fraction, 0u);
}

// Piece `number` is left at 40, behind it come two that are filled already. It is not if that is over.
TEST_F(Ring, WhatIsReplacedFollowsAtItsMoment) {
  const struct {
    std::int64_t elapsed;
    std::uint32_t number;
    bool possible;
  } cases[] = {{0, 0, true},   {40, 0, true},   {41, 0, false},  {0, 1, true},    {99, 1, true},
               {140, 1, true}, {141, 1, false}, {150, 0, false}, {99, 3, true},   {0, 4, false},
               {340, 3, true}, {341, 3, false}, {399, 2, false}, {299, 2, false}, {199, 2, true}};
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.number << " at " << c.elapsed);
    piece_ring_initialize(&ring, cubics, 1);
    for (int i = 0; i < 4; ++i) add(100);
    for (std::uint32_t i = 4; i < 6; ++i) piece_set_time(piece_ring_at(&ring, i), 1000);
    ASSERT_TRUE(piece_ring_advance(&ring, c.elapsed));
    ASSERT_EQ(piece_ring_replace(&ring, c.number, 40, 2), c.possible);
    EXPECT_EQ(ring.added, c.possible ? 6u : 4u);
    for (std::uint32_t i = 0; i < 4; ++i)
      EXPECT_EQ(piece_ring_at(&ring, i)->end, !c.possible || i < c.number ? 100 : i == c.number ? 40 : 0) << i;
    if (!c.possible) continue;
    ASSERT_TRUE(piece_ring_advance(&ring, 100 * c.number + 40 - c.elapsed));
    EXPECT_EQ(ring.executing, 4u);
    EXPECT_EQ(ring.elapsed, 0);
  }
}

// u = p + warp p (1 - p), then from one sixteenth to another, backwards too.
TEST_F(Ring, WarpAndSixteenthsOfAWay) {
  const std::int64_t time = 1 << 20;
  for (const double warp : {-1.0, -0.3, 0.0, 0.7, 1.0})
    for (const auto& way : std::vector<std::vector<int>>{{0, 16}, {16, 0}, {0, 4}, {4, 16}, {12, 8}, {16, 12}, {5, 5}})
      for (std::int64_t elapsed = 0; elapsed < time; elapsed += time / 16 - 1) {
        piece_ring_initialize(&ring, cubics, 1);
        add(time);
        piece* p = piece_ring_at(&ring, 0);
        p->warp = static_cast<std::int32_t>(warp * PIECE_WARP_ONE);
        p->from = static_cast<std::uint8_t>(way[0]);
        p->to = static_cast<std::uint8_t>(way[1]);
        ASSERT_TRUE(piece_ring_advance(&ring, elapsed));
        const double at = static_cast<double>(elapsed) / static_cast<double>(time), u = at + warp * at * (1 - at);
        const double expected = (way[0] + (way[1] - way[0]) * u) / 16.0 * kWhole;
        ASSERT_NEAR(ring.fraction, std::min(expected, kWhole - 1), 6) << warp << " " << way[0] << " to " << way[1];
      }
}

TEST_F(Ring, AnEndIsThatOfTheCubicOrOfItsPart) {
  const cubic c = {1000, 1600, -3200, 4096};
  piece p = {};
  piece_set_time(&p, 10);
  EXPECT_EQ(cubic_end(&c), 1000 + 1600 - 3200 + 4096);
  EXPECT_EQ(piece_end(&p, &c), cubic_end(&c));
  p.to = 8;
  EXPECT_EQ(piece_end(&p, &c), 1000 + 800 - 800 + 512);
  p.to = 0;
  EXPECT_EQ(piece_end(&p, &c), 1000);
}

std::int64_t whole(double value) {
  EXPECT_GT(std::abs(value - std::floor(value) - 0.5), 1e-6) << "no test: between two units";
  return std::llround(value);
}

struct Speeds {
  double from, to;
};

class OwnPath : public ::testing::Test {
 protected:
  void begin(std::int64_t start) {
    path.pieces[0].time = path.repeats = path.carry = path.carried = path.executing = 5;
    path.elapsed = path.shift = 7;
    own_path_begin(&path, start);
  }
  void expect_piece(std::uint32_t n, double time, double speed, double acceleration, double jerk, own_shape shape) {
    SCOPED_TRACE(n);
    const own_piece& p = path.pieces[n];
    EXPECT_EQ(p.time, whole(time * kMs));
    EXPECT_NEAR(p.speed, speed, 1e-9);
    EXPECT_EQ(p.shape, shape);
    const double square = acceleration * time * time / 2, cube = jerk * time * time * time / 6;
    made += speed * time + square + cube;
    EXPECT_EQ(p.cubic.start, end);
    EXPECT_EQ(p.cubic.square, whole(square));
    EXPECT_EQ(p.cubic.cube, whole(cube));
    end = path.start + whole(made);
    EXPECT_EQ(cubic_end(&p.cubic), end);
  }
  own_path path{};
  double made = 0;
  std::int64_t end = 0;
};

// Speeds in units a ms, by a limit that gives each change another time; S-shaped for 0 and 3.25 ms.
TEST_F(OwnPath, ChangesAreRoundedToTheUnit) {
  for (const double s : {0.0, 3.25})
    for (const Speeds& v : {Speeds{0, 10.3}, Speeds{10.3, 0}, Speeds{-7.7, 30.1}, Speeds{20.9, -3.3}}) {
      SCOPED_TRACE(::testing::Message() << v.from << " to " << v.to << ", " << s);
      for (const std::int64_t start : {0, -1000}) {
        const speed_limits limits = speed_limits_make(1.7, 5, s);
        const double time = speed_change_time(&limits, v.from, v.to), a = (v.to - v.from) / (time - s);
        begin(start);
        made = 0;
        end = start;
        own_path_change(&path, &limits, v.from, v.to);
        if (s == 0) {
          ASSERT_EQ(path.count, 1u);
          expect_piece(0, time, v.from, a, 0, SHAPE_EVEN);
        } else {
          const double level = time - 2 * s;
          ASSERT_EQ(path.count, level > 1e-9 ? 3u : 2u);
          expect_piece(0, s, v.from, 0, a / s, SHAPE_FROM_0);
          if (level > 1e-9) expect_piece(1, level, v.from + a * s / 2, a, 0, SHAPE_EVEN);
          expect_piece(path.count - 1, s, v.to - a * s / 2, a, -a / s, SHAPE_TO_0);
        }
        EXPECT_EQ(path.end, end);
        EXPECT_EQ(path.start, start);
      }
    }
}

TEST_F(OwnPath, RampsAndStaysOfNoTimeAreNone) {
  begin(3);
  const speed_limits limits = speed_limits_make(1, 5, 0);
  own_path_change(&path, &limits, 4, 4);
  own_path_ramp(&path, 4, 0);
  own_path_stay(&path, 4, 0);
  own_path_end_at(&path, 900);
  EXPECT_EQ(path.count, 0u);
  EXPECT_EQ(path.end, 3);
  end = 3;
  own_path_ramp(&path, 12.3, 7.9);
  expect_piece(0, 7.9, 12.3, -12.3 / 7.9, 0, SHAPE_EVEN);
  own_path_end_at(&path, 60);
  EXPECT_EQ(path.end, 60);
  EXPECT_EQ(cubic_end(&path.pieces[0].cubic), 60);
}

// 8192 ms a time, what the speed has of a unit carried on from one to the next, then the rest.
TEST_F(OwnPath, AStayIsARowOfEqualPartsAndARest) {
  const double speed = 1000.0 / 3, rests[] = {0, 100.5};
  for (const int parts : {1, 2, 5})
    for (const double rest : rests) {
      begin(50);
      own_path_stay(&path, speed, 8192.0 * parts + rest);
      ASSERT_EQ(path.count, rest > 0 ? 2u : 1u);
      EXPECT_EQ(path.repeated, 0u);
      EXPECT_EQ(path.repeats, static_cast<std::uint32_t>(parts - 1));
      const own_piece& p = path.pieces[0];
      EXPECT_EQ(p.time, std::int64_t{1} << 36);
      EXPECT_EQ(p.shape, SHAPE_STRAIGHT);
      EXPECT_EQ(p.speed, speed);
      EXPECT_EQ(p.cubic.start, 50);
      EXPECT_EQ(p.cubic.linear, 2730666) << "8,192,000 / 3";
      EXPECT_NEAR(path.carry, kWhole * 2 / 3, 8);
      const double way = speed * (8192.0 * parts + rest);
      if (rest > 0) {
        EXPECT_EQ(path.end, 50 + whole(way));
        EXPECT_EQ(path.pieces[1].time, whole(rest * kMs));
      } else {
        EXPECT_EQ(path.end, 50 + static_cast<std::int64_t>(std::floor(way)));
      }
      std::int64_t position = 0;
      const std::int32_t step = 1 << 30;  // 128 ms
      for (int i = 1; i * 128.0 < 8192.0 * parts; ++i) {
        ASSERT_TRUE(own_path_advance(&path, step, &position));
        ASSERT_NEAR(static_cast<double>(position), 50 + speed * 128 * i, 3) << i;
      }
    }
}

// Where the servo task has it, and what a plan that leaves it there begins with.
TEST_F(OwnPath, PositionAndSpeedAtEachMoment) {
  const speed_limits limits = speed_limits_make(2, 5, 4);
  for (const double stay : {50.0, 30000.0}) {
    const double up = 20 / 2.0 + 4,
                 t[] = {0, 4, up - 4, up, up + stay, up + stay + 4, 2 * up + stay - 4, 2 * up + stay};
    begin(-300);
    own_path_change(&path, &limits, 0, 20);
    own_path_stay(&path, 20, stay);
    own_path_change(&path, &limits, 20, 0);
    path.shift = 1000;
    const auto risen = [&](double x) {  // way of a change from 0 to 20
      const double a = 20 / (up - 4), j = a / 4;
      if (x <= 0) return 0.0;
      if (x >= up) return 20 * x - 10 * up;
      if (x <= 4) return j * x * x * x / 6;
      if (x <= up - 4) return j * 64 / 6 + a * 2 * (x - 4) + a * (x - 4) * (x - 4) / 2;
      return 20 * x - 10 * up + j * std::pow(up - x, 3) / 6;
    };
    const auto expected = [&](double at) { return 700 + risen(at) - risen(at - up - stay); };
    const auto speed = [&](double at) { return (expected(at + 1e-4) - expected(at - 1e-4)) / 2e-4; };
    EXPECT_NEAR(static_cast<double>(path.end), expected(t[7]) - 1000, 1);
    std::int64_t position = 0, now = 0;
    for (int i = 1; i < 8; ++i)
      for (const double share : {0.25, 0.5, 0.999}) {
        const auto next = static_cast<std::int64_t>((t[i - 1] + share * (t[i] - t[i - 1])) * kMs);
        struct own_path_place place;
        own_path_place(&place, &path, next - now);
        const struct own_path_state state = own_path_state(&place);
        const double at = static_cast<double>(next) / kMs;
        EXPECT_NEAR(state.position, expected(at), 4) << at;
        EXPECT_NEAR(state.speed, speed(at), 1e-3) << at;
        while (next - now > INT32_MAX) {
          ASSERT_TRUE(own_path_advance(&path, INT32_MAX, &position));
          now += INT32_MAX;
        }
        ASSERT_TRUE(own_path_advance(&path, static_cast<std::int32_t>(next - now), &position));
        now = next;
        EXPECT_NEAR(static_cast<double>(position), expected(at), 4) << at;
      }
    struct own_path_place place;
    own_path_place(&place, &path, INT64_C(1) << 40);
    EXPECT_EQ(own_path_state(&place).position, static_cast<double>(path.end + 1000));
    EXPECT_EQ(own_path_state(&place).speed, 0);
    EXPECT_FALSE(own_path_advance(&path, 1 << 28, &position));
    EXPECT_EQ(position, path.end + 1000);
    EXPECT_FALSE(own_path_advance(&path, 1 << 28, &position));
    EXPECT_EQ(position, path.end + 1000);
  }
}

// motion:4.1, at any scale: from `from` to `speed`, on for `cruise`, to rest, all of it the distance, and no faster
// than it may be. Where it could be faster it goes on at the top, or keeps the speed that it has.
TEST(SpeedPlan, CoversItsDistance) {
  std::mt19937_64 random(brick::random_seed(2));
  const auto real = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  unsigned peaks = 0, tops = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::exp(real(-3, 12)), s = i % 3 == 0 ? 0 : real(0, 30),
                 shortest = i % 2 == 0 ? 0 : real(0, 80);
    const speed_limits l = speed_limits_make(scale * real(0.01, 1), shortest, s);
    EXPECT_EQ(l.shortest, std::max({shortest, 2 * s, 1.0}));
    const double from = i % 4 == 0 ? 0 : scale * real(-10, 10), top = scale * real(0.1, 10);
    const double distance = scale * std::exp(real(2, 12)) * (i % 5 < 2 ? -1 : 1);
    const auto change = [&](double a, double b) {
      return a == b ? 0 : (a + b) / 2 * std::max(l.shortest, std::abs(b - a) / l.acceleration + s);
    };
    const double rest = distance - change(from, 0);
    if (std::abs(rest) < 1) continue;
    const speed_plan p = speed_plan_to(&l, from, distance, top);
    const double made = change(from, p.speed) + p.speed * p.cruise + change(p.speed, 0);
    ASSERT_NEAR(made, distance, std::abs(distance) * 1e-9 + scale * 1e-6) << i;
    ASSERT_GE(p.cruise, 0) << i;
    const double ahead = rest > 0 ? from : -from, speed = rest > 0 ? p.speed : -p.speed;
    ASSERT_GT(speed, 0) << i;
    ASSERT_LE(speed, std::max(top, ahead) * (1 + 1e-12)) << i;
    if (p.cruise == 0) {
      ++peaks;
      ASSERT_GE(speed, std::max(ahead, 0.0) * (1 - 1e-9)) << i << ": not slower, and then faster again";
    } else if (speed != ahead) {
      ++tops;
      ASSERT_EQ(speed, top) << i;
    } else if (ahead < top) {
      ASSERT_LT(std::abs(rest), ahead * l.shortest * (1 + 1e-9)) << i << ": too near to become faster";
    }
  }
  EXPECT_GT(peaks, 500u);
  EXPECT_GT(tops, 500u);
  const speed_limits l = speed_limits_make(1, 5, 0);
  EXPECT_EQ(speed_plan_to(&l, 0, 0.49, 10).speed, 0);
  EXPECT_GT(speed_plan_to(&l, 0, 0.5, 10).speed, 0);
  EXPECT_LT(speed_plan_to(&l, 0, -0.5, 10).speed, 0);
  EXPECT_EQ(speed_plan_to(&l, 0, 100, 0).speed, 0);
}

}  // namespace
