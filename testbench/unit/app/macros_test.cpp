// Macros of command files: what they expand to, and that bad ones and endless ones are told.
#include "app/macros.h"

#include <gmock/gmock.h>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string expanded(const std::vector<std::string>& defines, const std::string& line) {
  Macros macros;
  for (const auto& define : defines) macros.define(define);
  return macros.expand(line);
}

std::string error_of(const std::vector<std::string>& defines, const std::string& line) {
  try {
    expanded(defines, line);
  } catch (const UsageError& e) { return e.what(); }
  return "no error";
}

TEST(Macros, ReplaceWholeWords) {
  EXPECT_EQ(expanded({"HEIGHT Q7"}, "HEIGHT=HEIGHT+1"), "Q7=Q7+1");
  EXPECT_EQ(expanded({"HEIGHT Q7"}, "HEIGHTS Height HEIGHT_A 1HEIGHT"), "HEIGHTS Height HEIGHT_A 1HEIGHT");
  EXPECT_EQ(expanded({"Base 30030"}, "M1->X:$Base,0,4"), "M1->X:$30030,0,4");
  EXPECT_EQ(expanded({"A_ X1"}, "(A_)A_ #A_"), "(X1)X1 #X1");
  EXPECT_EQ(expanded({"GO"}, "A GO B"), "A  B") << "an empty text";
  EXPECT_EQ(expanded({"TEXT HELLO"}, "SEND\"TEXT\" TEXT"), "SEND\"TEXT\" HELLO");
  EXPECT_EQ(expanded({"A B", "A C"}, "A"), "C") << "the newest";
  EXPECT_EQ(expanded({}, "#1->1000X \"open"), "#1->1000X \"open");
}

// `$NAME` with hexadecimal digits behind it: the longest name.
TEST(Macros, HexadecimalDigitsMayFollowANameBehindADollarSign) {
  EXPECT_EQ(expanded({"VarAdr 300"}, "M40->L:$VarAdr0A M41->Y:$VarAdr00,0,24"), "M40->L:$3000A M41->Y:$30000,0,24");
  EXPECT_EQ(expanded({"Var 1", "VarAdr 300", "VarAdr0 7"}, "$Var2 $VarAdr2 $VarAdr0A $VarAdr0"), "$12 $3002 $7A $7");
  EXPECT_EQ(expanded({"VarAdr 300", "Points VarAdr50"}, "P1=$Points"), "P1=$30050") << "a name in the text of another";
  EXPECT_EQ(expanded({"VarAdr 300", "Points VarAdr5"}, "P1=$Points0F"), "P1=$30050F") << "and digits behind both";
  EXPECT_EQ(expanded({"VarAdr 300"}, "VarAdr0A #VarAdr1 $ VarAdr0A"), "VarAdr0A #VarAdr1 $ VarAdr0A")
      << "elsewhere a name is a whole word";
  EXPECT_EQ(expanded({"VarAdr 300"}, "$VarAdr0AX $VarAdr_0 $VarAdrZ"), "$VarAdr0AX $VarAdr_0 $VarAdrZ") << "no digits";
  EXPECT_EQ(expanded({"A 5", "Z 1"}, "$ZA"), "$1A") << "the digits are no name";
  EXPECT_EQ(expanded({"F(a) a"}, "$F2 $F(2)"), "$F2 $2") << "arguments belong to a whole word";
  EXPECT_EQ(expanded({"Z 1"}, "$Z" + std::string(12, '0')), "$1" + std::string(12, '0'));
  EXPECT_EQ(expanded({"Z 1"}, "$Z" + std::string(13, '0')), "$Z" + std::string(13, '0')) << "longer than any constant";
  EXPECT_THAT(error_of({"LoopX LoopX0"}, "$LoopX"), HasSubstr("expands to itself"));
}

// Whoever defines a name that is a hexadecimal number means the name: behind `$` too, and with digits behind it.
TEST(Macros, ANameOfHexadecimalDigitsIsANameBehindADollarSignToo) {
  EXPECT_EQ(expanded({"FACE 7"}, "$FACE $FACE0 $FACES FACE0"), "$7 $70 $FACES FACE0");
  EXPECT_EQ(expanded({"FA 6", "FAC 7"}, "$FACE $FAE $FAC"), "$7E $6E $7") << "the longest name";
  EXPECT_EQ(expanded({"A 5"}, "$FACE $0A $A0 WX$10,$A"), "$FACE $0A $50 WX$10,$5") << "no name stands right behind it";
  EXPECT_EQ(expanded({}, "$FACE $A0"), "$FACE $A0");
}

TEST(Macros, TakeArguments) {
  EXPECT_EQ(expanded({"SUM(a,b) ((a)+(b))"}, "P1=SUM(1,P2)"), "P1=((1)+(P2))");
  EXPECT_EQ(expanded({"SUM(a,b) (a+b)"}, "SUM(SUM(1,2),(3,4))"), "((1+2)+(3,4))");
  EXPECT_EQ(expanded({"NOW() P1=1"}, "NOW() NOW ( )"), "P1=1 P1=1");
  EXPECT_EQ(expanded({"ONE(a) [a]"}, "ONE() ONE(\"a,)\")"), "[] [\"a,)\"]");
  EXPECT_EQ(expanded({"AXIS (P1)"}, "AXIS(2)"), "(P1)(2)") << "a space before the bracket: it is text";
  EXPECT_EQ(expanded({"M(n) I##n"}, "M(5)"), "I##5");
}

TEST(Macros, AreReplacedInMacros) {
  EXPECT_EQ(expanded({"POS (RES*P3+OFF)", "RES P(4800+3)", "OFF P4903"}, "Q7=POS"), "Q7=(P(4800+3)*P3+P4903)");
  Macros macros;
  macros.define("A B");
  macros.define("B 1");
  macros.undefine("B");
  EXPECT_EQ(macros.expand("A"), "B");
  EXPECT_TRUE(macros.defined(" A "));
  EXPECT_FALSE(macros.defined("B"));
}

TEST(Macros, ErrorsSayWhatAndWhatWasExpected) {
  for (const char* bad : {"", "1X 2", "(a)", "A(a", "A(a,a) 1", "A(1) 1", "A(a,) 1", "A-B", "A\"x\""})
    EXPECT_THAT(error_of({bad}, ""), HasSubstr("expected")) << bad;
  EXPECT_THAT(error_of({"SUM(a,b) a"}, "SUM"), AllOf(HasSubstr("`SUM`"), HasSubstr("expected SUM(a,b)")));
  EXPECT_THAT(error_of({"SUM(a,b) a"}, "SUM(1)"), HasSubstr("with 1 arguments; expected SUM(a,b)"));
  EXPECT_THAT(error_of({"SUM(a,b) a"}, "SUM(1,(2)"), HasSubstr("no closing bracket"));
}

TEST(Macros, NeverGoOnForEver) {
  EXPECT_THAT(error_of({"A B", "B A"}, "A"),
              AllOf(HasSubstr("`A` expands to itself (A, B, A)"), HasSubstr("expected")));
  EXPECT_THAT(error_of({"A(x) A(x x)"}, "A(1)"), HasSubstr("expands to itself"));
  std::vector<std::string> doubling{"D0 X"}, vanishing{"D0"}, deep{"D0 X"};
  for (int i = 1; i <= 60; ++i) {
    const std::string before = "D" + std::to_string(i - 1), name = "D" + std::to_string(i);
    doubling.push_back(name + " " + before + before.substr(0, 0) + " " + before);
    vanishing.push_back(name + " " + before + " " + before);
    deep.push_back(name + " " + before);
  }
  EXPECT_THAT(error_of(doubling, "D40"), AllOf(HasSubstr("macro `D40`"), HasSubstr("expected")));
  EXPECT_THAT(error_of(vanishing, "D40"), AllOf(HasSubstr("too many macros"), HasSubstr("expected")));
  EXPECT_THAT(error_of(deep, "D60"), HasSubstr("50 deep"));
  EXPECT_EQ(expanded(deep, "D40"), "X");
  EXPECT_THAT(error_of({"L " + std::string(500, 'X'), "M L L L L L L L L L L"}, "M"),
              HasSubstr("more than 4096 characters"));
}

}  // namespace
}  // namespace brick
