// Products and quotients of the image are those of the machine, to the last bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

extern "C" {
#include "firmware/base/soft_double.h"
}

namespace {

std::uint64_t bits(double x) {
  std::uint64_t word;
  std::memcpy(&word, &x, sizeof word);
  return word;
}
double value(std::uint64_t word) {
  double x;
  std::memcpy(&x, &word, sizeof x);
  return x;
}

class SoftDouble : public ::testing::Test {
 protected:
  static void expect(double a, double b) {
    const double found[] = {soft_double_product(a, b), soft_double_quotient(a, b)}, exact[] = {a * b, a / b};
    for (int i = 0; i < 2; ++i) {
      const char* const of = i == 0 ? " * " : " / ";
      if (exact[i] == exact[i])
        ASSERT_EQ(bits(found[i]), bits(exact[i])) << a << of << b;
      else
        ASSERT_EQ(bits(found[i]), 0x7FF8000000000000u) << a << of << b;
    }
  }
  std::mt19937_64 random{1};
};

TEST_F(SoftDouble, OfAllSizes) {
  for (int i = 0; i < 200000 && !HasFailure(); ++i) expect(value(random()), value(random()));
}

// Significands that end in zeros or ones, so that results are exact or about the middle of two doubles.
TEST_F(SoftDouble, NearToTies) {
  const auto some = [this] {
    const std::uint64_t ones = (std::uint64_t{1} << random() % 53) - 1, word = random() >> 12;
    return value(std::uint64_t{1021 + random() % 5} << 52 | (random() % 2 == 0 ? word & ~ones : word | ones));
  };
  for (int i = 0; i < 200000 && !HasFailure(); ++i) expect(some(), some());
}

// Results that are too large, or too small to have all of their bits, from such ones too.
TEST_F(SoftDouble, AtTheEndsOfTheRange) {
  const auto some = [this] {
    const std::uint64_t ends[] = {0, 0, 1, 2, 500, 550, 1500, 1550, 2045, 2046};
    return value(random() >> 63 << 63 | ends[random() % 10] << 52 | random() >> (12 + random() % 52));
  };
  for (int i = 0; i < 200000 && !HasFailure(); ++i) expect(some(), some());
}

// The smallest in halves, quarters and so on: results in the very middle of two, and beside it.
TEST_F(SoftDouble, TiesOfTheSmallest) {
  for (std::uint64_t k = 1; k < 300; ++k)
    for (int n = 1; n < 8; ++n) {
      expect(value(k), std::ldexp(1, n));
      expect(value(k), std::ldexp(1, -n));
      expect(value(k), std::ldexp(3, -n));
    }
}

TEST_F(SoftDouble, Special) {
  const double ones[] = {0.0,
                         value(0x7FF0000000000000),
                         value(0x7FF8000000000000),
                         value(0x7FF0000000000001),
                         1.0,
                         value(1),
                         value(0x000FFFFFFFFFFFFF),
                         value(0x0010000000000000),
                         -0.5,
                         value(0x7FEFFFFFFFFFFFFF),
                         value(0x3FFFFFFFFFFFFFFF),
                         value(0x3FEFFFFFFFFFFFFF)};
  for (const double a : ones)
    for (const double b : ones)
      for (int signs = 0; signs < 4; ++signs) expect((signs & 1) != 0 ? -a : a, (signs & 2) != 0 ? -b : b);
}

}  // namespace
