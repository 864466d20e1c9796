// Compensation tables, TBUF and UBUFFER (firmware:4.2, firmware:4.3): sizes, order, entries, what LIST and SAVE keep.
#include <map>
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::host;

class Tables : public FirmwareTest {};

TEST_F(Tables, ConstantsFillATableAndThenGoToP0) {
  ASSERT_EQ(host("#3DEFINE COMP 4,#1D,#2,8000"), "");
  EXPECT_EQ(host("SIZE"), std::to_string(26624 - 4));
  EXPECT_EQ(host("LIST COMP"), "0|0|0|0");
  EXPECT_EQ(host("10 -20"), "");
  EXPECT_EQ(host("#1 P1=7 8388607"), "");  // other commands may stand between
  EXPECT_EQ(host("1.5"), "ERR003");
  EXPECT_EQ(host("8388608"), "ERR003");
  EXPECT_EQ(host("-8388608"), "");
  EXPECT_EQ(host("P0"), "0");
  EXPECT_EQ(host("25"), "");
  EXPECT_EQ(host("P0"), "25");
  EXPECT_EQ(host("LIST COMP"), "ERR003");  // of motor 1
  EXPECT_EQ(host("#3LIST COMP"), "10|-20|8388607|-8388608");
  EXPECT_EQ(host("LIST COMP DEF"), "DEFINE COMP 4,#1D,#2,8000");
}

TEST_F(Tables, DefinitionsListAsTheyAreDefinedAgain) {
  for (const std::string text :
       {"DEFINE COMP 4,#1D,#2,8000", "DEFINE COMP 1,#32,#5,1", "DEFINE TCOMP 10,2147483647", "DEFINE BLCOMP 26624,5"}) {
    const std::string kind = text.substr(7, text.find(' ', 7) - 7);
    ASSERT_EQ(host("#5" + text), "");
    EXPECT_EQ(host("LIST " + kind + " DEF"), text);
    ASSERT_EQ(host("DELETE " + kind + " " + text), "") << text;
    EXPECT_EQ(host("LIST " + kind + " DEF"), text);
    ASSERT_EQ(host("DEL " + kind), "");
    EXPECT_EQ(host("LIST " + kind), "ERR003");
  }
  ASSERT_EQ(host("#5DEF COMP 3,900 #2DEF COMP 3,#7,900"), "");
  EXPECT_EQ(host("#5LIST COMP DEF #2LIST COMP DEF"), "DEFINE COMP 3,#5,#5,900|DEFINE COMP 3,#7,#2,900");
}

// User memory is not empty where a table is made, and an entry is the low half of its word.
TEST_F(Tables, EntriesBeginAsZeroAndFillTheLowHalf) {
  ASSERT_EQ(host("WX$107FE,-1,-1 WY$107FE,-1,-1 DEF COMP 2,100"), "");
  EXPECT_EQ(host("LIST COMP RHX$107FE,2 RHY$107FE,2"), "0|0|0 0|0 0");
  ASSERT_EQ(host("-1 -8388608"), "");
  EXPECT_EQ(host("RHX$107FE,2 RHY$107FE,2"), "0 0|FFFFFF 800000");
}

// Only what deletes the table that is filled ends that: not another kind, not another motor, not a refusal.
TEST_F(Tables, ATableIsFilledUntilItIsDeleted) {
  for (const std::string text : {"#9DEL TCOMP", "#9DEL BLCOMP", "#8DEL COMP", "#9DEL ROT DEF ROT 5 #9DEL COMP"}) {
    ASSERT_EQ(host("#9DEF COMP 2,100 P0=3"), "");
    EXPECT_EQ(host(text), text.find("DEF ROT") != std::string::npos ? "ERR003" : "") << text;
    ASSERT_EQ(host("7 P0"), "3") << text;
    ASSERT_EQ(host("DELETE ALL TEMPS #9LIST COMP DEL COMP"), "7|0") << text;
  }
}

TEST_F(Tables, ADeletedTableTakesNoConstants) {
  for (const std::string text : {"DEL COMP", "DELETE ALL"}) {
    ASSERT_EQ(host("DEF COMP 4,100 1 2"), "");
    ASSERT_EQ(host(text + " P0=0 5 P0"), "5");
  }
  ASSERT_EQ(host("DEF COMP 4,100 P0=3"), "");
  platform::power_up();
  EXPECT_EQ(host("5 P0"), "5");
}

TEST_F(Tables, ArgumentsAndStatesAreChecked) {
  for (const char* text :
       {"DEF COMP",         "DEF COMP 0,5",    "DEF COMP 5",      "DEF COMP 5,0",       "DEF COMP 5,-1",
        "DEF COMP 5,#33,9", "DEF COMP 5,#0,9", "DEF COMP 5,#1 9", "DEF COMP 5,#1,#2 9", "DEF COMP 2.2,#1,9",
        "DEF TCOMP 5,#1,9", "DEF BLCOMP 5",    "DEF TBUF 0",      "DEF TBUF",           "DEF UBUFFER",
        "DEF UBUFFER -1",   "LIST COMP",       "LIST TCOMP DEF",  "LIST LINK",          "DEL UBUFFER"})
    EXPECT_EQ(host(text), "ERR003") << text;
  EXPECT_EQ(host("DEF COMP 26625,5"), "ERR006");
  EXPECT_EQ(host("DEF TBUF 2219"), "ERR006");  // 12 words each: 26,628
  EXPECT_EQ(host("DEF TBUF 4294967295"), "ERR003");
  EXPECT_EQ(host("DEF TBUF 2147483647"), "ERR006");
  ASSERT_EQ(host("OPEN PLC 1 DEF COMP 5,5"), "ERR007");
  EXPECT_EQ(host("DEL COMP"), "ERR007");
  EXPECT_EQ(host("DEF UBUFFER 5"), "ERR007");
  EXPECT_EQ(host("CLOSE DEF TBUF 2218 SIZE"), std::to_string(26624 - 2218 * 12));
}

TEST_F(Tables, UBufferIsTheTopOfMemoryAndComesFirst) {
  ASSERT_EQ(host("DEFINE UBUFFER 512"), "");
  EXPECT_EQ(host("I4908 SIZE"), "$10600|26112");  // $10800 - $200
  EXPECT_EQ(host("DEF UBUF 26625"), "ERR006");
  EXPECT_EQ(host("DEF GAT I4908 DEF UBUFFER 0"), "ERR003");
  EXPECT_EQ(host("DELETE ALL I4908 OPEN PROG 1 CLEAR X1 CLOSE"), "$10600");
  EXPECT_EQ(host("DEF UBUFFER 0"), "ERR003");
  EXPECT_EQ(host("OPEN PROG 1 CLEAR CLOSE DEF UBUFFER 0 I4908 SIZE"), "$10800|26624");
}

TEST_F(Tables, SaveKeepsTablesAndUBufferNotTbuf) {
  ASSERT_EQ(host("DEF UBUFFER 100 OPEN PROG 7 CLEAR X1Y2 CLOSE"), "");
  ASSERT_EQ(host("#9DEF COMP 3,#1D,#2,700 5 -6 7"), "");
  ASSERT_EQ(host("#2DEF COMP 2,60 8 9 #32DEF TCOMP 2,50 -1 -2"), "");
  ASSERT_EQ(host("#1DEF BLCOMP 1,40 3 DEF TBUF 4"), "");
  ASSERT_EQ(host("PASSWORD=word"), "");
  ASSERT_EQ(host("SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("I4908 SIZE"), "$1079C|" + std::to_string(26624 - 100 - 3 - 3 - 2 - 2 - 1));
  EXPECT_EQ(host("#9LIST COMP LIST COMP DEF"), "5|-6|7|DEFINE COMP 3,#1D,#2,700");
  EXPECT_EQ(host("#2LIST COMP #32LIST TCOMP #1LIST BLCOMP"), "8|9|-1|-2|3");
  EXPECT_EQ(host("LIST PROG 7"), "X1Y2|RET");
  platform::reset("$$$***");
  EXPECT_EQ(host("I4908 SIZE"), "$10800|26624");
  EXPECT_EQ(host("#9LIST COMP"), "ERR003");
}

// firmware:4.3: OPEN PROG is refused for other things only. What lies at the top of memory stays as it is.
TEST_F(Tables, ProgramsAreChangedWhileTablesAndRingsAreThere) {
  ASSERT_EQ(host("OPEN PROG 7 CLEAR X1Y2 CLOSE OPEN PLC 3 CLEAR P1=1 CLOSE"), "");
  ASSERT_EQ(host("#9DEF COMP 3,#1D,#2,700 5 -6 7 #2DEF BLCOMP 2,60 8 9"), "");
  ASSERT_EQ(host("SAVE"), "");
  platform::reset();
  ASSERT_EQ(host("DEF ROT 20 B0 OPEN ROT"), "");
  ASSERT_EQ(host("X5 F10"), "");
  ASSERT_EQ(host("CLOSE OPEN PROG 7 CLEAR X3Y4Z5 CLOSE OPEN PLC 3 P2=2 CLOSE"), "");
  const std::string all = "X3Y4Z5|RET|P1=1|P2=2|RET|5|-6|7|8|9";
  EXPECT_EQ(host("LIST PROG 7 LIST PLC 3 #9LIST COMP #2LIST BLCOMP LIST ROT"), all + "|X5F10");
  EXPECT_EQ(host("SIZE"), std::to_string(26624 - 4 - 3 - 3 - 2 - 20));
  ASSERT_EQ(host("SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("LIST PROG 7 LIST PLC 3 #9LIST COMP #2LIST BLCOMP"), all);
}

// Random DEFINE, DELETE and programs, against a list of what is there by its place in memory, from the top down
// (firmware:4.2).
TEST_F(Tables, RandomSequencesFollowTheMemoryOrder) {
  BRICK_COVERS("BIN-2 I18-3");
  static const char* const kinds[] = {"COMP", "TCOMP", "BLCOMP", "TBUF", "CCBUF", "LOOKAHEAD", "ROTARY", "GATHER"};
  std::mt19937 random(brick::random_seed(20));
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  std::map<unsigned, unsigned> there;  // place to words; place 0: programs
  unsigned refused = 0, made = 0, full = 0, lines = 0;
  for (unsigned step = 0; step < 6000; ++step) {
    unsigned used = 0;
    for (const auto& [place, words] : there) used += words;
    const unsigned lowest = there.empty() ? 0 : there.rbegin()->first;
    if (below(40) == 0) {  // a program grows by a line of two words, or all are cleared
      const bool clear = below(2) == 0;
      const std::string got = host(clear ? "OPEN PROG 1 CLEAR CLOSE" : "OPEN PROG 1 X1Y2 CLOSE");
      const unsigned others = used - (there.count(0) != 0 ? there[0] : 0);
      ASSERT_EQ(got, !clear && others + lines + 2 > 26624 ? "ERR006" : "") << step;
      if (got.empty()) lines = clear ? 0 : lines + 2;
      there.erase(0);
      if (lines != 0) there[0] = lines + (others + lines < 26624 ? 1 : 0);  // RETURN, where there is room
    } else if (below(60) == 0) {
      const bool all = below(2) == 0;
      ASSERT_EQ(host(all ? "DELETE ALL" : "DELETE ALL TEMPS"), "");
      there.erase(there.lower_bound(all ? 100 : 500), there.end());
    } else {
      const unsigned kind = below(8), owners = kind < 3 ? 32 : kind == 3 || kind == 7 ? 1 : 16;
      const unsigned owner = below(4) != 0 ? owners - 1 - below(std::min(owners, 3u)) : below(owners);
      const unsigned place = 100 * (kind + 1) + owners - owner, size = 1 + below(below(5) == 0 ? 30000 : 400);
      const std::string address = (kind < 3 ? "#" : "&") + std::to_string(owner + 1);
      const std::string name = kinds[kind];
      const bool defines = below(3) != 0;
      unsigned words = size;
      std::string arguments = std::to_string(size);
      if (kind < 3) arguments += ",1000";
      if (kind == 3) words = 12 * size;
      if (kind == 4) words = 10 * size;
      if (kind == 5) words = 6 * size + 2 * 3;
      if (kind == 5) arguments += ",3";
      const bool held = lowest > place, again = defines && there.count(place) != 0;
      const bool begins_anew = again && kind == 7;  // GATHER: the buffer there is
      std::string expected = held || (again && !begins_anew) ? "ERR003" : "";
      if (expected.empty() && defines && !begins_anew && used + words > 26624) expected = "ERR006";
      ASSERT_EQ(host(address + (defines ? "DEFINE " + name + " " + arguments : "DELETE " + name)), expected)
          << step << ": " << address << (defines ? "DEFINE " : "DELETE ") << name << " " << arguments;
      refused += expected == "ERR003";
      full += expected == "ERR006";
      if (expected.empty() && defines && !begins_anew) there[place] = words;
      if (expected.empty() && !defines) there.erase(place);
      made += expected.empty() && defines;
    }
    used = 0;
    for (const auto& [place, words] : there) used += words;
    ASSERT_EQ(host("SIZE"), std::to_string(26624 - used)) << step;
  }
  EXPECT_GT(made, 300u);
  EXPECT_GT(refused, 1000u);
  EXPECT_GT(full, 20u);
}

}  // namespace
