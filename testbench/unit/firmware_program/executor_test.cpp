// What all programs share, word by word (firmware/run/executor.h, calls.h): state that ends with a statement, a line, a
// program; places in it; comparators; the ends of numbers of programs and labels.
#include <cmath>
#include <limits>

#include "testbench/unit/firmware_program/motion_program.h"

extern "C" {
#include "firmware/run/executor.h"
bool calls_split(double value, uint32_t* program, uint32_t* label); /* calls.h has a struct of the namespace's name */
}

namespace {

using namespace motion_program;

class Executor : public MotionProgram {
 protected:
  // At the top of PROG 1, which has these lines.
  void load(const Lines& lines) {
    store(1, lines);
    reader_fixed(&x_.at.reader, FIXED_PROG, 1, 0);
    word48_t word;
    ASSERT_EQ(reader_peek(&x_.at.reader, 0, &word), READER_WORD);
    executor_begin(&x_, 0);
  }
  // All of it but the reader as nothing leaves it.
  void spoil(std::uint32_t offset) {
    executor spoilt{};
    spoilt.at.reader = x_.at.reader;
    spoilt.at.reader.offset = offset;
    spoilt.at.line = spoilt.at.statement = 99;
    spoilt.at.begun = spoilt.at.in_line = true;
    spoilt.at.loop_count = 3;
    spoilt.jumps_back = 7;
    spoilt.prefix = 1024;
    spoilt.evaluator.depth = 5;
    spoilt.condition.open = true;
    spoilt.error = RUN_TIME_DEPTH;
    x_ = spoilt;
  }
  void nothing_is_begun() const {
    EXPECT_FALSE(x_.at.begun);
    EXPECT_FALSE(x_.at.in_line);
    EXPECT_EQ(x_.prefix, 0u);
    EXPECT_EQ(x_.evaluator.depth, 0u);
    EXPECT_FALSE(x_.condition.open);
  }
  executed step() { return executor_step(&x_, &in_); }

  executor x_{};
  instruction in_{};
};

TEST_F(Executor, BeginHasNothingOfWhatWasBefore) {
  load({"P1=1", "P2=2"});
  spoil(1);
  executor_begin(&x_, 4);
  nothing_is_begun();
  EXPECT_EQ(x_.cs, 4u);
  EXPECT_EQ(x_.at.reader.offset, 1u);
  EXPECT_EQ(x_.at.reader.number, 1u);
  EXPECT_EQ(x_.at.loop_count, 0u);
  EXPECT_EQ(x_.error, RUN_TIME_NONE);
}

TEST_F(Executor, AJumpEndsTheLineAndItsLoopsAndCountsWhenItGoesBack) {
  load({"P1=1", "P2=2", "P3=3", "P4=4"});
  for (const std::uint32_t target : {0u, 1u, 2u, 3u}) {
    spoil(2);
    EXPECT_EQ(executor_jump(&x_, target), EXECUTED_LINE);
    nothing_is_begun();
    EXPECT_EQ(x_.at.reader.offset, target) << "not the begin of a loop";
    EXPECT_EQ(x_.at.loop_count, 0u);
    EXPECT_EQ(x_.jumps_back, target <= 2 ? 8u : 7u) << target;
  }
}

TEST_F(Executor, TheEndOfALineGoesToTheInnermostOfItsLoops) {
  load({"P1=1", "P2=2", "P3=3", "P4=4"});
  spoil(3);
  x_.at.loop_count = 2;
  x_.at.loops[0] = 1;
  x_.at.loops[1] = 2;
  for (const std::uint32_t target : {2u, 1u, 1u}) {
    EXPECT_EQ(executor_end_line(&x_), EXECUTED_LINE);
    nothing_is_begun();
    EXPECT_EQ(x_.at.reader.offset, target);
  }
  EXPECT_EQ(x_.jumps_back, 9u) << "the third end had none to go back to";
}

TEST_F(Executor, BackIsTheStatementInTheLoopsOfItsLine) {
  load({"P1=1", "P2=2", "P3=3"});
  spoil(2);
  x_.at.statement = 1;
  executor_back(&x_);
  nothing_is_begun();
  EXPECT_EQ(x_.at.reader.offset, 1u);
  EXPECT_EQ(x_.at.loop_count, 3u);
  EXPECT_EQ(x_.jumps_back, 7u);
}

TEST_F(Executor, WhatIsSkippedOfALineIsItsRest) {
  load({"P1=1 P2=2 P3=P1+4.1", "P4=4"});  // words 0; 1; 2 to 6, a raw one among them; 7
  for (const std::uint32_t from : {1u, 2u, 3u, 6u}) {
    spoil(from);
    executor_skip_line(&x_);
    nothing_is_begun();
    EXPECT_EQ(x_.at.reader.offset, 7u) << from;
    EXPECT_EQ(x_.at.loop_count, 0u);
  }
  spoil(0);
  x_.at.in_line = false;
  executor_skip_line(&x_);
  EXPECT_EQ(x_.at.reader.offset, 0u) << "none is begun";
}

TEST_F(Executor, EachWordTellsWhereItsLineAndStatementBegin) {
  load({"P1=1 P2000=P1+1", "X(P1) P3=3"});  // 0; 1 2 3, 4 the prefix, 5; 6 7; 8
  const struct {
    std::uint32_t line, statement;
    executed how;
    bool begun, in_line;
  } words[] = {{0, 0, EXECUTED_WORD, false, true},
               {0, 1, EXECUTED_WORD, true, true},
               {0, 1, EXECUTED_WORD, true, true},
               {0, 1, EXECUTED_WORD, true, true}};
  for (const auto& word : words) {
    EXPECT_EQ(step(), word.how);
    EXPECT_EQ(x_.at.line, word.line);
    EXPECT_EQ(x_.at.statement, word.statement);
    EXPECT_EQ(x_.at.begun, word.begun);
    EXPECT_EQ(x_.at.in_line, word.in_line);
  }
  while (x_.at.reader.offset < 8 && step() != EXECUTED_STATEMENT) {}
  EXPECT_EQ(host("P1 P2000"), "1|2");
  EXPECT_EQ(in_.operation, OP_AXIS_POP);
  EXPECT_EQ(in_.value, 1.0) << "X has the value that was pushed before it";
  const std::uint32_t at = x_.at.reader.offset;
  EXPECT_EQ(x_.at.line, at - 1);
  EXPECT_EQ(x_.at.statement, at - 1);
  EXPECT_EQ(step(), EXECUTED_STATEMENT) << "it is not consumed";
  EXPECT_EQ(executor_pass(&x_), EXECUTED_WORD);
  EXPECT_EQ(x_.evaluator.depth, 0u);
  EXPECT_EQ(step(), EXECUTED_LINE);
  EXPECT_EQ(x_.at.statement, at + 1);
  EXPECT_FALSE(x_.at.in_line);
  EXPECT_EQ(step(), EXECUTED_END) << "RETURN";
  EXPECT_EQ(step(), EXECUTED_END) << "which comes again";
}

// A prefix is of the next command alone.
TEST_F(Executor, APrefixEndsWithItsCommand) {
  load({"P2000=P2001+1 P5=7", "P2001=3 P6=8"});
  while (step() != EXECUTED_END) {}
  EXPECT_EQ(host("P2000 P5 P2001 P6"), "1|7|3|8");
  EXPECT_EQ(host("P1029 P1030"), "0|0") << "1024 + 5, 1024 + 6";
}

// READ and PRELUDE look so far ahead: behind the expression, not behind the line.
TEST_F(Executor, NextIsWhatTheValueIsFor) {
  load({"X(P1*2+0.1)", "Y2 P7=P1+P2"});
  ASSERT_TRUE(executor_next(&x_, &in_));
  EXPECT_EQ(in_.operation, OP_AXIS_POP);
  EXPECT_EQ(in_.number, static_cast<std::uint32_t>(AXIS_X));
  EXPECT_EQ(x_.at.reader.offset, 0u) << "nothing is executed";
  EXPECT_EQ(x_.evaluator.depth, 0u);
  while (step() == EXECUTED_WORD) {}
  const std::uint32_t last = x_.at.reader.offset - 1;
  EXPECT_EQ(executor_pass(&x_), EXECUTED_LINE);
  ASSERT_TRUE(executor_next(&x_, &in_));
  EXPECT_EQ(in_.operation, OP_AXIS);
  EXPECT_EQ(executor_pass(&x_), EXECUTED_WORD);
  ASSERT_TRUE(executor_next(&x_, &in_));
  EXPECT_EQ(in_.operation, OP_ASSIGN_POP);
  EXPECT_EQ(in_.number, 7u);
  const std::uint32_t base = x_.at.reader.base;  // X( and what is behind it were one line, with no one for the value
  user_memory_write(base + last, word48_t{13} << 43 | WORD_START_OF_LINE);
  x_.at.reader.offset = 0;
  EXPECT_FALSE(executor_next(&x_, &in_)) << "another line begins";
}

// firmware:1.7: `~` is a difference below 0.5; each has its opposite.
TEST_F(Executor, ComparatorsAtTheirEdges) {
  const char* const names[] = {"=", ">", "<", "~"};
  Lines lines;
  for (unsigned i = 0; i < 4; ++i) {
    lines.push_back(std::string("IF(P1") + names[i] + "P2) P" + std::to_string(10 + i) + "=1");
    lines.push_back(std::string("IF(P1!") + names[i] + "P2) P" + std::to_string(20 + i) + "=1");
  }
  for (const double difference : {-1.0, -0.5, -0.4375, 0.0, 0.4375, 0.5, 1.0}) {
    p_variable_write(1, 3.0 + difference);
    ASSERT_EQ(host("P2=3 P10..13=0 P20..23=0"), "");
    run(lines);
    const bool is[] = {difference == 0.0, difference > 0.0, difference < 0.0, std::fabs(difference) < 0.5};
    for (unsigned i = 0; i < 4; ++i) {
      EXPECT_EQ(p(10 + i), is[i] ? 1.0 : 0.0) << names[i] << " " << difference;
      EXPECT_EQ(p(20 + i), is[i] ? 0.0 : 1.0) << "!" << names[i] << " " << difference;
    }
  }
}

// firmware:7.10, number 5.
TEST_F(Executor, EightLoopsFitInALine) {
  const auto line = [](unsigned loops) {
    std::string text;
    for (unsigned i = 1; i <= loops; ++i) text += "WHILE(P" + std::to_string(i) + "<1)";
    for (unsigned i = 1; i <= loops; ++i) text += "P" + std::to_string(i) + "=1";
    return text;
  };
  run({line(8), "P20=1"});
  EXPECT_FALSE(error());
  EXPECT_EQ(host("P1..8 P20"), "1|1|1|1|1|1|1|1|1");
  ASSERT_EQ(host("P1..8=0 P20=0"), "");
  run({line(9), "P20=1"});
  EXPECT_TRUE(error());
  EXPECT_EQ(host("RY$2014 P9 P20"), "5|0|0");
}

// firmware:4.3: 0 to 32767.99999, five places of label.
TEST(Calls, NumbersOfProgramsAndLabels) {
  const struct {
    double value;
    std::uint32_t program, label;
  } calls[] = {{0.0, 0, 0},         {0.5, 0, 50000},       {1.0, 1, 0},
               {3.025, 3, 2500},    {7.00001, 7, 1},       {32767.0, 32767, 0},
               {7.99999, 7, 99999}, {1000.9, 1000, 90000}, {32767.99999, 32767, 99999}};
  for (const auto& call : calls) {
    std::uint32_t program = 1, label = 1;
    EXPECT_TRUE(calls_split(call.value, &program, &label)) << call.value;
    EXPECT_EQ(program, call.program) << call.value;
    EXPECT_EQ(label, call.label) << call.value;
  }
  for (const double value : {-1.0, -0.00001, 32768.0, 1e9, 1e300, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    std::uint32_t program, label;
    EXPECT_FALSE(calls_split(value, &program, &label)) << value;
  }
}

// 262143 is the last label (firmware:7.2). The whole part counts.
TEST_F(Executor, LabelsOfJumpsHaveTheirEnds) {
  for (const char* jump : {"GOTO", "GOSUB"})
    for (const auto& [number, number_of_error] :
         {std::pair{"262143", 0}, {"262143.9", 3}, {"262144", 3}, {"-1", 3}, {"0.5", 0}, {"262142", 3}}) {
      SCOPED_TRACE(std::string(jump) + number);
      ASSERT_EQ(host("P1=0 P2=0"), "");
      run({"IF(P2=1) RETURN", std::string("P2=1 ") + jump + "(" + number + ")", "RETURN", "N262143 P1=1"});
      EXPECT_EQ(host("RY$2014"), std::to_string(number_of_error));
      EXPECT_EQ(p(1), number == std::string("262143") ? 1.0 : 0.0);
    }
}

// firmware:7.2/1: the first from the top.
TEST_F(Executor, OfLabelsThatAreTwiceThereTheFirstIsTaken) {
  run({"GOTO7", "P1=1", "N7 P2=P2+1 RETURN", "O7 P2=100", "N8 P2=200"});
  EXPECT_EQ(host("P1..2"), "0|1");
}

// firmware:7.3: programs of codes by hundreds, the label a thousand times the rest.
TEST_F(Executor, CodesNameProgramsAndLabels) {
  const struct {
    const char *code, *number_of_error;
    unsigned program;
    const char* label;
  } codes[] = {{"G0", "0", 1000, ""},           {"G99", "0", 1000, "N99000"},
               {"G100", "0", 1010, ""},         {"G99.999", "0", 1000, "N99999"},
               {"M254.5", "0", 1021, "N54500"}, {"T1000", "0", 1102, ""},
               {"D301", "0", 1033, "N1000"},    {"G32767", "0", 4270, "N67000"},
               {"G32768", "2", 4270, "N68000"}, {"G(-1)", "2", 1000, ""}};
  for (const auto& code : codes) {
    SCOPED_TRACE(code.code);
    platform::power_up();
    store(code.program, {"P2=1 RETURN", std::string(code.label) + " P1=1"});
    run({code.code});
    EXPECT_EQ(host("RY$2014"), code.number_of_error);
    if (*code.number_of_error == '0') { EXPECT_EQ(host("P1 P2"), *code.label == '\0' ? "0|1" : "1|0"); }
  }
}

}  // namespace
