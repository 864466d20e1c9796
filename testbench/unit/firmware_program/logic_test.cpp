// Random programs of assignments and logic: the same tree is written out as program lines, in any of the forms that the
// language has for it, and evaluated here; P, Q and M must agree.
#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::host;
using Lines = std::vector<std::string>;

constexpr unsigned kVariables = 10, kLineLimit = 255;

// What a program computes with: P0..9, Q0..9, M10..19, and counters of loops P200...
struct State {
  std::array<double, kVariables> p{}, q{}, m{};
  double& at(char letter, unsigned index) { return letter == 'P' ? p[index] : letter == 'Q' ? q[index] : m[index]; }
};

// A part of a program: its text, and what it does.
struct Value {
  std::string text;
  std::function<double(State&)> get;
};
struct Condition {
  std::string text;  // with its brackets; parts of a condition follow each other on the line
  std::function<bool(State&)> is_true;
};
struct Part {
  Lines lines;
  std::function<void(State&)> act;
};

class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed) {}

  Part block(unsigned depth) {
    std::vector<Part> parts;
    for (unsigned i = 1 + number(3); i > 0; --i) parts.push_back(statement(depth));
    Part all;
    for (const Part& part : parts) all.lines.insert(all.lines.end(), part.lines.begin(), part.lines.end());
    all.act = [parts](State& s) {
      for (const Part& part : parts) part.act(s);
    };
    return all;
  }
  const Lines& subroutines() const { return subroutines_; }
  const std::vector<unsigned>& forms() const { return forms_; }

 private:
  unsigned number(unsigned count) { return std::uniform_int_distribution<unsigned>(0, count - 1)(random_); }

  Value value(unsigned depth) {
    if (depth == 0 || number(3) == 0) {
      if (number(3) == 0) {
        const double constant = number(50);
        return {std::to_string(static_cast<int>(constant)), [constant](State&) { return constant; }};
      }
      const char letter = "PQM"[number(3)];
      const unsigned index = number(kVariables), base = letter == 'M' ? 10 : 0;
      if (number(4) != 0) return {letter + std::to_string(base + index), [=](State& s) { return s.at(letter, index); }};
      const Value inner = value(0);  // P((Q1)%10)
      return {std::string(1, letter) + "((" + inner.text + ")%10+" + std::to_string(base) + ")",
              [=](State& s) { return s.at(letter, static_cast<unsigned>(inner.get(s)) % kVariables); }};
    }
    const Value a = value(depth - 1), b = value(depth - 1);
    switch (number(3)) {
      case 0:
        return {"(" + a.text + "+" + b.text + ")", [=](State& s) { return a.get(s) + b.get(s); }};
      case 1:
        return {"(" + a.text + "-" + b.text + ")", [=](State& s) { return a.get(s) - b.get(s); }};
      default:
        return {"(" + a.text + "*" + b.text + ")", [=](State& s) { return a.get(s) * b.get(s); }};
    }
  }

  static double modulo(double a, double n) { return a - n * std::floor(a / n); }

  Part assignment() {
    const Value v = value(2);
    const char letter = "PQM"[number(3)];
    const unsigned index = number(kVariables);
    const std::string name = letter + std::to_string((letter == 'M' ? 10 : 0) + index);
    return {{name + "=(" + v.text + ")%1000"}, [=](State& s) { s.at(letter, index) = modulo(v.get(s), 1000.0); }};
  }

  Condition comparison() {
    static const std::array<const char*, 6> names = {"=", "!=", ">", "!>", "<", "!<"};
    const Value a = value(1), b = value(1);
    const unsigned which = number(6);
    return {a.text + names[which] + b.text, [=](State& s) {
              const double x = a.get(s), y = b.get(s);
              const bool is = which < 2 ? x == y : which < 4 ? x > y : x < y;
              return is != (which % 2 == 1);
            }};
  }

  // OR of ANDs, as the language binds; `inside`: of comparisons in one pair of brackets, else of such brackets.
  Condition condition(bool inside) {
    Condition all;
    std::vector<std::vector<Condition>> sums(1);
    for (unsigned i = 1 + number(3); i > 0; --i) {
      const bool first = all.text.empty(), is_or = number(2) == 0;
      const Condition part = inside ? comparison() : condition(true);
      if (!first) all.text += is_or ? (inside ? " OR " : "OR") : (inside ? " AND " : "AND");
      if (!first && is_or) sums.emplace_back();
      all.text += part.text;
      sums.back().push_back(part);
    }
    if (inside) all.text = "(" + all.text + ")";
    all.is_true = [sums](State& s) {
      bool any = false;
      for (const auto& product : sums) {
        bool every = true;
        for (const Condition& part : product) every = part.is_true(s) && every;
        any = any || every;
      }
      return any;
    };
    return all;
  }

  Part one_line(unsigned count) {  // assignments on one line
    Part all{{""}, [](State&) {}};
    for (unsigned i = 0; i < count; ++i) {
      const Part next = assignment();
      const auto before = all.act;
      all.lines[0] += (i == 0 ? "" : " ") + next.lines[0];
      all.act = [before, next](State& s) {
        before(s);
        next.act(s);
      };
    }
    return all;
  }

  static void append(Lines& lines, const Lines& more) { lines.insert(lines.end(), more.begin(), more.end()); }

  Part if_else(unsigned depth) {
    const Condition c = condition(false);
    const bool block_if = number(2) == 0;
    const unsigned otherwise = number(3);  // none, on its line, as a block
    const Part yes = block_if ? block(depth - 1) : one_line(1 + number(2));
    Part no{{}, [](State&) {}};
    Part all;
    all.lines = {"IF" + c.text + (block_if ? "" : " " + yes.lines[0])};
    if (block_if) append(all.lines, yes.lines);
    // An ELSE behind a line with IF belongs to that one: something else comes between.
    if (block_if && otherwise != 0) all.lines.push_back("P99=P99");
    if (otherwise == 1) {
      no = one_line(1);
      all.lines.push_back("ELSE " + no.lines[0]);
    } else if (otherwise == 2) {
      no = block(depth - 1);
      all.lines.push_back("ELSE");
      append(all.lines, no.lines);
      all.lines.push_back("ENDIF");
    }
    if (block_if && otherwise == 0) all.lines.push_back("ENDIF");
    if (!block_if && otherwise == 0) all.lines.push_back("P99=P99");
    all.act = [c, yes, no](State& s) { c.is_true(s) ? yes.act(s) : no.act(s); };
    forms_.push_back(block_if * 3 + otherwise);
    return all;
  }

  Part loop(unsigned depth) {
    const std::string counter = "P" + std::to_string(200 + loops_++);
    const unsigned times = number(4);
    const Condition c = condition(true);  // in one pair of brackets: the counter bounds all of it
    const bool in_line = number(3) == 0;
    const Part body = in_line ? one_line(1) : block(depth - 1);
    const std::string count = counter + "=" + counter + "+1";
    const std::string head = "WHILE(" + counter + "<" + std::to_string(times) + ")AND" + c.text;
    Part all{{counter + "=0"}, nullptr};
    if (in_line) {
      all.lines.push_back(head + " " + count + " " + body.lines[0]);
    } else {
      append(all.lines, {head, count});
      append(all.lines, body.lines);
      all.lines.push_back("ENDWHILE");
    }
    all.act = [=](State& s) {
      for (unsigned i = 0; i < times && c.is_true(s); ++i) body.act(s);
    };
    forms_.push_back(in_line ? 6 : 7);
    return all;
  }

  Part subroutine(unsigned depth) {
    const unsigned label = ++labels_;
    const Part body = block(depth - 1);
    append(subroutines_, {"N" + std::to_string(label)});
    append(subroutines_, body.lines);
    append(subroutines_, {"RETURN"});
    forms_.push_back(8);
    return {{"GOSUB " + std::to_string(label)}, body.act};
  }

  Part jump() {  // over what is not executed
    const unsigned label = ++labels_;
    forms_.push_back(9);
    return {{"GOTO " + std::to_string(label), assignment().lines[0], "N" + std::to_string(label)}, [](State&) {}};
  }

  Part statement(unsigned depth) {
    switch (depth == 0 ? 0 : number(7)) {
      case 2:
      case 3:
        return if_else(depth);
      case 4:
        return loop(depth);
      case 5:
        return subroutine(depth);
      case 6:
        return jump();
      default:
        return one_line(1 + number(3));
    }
  }

  std::mt19937 random_;
  unsigned loops_ = 0, labels_ = 0;
  Lines subroutines_;
  std::vector<unsigned> forms_;
};

class Logic : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    for (unsigned i = 0; i < kVariables; ++i)
      ASSERT_EQ(host("M" + std::to_string(10 + i) + "->X:$" + std::to_string(10) + "F" + std::to_string(i) + ",0,24,S"),
                "");
  }
  static State memory() {
    State s;
    for (unsigned i = 0; i < kVariables; ++i) {
      s.p[i] = p_variable_read(i);
      s.q[i] = q_variable_read(0, i);
      s.m[i] = m_variable_read(10 + i);
    }
    return s;
  }
};

// firmware:1.2/6: a PLC that looks whether a value has changed finds that it has not, whichever way it was rounded.
TEST_F(Logic, AnExpressionIsComparedAsAVariableHoldsIt) {
  ASSERT_EQ(host("P3=0.7"), "");
  unsigned up = 0, down = 0;
  for (const std::string text : {"P2/3", "-P2/7", "SQRT(P2)*P3", "EXP(P2)", "SIN(P2)/1000000", "P2*1.1"})
    for (unsigned value = 1; value <= 20; ++value) {
      ASSERT_EQ(host("P2=" + std::to_string(value)), "");
      ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
      ASSERT_EQ(host("P1=" + text + " P5=0"), "");
      for (const std::string comparator : {"!=", "<", ">", "!~"})
        ASSERT_EQ(host("IF(P1" + comparator + text + ")P5=P5+1"), "");
      for (const std::string comparator : {"=", "!<", "!>", "~"})
        ASSERT_EQ(host("IF(" + text + comparator + "P1)P5=P5+100"), "");
      ASSERT_EQ(host("CLOSE B1R"), "");
      for (unsigned i = 0; i < 10 && run_is_running(0); ++i) platform::real_time();
      EXPECT_EQ(host("P5"), "400") << text << " with P2=" << value;
      up += text == "P2/3" && p_variable_read(1) > value / 3.0;
      down += text == "P2/3" && p_variable_read(1) < value / 3.0;
    }
  EXPECT_GT(up, 2u);
  EXPECT_GT(down, 2u);
}

TEST_F(Logic, RandomProgramsDoWhatTheirTreeSays) {
  std::array<unsigned, 10> met{};
  unsigned changed = 0, programs = 0;
  for (unsigned seed = 1; programs < 150; ++seed) {
    Writer writer(brick::random_seed(seed));
    const Part program = writer.block(4);
    Lines lines = program.lines;
    lines.push_back("RETURN");
    lines.insert(lines.end(), writer.subroutines().begin(), writer.subroutines().end());
    const auto too_long = [](const std::string& line) { return line.size() > kLineLimit; };
    if (std::any_of(lines.begin(), lines.end(), too_long)) continue;  // no host sends it
    ++programs;
    ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
    State expected = memory();
    const State before = expected;
    program.act(expected);
    ASSERT_EQ(host("B1R"), "");
    for (unsigned i = 0; i < 3000 && run_is_running(0); ++i) platform::real_time();
    ASSERT_FALSE(run_is_running(0)) << "seed " << seed;
    ASSERT_EQ(motion_cs_status(0, 1) >> 22 & 1u, 0u) << "seed " << seed << ": " << host("LIST PC");
    const State is = memory();
    ASSERT_EQ(is.p, expected.p) << "seed " << seed << "\n" << ::testing::PrintToString(lines);
    ASSERT_EQ(is.q, expected.q) << "seed " << seed << "\n" << ::testing::PrintToString(lines);
    ASSERT_EQ(is.m, expected.m) << "seed " << seed << "\n" << ::testing::PrintToString(lines);
    if (before.p != expected.p || before.q != expected.q) ++changed;
    for (const unsigned form : writer.forms()) ++met[form];
  }
  EXPECT_GT(changed, 100u);
  for (unsigned form = 0; form < met.size(); ++form) EXPECT_GT(met[form], 10u) << "form " << form;
}

}  // namespace
