// Expressions against the C++ standard library, precedence and domain errors (firmware:1.7, firmware:10/9).
#include <cmath>
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

constexpr double kRadian = 180.0 / 3.14159265358979323846;

class Expression : public FirmwareTest {
 protected:
  static double value(const std::string& text) {
    lexer lx{text.c_str()};
    double result = -12345.0;
    EXPECT_EQ(expression_evaluate(&lx, 0, &result), ERR_NONE) << text;
    EXPECT_EQ(lexer_peek(&lx), 0) << text << ": something was left over";
    return result;
  }
  static error_t error(const std::string& text) {
    lexer lx{text.c_str()};
    double result = 0.0;
    return expression_evaluate(&lx, 0, &result);
  }
  static void near(double actual, double expected, const std::string& what) {
    EXPECT_NEAR(actual, expected, 1e-10 * std::fmax(1.0, std::fabs(expected))) << what;
  }
};

TEST_F(Expression, PrecedenceAndOrder) {
  EXPECT_EQ(value("1+2*3"), 7.0);
  EXPECT_EQ(value("(1+2)*3"), 9.0);
  EXPECT_EQ(value("8-3-2"), 3.0);
  EXPECT_EQ(value("64/4/2"), 8.0);
  EXPECT_EQ(value("7|8&12"), 15.0);  // & above |
  EXPECT_EQ(value("5^1+2"), 6.0);    // ^ and + on one level: (5^1)+2
  EXPECT_EQ(value("10-3%2"), 9.0);
  EXPECT_EQ(value("-(2+3)*2"), -10.0);
  EXPECT_EQ(value("2*-3"), -6.0);
  EXPECT_EQ(value("$20000|1"), 131073.0);
  EXPECT_EQ(value("131073&$FDFFFF"), 1.0);
  EXPECT_EQ(value("0-1&$FF"), -1.0);  // 0-(1&255)
  EXPECT_EQ(value("-1&$FF"), 255.0);
}

// In binary 0.875 is 0.111, 1.75 is 1.11, -0.25 ...11.11 and -1 ...11.00 (firmware:1.7/2).
TEST_F(Expression, BitOperatorsTakeTheFractionToo) {
  EXPECT_EQ(value("0.875&1.75"), 0.75);
  EXPECT_EQ(value("1.5|0.25"), 1.75);
  EXPECT_EQ(value("2.5^0.75"), 2.25);
  EXPECT_EQ(value("-0.25&1.5"), 1.5);
  EXPECT_EQ(value("-0.25|0.5"), -0.25);
  EXPECT_EQ(value("-1^0.25"), -0.75);
  EXPECT_EQ(value("-1&5.75"), 5.0);
  EXPECT_EQ(value("P1|P2"), 0.0) << "0 and 0";
  for (const double each : {1.0 / 3.0, -1.0 / 3.0, 34359738367.5, -34359738367.5, 1.0e-6, 140737488355328.0}) {
    p_variable_write(1, each);
    const double kept = p_variable_read(1);
    EXPECT_EQ(value("P1&P1"), kept) << each;
    EXPECT_EQ(value("P1|0"), kept) << each;
    EXPECT_EQ(value("0^P1"), kept) << each;
    EXPECT_EQ(value("P1^P1"), 0.0) << each;
  }
}

TEST_F(Expression, VariablesAndComputedIndex) {
  p_variable_write(1, 3.0);
  p_variable_write(30, 4.5);
  q_variable_write(0, 7, 2.5);
  platform::set_i(113, 12.0);
  m_variable_write(70, 9.0);
  EXPECT_EQ(value("P1*10"), 30.0);
  EXPECT_EQ(value("P(P1*10)+Q7"), 7.0);
  EXPECT_EQ(value("I(100+P1+10)+M70"), 21.0);
}

// Of 35 bits and a sign: m / 2^35 x 2^e with m in [2^34, 2^35) (firmware:1.2/5), the nearest one.
TEST_F(Expression, ConstantsAre48BitFloats) {
  for (const char* text :
       {"0.1", "3.7", "1250.1", "34359738367.5", "0.9998474121", "123456789.123456", ".5", "007", "1.0000000001"}) {
    const double exact = std::strtod(text, nullptr);
    int exponent = 0;
    const double mantissa = std::round(std::ldexp(std::frexp(exact, &exponent), 35));
    EXPECT_EQ(value(text), std::ldexp(mantissa, exponent - 35)) << text;
    EXPECT_EQ(value(std::string("-") + text), -std::ldexp(mantissa, exponent - 35)) << text;
    p_variable_write(1, exact);
    EXPECT_EQ(value(text), p_variable_read(1)) << "what a variable keeps of it: " << text;
  }
  EXPECT_EQ(value("$FFFFFF"), 16777215.0);
  EXPECT_EQ(value("$7FFFFFFFF"), 34359738367.0);
}

// Mantissa of 35 bits, half up (firmware:1.2/5).
double rounded(double value) {
  int exponent;
  const double mantissa = std::floor(std::ldexp(std::fabs(std::frexp(value, &exponent)), 35) + 0.5);
  return std::copysign(std::ldexp(mantissa, exponent - 35), value);
}

// firmware:1.2/6: the controller has no other numbers, so a variable is what it has been set to.
TEST_F(Expression, EachResultIsA48BitFloat) {
  std::mt19937 random(brick::random_seed(4));
  std::uniform_real_distribution<double> any(-1000.0, 1000.0);
  for (int i = 0; i < 300; ++i) {
    double p[4] = {};
    for (unsigned n = 1; n < 4; ++n) p_variable_write(n, any(random)), p[n] = p_variable_read(n);
    EXPECT_EQ(value("P1*P2+P3"), rounded(rounded(p[1] * p[2]) + p[3]));
    EXPECT_EQ(value("(P1-P2)/P3"), rounded(rounded(p[1] - p[2]) / p[3]));
    p_variable_write(4, value("P1/P2"));
    EXPECT_EQ(value("P1/P2-P4"), 0.0);
  }
  EXPECT_EQ(value("34359738367*2+1"), 68719476736.0) << "2^36 - 1";
}

TEST_F(Expression, FunctionsInDegreesAndRadians) {
  std::mt19937_64 random(brick::random_seed(7));
  std::uniform_real_distribution<double> angle(-1000.0, 1000.0), unit(-1.0, 1.0), positive(1e-6, 1e6),
      small(-20.0, 20.0);
  for (int i = 0; i < 500; ++i) {
    const auto stored = [](std::uint32_t number, double exact) {  // 36 bits of it
      p_variable_write(number, exact);
      return p_variable_read(number);
    };
    const double a = stored(1, angle(random)), u = stored(2, unit(random)), x = stored(3, positive(random)),
                 e = stored(4, small(random));
    q_variable_write(0, 0, e);
    platform::set_i(15, 0);
    near(value("SIN(P1)"), std::sin(a / kRadian), "sin degrees");
    near(value("COS(P1)"), std::cos(a / kRadian), "cos degrees");
    near(value("ASIN(P2)"), std::asin(u) * kRadian, "asin degrees");
    near(value("ACOS(P2)"), std::acos(u) * kRadian, "acos degrees");
    near(value("ATAN(P1)"), std::atan(a) * kRadian, "atan degrees");
    near(value("ATAN2(P1)"), std::atan2(a, e) * kRadian, "atan2 degrees");
    platform::set_i(15, 1);
    near(value("SIN(P1)"), std::sin(a), "sin radians");
    near(value("TAN(P2)"), std::tan(u), "tan radians");
    near(value("ACOS(P2)"), std::acos(u), "acos radians");
    near(value("ATAN2(P1)"), std::atan2(a, e), "atan2 radians");
    near(value("LN(P3)"), std::log(x), "ln");
    near(value("EXP(P4)"), std::exp(e), "exp");
    near(value("SQRT(P3)"), std::sqrt(x), "sqrt");
    near(value("ABS(P1)"), std::fabs(a), "abs");
    near(value("INT(P1)"), std::floor(a), "int");
    near(value("SQRT(SIN(P1)*SIN(P1)+COS(P1)*COS(P1))"), 1.0, "pythagoras");
  }
}

TEST_F(Expression, ExactAtMultiplesOfNinetyDegrees) {
  EXPECT_EQ(value("SIN(180)"), 0.0);
  EXPECT_EQ(value("COS(90)"), 0.0);
  EXPECT_EQ(value("SIN(-270)"), 1.0);
  EXPECT_EQ(value("COS(720)"), 1.0);
}

TEST_F(Expression, ModuloRanges) {
  EXPECT_EQ(value("7%3"), 1.0);
  EXPECT_EQ(value("(0-7)%3"), 2.0);    // [0, n)
  EXPECT_EQ(value("(0-7)%-3"), -1.0);  // [-n, n): -7 + 6
  EXPECT_EQ(value("4%-3"), -2.0);      // 4 - 6
  EXPECT_EQ(value("3%-3"), -3.0);
}

TEST_F(Expression, IntRoundsTowardMinusInfinity) {
  EXPECT_EQ(value("INT(-0.5)"), -1.0);
  EXPECT_EQ(value("INT(2.9)"), 2.0);
}

TEST_F(Expression, DomainErrorsSaturateOrGiveZero) {
  EXPECT_EQ(value("1/0"), 140737488355328.0);
  EXPECT_EQ(value("-1/0"), -140737488355328.0);
  EXPECT_EQ(value("SQRT(0-1)"), 0.0);
  EXPECT_EQ(value("LN(0)"), 0.0);
  EXPECT_EQ(value("ASIN(2)"), 0.0);
}

TEST_F(Expression, RejectsBadText) {
  for (const char* text : {"", "1+", "(1+2", "*3", "SIN 30", "SIN(", "P", "P9000", "34359738369", "P1.5", "()"})
    EXPECT_EQ(error(text), ERR_DATA) << '"' << text << '"';
  std::string deep(300, '(');
  EXPECT_EQ(error(deep + "1" + std::string(300, ')')), ERR_DATA) << "nesting is limited";
}

TEST_F(Expression, NothingInALineOf255CharactersIsTooDeep) {
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    while (count-- > 0) all += text;
    return all;
  };
  EXPECT_EQ(value(repeated("(", 126) + "7" + repeated(")", 126)), 7.0);
  EXPECT_EQ(value(repeated("1+(", 63) + "1" + repeated(")", 63)), 64.0);
  EXPECT_EQ(value(repeated("-", 250) + "P1"), 0.0);
  EXPECT_EQ(value(repeated("1+", 127) + "1"), 128.0);
  EXPECT_EQ(value(repeated(".5+", 84) + ".5"), 42.5);
  EXPECT_EQ(value(repeated("ABS(", 50) + "-3" + repeated(")", 50)), 3.0);
}

TEST_F(Expression, StopsBehindACompleteValue) {
  lexer lx{"5+1 I114=6"};
  double result = 0.0;
  ASSERT_EQ(expression_evaluate(&lx, 0, &result), ERR_NONE);
  EXPECT_EQ(result, 6.0);
  EXPECT_EQ(lexer_peek(&lx), 'I');
}

// firmware:1.1/4: the limit itself is a constant, in either sign.
TEST_F(Expression, ConstantsHaveALimitInEitherSign) {
  for (const char* sign : {"", "-"}) {
    const std::string s = sign;
    EXPECT_EQ(platform::host("P1=" + s + "34359738368 P1=P1/1024 P1"), s + "33554432");
    EXPECT_EQ(platform::host("P1=" + s + "34359738369"), "ERR003");
    EXPECT_EQ(platform::host(s + "34359738369"), "ERR003");
    EXPECT_EQ(platform::host("#1->" + s + "34359738368X #1->"), s + "34359738368X");
    EXPECT_EQ(platform::host("#1->" + s + "34359738369X"), "ERR003");
    EXPECT_EQ(platform::host("#1->X" + std::string(s.empty() ? "+" : s) + "34359738369"), "ERR003");
  }
}

TEST_F(Expression, LexerTakesTheNumbersOfTheLanguage) {
  struct {
    const char* text;
    bool ok;
    double value;
    char next;
  } const cases[] = {{"12.50X", true, 12.5, 'X'}, {"0..99", true, 0.0, '.'}, {"$aG", false, 0.0, '$'},
                     {"$FG", true, 15.0, 'G'},    {".", false, 0.0, '.'},    {"  7 ;9", true, 7.0, 0},
                     {"5.", true, 5.0, 0},        {"000.250", true, 0.25, 0}};
  for (const auto& c : cases) {
    lexer lx{c.text};
    double v = 0.0;
    EXPECT_EQ(lexer_number(&lx, &v), c.ok) << c.text;
    if (c.ok) { EXPECT_EQ(v, c.value) << c.text; }
    EXPECT_EQ(lexer_peek(&lx), c.next) << c.text;
  }
  lexer limit{"-34359738368"};
  double v = 0.0;
  EXPECT_EQ(lexer_constant(&limit, &v), ERR_NONE);
  EXPECT_EQ(v, -34359738368.0);
  lexer beyond{"34359738368.5"};
  EXPECT_EQ(lexer_constant(&beyond, &v), ERR_DATA);
  lexer whole{"2.5"};
  std::int32_t n = 0;
  EXPECT_EQ(lexer_integer(&whole, &n), ERR_DATA);
}

// firmware:1.7/4: x of ATAN2(y) is Q0 of the addressed system.
TEST_F(Expression, ArcTangentOfTwoTakesQ0OfItsSystem) {
  EXPECT_EQ(platform::host("&1 Q0=-1"), "");
  EXPECT_EQ(platform::host("&2 Q0=1 P1=ATAN2(1)"), "");
  EXPECT_EQ(platform::host("&1 P2=ATAN2(1) P1..2"), "45|135");
}

}  // namespace
