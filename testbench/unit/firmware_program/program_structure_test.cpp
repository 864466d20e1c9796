// Where the execution of a fixed program goes on (firmware/buffers/program_structure.h), word by word, and programs in
// user memory with their links (firmware/buffers/fixed_programs.h).
#include <algorithm>
#include <map>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/buffers/program_links.h"
#include "firmware/buffers/program_structure.h"
}

namespace {

using platform::host;
using Lines = std::vector<std::string>;
using Links = std::map<unsigned, unsigned>;  // those that are not LINK_NONE

class ProgramStructure : public FirmwareTest {
 protected:
  static void enter(const std::string& program, const Lines& lines) {
    ASSERT_EQ(host("OPEN " + program + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  static Links links_of(fixed_kind kind) {
    const fixed_program* program = fixed_program_find(kind, 1);
    EXPECT_EQ(program_links_make(program), LINKS_MADE);
    Links found;
    for (unsigned i = 0; i < program->words; ++i)
      if (fixed_program_links[program->base + i] != LINK_NONE) found[i] = fixed_program_links[program->base + i];
    return found;
  }
};

// A condition is two pushed values and the word that has its link.
TEST_F(ProgramStructure, LinksOfAMotionProgram) {
  const struct {
    Lines lines;
    Links links;
  } cases[] = {{{"IF(P1=1)", "X1", "ENDIF"}, {{2, 5}}},
               {{"IF(P1=1)", "X1", "ELSE", "X2", "ENDIF"}, {{2, 5}, {4, 7}}},
               {{"IF(P1=1)", "X1", "ELSE X2"}, {{2, 5}}},
               {{"IF(P1=1)X1", "ELSE X2"}, {}},
               {{"IF(P1=1)X1", "ELSE", "X2", "ENDIF"}, {{4, 7}}},
               {{"WHILE(P1=1)", "X1", "ENDWHILE"}, {{2, 5}, {4, 1}}},
               {{"WHILE(P1=1)X1"}, {}},
               {{"X1", "WHILE(P1=1)", "IF(P2=2)", "X2", "ENDIF", "ENDWHILE"}, {{3, 10}, {6, 9}, {9, 2}}},
               {{"IF(P1=1)AND(P2=2)", "X1", "ENDIF"}, {{2, LINK_CONTINUES}, {5, 8}}},
               {{"IF(P1=1)AND(P2=2)OR(P3=3)X1"}, {{2, LINK_CONTINUES}, {5, LINK_CONTINUES}}},
               {{"WHILE(P1=1)OR(P2=2)", "X1", "ENDWHILE"}, {{2, LINK_CONTINUES}, {5, 8}, {7, 1}}},
               {{"IF(P1=1 AND P2=2)", "X1", "ENDIF"}, {{5, 8}}},
               {{"X1", "WHILE(P1=1 OR P2=2)", "X1", "ENDWHILE"}, {{6, 9}, {8, 2}}},
               {{"IF(P1=1)", "IF(P2=2)", "X1", "ELSE", "X2", "ENDIF", "ELSE", "X3", "ENDIF"},
                {{2, 11}, {5, 8}, {7, 10}, {10, 13}}},
               {{"IF(P1=1)IF(P2=2)X1", "ELSE X2"}, {}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.lines.front());
    enter("PROG 1", c.lines);
    EXPECT_EQ(links_of(FIXED_PROG), c.links);
  }
}

// There a line is a statement, and AND and OR are lines of their own too.
TEST_F(ProgramStructure, LinksOfAPlc) {
  const struct {
    Lines lines;
    Links links;
  } cases[] = {{{"IF(P1=1)P2=2 ENDIF"}, {{2, 5}}},
               {{"IF(P1=1)", "AND(P2=2)", "P3=3", "ELSE", "P4=4", "ENDIF"}, {{2, LINK_CONTINUES}, {5, 8}, {7, 10}}},
               {{"P3=3", "WHILE(P1=1)", "OR(P2=2)", "P3=3", "ENDWHILE"}, {{3, LINK_CONTINUES}, {6, 9}, {8, 2}}},
               {{"WHILE(P1=1 AND P2=2)AND(P3=3)", "ENDWHILE"}, {{5, LINK_CONTINUES}, {8, 10}, {9, 1}}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.lines.front());
    enter("PLC 1", c.lines);
    EXPECT_EQ(links_of(FIXED_PLC), c.links);
  }
}

// What stands behind an ELSE is all that it governs: no block begins or ends there.
TEST_F(ProgramStructure, NoBlockBeginsOrEndsBehindAnElseOfItsLine) {
  const Lines heads[] = {{"IF(P1=1)", "X1"}, {"IF(P1=1)X1"}, {"WHILE(P9=9)", "IF(P1=1)", "X1"}};
  for (const Lines& head : heads)
    for (const std::string tail : {"X2 ENDIF", "X2 ENDWHILE", "ENDIF", "X2 ELSE X3", "ELSE X3", "ELSE", "IF(P2=2)",
                                   "WHILE(P2=2)", "X2 IF(P2=2)", "X2 IF(P2=2)OR(P3=3)"}) {
      ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
      for (const std::string& line : head) ASSERT_EQ(host(line), "") << line;
      EXPECT_EQ(host("ELSE " + tail), "ERR009") << head.back() << ", ELSE " << tail;
      EXPECT_EQ(host("ELSE IF(P2=2)X2"), "") << head.back();
      EXPECT_EQ(host("ELSE X3"), "") << "of that IF";
      EXPECT_EQ(host("ELSE X3"), "ERR009");
      host("CLOSE");
    }
}

// 32 blocks in each other.
TEST_F(ProgramStructure, BlocksHaveADepth) {
  for (const std::string first : {"IF(P1=1)", "WHILE(P1=1)"}) {
    ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
    for (int i = 0; i < 32; ++i) ASSERT_EQ(host(first), "") << i;
    EXPECT_EQ(host("IF(P1=1)"), "ERR009");
    EXPECT_EQ(host("WHILE(P1=1)"), "ERR009");
    EXPECT_EQ(host("WHILE(P1=1)X1"), "") << "no block";
    for (int i = 0; i < 32; ++i) ASSERT_EQ(host(first[0] == 'I' ? "ENDIF" : "ENDWHILE"), "") << i;
    EXPECT_EQ(host(first[0] == 'I' ? "ENDIF" : "ENDWHILE"), "ERR009");
    ASSERT_EQ(host("CLOSE"), "");
  }
}

class FixedPrograms : public FirmwareTest {
 protected:
  // Words that name their program, with links that do, too.
  static void make(fixed_kind kind, unsigned number, unsigned words) {
    ASSERT_EQ(fixed_program_open(kind, number), ERR_NONE);
    for (unsigned i = 0; i < words; ++i) {
      const word48_t word = word_of(kind, number, i);
      ASSERT_EQ(fixed_program_append(&word, 1), ERR_NONE);
    }
    fixed_program_close();
    const fixed_program* program = fixed_program_find(kind, number);
    for (unsigned i = 0; i < words; ++i) fixed_program_links[program->base + i] = link_of(kind, number, i);
    fixed_program_set_linked(program);
  }
  static word48_t word_of(fixed_kind kind, unsigned number, unsigned i) {
    const instruction in{OP_AXIS, 0, AXIS_X, 1000.0 * number + 10.0 * i + kind};
    return word_encode(&in);
  }
  static std::uint16_t link_of(fixed_kind kind, unsigned number, unsigned i) {
    return static_cast<std::uint16_t>(1000 * number + 10 * i + kind + 1);
  }
  // In memory one behind the other, nothing open between.
  struct There {
    fixed_kind kind;
    unsigned number, words;
    bool linked;
  };
  static void expect(const std::vector<There>& programs) {
    ASSERT_EQ(fixed_programs_count(), programs.size());
    unsigned base = 0;
    for (unsigned i = 0; i < programs.size(); ++i) {
      const There& t = programs[i];
      const fixed_program* p = fixed_program_at(i);
      SCOPED_TRACE(t.number);
      EXPECT_EQ(fixed_program_find(t.kind, t.number), p);
      EXPECT_EQ(p->kind, t.kind);
      EXPECT_EQ(p->number, t.number);
      EXPECT_EQ(p->base, base);
      ASSERT_EQ(p->words, t.words);
      EXPECT_EQ(p->linked, t.linked);
      for (unsigned n = 0; n < t.words; ++n) {
        EXPECT_EQ(fixed_program_word(p, n), word_of(t.kind, t.number, n) | WORD_START_OF_LINE) << n;
        EXPECT_EQ(fixed_program_links[base + n], link_of(t.kind, t.number, n)) << n;
      }
      base += t.words;
    }
    EXPECT_EQ(region_open_words(), 26624 - base);
    EXPECT_EQ(fixed_programs_generation() % 2, 0u);
  }
};

// A program that is opened again goes above the others, words and links; those come down by its words.
TEST_F(FixedPrograms, TheOneThatIsOpenedIsRaised) {
  make(FIXED_PROG, 3, 2);
  make(FIXED_PLC, 3, 5);
  make(FIXED_PROG, 9, 1);
  make(FIXED_INVERSE, 4, 4);
  std::vector<There> order = {
      {FIXED_PROG, 3, 2, true}, {FIXED_PLC, 3, 5, true}, {FIXED_PROG, 9, 1, true}, {FIXED_INVERSE, 4, 4, true}};
  expect(order);
  for (const unsigned index : {0u, 1u, 2u, 3u, 0u, 2u}) {
    const There raised = order[index];
    const std::uint32_t before = fixed_programs_generation();
    ASSERT_EQ(fixed_program_open(raised.kind, raised.number), ERR_NONE);
    EXPECT_EQ(fixed_programs_generation() != before, index != 3) << "whether any has moved";
    EXPECT_EQ(fixed_program_opened(), fixed_program_at(3));
    order.erase(order.begin() + index);
    order.push_back(raised);
    order.back().linked = false;
    expect(order);
    const std::uint32_t open = fixed_programs_generation();
    fixed_program_close();
    EXPECT_NE(fixed_programs_generation(), open) << "its words have changed";
    EXPECT_EQ(fixed_program_opened(), nullptr);
    fixed_program_set_linked(fixed_program_at(3));
    order.back().linked = true;
    expect(order);
  }
}

TEST_F(FixedPrograms, WhatIsErasedLeavesNoGap) {
  const There all[] = {{FIXED_PROG, 3, 2, true},     {FIXED_PLC, 3, 5, true}, {FIXED_FORWARD, 3, 3, true},
                       {FIXED_PROG, 32767, 1, true}, {FIXED_PLC, 0, 1, true}, {FIXED_INVERSE, 15, 4, true}};
  for (unsigned kinds = 0; kinds < 16; ++kinds) {
    SCOPED_TRACE(kinds);
    platform::power_up();
    std::vector<There> left;
    for (const There& t : all) {
      make(t.kind, t.number, t.words);
      if ((kinds >> t.kind & 1) == 0) left.push_back(t);
    }
    const std::uint32_t before = fixed_programs_generation();
    fixed_programs_erase(kinds);
    EXPECT_NE(fixed_programs_generation(), before);
    expect(left);
  }
}

// Links are those of the words that are stored; an older program's at their places are none.
TEST_F(FixedPrograms, NewWordsHaveNoLinks) {
  const auto mark = [] { std::fill(fixed_program_links, fixed_program_links + 40, std::uint16_t{0x1234}); };
  const auto expect_none = [](unsigned from, unsigned end) {
    for (unsigned i = 0; i < 40; ++i) EXPECT_EQ(fixed_program_links[i], i >= from && i < end ? LINK_NONE : 0x1234) << i;
  };
  const word48_t words[] = {word_of(FIXED_PROG, 1, 0), word_of(FIXED_PROG, 1, 1), word_of(FIXED_PROG, 1, 2)};
  ASSERT_EQ(fixed_program_open(FIXED_PROG, 1), ERR_NONE);
  mark();
  ASSERT_EQ(fixed_program_append(words, 3), ERR_NONE);
  expect_none(0, 3);
  mark();
  ASSERT_EQ(fixed_program_append(words, 2), ERR_NONE);
  expect_none(3, 5);
  const fixed_program* program = fixed_program_opened();
  for (unsigned i = 0; i < 5; ++i)  // the first of each line has the mark
    EXPECT_EQ(fixed_program_word(program, i), words[i % 3] | (i % 3 == 0 ? WORD_START_OF_LINE : 0)) << i;
  EXPECT_EQ(fixed_program_line(program, 0), 3u);
  EXPECT_EQ(fixed_program_line(program, 3), 2u);
  EXPECT_EQ(fixed_program_line(program, 5), 0u);
  fixed_program_drop_last();
  EXPECT_EQ(fixed_program_line(program, 3), 1u);
  EXPECT_EQ(region_open_words(), 26624u - 4);
  fixed_program_close();
  mark();
  ASSERT_TRUE(fixed_program_restore(FIXED_PLC, 7, 6));
  expect_none(4, 10);
  EXPECT_FALSE(fixed_program_find(FIXED_PLC, 7)->linked);
}

// CLOSE keeps no program without words, whether it is the only one or not.
TEST_F(FixedPrograms, AnEmptyOneIsGoneWithItsClose) {
  for (unsigned others = 0; others < 3; ++others) {
    if (others > 0) make(FIXED_PROG, others, 1);
    ASSERT_EQ(fixed_program_open(FIXED_PLC, 5), ERR_NONE);
    EXPECT_EQ(fixed_programs_count(), others + 1);
    fixed_program_close();
    EXPECT_EQ(fixed_programs_count(), others);
    EXPECT_EQ(fixed_program_find(FIXED_PLC, 5), nullptr);
    make(FIXED_PLC, 5, 3);
    ASSERT_EQ(fixed_program_open(FIXED_PLC, 5), ERR_NONE);
    fixed_program_clear();
    EXPECT_EQ(region_open_words(), 26624 - others);
    fixed_program_close();
    EXPECT_EQ(fixed_programs_count(), others);
  }
}

}  // namespace
