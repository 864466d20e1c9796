// How fast a part of a path may be (firmware/motion/lookahead_limits.h), against its definition in doubles: at both
// ends, and the middle coefficients of the quarters, each motor's acceleration is no more than its limit. Found with a
// limit that is a little less and one that is a little more, for what rounding costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "testbench/unit/random_seed.h"
extern "C" {
#include "firmware/motion/lookahead_limits.h"
}

namespace {

constexpr double kOne = 1 << RATE_BITS, kBend = 1 << BEND_BITS;
constexpr double kLess = 1 - 24.0 / 4096, kMore = 1 + 10.0 / 4096;

// |c[0] w0 + c[1] w1| <= 1
struct Asked {
  double c[2];
};

class LookaheadLimits : public ::testing::Test {
 protected:
  double real(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  double power(double from, double to) { return std::exp2(real(from, to)) * (random_() % 2 == 0 ? 1 : -1); }

  // Motors at both knots of a segment, some beyond their limits as far as numbers go, others far from them.
  void make(unsigned count, double largest) {
    at_.resize(count);
    next_.resize(count);
    for (unsigned i = 0; i < count; ++i) {
      const double from = power(-4, largest), to = random_() % 3 == 0 ? from : power(-4, largest);
      const double pace = random_() % 4 == 0 ? 0 : power(-4, largest);
      at_[i] = {0, static_cast<std::int32_t>(pace * kBend), static_cast<std::int32_t>(from * kBend)};
      next_[i] = {0, static_cast<std::int32_t>((pace + (from + to) / 2) * kBend),
                  static_cast<std::int32_t>(to * kBend)};
    }
  }
  // x'' w + x' w' / 2 at the ends and the middle Bernstein coefficients of the quarters, from `first` to `last`
  // sixteenths.
  void ask(unsigned first = 0, unsigned last = 16) {
    asked_.clear();
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const double b0 = at_[i].bend / kBend, b1 = next_[i].bend / kBend, p = at_[i].pace / kBend,
                   part = (last - first) / 16.0;
      const auto bend = [&](double u) { return b0 + (b1 - b0) * u; };
      const auto pace = [&](double u) { return p + b0 * u + (b1 - b0) * u * u / 2; };
      const double u0 = first / 16.0, u1 = last / 16.0, turn0 = pace(u0) / part / 2, turn1 = pace(u1) / part / 2;
      const double turn = turn0 + bend(u0) / 4;
      const Asked b[3] = {
          {{bend(u0) - turn0, turn0}}, {{bend(u1) / 2 - turn, bend(u0) / 2 + turn}}, {{-turn1, bend(u1) + turn1}}};
      asked_.push_back(b[0]);
      asked_.push_back(b[2]);
      for (int k = 0; k < 4; ++k) {  // of a quadratic between s and t
        const double s = k / 4.0, t = (k + 1) / 4.0, of[3] = {(1 - s) * (1 - t), s + t - 2 * s * t, s * t};
        Asked mid{};
        for (int j = 0; j < 3; ++j)
          for (int e = 0; e < 2; ++e) mid.c[e] += of[j] * b[j].c[e];
        asked_.push_back(mid);
      }
    }
  }
  struct Room {
    double lowest = 0, highest = 1;
    bool none() const { return lowest > highest; }
  };
  // For w at `end`, 0 to `most`, when it is `w` at the other.
  Room room(limits_end end, double w, double most, double limit) const {
    Room r{0, most};
    for (const Asked& a : asked_) {
      const double given = a.c[1 - end] * w, by = a.c[end];
      if (std::abs(by) < 1e-12) {
        if (std::abs(given) > limit) r.highest = -1;
        continue;
      }
      const double one = (limit - given) / by, other = (-limit - given) / by;
      r.lowest = std::max(r.lowest, std::min(one, other));
      r.highest = std::min(r.highest, std::max(one, other));
    }
    return r;
  }
  // The largest at `end` with some w of at most `other`: it is concave in that, as far as there is any.
  double reach(limits_end end, double other, double most, double limit) const {
    const auto at = [&](double w) {
      const Room r = room(end, w, most, limit);
      return r.none() ? -1 - w : r.highest;
    };
    double from = 0, to = other;
    for (int i = 0; i < 60; ++i) {
      const double one = from + (to - from) / 3, two = to - (to - from) / 3;
      (at(one) < at(two) ? from : to) = at(one) < at(two) ? one : two;
    }
    return std::max({at(from), at(0), at(other), 0.0});
  }
  void expect_room(unsigned set) {
    for (const limits_end end : {LIMITS_FIRST, LIMITS_SECOND})
      for (int i = 0; i < 6; ++i) {
        SCOPED_TRACE(::testing::Message() << "set " << set << ", end " << end);
        const double w = i == 0 ? 0 : std::exp2(real(-24, 0)), most = i % 2 == 0 ? 1 : std::exp2(real(-20, 0));
        const auto given = static_cast<std::int32_t>(w * kOne), cap = static_cast<std::int32_t>(most * kOne);
        const Room less = room(end, given / kOne, cap / kOne, kLess), more = room(end, given / kOne, cap / kOne, kMore);
        const double largest = limits_most(end, given, cap) / kOne, least = limits_least(end, given, cap) / kOne;
        if (!less.none()) {
          ++possible_;
          ASSERT_GE(largest, less.highest * (1 - 1e-6) - 1e-8) << "w " << w << " most " << most;
          ASSERT_LE(least, less.lowest * (1 + 1e-6) + 1e-7);
          ASSERT_GE(least, more.lowest * (1 - 1e-6) - 1e-7);
        }
        if (more.none()) {
          ++impossible_;
          ASSERT_LT(largest, 0);
        } else {
          ASSERT_LE(largest, more.highest * (1 + 1e-6) + 1e-8) << "w " << w << " most " << most;
        }
        const double found = limits_reach(end, given, cap) / kOne;
        ASSERT_LE(found, cap / kOne);
        const limits_end opposite = end == LIMITS_FIRST ? LIMITS_SECOND : LIMITS_FIRST;
        ASSERT_FALSE(room(opposite, found * (1 - 1e-6), given / kOne + 1e-8, kMore).none()) << "there is none for it";
        const double possible = reach(end, given / kOne, cap / kOne, kLess - 20.0 / 4096);
        for (const double other : {0.0, given / kOne}) {
          const Room r = room(end, other, cap / kOne, kLess - 20.0 / 4096);
          if (!r.none()) { ASSERT_GE(found, r.highest * (1 - 1e-6) - 1e-8); }
        }
        ++reached_[found >= 0.9 * possible - 1e-8];
      }
  }

  std::mt19937_64 random_{brick::random_seed(1)};
  std::vector<lookahead_motor> at_, next_;
  std::vector<Asked> asked_;
  unsigned possible_ = 0, impossible_ = 0, reached_[2] = {0, 0};
};

TEST_F(LookaheadLimits, OfWholeSegments) {
  for (unsigned set = 0; set < 150 && !HasFatalFailure(); ++set) {
    make(1 + set % 9, set % 3 == 0 ? 2 : set % 3 == 1 ? 6 : 11.5);
    ask();
    limits_load(at_.data(), next_.data(), static_cast<std::uint32_t>(at_.size()));
    expect_room(set);
  }
  EXPECT_GT(possible_, 200u);
  EXPECT_GT(impossible_, 100u);
  EXPECT_GT(reached_[1], 20 * reached_[0]) << "the search ends near to the largest";
}

TEST_F(LookaheadLimits, OfPartsOfSegments) {
  const unsigned parts[][2] = {{0, 4}, {4, 8}, {12, 16}, {0, 8}, {8, 16}, {4, 16}, {0, 12}, {0, 16}, {6, 7}};
  for (unsigned set = 0; set < 150 && !HasFatalFailure(); ++set) {
    const auto& part = parts[set % 9];
    make(1 + set % 7, 6);
    ask(part[0], part[1]);
    limits_load_part(at_.data(), next_.data(), static_cast<std::uint32_t>(at_.size()), part[0], part[1]);
    expect_room(set);
  }
  EXPECT_GT(possible_, 200u);
  EXPECT_GT(impossible_, 50u);
}

// A motor whose bends and paces are all below half of its limit is never beyond it.
TEST_F(LookaheadLimits, SlowMotorsLeaveAll) {
  at_ = {{0, 8191, 8191}, {0, -8191, 0}};
  next_ = {{0, 8191, -8191}, {0, 8191, 8191}};
  limits_load(at_.data(), next_.data(), 2);
  for (const limits_end end : {LIMITS_FIRST, LIMITS_SECOND}) {
    EXPECT_EQ(limits_most(end, 0, RATE_FULL), RATE_FULL);
    EXPECT_EQ(limits_least(end, RATE_FULL, RATE_FULL), 0);
    EXPECT_EQ(limits_reach(end, RATE_FULL, RATE_FULL), RATE_FULL);
  }
  EXPECT_EQ(limits_change(), INT32_MAX);
}

TEST_F(LookaheadLimits, AChangeIsThatOfTheFastestMotor) {
  for (const double pace : {2.5, -3.0, 100.0, -1000.0}) {
    at_ = {{0, static_cast<std::int32_t>(pace * kBend), 0}, {0, static_cast<std::int32_t>(1.2 * kBend), 0}};
    next_ = at_;
    limits_load(at_.data(), next_.data(), 2);
    EXPECT_NEAR(limits_change() / kOne, 4092.0 / 4096 * 2 / std::abs(pace), 1e-6) << pace;
    limits_load_part(at_.data(), next_.data(), 2, 4, 8);
    EXPECT_NEAR(limits_change() / kOne, 4092.0 / 4096 / 2 / std::abs(pace), 1e-6) << pace << ", a quarter";
  }
}

}  // namespace
