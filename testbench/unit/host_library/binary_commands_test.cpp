// Program text as commands of a binary rotary buffer (host-bus:7.7): each form by its fields, and what that form cannot
// say by the library's codes (host-bus:7.5/12).
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "testbench/host/binary_commands.h"

namespace brick {

static bool operator==(const BinaryCommand& a, const BinaryCommand& b) {
  return a.first == b.first && a.second == b.second;
}
static void PrintTo(const BinaryCommand& c, std::ostream* out) {
  char text[32];
  std::snprintf(text, sizeof text, "%06X %06X", c.first, c.second);
  *out << text;
}

namespace {

using Commands = std::vector<BinaryCommand>;

// 0.5 <= |fraction| < 1, which is what frexp() gives; of zero all is zero.
BinaryCommand command(unsigned code1, unsigned code2, unsigned n, double value = 0) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent) * 0x800000;
  EXPECT_EQ(fraction, std::trunc(fraction)) << "of 23 bits";
  return {code1 << 19 | code2 << 16 | n << 6 | (static_cast<unsigned>(exponent) & 0x3F),
          static_cast<std::uint32_t>(static_cast<std::int32_t>(fraction)) & 0xFFFFFF};
}

// A mask of 32 bits: 31 and 30 in the statement's number, 29 to 24 in the place of the exponent.
BinaryCommand list(unsigned n, std::uint32_t mask) {
  return {9u << 19 | 1u << 16 | (n | (mask >> 30) << 5) << 6 | (mask >> 24 & 0x3F), mask & 0xFFFFFF};
}

void expect_commands(const std::string& text, Commands expected) {
  const BinaryLine line = binary_line(text);
  EXPECT_EQ(line.result, BinaryResult::kOk) << text;
  if (!expected.empty()) expected[0].first |= 0x800000;  // the start of a line
  EXPECT_EQ(line.commands, expected) << text;
}

void expect_refused(BinaryResult result, const std::vector<std::string>& lines) {
  for (const std::string& text : lines) {
    EXPECT_EQ(binary_line(text).result, result) << text;
    EXPECT_TRUE(binary_line(text).commands.empty()) << "nothing of " << text;
    EXPECT_EQ(binary_line("Y1 " + text).result, result) << "behind another";
    EXPECT_TRUE(binary_line("Y1 " + text).commands.empty()) << "nor what was before it in the line";
  }
}

TEST(BinaryCommands, BlankLinesAndCommentsAreNoCommand) {
  for (const char* text : {"", " ", "\t ", ";", " ; X1", ";;"}) expect_commands(text, {});
  expect_commands("X1 ; Y2", {command(1, 0, 6, 1)});
  expect_commands(" \tx1\ty2 ", {command(1, 0, 6, 1), command(1, 0, 7, 2)});
}

TEST(BinaryCommands, ALineHas255Characters) {
  EXPECT_EQ(binary_line("X1" + std::string(253, ' ')).result, BinaryResult::kOk);
  EXPECT_EQ(binary_line("X1" + std::string(254, ' ')).result, BinaryResult::kSyntax);
}

TEST(BinaryCommands, AxesAndWhatBelongsToThem) {
  const std::string axes = "ABCUVWXYZ";
  for (unsigned n = 0; n < axes.size(); ++n) {
    const std::string axis(1, axes[n]);
    expect_commands(axis + "5", {command(1, 0, n, 5)});
    expect_commands(axis + " -5", {command(1, 0, n, -5)});
    expect_commands(axis + "+.5", {command(1, 0, n, 0.5)});
    expect_commands(axis + "1^2", {command(1, 0, n, 1), command(1, 2, n, 2)});
    expect_commands(axis + "1 : -3 ", {command(1, 0, n, 1), command(1, 3, n, -3)});
  }
  expect_commands("X1I5 J-2 K.25R 3", {command(1, 0, 6, 1), command(1, 1, 0, 5), command(1, 1, 1, -2),
                                       command(1, 1, 2, 0.25), command(1, 1, 3, 3)});
  expect_commands("J1 I2", {command(1, 1, 1, 1), command(1, 1, 0, 2)});
  expect_refused(BinaryResult::kConversion, {"X-", "X.", "X1^", "X1:", "X+"});
  expect_refused(BinaryResult::kIllegal, {"X(P1)", "X$10", "X1^(P1)", "X1:$5", "J(P1)"});
  expect_refused(BinaryResult::kSyntax, {"X", "X1 R", "X1..2", "X^1", "J", "?", "&2X1", "OPEN ROT"});
  EXPECT_EQ(binary_line("I5").result, BinaryResult::kSyntax) << "by itself it asks for the variable";
  EXPECT_EQ(binary_line("I5 X1").result, BinaryResult::kSyntax);
}

TEST(BinaryCommands, NumbersAreExactOrRefused) {
  for (const auto& [text, value] : std::vector<std::pair<std::string, double>>{{"0", 0},
                                                                               {"-0", 0},
                                                                               {"0.000", 0},
                                                                               {"007", 7},
                                                                               {"5.", 5},
                                                                               {"0005.500", 5.5},
                                                                               {"-.125", -0.125},
                                                                               {"8388607", 8388607},
                                                                               {"8388608", 8388608},
                                                                               {"-8388610", -8388610},
                                                                               {"1048575.875", 1048575.875},
                                                                               {"2147483392", 2147483392.0},
                                                                               {"-2147483392", -2147483392.0},
                                                                               {"0.0000152587890625", std::exp2(-16)},
                                                                               {"0.000030517578125", std::exp2(-15)}})
    expect_commands("X" + text, {command(1, 0, 6, value)});
  expect_commands("X0." + std::string(7, '0') + "298023223876953125", {command(1, 0, 6, std::exp2(-25))});
  expect_refused(BinaryResult::kFloat,
                 {"X0.1", "X8388609", "X16777218.5", "X1.00000001", "X1234567890", "X.0000000001", "X2147483391",
                  "X1000000000.000000001", "X0.0000000000000000000001234567890123456789", "X0.1234567890123456789"});
  expect_refused(BinaryResult::kRange, {"X2147483648", "X-4294967296", "X100000000000000000", "X99999999999999999999",
                                        "X12345678901.00000001"});
}

TEST(BinaryCommands, ModesRatesAndTimes) {
  const std::pair<const char*, unsigned> modes[] = {
      {"LINEAR", 0},  {"LIN", 0},     {"RAPID", 1}, {"rpd", 1},   {"CIRCLE1", 2},     {"CIR2", 3},
      {"SPLINE1", 4}, {"SPLINE2", 5}, {"CC0", 8},   {"CC3", 11},  {"BLOCKSTART", 16}, {"BSTOP", 17},
      {"STOP", 18},   {"TINIT", 24},  {"MVTM", 25}, {"PSET", 26}, {"NORMAL", 27},     {"NRM", 27}};
  for (const auto& [text, n] : modes) expect_commands(text, {command(2, 0, n)});
  expect_commands("LINX1", {command(2, 0, 0), command(1, 0, 6, 1)});
  const std::pair<const char*, unsigned> values[] = {
      {"F", 0},   {"TM", 1},   {"TA", 2},   {"TS", 3},    {"DWELL", 4}, {"DWE", 4},   {"DELAY", 5},   {"DLY", 5},
      {"CCR", 6}, {"ADIS", 8}, {"IDIS", 9}, {"AROT", 10}, {"IROT", 11}, {"TSEL", 12}, {"PRELUDE", 13}};
  for (const auto& [text, n] : values) {
    expect_commands(std::string(text) + "100", {command(3, 0, n, 100)});
    expect_commands(std::string(text) + " 0", {command(3, 0, n)});
  }
  expect_commands("PVT 25", {command(2, 0, 6, 25)});
  for (const char* name : {"F", "TA", "TS", "DWE", "DLY", "PVT", "TM"}) {
    EXPECT_EQ(binary_line(std::string(name) + "-1").result, BinaryResult::kRange) << name;
    EXPECT_EQ(binary_line(std::string(name) + "-0").result, BinaryResult::kOk) << name;
  }
  for (const char* name : {"CCR", "ADIS", "TSEL", "S"})
    EXPECT_EQ(binary_line(std::string(name) + "-1").result, BinaryResult::kOk) << name;
  expect_commands("TM8388607", {command(3, 0, 1, 8388607)});
  expect_commands("TA8388608", {command(3, 0, 2, 8388608)});
  expect_refused(BinaryResult::kRange, {"TM8388608", "F-.5"});
  expect_refused(BinaryResult::kIllegal, {"F(Q1)", "TM$5", "F+(P1)"});
  expect_refused(BinaryResult::kSyntax, {"F", "TM", "F.", "DWELL", "FX1", "LINE"});
}

// Letters behind a call are its arguments, elsewhere variables.
TEST(BinaryCommands, CallsLabelsAndArguments) {
  const std::pair<const char*, unsigned> letters[] = {{"G", 0}, {"M", 1}, {"T", 2}, {"D", 3}, {"S", 4}};
  for (const auto& [text, n] : letters) expect_commands(std::string(text) + "1.5", {command(8, 0, n, 1.5)});
  expect_commands("N0", {command(8, 0, 5)});
  expect_commands("N262143 O5", {command(8, 0, 5, 262143), command(8, 0, 6, 5)});
  expect_commands("N1.0", {command(8, 0, 5, 1)});
  expect_refused(BinaryResult::kRange, {"N262144", "O262144", "N-1", "N1.5", "N-0.5"});
  for (const char* call : {"G", "M", "T", "D"})
    expect_commands(std::string(call) + "4E1H2L3P4Q5",
                    {binary_line(std::string(call) + "4").commands.at(0), command(8, 0, 20, 1), command(8, 0, 23, 2),
                     command(8, 0, 27, 3), command(8, 0, 31, 4), command(8, 0, 32, 5)});
  expect_commands("CALL100.5 X1 P2", {command(9, 0, 3, 100.5), command(1, 0, 6, 1), command(8, 0, 31, 2)});
  expect_commands("LOCK1UNLOCK2", {command(9, 0, 12, 1), command(9, 0, 13, 2)});
  expect_refused(BinaryResult::kSyntax, {"P1", "Q1", "E1", "H1", "L1", "S5 P1", "N5 P1", "LOCK1 P1"});
  expect_refused(BinaryResult::kSyntax, {"M1->*", "M1..3", "M1,2", "M", "M->", "M1 -> X:1", "M1 .. 3", "M1 ,2"});
  expect_refused(BinaryResult::kIllegal, {"M(P1)", "G(P1)", "M$5", "G$5"});
  expect_commands("M-1", {command(8, 0, 1, -1)});
}

// From 1024 on a prefix has the upper bits of the number.
TEST(BinaryCommands, Assignments) {
  const std::pair<char, unsigned> kinds[] = {{'M', 4}, {'P', 5}, {'Q', 6}, {'I', 7}};
  for (const auto& [letter, code] : kinds) {
    const std::string name(1, letter);
    expect_commands(name + "0=1", {command(code, 0, 0, 1)});
    expect_commands(name + " 1023 = -2.5", {command(code, 0, 1023, -2.5)});
    expect_commands(name + "1024=+.5", {command(15, 0, 1), command(code, 0, 0, 0.5)});
    expect_commands(name + "8191=3", {command(15, 0, 7), command(code, 0, 1023, 3)});
    expect_commands(name + "5=1X2", {command(code, 0, 5, 1), command(1, 0, 6, 2)});
    expect_refused(BinaryResult::kRange, {name + "8192=1", name + "1.5=1", name + "99999999999999999999=1"});
    expect_refused(BinaryResult::kIllegal, {name + "(3)=4", name + "((P1)+2)=4", name + "$10=1", name + "$aF = 1",
                                            name + "5=P2", name + "5=$A", name + "5=(2)", name + "(3)=1=2"});
    expect_refused(BinaryResult::kConversion, {name + "5=", name + "5=-", name + "5=."});
    for (const char operation : std::string("+-*/%&|^"))
      EXPECT_EQ(binary_line(name + "5=2 " + operation + "3").result, BinaryResult::kIllegal) << operation;
    EXPECT_EQ(binary_line(name + "5=0.1").result, BinaryResult::kFloat);
  }
  const std::pair<const char*, unsigned> forms[] = {{"==", 1}, {"&=", 2}, {"|=", 3}, {"^=", 4}};
  for (const auto& [form, code] : forms) {
    expect_commands(std::string("M7") + form + "9", {command(4, code, 7, 9)});
    expect_commands(std::string("M2048 ") + form + " 9", {command(15, 0, 2), command(4, code, 0, 9)});
    EXPECT_NE(binary_line(std::string("P7") + form + "9").result, BinaryResult::kOk) << "of M-variables alone";
  }
  expect_commands("M7==9 P7=1", {command(4, 1, 7, 9), command(5, 0, 7, 1)});
  expect_refused(BinaryResult::kSyntax, {"P(3", "P(3)", "Q$10"});
}

TEST(BinaryCommands, ListsOfAxes) {
  expect_commands("ABS", {command(2, 1, 0x1FF)});
  expect_commands("INC ( a , B,R )", {command(2, 2, 0x203)});
  expect_commands("ABS(X,Y,Z)", {command(2, 1, 0x1C0)});
  expect_commands("FRAX", {command(2, 3, 0x1C0)});
  expect_commands("FRAX(C,U)X1", {command(2, 3, 0x00C), command(1, 0, 6, 1)});
  expect_commands("NOFRAX", {command(2, 3, 0)});
  expect_refused(BinaryResult::kSyntax,
                 {"ABS(", "ABS()", "ABS(Q)", "ABS(X", "ABS(X,", "ABS(X Y)", "FRAX(R)", "FRAX (X)", "FRAX("});
}

TEST(BinaryCommands, ListsOfMotorsAndPlcs) {
  expect_commands("HOME1", {list(0, 1)});
  expect_commands("HM1..32", {list(0, 0xFFFFFFFF)});
  expect_commands("HOMEZ 31 , 2..4", {list(1, 1u << 30 | 0xE)});
  expect_commands("HMZ30,25", {list(1, 1u << 29 | 1u << 24)});
  const std::pair<const char*, unsigned> plcs[] = {{"ENABLE PLC", 3},   {"ENAPLC", 3},      {"DIS  PLC", 4},
                                                   {"DISABLE\tPLC", 4}, {"PAUSE PLC", 5},   {"PAUPLC", 5},
                                                   {"RESUME PLC", 6},   {"ENABLE PLCC", 7}, {"disable plcc ", 8}};
  for (const auto& [text, n] : plcs) {
    expect_commands(std::string(text) + "0", {list(n, 1)});
    expect_commands(std::string(text) + "31,5 .. 7", {list(n, 1u << 31 | 0xE0)});
  }
  expect_refused(BinaryResult::kRange, {"HM0", "HM33", "HM5..3", "HM32..33", "ENA PLC 32", "DIS PLC 0..32"});
  expect_refused(BinaryResult::kConversion, {"HM1,", "HM1..", "HM1.5", "HM1,X1", "ENA PLC 1..X2"});
  expect_refused(BinaryResult::kSyntax, {"HM", "HMX1", "ENA PLC", "ENA PLC(1)", "ENABLE"});
}

TEST(BinaryCommands, WhatGoesByAsciiIsIllegal) {
  expect_refused(BinaryResult::kIllegal,
                 {"IF(P1=2)X1", "WHILE(P1<2)", "AND(P1=1)",  "OR(P1=1)",  "ELSE",     "ENDIF",    "ENDI", "END IF",
                  "ENDWHILE",   "ENDW",        "END  WHILE", "WAIT",      "GOTO5",    "GOSUB5",   "GOS5", "RETURN",
                  "RET",        "READ(A)",     "ADR&1",      "SEND\"A\"", "CMD\"R\"", "DISP\"A\""});
}

}  // namespace
}  // namespace brick
