// Fixed buffers (firmware:4.1 to firmware:4.3, firmware:4.7): which can be opened when, what is stored, order and room,
// structure.
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;
using Lines = std::vector<std::string>;

class FixedBuffer : public FirmwareTest {
 protected:
  static unsigned open_words() {
    const std::string size = host("SIZE");
    return size[0] == '-' ? static_cast<unsigned>(-std::stol(size) - 1) : static_cast<unsigned>(std::stol(size));
  }
  static unsigned status2() { return static_cast<unsigned>(std::stoul(host("???").substr(6), nullptr, 16)); }
};

TEST_F(FixedBuffer, OneBufferAtATime) {
  const Lines opens = {"OPEN PROG 1", "OPEN PLC 1", "OPEN FORWARD", "OPEN INVERSE", "OPEN ROT"};
  ASSERT_EQ(host("DEF ROT 20"), "");
  for (const std::string& first : opens) {
    ASSERT_EQ(host(first), "") << first;
    for (const std::string& second : opens) EXPECT_EQ(host(second), "ERR007") << first << ", " << second;
    ASSERT_EQ(host("CLOSE"), "");
  }
  EXPECT_EQ(host("CLOSE"), "");  // with nothing open
}

TEST_F(FixedBuffer, NumbersAndNamesAreChecked) {
  for (const char* text : {"OPEN PROG", "OPEN PROG 0", "OPEN PROG 32768", "OPEN PROG 1.5", "OPEN PLC", "OPEN PLC 32",
                           "OPEN PLCC 1", "OPEN PLC -1", "OPEN TABLE"})
    EXPECT_EQ(host(text), "ERR003") << text;
  for (const char* text : {"OPEN PROGRAM 32767", "OPEN PROG 1", "OPEN PLC 0", "OPEN PLC 31", "OPEN FWD", "OPEN INV"})
    EXPECT_EQ(host(std::string(text) + " CLOSE"), "") << text;
}

TEST_F(FixedBuffer, StatusTellsWhatIsOpen) {  // bits 19, 17 and 11: firmware:5.8
  const struct {
    const char* open;
    unsigned bits;
  } cases[] = {{"OPEN PROG 1", 1u << 19}, {"OPEN PLC 1", 1u << 17}, {"OPEN FORWARD", 0}};
  EXPECT_EQ(status2() & 0x1F0800, 0x800u);
  for (const auto& c : cases) {
    ASSERT_EQ(host(c.open), "");
    EXPECT_EQ(status2() & 0x1F0800, c.bits) << c.open;
    ASSERT_EQ(host("CLOSE"), "");
    EXPECT_EQ(status2() & 0x1F0800, 0x800u);
  }
}

TEST_F(FixedBuffer, EachWordTakesOneOfTheOpenOnes) {
  BRICK_COVERS("I18-3");
  ASSERT_EQ(open_words(), 26624u);
  ASSERT_EQ(host("OPEN PROG 5"), "");
  EXPECT_EQ(host("SIZE"), "-26625");
  ASSERT_EQ(host("X1000 Y1200 Z1400 A1600"), "");  // 4 words: firmware:4.4
  EXPECT_EQ(open_words(), 26620u);
  ASSERT_EQ(host("DWELL(P1*2)"), "");  // P1, 2, *, DWELL
  EXPECT_EQ(open_words(), 26616u);
  ASSERT_EQ(host("CLEAR"), "");
  EXPECT_EQ(open_words(), 26624u);
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 5"), "ERR003");  // empty: there is no such program
}

TEST_F(FixedBuffer, AProgramGrowsWhereverItLies) {
  for (const char* program : {"1", "2", "3"})
    ASSERT_EQ(host(std::string("OPEN PROG ") + program + " CLEAR X" + program + "1 CLOSE"), "");
  ASSERT_EQ(host("OPEN PLC 1 P1=1 CLOSE"), "");
  ASSERT_EQ(host("OPEN PROG 2"), "");
  ASSERT_EQ(host("X22"), "");
  ASSERT_EQ(host("CLOSE OPEN PROG 1 CLEAR CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 1"), "ERR003");
  EXPECT_EQ(host("LIST PROG 2"), "X21|X22|RET");
  EXPECT_EQ(host("LIST PROG 3"), "X31|RET");
  EXPECT_EQ(host("LIST PLC 1"), "P1=1|RET");
  EXPECT_EQ(open_words(), 26624u - 7u);
}

TEST_F(FixedBuffer, NothingIsStoredOfALineWithoutRoom) {
  ASSERT_EQ(host("OPEN PROG 1"), "");
  ASSERT_EQ(host("X1 Y1 Z1"), "");
  ASSERT_EQ(host("CLOSE DEF GAT CLOSE OPEN PROG 1"), "");  // its RETURN is one word
  EXPECT_EQ(host("X2 Y2"), "ERR006");
  ASSERT_EQ(host("CLOSE DEL GAT &2DEF ROT 26620 OPEN PROG 1"), "");  // one word is open
  EXPECT_EQ(host("X2 Y2"), "ERR006");
  EXPECT_EQ(host("X2"), "");
  EXPECT_EQ(host("X3"), "ERR006");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 1"), "X1Y1Z1|X2");  // nor a RETURN
}

TEST_F(FixedBuffer, MemoryCanBeFilledToTheLastWord) {
  ASSERT_EQ(host("OPEN PROG 1"), "");
  std::string line;
  for (int i = 0; i < 100; ++i) line += "X1";
  for (unsigned left = 26624; left >= 100; left -= 100) ASSERT_EQ(host(line), "");
  ASSERT_EQ(open_words(), 24u);
  EXPECT_EQ(host("X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1"), "ERR006");
  EXPECT_EQ(host("X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1X1"), "");
  EXPECT_EQ(open_words(), 0u);
  EXPECT_EQ(host("X1"), "ERR006");
  ASSERT_EQ(host("CLOSE OPEN PROG 2"), "");
  EXPECT_EQ(host("X1"), "ERR006");
}

TEST_F(FixedBuffer, ThereAre224MotionPrograms) {
  for (int program = 1; program <= 224; ++program)
    ASSERT_EQ(host("OPEN PROG " + std::to_string(program) + " X1 CLOSE"), "") << program;
  EXPECT_EQ(host("OPEN PROG 225"), "ERR006");
  EXPECT_EQ(host("OPEN PROG 224 CLOSE"), "");
  EXPECT_EQ(host("OPEN PLC 1 P1=1 CLOSE"), "");
}

// With the 32 PLCs and both kinematic programs of 16 systems that is all. The lowest goes above them when it is opened.
TEST_F(FixedBuffer, EachProgramKeepsItsLinesWhenAllAreThere) {
  std::vector<std::string> names;
  for (int i = 1; i <= 224; ++i) names.push_back("PROG " + std::to_string(i));
  for (int i = 0; i < 32; ++i) names.push_back("PLC " + std::to_string(i));
  ASSERT_EQ(host("I68=15"), "");
  const auto line = [](std::size_t i) { return "P" + std::to_string(i) + "=1"; };
  const auto kinematic = [&](const std::string& what) {
    std::string all;
    for (int cs = 1; cs <= 16; ++cs)
      for (const char* kind : {" FORWARD", " INVERSE"})
        all += host("&" + std::to_string(cs) + what + kind + (what == "OPEN" ? " P1=1 CLOSE" : "")) + "/";
    return all;
  };
  for (std::size_t i = 0; i < names.size(); ++i) ASSERT_EQ(host("OPEN " + names[i] + " " + line(i) + " CLOSE"), "");
  std::string nothing, lines;
  for (int i = 0; i < 32; ++i) nothing += "/", lines += "P1=1|RET/";
  ASSERT_EQ(kinematic("OPEN"), nothing);
  for (int turn = 0; turn < 3; ++turn) {
    ASSERT_EQ(host("OPEN " + names[static_cast<std::size_t>(turn)] + " P9=9 CLOSE"), "");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool added = i <= static_cast<std::size_t>(turn);
      ASSERT_EQ(host("LIST " + names[i]), line(i) + (added && i < 224 ? "|P9=9" : "") + "|RET") << names[i];
    }
    EXPECT_EQ(kinematic("LIST"), lines);
  }
}

// What a damaged store says of a program is no program: numbers of firmware:4.1, words that there are.
TEST_F(FixedBuffer, NothingIsRestoredThatCannotBe) {
  const struct {
    fixed_kind kind;
    unsigned number, words;
    bool is_one;
  } cases[] = {{FIXED_PROG, 32768, 1, false}, {FIXED_PROG, 32767, 1, true},  {FIXED_PROG, 32767, 1, false},
               {FIXED_PLC, 32, 1, false},     {FIXED_PLC, 31, 2, true},      {FIXED_FORWARD, 16, 1, false},
               {FIXED_FORWARD, 15, 1, true},  {FIXED_INVERSE, 16, 1, false}, {FIXED_INVERSE, 15, 1, true},
               {FIXED_PROG, 5, 0, false},     {FIXED_PROG, 5, 26625, false}, {FIXED_PROG, 5, 0xFFFFFFFF, false},
               {FIXED_PROG, 5, 26620, false}, {FIXED_PROG, 5, 26619, true}};
  unsigned count = 0, words = 0;
  for (const auto& c : cases) {
    EXPECT_EQ(fixed_program_restore(c.kind, c.number, c.words), c.is_one) << c.number << " " << c.words;
    count += c.is_one ? 1 : 0;
    words += c.is_one ? c.words : 0;
    EXPECT_EQ(fixed_programs_count(), count);
    EXPECT_EQ(host("SIZE"), std::to_string(26624 - words));
  }
}

// Every second one is emptied, the others are closed without a line.
TEST_F(FixedBuffer, EmptyProgramsTakeNoPlace) {
  for (int i = 1; i <= 300; ++i)
    ASSERT_EQ(host("OPEN PROG " + std::to_string(i) + (i % 2 == 0 ? " X1 CLEAR" : "") + " CLOSE"), "") << i;
  ASSERT_EQ(host("OPEN PROG 1 X1 CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 1"), "X1|RET");
}

TEST_F(FixedBuffer, StatementsBelongToTheirKindOfProgram) {
  const struct {
    const char* open;
    Lines taken, refused;
  } cases[] = {
      {"OPEN PROG 1",
       {"X1 Y2 I3 J4",
        "NORMAL K-1",
        "CIRCLE2",
        "PVT200",
        "X1:500 Y2^3",
        "G17.1 X1 P5 Q(P1)",
        "M03",
        "T2 D5 S100",
        "N262143 PSET X1",
        "GOTO10",
        "GOSUB(P1)",
        "CALL500.5 E5",
        "READ(X,P)",
        "M1==2",
        "HOME1,3..5",
        "HOMEZ2",
        "TSEL5",
        "CCR5",
        "WHILE(P1=1)WAIT",
        "PRELUDE1 G5",
        "ENABLE PLC 3",
        "SEND^A",
        "B10",
        "BSTART X1 BSTOP"},
       {"ADDRESS#1", "X", "N262144", "N-1", "READ(N)", "HOME0", "HOME1..33", "ENABLE PLC 32", "DWELL-1", "TM8388608",
        "X1:", "IF(P1)", "CALL", "CIRCLE5", "P1==2", "WAIT(P1=1)", "P1=(P2=3)", "X(P1>2)", "CALL(P1<2)"}},
      {"OPEN PLC 1",
       {"IF(P1=1)", "OR(P2=2)", "ELSE", "ENDIF", "ADR#1&2", "ADR&3", "ADR#P400", "ADR&P8191", "DISPLAY 3,8.2,P1",
        "M1=2", "RET"},
       {"X1", "A10", "LINEAR", "DWELL5", "GOTO5", "CALL5", "WHILE(P1=1)WAIT", "M1==2", "ADR#33", "ADR#P8192",
        "ADR&P(1)", "ADR#P", "ADR#P-1", "ADR#Q1", "ADR", "DISP80\"A\"", "DISP1,17.2,P1", "READ(X)"}},
      {"OPEN INVERSE", {"P1=Q7", "IF(P1>2)", "ENDIF", "RETURN"}, {"X1", "SEND\"A\"", "GOTO5", "ENABLE PLC1"}}};
  for (const auto& c : cases) {
    ASSERT_EQ(host(c.open), "");
    for (const std::string& text : c.taken) EXPECT_EQ(host(text), "") << c.open << ": " << text;
    const unsigned words = open_words();
    for (const std::string& text : c.refused) EXPECT_EQ(host(text), "ERR003") << c.open << ": " << text;
    EXPECT_EQ(open_words(), words);
    ASSERT_EQ(host("CLOSE"), "");
  }
}

TEST_F(FixedBuffer, CommandsActWhileABufferIsOpen) {
  ASSERT_EQ(host("P5=17 M5->*"), "");
  ASSERT_EQ(host("OPEN PROG 1"), "");
  const unsigned words = open_words();
  EXPECT_EQ(host("P5"), "17");
  EXPECT_EQ(host("I17"), "10");
  EXPECT_EQ(host("M5->"), "*");
  EXPECT_EQ(host("P5..6"), "17|0");
  EXPECT_EQ(host("&2 #3"), "");
  EXPECT_EQ(open_words(), words);
  ASSERT_EQ(host("M5"), "");  // an M code here, a query in a PLC
  EXPECT_EQ(open_words(), words - 1);
  ASSERT_EQ(host("CLOSE OPEN PLC 1"), "");
  EXPECT_EQ(host("M5"), "0");
}

TEST_F(FixedBuffer, TextOnLineNeedsABuffer) {  // firmware:4.3
  for (const char* text : {"X1000", "IF(P1=1)", "ENDIF", "GOTO5", "CALL5", "G01", "READ(X)", "SEND\"A\"", "DISP\"A\"",
                           "HOME1", "ADR#1", "N10", "WAIT"})
    EXPECT_EQ(host(text), "ERR005") << text;
  EXPECT_EQ(host("CLEAR"), "ERR007");
}

TEST_F(FixedBuffer, StructureOfMotionPrograms) {  // firmware:6.4
  const struct {
    Lines lines;
    std::string last;  // reply to the last line
    std::string close;
  } cases[] = {{{"IF(P1=1)"}, "", "ERR009"},
               {{"WHILE(P1=1)"}, "", "ERR009"},
               {{"IF(P1=1)", "X1", "ENDIF"}, "", ""},
               {{"IF(P1=1)", "X1", "ELSE", "X2", "ENDIF"}, "", ""},
               {{"IF(P1=1)", "X1", "ELSE X2"}, "", ""},
               {{"IF(P1=1)X1", "ELSE X2"}, "", ""},
               {{"IF(P1=1)X1", "ELSE", "X2", "ENDIF"}, "", ""},
               {{"IF(P1=1 AND P2=2)", "X1"}, "", "ERR009"},
               {{"IF(P1=1)AND(P2=2)", "X1", "ENDIF"}, "", ""},
               {{"IF(P1=1)AND(P2=2)X1"}, "", ""},
               {{"WHILE(P1=1)WAIT"}, "", ""},
               {{"WHILE(P1=1)", "IF(P1=2)", "ENDIF", "ENDWHILE"}, "", ""},
               {{"ENDIF"}, "ERR009", ""},
               {{"ELSE"}, "ERR009", ""},
               {{"ENDWHILE"}, "ERR009", ""},
               {{"AND(P1=1)"}, "ERR009", ""},
               {{"IF(P1=1)", "AND(P2=2)"}, "ERR009", "ERR009"},  // on a line of its own in PLCs only
               {{"IF(P1=1)", "ENDWHILE"}, "ERR009", "ERR009"},
               {{"WHILE(P1=1)", "ELSE"}, "ERR009", "ERR009"},
               {{"IF(P1=1)X1 ENDIF"}, "ERR009", ""},
               {{"IF(P1=1)X1", "X2", "ELSE X3"}, "ERR009", ""},
               {{"IF(P1=1)", "ELSE", "ELSE"}, "ERR009", "ERR009"},
               // Behind a loop of one line there is no ELSE, whatever its IF says, but that of a block around it.
               {{"WHILE(P1=1)IF(P1=2)X1", "ELSE X2"}, "ERR009", ""},
               {{"WHILE(P1=1)IF(P1=2)X1", "ELSE"}, "ERR009", ""},
               {{"WHILE(P1=1)IF(P1=2)IF(P1=3)X1", "ELSE X2"}, "ERR009", ""},
               {{"WHILE(P1=1)WHILE(P1=2)IF(P1=3)X1", "ELSE X2"}, "ERR009", ""},
               {{"IF(P1=3)X1", "ELSE WHILE(P1=1)IF(P1=2)X1", "ELSE X2"}, "ERR009", ""},
               {{"IF(P1=3)", "WHILE(P1=1)IF(P1=2)X1", "ELSE", "ENDIF"}, "", ""},
               {{"IF(P1=2)WHILE(P1=1)X1", "ELSE X2"}, "", ""},
               {{"IF(P1=2)WHILE(P1=1)IF(P1=3)X1", "ELSE", "X2", "ENDIF"}, "", ""}};
  for (const auto& c : cases) {
    ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
    for (std::size_t i = 0; i < c.lines.size(); ++i)
      EXPECT_EQ(host(c.lines[i]), i + 1 == c.lines.size() ? c.last : "") << c.lines[0] << " .. " << c.lines[i];
    EXPECT_EQ(host("CLOSE"), c.close) << c.lines[0] << " .. " << c.lines.back();
    EXPECT_EQ(host("CLOSE"), "") << "it was closed all the same";
  }
}

// firmware:6.4: AND, OR and ELSE are of the condition right before them, whatever stands between.
TEST_F(FixedBuffer, AnyStatementEndsACondition) {
  for (const std::string text :
       {"X1",    "X(P1)",     "F5",     "F(P1)",         "P1=2",      "P1=P2",   "P1=0.1", "P(P1)=P2",
        "M1==2", "M(P1)==P2", "DWELL1", "DWELL(P1)",     "ABS(X)",    "FRAX(X)", "LINEAR", "NORMAL K-1",
        "HOME1", "N10",       "GOSUB5", "DISABLE PLC 3", "SEND\"A\"", "WAIT"}) {
    ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
    EXPECT_EQ(host("IF(P1=1)" + text + " AND(P2=2)"), "ERR009") << text;
    EXPECT_EQ(host("IF(P1=1)" + text + " OR(P2=2)"), "ERR009") << text;
    EXPECT_EQ(host("IF(P1=1)AND(P2=2)OR(P3=3)" + text), "") << text;
    EXPECT_EQ(host(text + " ELSE X2"), "ERR009") << text;
    EXPECT_EQ(host("ELSE " + text), "") << text;
    EXPECT_EQ(host("CLOSE"), "") << text;
  }
}

// A block begins with a line of its own: behind a condition of one line there is none.
TEST_F(FixedBuffer, NoBlockBeginsBehindAConditionOfItsLine) {
  for (const std::string first :
       {"IF(P1=1)", "WHILE(P1=1)", "IF(P1=1)AND(P2=2)", "IF(P1=1)X1 ", "WHILE(P1=1)WHILE(P2=2)"})
    for (const std::string last : {"IF(P3=3)", "WHILE(P3=3)", "IF(P3=3)AND(P4=4)", "WHILE(P3=3 OR P4=4)OR(P5=5)"}) {
      ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
      EXPECT_EQ(host(first + last), "ERR009") << first << last;
      EXPECT_EQ(host(first + last + "X1"), "") << first << last;
      EXPECT_EQ(host("ENDIF"), "ERR009");
      EXPECT_EQ(host("ENDWHILE"), "ERR009");
      EXPECT_EQ(host("CLOSE"), "") << first << last;
    }
}

TEST_F(FixedBuffer, StructureOfPlcs) {
  const struct {
    std::string line, reply, close;
  } cases[] = {{"IF(P1=1) P2=2 ENDIF", "", ""},     {"IF(P1=1) P2=2", "", "ERR009"},
               {"IF(P1=1) OR(P1=2) ENDIF", "", ""}, {"WHILE(P1=1) P2=2 ENDWHILE", "", ""},
               {"P2=2 ENDIF", "ERR009", ""},        {"P2=2 AND(P1=1)", "ERR009", ""}};
  for (const auto& c : cases) {
    ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
    EXPECT_EQ(host(c.line), c.reply) << c.line;
    EXPECT_EQ(host("CLOSE"), c.close) << c.line;
  }
  EXPECT_EQ(host("LIST PLC 1"), "ERR003") << "nothing is stored of a line with an error";
}

TEST_F(FixedBuffer, AProgramThatIsAddedToKeepsItsStructure) {
  ASSERT_EQ(host("OPEN PROG 1 IF(P1=1)"), "");
  ASSERT_EQ(host("CLOSE"), "ERR009");
  ASSERT_EQ(host("OPEN PROG 1 X1"), "");
  ASSERT_EQ(host("ENDIF"), "");
  EXPECT_EQ(host("CLOSE"), "");
}

// firmware:4.3/4: what CLOSE has appended OPEN takes away, a RETURN of the lines it does not: subroutines are added
// file by file.
// As if it had never been closed.
TEST_F(FixedBuffer, AReopenedProgramGoesOnBehindAOneLineIf) {
  ASSERT_EQ(host("OPEN PROG 1 P1=1"), "");
  ASSERT_EQ(host("IF(P9=1) P2=2"), "");
  ASSERT_EQ(host("CLOSE OPEN PROG 1"), "");
  EXPECT_EQ(host("ELSE P3=3"), "");
  EXPECT_EQ(host("LIST"), "P1=1|IF(P9=1)P2=2|ELSE P3=3");
}

TEST_F(FixedBuffer, CloseAppendsAReturnThatOpenTakesAway) {
  for (const std::string name : {"PROG 1", "PLC 1", "FORWARD", "INVERSE"}) {
    ASSERT_EQ(host("OPEN " + name + " P1=1 CLOSE"), "");
    EXPECT_EQ(host("LIST " + name + ",0"), "0:P1=1|1:RET");
    ASSERT_EQ(host("OPEN " + name), "");
    EXPECT_EQ(host("LIST"), "P1=1") << name;
    ASSERT_EQ(host("P2=2"), "");
    ASSERT_EQ(host("RETURN"), "");
    ASSERT_EQ(host("CLOSE"), "");
    EXPECT_EQ(host("LIST " + name), "P1=1|P2=2|RET") << name << ": the lines end with one";
    ASSERT_EQ(host("OPEN " + name), "");
    ASSERT_EQ(host("P3=3 CLOSE"), "");
    EXPECT_EQ(host("LIST " + name), "P1=1|P2=2|RET|P3=3|RET") << name;
    ASSERT_EQ(host("OPEN " + name + " CLOSE"), "");
    EXPECT_EQ(host("LIST " + name), "P1=1|P2=2|RET|P3=3|RET") << name << ": as it was";
    ASSERT_EQ(host("OPEN " + name + " CLEAR CLOSE"), "");
    EXPECT_EQ(host("LIST " + name), "ERR003") << name << ": nothing ends with nothing";
  }
  EXPECT_EQ(open_words(), 26624u);
}

TEST_F(FixedBuffer, TheAppendedReturnOutlivesSave) {
  ASSERT_EQ(host("OPEN PROG 1 N1 X1 CLOSE SAVE"), "");
  platform::reset();
  ASSERT_EQ(host("OPEN PROG 1 X2 CLOSE"), "");
  EXPECT_EQ(host("LIST PROG 1"), "N1X1|X2|RET");
}

TEST_F(FixedBuffer, NoReturnIsAppendedInAnOpenBlock) {
  ASSERT_EQ(host("OPEN PLC 1 WHILE(P1=1) P1=2"), "");
  ASSERT_EQ(host("CLOSE"), "ERR009");
  EXPECT_EQ(host("LIST PLC 1"), "WHILE(P1=1)|P1=2");
  ASSERT_EQ(host("OPEN PLC 1 ENDWHILE CLOSE"), "");
  EXPECT_EQ(host("LIST PLC 1"), "WHILE(P1=1)|P1=2|ENDW|RET");
}

// The words of a text or of a double may look like anything.
TEST_F(FixedBuffer, OnlyAStatementIsTheAppendedReturn) {
  const char* const lines[] = {"SEND\"RETURN\"", "DWELL0.1", "P1=0.1", "IF(P1=1)RETURN"};
  for (const std::string line : lines) {
    ASSERT_EQ(host("OPEN PROG 1 CLEAR " + line), "");
    const std::string listed = host("LIST");
    ASSERT_EQ(host("CLOSE OPEN PROG 1"), "");
    EXPECT_EQ(host("LIST"), listed);
    ASSERT_EQ(host("CLOSE"), "");
  }
}

// firmware:4.3/5: of what stays nothing changes but where it lies.
TEST_F(FixedBuffer, ClearAllErasesProgramsOrPlcs) {
  const std::string logic = "P1=0.1 IF(P2=2)P3=3 ENDIF";
  for (const std::string& program : {"PLC 0 " + logic, std::string("PROG 7 N5 P4=4"), "PLC 31 " + logic,
                                     "FORWARD " + logic, std::string("PROG 32767 X1Y2"), "INVERSE " + logic})
    ASSERT_EQ(host("OPEN " + program + " CLOSE"), "") << program;
  ASSERT_EQ(host("ENABLE PLC 31"), "");
  ASSERT_EQ(host("CLEAR ALL PLCS"), "");
  EXPECT_EQ(host("LIST PLC 0"), "ERR003");
  EXPECT_EQ(host("LIST PLC 31"), "ERR003");
  EXPECT_EQ(plc_enabled(), 0u);
  EXPECT_EQ(host("LIST PROG 7 LIST PROG 32767 LIST FORWARD LIST INVERSE"),
            "N5P4=4|RET|X1Y2|RET|P1=0.1|IF(P2=2)|P3=3|ENDI|RET|P1=0.1|IF(P2=2)|P3=3|ENDI|RET");
  EXPECT_EQ(open_words(), 26624u - 3u - 3u - 2u * 9u);
  EXPECT_EQ(host("B7.00005 R"), "") << "PROG 7 is pointed to as before";
  platform::servo_ticks(30);
  EXPECT_EQ(host("P4"), "4");
  ASSERT_EQ(host("OPEN PROG 7"), "");
  for (const char* text : {"CLEAR ALL", "CLEAR ALL PLCS", "CLR ALL"}) EXPECT_EQ(host(text), "ERR007") << text;
  EXPECT_EQ(host("LIST"), "N5P4=4") << "nor is the open one cleared";
  ASSERT_EQ(host("CLOSE CLEAR ALL"), "");
  for (const char* name : {"PLC 0", "PROG 7", "PLC 31", "FORWARD", "PROG 32767", "INVERSE"})
    EXPECT_EQ(host(std::string("LIST ") + name), "ERR003") << name;
  EXPECT_EQ(host("R"), "ERR015");
  EXPECT_EQ(open_words(), 26624u);
}

TEST_F(FixedBuffer, ARunningProgramOutlivesThePlcsBelowIt) {
  ASSERT_EQ(host("OPEN PLC 3 P1=1 CLOSE OPEN PROG 1"), "");
  for (const char* line : {"WHILE(P5<9)", "P5=P5+1", "DWELL3", "ENDWHILE", "P6=7"}) ASSERT_EQ(host(line), "");
  ASSERT_EQ(host("CLOSE B1 R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(host("CLEAR ALL"), "ERR001");
  ASSERT_EQ(host("CLEAR ALL PLCS"), "");
  const double before = p_variable_read(5);
  platform::servo_ticks(120);
  EXPECT_LT(before, 9.0);
  EXPECT_EQ(host("P5..6"), "9|7");
}

TEST_F(FixedBuffer, LabelsAreDecimal) {
  ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
  EXPECT_EQ(host("N$64"), "ERR003");
  EXPECT_EQ(host("O$64"), "ERR003");
  EXPECT_EQ(host("N100"), "");
  EXPECT_EQ(host("CLOSE"), "");
}

TEST_F(FixedBuffer, BlocksNestToTheirLimit) {
  ASSERT_EQ(host("OPEN PLC 1"), "");
  for (int depth = 0; depth < 32; ++depth) ASSERT_EQ(host("WHILE(P1=1)"), "");
  EXPECT_EQ(host("WHILE(P1=1)"), "ERR009");
  for (int depth = 0; depth < 32; ++depth) ASSERT_EQ(host("ENDWHILE"), "");
  EXPECT_EQ(host("ENDWHILE"), "ERR009");
  EXPECT_EQ(host("CLOSE"), "");
}

TEST_F(FixedBuffer, MotionProgramsAreOpenedOnlyWhileNothingRuns) {
  ASSERT_EQ(host("&2DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("DWELL1000"), "");
  ASSERT_EQ(host("CLOSE R &1"), "");
  for (const char* text : {"OPEN PROG 1", "OPEN FORWARD", "OPEN INVERSE"}) EXPECT_EQ(host(text), "ERR001") << text;
  EXPECT_EQ(host("OPEN PLC 1 CLOSE"), "");
  ASSERT_EQ(host("&2A"), "");
  EXPECT_EQ(host("OPEN PROG 1"), "");
  EXPECT_EQ(host("R"), "ERR015") << "a fixed buffer is open";
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("R"), "ERR015") << "B must be given again";
  EXPECT_EQ(host("B0 R"), "");
}

TEST_F(FixedBuffer, OpeningAPlcDisablesIt) {
  ASSERT_EQ(host("ENABLE PLC 1..3,31"), "");
  EXPECT_EQ(plc_enabled(), 0x8000000Eu);
  ASSERT_EQ(host("OPEN PLC 2 CLOSE"), "");
  EXPECT_EQ(plc_enabled(), 0x8000000Au);
  ASSERT_EQ(host("PAUSE PLC 3 DIS PLC 31"), "");
  EXPECT_EQ(plc_enabled(), 2u);
  ASSERT_EQ(host("RES PLC 3 ENA PLC 2 ENA PLCC 5"), "");
  EXPECT_EQ(plc_enabled(), 0xEu);
  for (const char* text : {"ENABLE PLC", "ENABLE PLC 32", "ENABLE 3", "DISABLE PLC 3..1"})
    EXPECT_EQ(host(text), "ERR003") << text;
}

// The short forms without a blank, which begin as DISPLAY does (firmware:4.8).
TEST_F(FixedBuffer, DisplcIsDisablePlc) {
  ASSERT_EQ(host("ENABLE PLC 1..3,31"), "");
  EXPECT_EQ(host("DISPLC1"), "");
  EXPECT_EQ(plc_enabled(), 0x8000000Cu);
  EXPECT_EQ(host("displc 2,31 ENAPLC1"), "");
  EXPECT_EQ(plc_enabled(), 0xAu);
  EXPECT_EQ(host("DISPLCC3"), "") << "a compiled one";
  EXPECT_EQ(plc_enabled(), 0xAu);
  EXPECT_EQ(host("DISPLC"), "ERR003");
  EXPECT_EQ(host("DISPLC32"), "ERR003");
  for (const char* text : {"DISP\"A\"", "DISPLAY\"A\"", "DISP LC1"}) EXPECT_EQ(host(text), "ERR005") << text;
}

// firmware:8.5; the ring comes back in no case.
TEST_F(FixedBuffer, SaveKeepsProgramsAndNoRotaryBuffer) {
  ASSERT_EQ(host("OPEN PROG 32767 X1 Y2 CLOSE OPEN PLC 31 P1=1 P2=$F CLOSE"), "");
  ASSERT_EQ(host("&16OPEN FORWARD Q7=P1 CLOSE OPEN INVERSE P1=Q7/3 CLOSE"), "");
  ASSERT_EQ(host("&1DEF ROT 100 I14=1 B0 OPEN ROT"), "");
  ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("CLOSE SAVE"), "");
  ASSERT_EQ(host("DEL ROT OPEN PROG 32767 CLEAR X3 CLOSE OPEN PROG 2 X4 CLOSE"), "");
  platform::reset();
  EXPECT_EQ(host("LIST PROG 32767"), "X1Y2|RET");
  EXPECT_EQ(host("LIST PLC 31"), "P1=1|P2=$F|RET");
  EXPECT_EQ(host("&16LIST FORWARD"), "Q7=P1|RET");
  EXPECT_EQ(host("LIST INVERSE"), "P1=Q7/3|RET");
  EXPECT_EQ(host("LIST PROG 2"), "ERR003") << "it was not saved";
  EXPECT_EQ(host("&1LIST ROT"), "ERR003");
  EXPECT_EQ(open_words(), 26624u - 3u - 4u - 3u - 5u);
  EXPECT_EQ(plc_enabled(), 0x80000000u) << "what there is comes up enabled (firmware:8.4)";
  ASSERT_EQ(host("OPEN PROG 32767 Z3 CLOSE"), "") << "it can be added to";
  EXPECT_EQ(host("LIST PROG 32767"), "X1Y2|Z3|RET");
  EXPECT_EQ(host("LIST PLC 31"), "P1=1|P2=$F|RET");
}

TEST_F(FixedBuffer, DefaultsHaveNoPrograms) {
  ASSERT_EQ(host("OPEN PROG 1 X1 CLOSE SAVE"), "");
  platform::reset("$$$***");
  EXPECT_EQ(host("LIST PROG 1"), "ERR003");
  EXPECT_EQ(open_words(), 26624u);
  platform::reset();
  EXPECT_EQ(host("LIST PROG 1"), "X1|RET") << "the flash store is untouched until SAVE";
}

TEST_F(FixedBuffer, FullMemoryIsSavedAndRestored) {
  std::string line;
  for (int i = 0; i < 64; ++i) line += "X" + std::to_string(i);
  ASSERT_EQ(host("OPEN PROG 1"), "");
  for (unsigned i = 0; i < 26624 / 64; ++i) ASSERT_EQ(host(line), "");
  ASSERT_EQ(host("CLOSE SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("SIZE"), "0");
  const Lines listed = platform::host_lines("LIST PROG 1");
  ASSERT_EQ(listed.size(), 26624u / 64);
  for (const std::string& text : listed) ASSERT_EQ(text, line);
}

TEST_F(FixedBuffer, ResetForgetsWhatWasNotSaved) {
  ASSERT_EQ(host("OPEN PROG 1 X1 CLOSE"), "");
  platform::power_up();
  EXPECT_EQ(host("LIST PROG 1"), "ERR003");
  EXPECT_EQ(open_words(), 26624u);
}

}  // namespace
