// Program words: the layout of host-bus:7.7, rounding of wide constants, round trips.
#include <cmath>
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

word48_t encode(operation op, std::uint32_t group, std::uint32_t number, double value) {
  const instruction in{op, group, number, value};
  return word_encode(&in);
}

TEST(ProgramWord, ShortFormIsTheBinaryRotaryFormat) {
  BRICK_COVERS("BIN-3");
  // X1000: CODE1 = 1 (axis), N = 6 (X), 1000 = 0.9765625 * 2^10, fraction 0.9765625 * 2^23 = 0x7D0000.
  EXPECT_EQ(encode(OP_AXIS, 0, AXIS_X, 1000.0), (1ull << 43) | (6ull << 30) | (10ull << 24) | 0x7D0000ull);
  // A-0.75: -0.75 * 2^23 = -0x600000 -> 0xA00000 in 24 bits, exponent 0.
  EXPECT_EQ(encode(OP_AXIS, 0, AXIS_A, -0.75), (1ull << 43) | 0xA00000ull);
  // F100: CODE1 = 3, N = 0, 100 = 0.78125 * 2^7.
  EXPECT_EQ(encode(OP_RATE, 0, RATE_F, 100.0), (3ull << 43) | (7ull << 24) | 0x640000ull);
  // DWELL with 0: N = 4, all else zero.
  EXPECT_EQ(encode(OP_RATE, 0, RATE_DWELL, 0.0), (3ull << 43) | (4ull << 30));
  // RAPID: CODE1 = 2, CODE2 = 0, N = 1. INC(X,Y): CODE2 = 2, N = mask of Y and X.
  EXPECT_EQ(encode(OP_MODE, 0, MODE_RAPID, 0.0), (2ull << 43) | (1ull << 30));
  EXPECT_EQ(encode(OP_INC, 0, 0xC0, 0.0), (2ull << 43) | (2ull << 40) | (0xC0ull << 30));
  // P5=2: CODE1 = 5; 2 = 0.5 * 2^2.
  EXPECT_EQ(encode(OP_ASSIGN, VARIABLE_P, 5, 2.0), (5ull << 43) | (5ull << 30) | (2ull << 24) | 0x400000ull);
}

TEST(ProgramWord, StartOfLineBitChangesNothingElse) {
  for (const double value : {1000.0, 0.1, -3.3e9}) {
    const instruction in = word_decode(encode(OP_AXIS, 0, AXIS_Z, value) | WORD_START_OF_LINE);
    EXPECT_EQ(in.operation, OP_AXIS);
    EXPECT_EQ(in.number, static_cast<std::uint32_t>(AXIS_Z));
    EXPECT_NEAR(in.value, value, std::fabs(value) * 2.4e-10);
  }
}

TEST(ProgramWord, ValuesRoundToThirtyThreeBits) {
  std::mt19937_64 random(brick::random_seed(3));
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-20, 35);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::ldexp(mantissa(random), exponent(random));
    for (std::uint32_t axis = 0; axis < AXIS_COUNT; ++axis) {
      const instruction in = word_decode(encode(OP_AXIS, 0, axis, value));
      ASSERT_EQ(in.operation, OP_AXIS);
      ASSERT_EQ(in.number, axis);
      ASSERT_LE(std::fabs(in.value - value), std::fabs(value) * std::ldexp(1.0, -32));
    }
    const instruction rate = word_decode(encode(OP_RATE, 0, RATE_DELAY, std::fabs(value)));
    ASSERT_EQ(rate.operation, OP_RATE);
    ASSERT_EQ(rate.number, static_cast<std::uint32_t>(RATE_DELAY));
  }
}

TEST(ProgramWord, ExactValuesStayExact) {
  for (const double value :
       {0.0, 1.0, -1.0, 8388607.0, 8388608.0, -8388609.0, 4294967295.0, -4294967296.0, 34359738368.0, 0.015625}) {
    EXPECT_TRUE(word_holds_exactly(value)) << value;
    EXPECT_EQ(word_decode(encode(OP_PUSH, 0, 0, value)).value, value);
    EXPECT_EQ(word_decode(encode(OP_AXIS, 0, AXIS_X, value)).value, value);
  }
  EXPECT_FALSE(word_holds_exactly(0.1));
  EXPECT_EQ(word_double_join(word_double_head(0.1), word_double_tail(0.1)), 0.1);
  EXPECT_EQ(word_decode(word_double_head(0.1)).operation, OP_PUSH_DOUBLE);
  EXPECT_EQ(word_double_join(word_double_head(-1e12 / 3), word_double_tail(-1e12 / 3)), -1e12 / 3);
}

TEST(ProgramWord, StackInstructionsRoundTrip) {
  for (const operation op :
       {OP_PUSH_VARIABLE, OP_ASSIGN_POP, OP_PUSH_INDEXED, OP_ASSIGN_INDEXED, OP_AXIS_POP, OP_RATE_POP}) {
    const instruction in = word_decode(encode(op, VARIABLE_Q, 8191, 0.0));
    EXPECT_EQ(in.operation, op);
    EXPECT_EQ(in.group, static_cast<std::uint32_t>(VARIABLE_Q));
    EXPECT_EQ(in.number, 8191u);
  }
  EXPECT_EQ(word_decode(encode(OP_APPLY, 0, OPERATOR_INT, 0.0)).number, static_cast<std::uint32_t>(OPERATOR_INT));
}

TEST(ProgramWord, StatementsOfFixedProgramsRoundTrip) {
  BRICK_COVERS("BIN-3");
  const struct {
    operation op;
    std::uint32_t group, number;
  } words[] = {{OP_STATEMENT, 0, WORD_KEY(8, 0, 0)},
               {OP_STATEMENT, 0, WORD_KEY(1, 3, AXIS_Z)},
               {OP_STATEMENT_POP, 0, WORD_KEY(9, 0, 3)},
               {OP_CONDITION, CONDITION_INNER_OR, CONDITION_MORE | CONDITION_COMPARATOR},
               {OP_SYNCHRONOUS, SYNCHRONOUS_XOR, 8191},
               {OP_SYNCHRONOUS_INDEXED, SYNCHRONOUS_AND, 0},
               {OP_LIST, WORD_KEY(9, 1, 8), 0xFFFFFFFF},
               {OP_LIST, WORD_KEY(9, 1, 0), 0x40000001},
               {OP_TEXT, WORD_KEY(9, 2, 10), 0xFFFFFF}};
  for (const auto& w : words) {
    const word48_t word = encode(w.op, w.group, w.number, 0.0);
    EXPECT_EQ(word & WORD_START_OF_LINE, 0u);
    const instruction in = word_decode(word);
    EXPECT_EQ(in.operation, w.op);
    EXPECT_EQ(in.group, w.group);
    EXPECT_EQ(in.number, w.number);
  }
}

TEST(ProgramWord, HexadecimalConstantsKeepTheirForm) {
  BRICK_COVERS("I9-3");
  for (const operation op : {OP_PUSH, OP_AXIS, OP_RATE}) {
    const instruction hexadecimal = word_decode(encode(op, 1, op == OP_PUSH ? 0 : 3, 31.0));
    EXPECT_EQ(hexadecimal.operation, op);
    EXPECT_EQ(hexadecimal.group, 1u);
    EXPECT_EQ(hexadecimal.value, 31.0);
    EXPECT_EQ(word_decode(encode(op, 0, op == OP_PUSH ? 0 : 3, 31.0)).group, 0u);
  }
}

TEST(ProgramWord, UndefinedCodesAreIllegal) {
  EXPECT_EQ(word_decode((8ull << 43) | (1ull << 40)).operation, OP_ILLEGAL);
  EXPECT_EQ(word_decode((9ull << 43) | (5ull << 40)).operation, OP_ILLEGAL);
  EXPECT_EQ(word_decode((1ull << 43) | (9ull << 30)).operation, OP_ILLEGAL);  // axis 9
  EXPECT_EQ(word_decode((2ull << 43) | (4ull << 40)).operation, OP_ILLEGAL);
  EXPECT_EQ(word_decode((5ull << 43) | (1ull << 40)).operation, OP_ILLEGAL);  // only M has synchronous ones
  EXPECT_EQ(word_decode(32ull << 30).operation, OP_ILLEGAL);                  // end-of-buffer mark
}

// The exponent of a short word has six bits with its sign, that of a wide one seven; no text has such a value.
TEST(ProgramWord, WhatIsTooSmallForAWordIsZero) {
  EXPECT_TRUE(word_holds_short(std::ldexp(1, -33)));
  EXPECT_FALSE(word_holds_short(std::ldexp(1, -34)));
  EXPECT_TRUE(word_holds_exactly(std::ldexp(1, -65)));
  EXPECT_FALSE(word_holds_exactly(std::ldexp(1, -66)));
  EXPECT_EQ(word_decode(encode(OP_AXIS, 0, AXIS_X, -std::ldexp(1, -65))).value, -std::ldexp(1, -65));
  EXPECT_EQ(encode(OP_AXIS, 0, AXIS_X, -std::ldexp(1, -66)), encode(OP_AXIS, 0, AXIS_X, 0));
}

TEST(ProgramWord, WhatIsNoOperationIsABlank) {
  EXPECT_EQ(encode(OP_BLANK, 0, 0, 0), 0u);
  EXPECT_EQ(encode(OP_ILLEGAL, 3, 4, 5), 0u);
  EXPECT_EQ(word_decode(0).operation, OP_BLANK);
}

}  // namespace
