// PASSWORD (firmware:5.10/7, docs/programs.md): what it protects, how it is entered and changed, what a start does.
#include <gtest/gtest.h>

#include <string>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"

namespace brick {
namespace {

void enter_programs(Controller& c) {
  for (const char* open : {"OPEN PROG 999", "OPEN PROG 1000", "OPEN PROG 32767", "OPEN PLC 0", "OPEN PLC 15",
                           "OPEN PLC 16", "&2OPEN FORWARD", "&2OPEN INVERSE"}) {
    EXPECT_EQ(c.line(std::string(open) + " CLEAR P1=1"), "") << open;
    EXPECT_EQ(c.line("CLOSE"), "");
  }
}

void expect_protected(Controller& c, bool is_protected) {
  const std::string listed = is_protected ? "ERR002" : "P1=1|RET", opened = is_protected ? "ERR002" : "";
  for (const char* name : {"PROG 1000", "PROG 32767", "PLC 0", "PLC 15", "FORWARD", "INVERSE"}) {
    EXPECT_EQ(c.line(std::string("&2LIST ") + name), listed) << name;
    EXPECT_EQ(c.line(std::string("LIST ") + name + ",0,9"), is_protected ? "ERR002" : "0:P1=1|1:RET") << name;
    EXPECT_EQ(c.line(std::string("OPEN ") + name), opened) << name;
    EXPECT_EQ(c.line("LIST"), is_protected ? "ERR003" : "P1=1") << "open: " << name;
    EXPECT_EQ(c.line("CLOSE"), "");
  }
  EXPECT_EQ(c.line("&1B1000 LIST PC"), is_protected ? "ERR002" : "0:P1=1") << "where a system points";
  EXPECT_EQ(c.line("&1B999 LIST PC"), "0:P1=1");
  for (const char* name : {"PROG 999", "PLC 16"}) {  // never protected
    EXPECT_EQ(c.line(std::string("LIST ") + name), "P1=1|RET") << name;
    EXPECT_EQ(c.line(std::string("OPEN ") + name), "") << name;
    EXPECT_EQ(c.line("CLOSE"), "");
  }
}

TEST(Password, ProtectsFromTheNextStartOnWhenItWasSaved) {
  Controller c;
  enter_programs(c);
  expect_protected(c, false);
  EXPECT_EQ(c.line("PASSWORD=Bush"), "");
  expect_protected(c, false);  // who sets it has entered it
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  c.line("I3=2 I6=1");
  expect_protected(c, true);
  EXPECT_EQ(c.line("PASSWORD=bush"), "ERR002") << "capitals count";
  EXPECT_EQ(c.line("PASSWORD=BUSH"), "ERR002");
  EXPECT_EQ(c.line("PASSWORD="), "ERR002");
  EXPECT_EQ(c.line("PASSWORD=Bus"), "ERR002");
  EXPECT_EQ(c.line("PASSWORD=Bush "), "ERR002") << "so do blanks";
  EXPECT_EQ(c.line("PASSWORD=\"Bush\""), "ERR002") << "and quotes";
  expect_protected(c, true);
  EXPECT_EQ(c.line("CLEAR ALL"), "ERR002");
  EXPECT_EQ(c.line("CLEAR ALL PLCS"), "ERR002");
  EXPECT_EQ(c.line("password=Bush"), "") << "but not those of the command";
  expect_protected(c, false);
  EXPECT_EQ(c.line("CLEAR ALL LIST PROG 1000"), "ERR003");
}

TEST(Password, IsLostWithoutSaveAndByTheFactorysDefaults) {
  Controller c;
  enter_programs(c);
  EXPECT_EQ(c.line("SAVE"), "");
  EXPECT_EQ(c.line("PASSWORD=once"), "");
  c.restart();
  expect_protected(c, false);
  EXPECT_EQ(c.line("PASSWORD=twice SAVE"), "") << "the password is `twice SAVE`";
  c.restart();
  expect_protected(c, false);
  EXPECT_EQ(c.line("PASSWORD=three"), "");
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  expect_protected(c, true);
  c.line("$$$***");
  c.line("I3=2 I6=1");
  EXPECT_EQ(c.line("LIST PROG 1000"), "ERR003") << "the programs are gone, and so is the password";
  EXPECT_EQ(c.line("PASSWORD=four"), "");
  c.restart();
  expect_protected(c, true);
  EXPECT_EQ(c.line("PASSWORD=four"), "ERR002");
  EXPECT_EQ(c.line("PASSWORD=three"), "") << "what was saved is untouched";
}

TEST(Password, ChangesOnceItHasBeenEnteredAndAnEmptyOneTakesItAway) {
  Controller c;
  enter_programs(c);
  EXPECT_EQ(c.line("PASSWORD=a b;c\"D"), "");
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  EXPECT_EQ(c.line("P2=5 PASSWORD=a b;c\"D"), "") << "behind other commands, and all of the line";
  EXPECT_EQ(c.line("P2"), "5");
  EXPECT_EQ(c.line("PASSWORD=new"), "");
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  EXPECT_EQ(c.line("PASSWORD=a b;c\"D"), "ERR002");
  EXPECT_EQ(c.line("PASSWORD=new"), "");
  EXPECT_EQ(c.line("PASSWORD="), "");
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  expect_protected(c, false);
}

TEST(Password, IsAsLongAsALineAllows) {
  Controller c;
  enter_programs(c);
  const std::string longest(255 - 9, 'x');
  EXPECT_EQ(c.line("PASSWORD=" + longest + "x"), "ERR003") << "256 characters in the line";
  EXPECT_EQ(c.line("PASSWORD=" + longest), "");
  EXPECT_EQ(c.line("PASSWORD"), "ERR003");
  EXPECT_EQ(c.line("SAVE"), "");
  c.restart();
  EXPECT_EQ(c.line("PASSWORD=" + longest.substr(1)), "ERR002");
  expect_protected(c, true);
  EXPECT_EQ(c.line("PASSWORD=" + longest), "");
  expect_protected(c, false);
}

// What comes first: a buffer is open, a program runs, the password (firmware:4.3).
TEST(Password, MissingIsToldAfterAnOpenBufferAndARunningProgram) {
  Controller c;
  enter_programs(c);
  c.line("PASSWORD=x");
  c.line("SAVE");
  c.restart();
  EXPECT_EQ(c.line("OPEN PROG 1"), "");
  EXPECT_EQ(c.line("OPEN PROG 1000"), "ERR007");
  EXPECT_EQ(c.line("OPEN PLC 0"), "ERR007");
  EXPECT_EQ(c.line("CLOSE"), "");
  EXPECT_EQ(c.line("OPEN PROG 0"), "ERR003");
  EXPECT_EQ(c.line("LIST PROG 1001"), "ERR002") << "whether there is one is nobody's business";
  EXPECT_EQ(c.line("&1DEF ROT 100 B0"), "");
  EXPECT_EQ(c.line("OPEN ROT"), "");
  EXPECT_EQ(c.line("DWELL 1000"), "");
  EXPECT_EQ(c.line("CLOSE"), "");
  EXPECT_EQ(c.line("R"), "");
  EXPECT_EQ(c.line("OPEN PROG 1000"), "ERR001");
  EXPECT_EQ(c.line("&2OPEN FORWARD"), "ERR001");
  EXPECT_EQ(c.line("OPEN PLC 0"), "ERR002");
  EXPECT_EQ(c.line("ENA PLC 0 DIS PLC 0"), "") << "it can be used";
}

}  // namespace
}  // namespace brick
