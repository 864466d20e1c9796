// firmware/base/mathematics.c and float48.c at and behind the ends of their ranges (firmware:1.7, firmware:10/9).
// Values are literals of mathematics, or the C library's where a literal would say nothing.
#include <cfloat>
#include <cmath>
#include <limits>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/base/float48.h"
}

namespace {

constexpr double kPi = 3.14159265358979323846, kEnd = 140737488355328.0, k2To62 = 4611686018427387904.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void near(double actual, double expected, const char* what, double relative = 4e-15) {
  EXPECT_NEAR(actual, expected, relative * std::fabs(expected)) << what << " " << expected;
}

TEST(Mathematics, ExponentialOverTheWholeRangeOfADouble) {
  for (double x = -708.0; x <= 709.0; x += 0.5) near(math_exponential(x), std::exp(x), "EXP", 2e-13);
  near(math_exponential(1.0), 2.718281828459045, "e");
  near(math_exponential(41.0), 6.398434935300549e17, "EXP(41)");
  near(math_exponential(42.0), 1.7392749415205010e18, "EXP(42)");
  near(math_exponential(88.0), 1.6516362549940018e38, "EXP(88)");
  near(math_exponential(89.0), 4.4896128191743453e38, "EXP(89)");
  near(math_exponential(709.75), 1.7398368732641617e308, "the end", 2e-13);
  EXPECT_EQ(math_exponential(0.0), 1.0);
  for (const double x : {709.79, 710.0, 1e4, 1e300}) {
    EXPECT_TRUE(math_is_finite(math_exponential(x))) << x;
    near(math_exponential(x), DBL_MAX, "stays at the end", 1e-12);
  }
  for (const double x : {-709.0, -745.2, -1e4, -1e300}) EXPECT_EQ(math_exponential(x), 0.0) << x;
  near(math_exponential(-708.3), std::exp(-708.3), "the smallest", 2e-13);
}

TEST(Mathematics, LogarithmOverTheWholeRangeOfADouble) {
  near(math_logarithm(DBL_MAX), 709.782712893384, "LN");
  near(math_logarithm(DBL_MIN), -708.3964185322641, "LN");
  near(math_logarithm(2.0), 0.6931471805599453, "LN");
  near(math_logarithm(kEnd), 32.57791748631743, "LN");
  near(math_logarithm(1.0 + DBL_EPSILON), DBL_EPSILON, "LN", 1e-12);
  EXPECT_EQ(math_logarithm(1.0), 0.0);
  for (const double x : {0.0, -0.0, -DBL_MIN, -1.0, -DBL_MAX}) EXPECT_EQ(math_logarithm(x), 0.0) << x;
  for (int e = -1022; e < 1024; ++e) near(math_logarithm(std::ldexp(1.1, e)), std::log(std::ldexp(1.1, e)), "LN");
}

TEST(Mathematics, RootOverTheWholeRangeOfADouble) {
  near(math_square_root(DBL_MAX), 1.3407807929942596e154, "SQRT");
  near(math_square_root(DBL_MIN), 1.4916681462400413e-154, "SQRT");
  for (const double x : {1.0, 4.0, 1e4, 0.25, kEnd * kEnd}) EXPECT_EQ(math_square_root(x), std::sqrt(x));
  for (const double x : {0.0, -0.0, -DBL_MIN, -4.0, -DBL_MAX}) EXPECT_EQ(math_square_root(x), 0.0) << x;
  for (int e = -1022; e < 1024; ++e) near(math_square_root(std::ldexp(1.7, e)), std::sqrt(std::ldexp(1.7, e)), "SQRT");
}

TEST(Mathematics, CircularFunctionsInEachEighthOfTheCircle) {
  for (int degrees = -1080; degrees <= 1080; degrees += 15) {
    const double exact[] = {
        0.0, std::sqrt(6.0) - std::sqrt(2.0), 2.0, std::sqrt(8.0), std::sqrt(12.0), std::sqrt(6.0) + std::sqrt(2.0),
        4.0};  // 4 sin of 0, 15, ... 90 degrees
    const auto sine = [&exact](int d) {
      d = ((d % 360) + 360) % 360;
      const double sign = d >= 180 ? -1.0 : 1.0;
      d %= 180;
      return sign * exact[(d > 90 ? 180 - d : d) / 15] / 4.0;
    };
    EXPECT_NEAR(math_sine(degrees, 1), sine(degrees), 1e-15) << degrees;
    EXPECT_NEAR(math_cosine(degrees, 1), sine(degrees + 90), 1e-15) << degrees;
    EXPECT_NEAR(math_sine(degrees * kPi / 180.0, 0), sine(degrees), 4e-15) << degrees;
    EXPECT_NEAR(math_cosine(degrees * kPi / 180.0, 0), sine(degrees + 90), 4e-15) << degrees;
    if (degrees % 180 == 0)
      EXPECT_EQ(math_tangent(degrees, 1), 0.0);
    else if (degrees % 90 == 0)
      EXPECT_EQ(std::fabs(math_tangent(degrees, 1)), kEnd) << degrees;
    else
      EXPECT_NEAR(math_tangent(degrees, 1), sine(degrees) / sine(degrees + 90), 1e-14) << degrees;
  }
  for (const double x : {34359738360.0, 140737488355320.0})  // multiples of 360, as many degrees as a reply can show
    EXPECT_EQ(math_sine(x - std::fmod(x, 360.0) + 30.0, 1), math_sine(30.0, 1));
  for (const double x : {1e15, 1e100, DBL_MAX, -DBL_MAX})
    for (const int degrees : {0, 1}) {
      EXPECT_LE(std::fabs(math_sine(x, degrees)), 1.0) << x;
      EXPECT_LE(std::fabs(math_cosine(x, degrees)), 1.0) << x;
      EXPECT_LE(std::fabs(math_tangent(x, degrees)), kEnd) << x;
    }
}

TEST(Mathematics, ArcFunctionsAtAndBehindTheirEnds) {
  const struct {
    double x, sine, cosine;  // in degrees
  } known[] = {{-1.0, -90.0, 180.0}, {-0.5, -30.0, 120.0}, {0.0, 0.0, 90.0}, {0.5, 30.0, 60.0}, {1.0, 90.0, 0.0}};
  for (const auto& k : known) {
    EXPECT_NEAR(math_arc_sine(k.x, 1), k.sine, 1e-13);
    EXPECT_NEAR(math_arc_cosine(k.x, 1), k.cosine, 1e-13);
    EXPECT_NEAR(math_arc_sine(k.x, 0), k.sine * kPi / 180.0, 1e-15);
    EXPECT_NEAR(math_arc_cosine(k.x, 0), k.cosine * kPi / 180.0, 1e-15);
  }
  for (const double x : {1.0 + DBL_EPSILON, 2.0, DBL_MAX, -1.0 - DBL_EPSILON, -DBL_MAX}) {
    EXPECT_EQ(math_arc_sine(x, 1), 0.0) << x;
    EXPECT_EQ(math_arc_cosine(x, 1), 0.0) << x;
  }
  near(math_arc_sine(1.0 - 1e-12, 0), std::asin(1.0 - 1e-12), "ASIN", 1e-13);
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_NEAR(math_arc_tangent(sign, 1), sign * 45.0, 1e-13);
    EXPECT_NEAR(math_arc_tangent(sign * std::sqrt(3.0), 1), sign * 60.0, 1e-13);
    EXPECT_NEAR(math_arc_tangent(sign * DBL_MAX, 1), sign * 90.0, 1e-13);
    near(math_arc_tangent(sign * 1e-300, 0), sign * 1e-300, "ATAN");
  }
  EXPECT_EQ(math_arc_tangent(0.0, 1), 0.0);
}

TEST(Mathematics, ArcTangentOfTwoInEachDirection) {
  const struct {
    double y, x, degrees;
  } known[] = {{0, 1, 0},    {1, 1, 45},   {1, 0, 90}, {1, -1, 135},     {0, -1, 180},      {-1, -1, -135},
               {-1, 0, -90}, {-1, 1, -45}, {0, 0, 0},  {DBL_MIN, 0, 90}, {-DBL_MAX, 0, -90}};
  for (const auto& k : known) {
    EXPECT_NEAR(math_arc_tangent2(k.y, k.x, 1), k.degrees, 1e-13) << k.y << ", " << k.x;
    EXPECT_NEAR(math_arc_tangent2(k.y, k.x, 0), k.degrees * kPi / 180.0, 1e-15) << k.y << ", " << k.x;
  }
}

TEST(Mathematics, DivisionAndModuloAtTheirEnds) {
  EXPECT_EQ(math_divide(6.0, 3.0), 2.0);
  EXPECT_EQ(math_divide(1.0, 0.0), kEnd);
  EXPECT_EQ(math_divide(-1.0, 0.0), -kEnd);
  EXPECT_EQ(math_divide(0.0, 0.0), kEnd);
  EXPECT_EQ(math_modulo(5.0, 0.0), 0.0);
  const struct {
    double a, b, rest;
  } known[] = {{7, 3, 1},  {-7, 3, 2},   {6, 3, 0},   {-6, 3, 0},   {0.5, 0.25, 0}, {7.5, 2, 1.5},
               {7, -3, 1}, {-7, -3, -1}, {3, -3, -3}, {-3, -3, -3}, {2.5, -3, 2.5}, {4, -3, -2}};
  for (const auto& k : known) EXPECT_EQ(math_modulo(k.a, k.b), k.rest) << k.a << " % " << k.b;
  for (const double a : {-1e-20, 1e-20, 1e15, 1e16 + 2.0, -1e17, 1e300, -1e300, DBL_MAX})
    for (const double b : {3.0, 0.1, 1e-9, kEnd}) {
      EXPECT_GE(math_modulo(a, b), 0.0) << a << " % " << b;
      EXPECT_LT(math_modulo(a, b), b) << a << " % " << b;
      EXPECT_GE(math_modulo(a, -b), -b) << a << " % -" << b;
      EXPECT_LT(math_modulo(a, -b), b) << a << " % -" << b;
    }
}

TEST(Mathematics, FloorAbsoluteAndWholeNumbersAtTheirEnds) {
  for (const double x : {-2.5, -2.0, -0.5, -DBL_MIN, 0.0, 0.5, 2.0, 2.999, 4503599627370495.5, -4503599627370495.5,
                         4503599627370497.0, 1e300, -1e300}) {
    EXPECT_EQ(math_floor(x), std::floor(x)) << x;
    EXPECT_EQ(math_absolute(x), std::fabs(x)) << x;
  }
  EXPECT_EQ(math_to_integer(-0.0), 0);
  EXPECT_EQ(math_to_integer(9007199254740993.0), 9007199254740992);
  for (const double x : {k2To62, 1e300, kInfinity}) {
    EXPECT_EQ(math_to_integer(x), INT64_C(1) << 62) << x;
    EXPECT_EQ(math_to_integer(-x), -(INT64_C(1) << 62)) << x;
  }
  EXPECT_EQ(math_to_integer(k2To62 / 2), INT64_C(1) << 61);
  for (const double x : {2.5, 2.49, 0.5, 0.49, kEnd - 1.0}) {
    EXPECT_EQ(math_nearest(x), std::llround(x)) << x;
    EXPECT_EQ(math_nearest(-x), -std::llround(x)) << x;
  }
  EXPECT_EQ(math_nearest(kEnd), (INT64_C(1) << 47) - 1);
  EXPECT_EQ(math_nearest(1e300), (INT64_C(1) << 47) - 1);
  EXPECT_EQ(math_nearest(-kEnd), -(INT64_C(1) << 47));
  EXPECT_EQ(math_nearest(-1e300), -(INT64_C(1) << 47));
  EXPECT_EQ(math_nearest(std::nan("")), (INT64_C(1) << 47) - 1);
}

TEST(Mathematics, NumbersTakenApartAndPutTogether) {
  EXPECT_TRUE(math_is_finite(DBL_MAX));
  EXPECT_TRUE(math_is_finite(-DBL_MIN));
  EXPECT_FALSE(math_is_finite(kInfinity));
  EXPECT_FALSE(math_is_finite(-kInfinity));
  EXPECT_FALSE(math_is_finite(std::nan("")));
  EXPECT_EQ(math_scale(1.0, 1023), std::ldexp(1.0, 1023));
  EXPECT_EQ(math_scale(-1.5, -1022), -1.5 * DBL_MIN);
  EXPECT_EQ(math_scale(1.0, -1023), 0.0) << "underflow";
  EXPECT_EQ(math_scale(0.0, 1000), 0.0);
  EXPECT_TRUE(math_is_finite(math_scale(1.5, 1024)));
  for (const double x : {1.0, -1.0, 0.1, -0.3, 34359738367.5, kEnd, DBL_MAX, DBL_MIN, 1.0 - DBL_EPSILON})
    for (const unsigned bits : {1u, 24u, 36u, 52u}) {
      std::int64_t mantissa = 0;
      int exponent = 0, e = 0;
      const bool exact = math_to_fixed(x, bits, &mantissa, &exponent);
      const double m = std::round(std::ldexp(std::fabs(std::frexp(x, &e)), static_cast<int>(bits)));
      const double value = std::copysign(std::ldexp(m, e - static_cast<int>(bits)), x);
      EXPECT_EQ(exact, value == x) << x << " in " << bits;
      if (!std::isfinite(value)) continue;
      EXPECT_EQ(math_from_fixed(mantissa, exponent - static_cast<int>(bits)), value) << x << " in " << bits;
    }
}

// 2^47 degrees are 248 more than whole turns.
TEST(Mathematics, TheLargestAngleIsOneStill) {
  near(math_sine(kEnd, 1), std::sin(248 * kPi / 180), "SIN");
  near(math_cosine(-kEnd, 1), std::cos(248 * kPi / 180), "COS");
  EXPECT_EQ(math_sine(kEnd * (1 + DBL_EPSILON), 1), 0.0) << "of more hardly anything is left";
}

// The 48-bit word of P and Q variables (firmware:1.2/5) where its mantissa is not normal, and where no double has it.
constexpr int kBias = 2047, kMantissaBits = 35;

float48 word(std::int64_t mantissa, int exponent) {
  const auto bits = static_cast<std::uint64_t>(mantissa);
  return {static_cast<std::uint32_t>(bits >> 12 & 0xFFFFFF),
          static_cast<std::uint32_t>((bits & 0xFFF) << 12 | static_cast<unsigned>(exponent))};
}

TEST(Float48, AWordThatIsNotNormalHasItsValue) {
  for (int shift = 0; shift < kMantissaBits - 1; ++shift)
    for (const std::int64_t sign : {1, -1}) {
      const std::int64_t mantissa = sign * ((std::int64_t{3} << (kMantissaBits - 2)) >> shift);
      EXPECT_EQ(float48_unpack(word(mantissa, kBias + 5)), std::ldexp(static_cast<double>(mantissa), 5 - kMantissaBits))
          << "shifted by " << shift;
    }
}

// 0.75 * 2^(E - 2047) is 1.5 * 2^-1022 with E = 1026.
TEST(Float48, WhatIsBelowTheLeastDoubleIsZero) {
  const std::int64_t mantissa = std::int64_t{3} << (kMantissaBits - 2);
  EXPECT_EQ(float48_unpack(word(mantissa, 1026)), std::ldexp(1.5, -1022));
  EXPECT_EQ(float48_unpack(word(mantissa, 1025)), 0.0);
  EXPECT_EQ(float48_unpack(word(mantissa >> 1, 1026)), 0.0) << "not normal";
  EXPECT_EQ(float48_unpack(word(mantissa, 0)), 0.0);
}

}  // namespace
