// The 8259: every cell of the mode matrix of docs/pic_8259.md, which is read from there; random talk against a second
// description of the part; alignments of edges, acknowledges and writes clock by clock. RTL and model in lock-step
// throughout.
#include "systemc/host/pic_8259.h"

#include <fstream>
#include <random>
#include <sstream>

#include "testbench/checkers/reference_8259.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr unsigned kCommand = 0, kMask = 1, kAcknowledge = 2;

class Rig {
 public:
  Pic8259 model{"pic"};
  Lockstep<Pic8259> both{make_rtl_pic_8259(), model, [](const Pic8259& m) {
                           return Outputs{{"rdata", m.rdata()},  {"irr", m.irr()},
                                          {"isr", m.isr()},      {"imr", m.imr()},
                                          {"level", m.level()},  {"request", m.request() && !m.served()},
                                          {"served", m.served()}};
                         }};

  void write(unsigned addr, unsigned value) {
    both.in.wr = true;
    both.in.addr = static_cast<std::uint8_t>(addr);
    both.in.wdata = static_cast<std::uint8_t>(value);
    both.ref();
    both.in.wr = false;
    settle();
  }
  unsigned read(unsigned addr) {
    both.in.rd = true;
    both.in.addr = static_cast<std::uint8_t>(addr);
    const unsigned value = both.get("rdata");
    both.ref();
    both.in.rd = false;
    settle();
    return value;
  }
  void line(unsigned n, bool high) {
    const auto bit = static_cast<std::uint8_t>(1u << n);
    both.in.line = static_cast<std::uint8_t>(high ? both.in.line | bit : both.in.line & ~bit);
  }
  void settle() { both.ref(4); }
};

// --------------------------------------------------------------------------------------------------- the mode matrix

struct Cell {
  std::string name, steps;
  bool level = false;
};

// gtest prints parameters by their name.
void PrintTo(const Cell& cell, std::ostream* out) { *out << cell.steps; }

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" `"), end = text.find_last_not_of(" `");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<Cell> read_cells() {
  std::vector<Cell> cells;
  std::ifstream page(BRICK_PIC_8259_PAGE);
  bool matrix = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| cell |", 0) == 0) matrix = true;
    if (!matrix || line.rfind("| ", 0) != 0 || line.rfind("| cell |", 0) == 0) continue;
    std::istringstream columns(line.substr(1));
    std::string name, triggers, steps;
    std::getline(columns, name, '|');
    std::getline(columns, triggers, '|');
    std::getline(columns, steps, '|');
    for (const bool level : {false, true})
      if (triggers.find(level ? "level" : "edge") != std::string::npos)
        cells.push_back({trimmed(name) + (level ? "Level" : "Edge"), trimmed(steps), level});
  }
  return cells;
}

class Pic8259Cell : public ::testing::TestWithParam<Cell>, protected Rig {
 protected:
  void step(const std::string& text) {
    SCOPED_TRACE(text);
    std::istringstream words(text);
    std::string verb, word;
    words >> verb;
    std::vector<unsigned> values;
    while (words >> word) values.push_back(static_cast<unsigned>(std::stoul(word, nullptr, 16)));
    ASSERT_FALSE(values.empty());
    const unsigned value = values.front();
    if (verb == "up" || verb == "down") {
      for (const unsigned n : values) line(n, verb == "up");
      settle();
    } else if (verb == "icw1") {
      write(kCommand, value | (GetParam().level ? 8 : 0));
    } else if (verb == "init") {
      step("icw1 13");
      write(kMask, 0x08);
      write(kMask, value);
    } else if (verb == "second" || verb == "mask") {
      write(kMask, value);
    } else if (verb == "ocw2" || verb == "ocw3") {
      write(kCommand, value);
    } else if (verb == "write2" || verb == "write3") {
      write(verb.back() - '0', value);
    } else if (verb == "int") {
      EXPECT_EQ(both.get("request"), value);
    } else {
      EXPECT_EQ(read_of(verb), value);
    }
  }

 private:
  unsigned read_of(const std::string& verb) {
    if (verb == "inta") return read(kAcknowledge);
    if (verb == "imr") return read(kMask);
    if (verb.rfind("read", 0) == 0) return read(verb.back() - '0');
    if (verb != "irr" && verb != "isr" && verb != "poll") throw std::logic_error("no such step");
    write(kCommand, verb == "irr" ? 0x0A : verb == "isr" ? 0x0B : 0x0C);
    return read(kCommand);
  }
};

TEST_P(Pic8259Cell, Holds) {
  std::istringstream steps(GetParam().steps);
  for (std::string text; std::getline(steps, text, ',');) step(trimmed(text));
  EXPECT_LOCKSTEP(both);
}

INSTANTIATE_TEST_SUITE_P(Matrix, Pic8259Cell, ::testing::ValuesIn(read_cells()),
                         [](const auto& cell) { return cell.param.name; });

TEST(Pic8259Matrix, IsReadFromItsPage) { EXPECT_GE(read_cells().size(), 130u); }

// --------------------------------------------------------------------------------------------- against the reference

class Pic8259Random : public ::testing::Test, protected Rig {
 protected:
  static constexpr unsigned kOperations = 2500;

  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
  unsigned command() {
    switch (pick(8)) {
      case 0:
        return 0x10 | pick(256);
      case 1:
      case 2:
        return 0x08 | (pick(256) & 0x67);
      case 3:
        return 0x20;
      default:
        return pick(256) & 0xE7;
    }
  }
  // The first difference of the two descriptions, "" if there is none. `broken`: the reference is told something else.
  std::string talk(unsigned seed, bool broken) {
    random_.seed(seed);
    Reference8259 reference;
    for (unsigned i = 0; i < kOperations; ++i) {
      unsigned expected = 0, measured = 0;
      switch (pick(8)) {
        case 0: {
          const unsigned value = command();
          if (value >> 4 != 0 && (value & 0x10) != 0 && pick(3) != 0) break;  // few of them
          write(kCommand, value);
          reference.write(false, static_cast<std::uint8_t>(broken ? value ^ 0x80 : value));
          break;
        }
        case 1: {
          const unsigned value = pick(2) != 0 ? pick(256) : 0;
          write(kMask, value);
          reference.write(true, static_cast<std::uint8_t>(value));
          break;
        }
        case 2:
        case 3:
          measured = read(kAcknowledge);
          expected = reference.vector();
          ++acknowledged_;
          break;
        case 4: {
          const bool a0 = pick(4) == 0;
          measured = read(a0 ? kMask : kCommand);
          expected = reference.read(a0);
          break;
        }
        default: {
          const unsigned n = pick(8);
          const bool high = (both.in.line >> n & 1) == 0;
          line(n, high);
          settle();
          reference.line(n, high);
          break;
        }
      }
      if (measured != expected || (both.get("request") != 0) != reference.interrupts())
        return "operation " + std::to_string(i) + ": read " + std::to_string(measured) + ", expected " +
               std::to_string(expected) + ", INT " + std::to_string(both.get("request"));
      if (!both.difference().empty()) return both.difference();
    }
    return "";
  }
  unsigned acknowledged_ = 0;

 private:
  std::mt19937 random_;
};

TEST_F(Pic8259Random, AgreesWithASecondDescription) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    both.in = {};
    both.reset();
    settle();  // all lines have been low
    EXPECT_EQ(talk(seed, false), "") << "seed " << seed;
  }
  EXPECT_GE(acknowledged_, 6 * kOperations / 8);
}

TEST_F(Pic8259Random, ComparisonSeesAWrongRotation) { EXPECT_NE(talk(1, true), ""); }

// ------------------------------------------------------------------------------------------------------ clock by clock

class Pic8259Clocks : public ::testing::Test, protected Rig {
 protected:
  void initialize() {
    both.in = {};
    both.reset();
    both.ref(3);
    write(kCommand, 0x13);
    write(kMask, 0x08);
    write(kMask, 0x01);
  }
};

TEST_F(Pic8259Clocks, EdgeRaisesTheInterruptAtTheThirdClock) {
  initialize();
  line(1, true);
  both.ref();
  EXPECT_EQ(both.get("request"), 0u);
  both.ref();
  EXPECT_EQ(both.get("irr"), 0x02u);
  EXPECT_EQ(both.get("request"), 1u) << "the third clock takes it to the pin";
  EXPECT_LOCKSTEP(both);
}

// INT is made of what the registers are after the edge: a request that meets the write that masks it, or the ICW1 that
// ends it, raises no edge that a PC would sense.
TEST_F(Pic8259Clocks, RequestThatMeetsItsMaskRaisesNothing) {
  for (const bool icw1 : {false, true})
    for (int lead = 0; lead <= 5; ++lead) {  // clocks from the line's rise to the write; it asks at the third
      SCOPED_TRACE(::testing::Message() << (icw1 ? "ICW1 " : "OCW1 ") << lead << " clocks after the rise");
      initialize();
      line(1, true);
      for (int clock = 0; clock < 8; ++clock) {
        both.in.wr = clock == lead;
        both.in.addr = icw1 ? kCommand : kMask;
        both.in.wdata = icw1 ? 0x13 : 0xFF;
        EXPECT_EQ(both.get("request"), clock >= 2 && clock < lead ? 1u : 0u) << "clock " << clock;
        both.ref();
      }
      both.in.wr = false;
      EXPECT_LOCKSTEP(both);
    }
}

// A level in service that holds the request off from that clock on: special mask mode ends, or the request becomes the
// lowest. And one that lets it through: INT is asked for at the same clock.
TEST_F(Pic8259Clocks, RequestFollowsAWriteAtItsClock) {
  struct {
    unsigned before, value, follows;  // commands of +8 before IR6 comes, and then: 1 INT is asked for
  } constexpr kWrites[] = {{0x68, 0x48, 0}, {0xC5, 0xC6, 0}, {0x48, 0x68, 1}, {0xC6, 0xC5, 1}, {0x48, 0x62, 1}};
  for (const auto& w : kWrites) {
    SCOPED_TRACE(::testing::Message() << std::hex << w.before << " " << w.value);
    initialize();
    line(2, true);
    settle();
    EXPECT_EQ(read(kAcknowledge), 0x0Au);
    write(kMask, 0x04);
    write(kCommand, w.before);
    line(6, true);
    settle();
    EXPECT_EQ(both.get("request"), 1 - w.follows);
    both.in.wr = true;
    both.in.addr = kCommand;
    both.in.wdata = static_cast<std::uint8_t>(w.value);
    EXPECT_EQ(both.get("request"), w.follows);
    both.ref();
    both.in.wr = false;
    EXPECT_EQ(both.get("request"), w.follows);
    EXPECT_LOCKSTEP(both);
  }
}

// host-bus:4.5/4, host-bus:4.5/9: a line that was high before the reset and since has had no edge.
TEST_F(Pic8259Clocks, LineThatIsHighAtAResetHasNoEdgeBeforeItHasBeenLow) {
  for (int low = 0; low <= 2; ++low) {
    SCOPED_TRACE(::testing::Message() << "low for " << low);
    both.in = {};
    line(3, true);
    both.ref(6);
    both.reset();
    settle();
    write(kMask, 0x00);
    EXPECT_EQ(both.get("irr"), 0u);
    EXPECT_EQ(both.get("request"), 0u);
    line(3, low == 0);
    if (low > 0) both.ref(low);
    line(3, true);
    settle();
    EXPECT_EQ(both.get("irr"), low > 0 ? 0x08u : 0u);
    EXPECT_EQ(both.get("request"), low > 0 ? 1u : 0u);
    EXPECT_LOCKSTEP(both);
  }
}

// A poll that nobody has fetched is forgotten: the next read is of the IRR.
TEST_F(Pic8259Clocks, AResetForgetsAPoll) {
  initialize();
  write(kCommand, 0x0C);
  both.in = {};
  both.reset();
  settle();
  line(5, true);
  settle();
  EXPECT_EQ(read(kCommand), 0x20u);
  EXPECT_LOCKSTEP(both);
}

// systemc/core/model_block.h: as long as all inputs rest and nothing will show, no edge is asked for.
TEST_F(Pic8259Clocks, SleepsWhileNothingMoves) {
  initialize();
  EXPECT_TRUE(both.asleep());
  line(1, true);
  settle();
  EXPECT_TRUE(both.asleep()) << "a request";
  read(kAcknowledge);
  EXPECT_TRUE(both.asleep()) << "it is acknowledged, its line still high";
  line(1, false);
  settle();
  EXPECT_TRUE(both.asleep());
  EXPECT_LOCKSTEP(both);
}

// A line that falls for `low` clocks and rises `lead` clocks around the acknowledge of its last edge is asked for
// again, unless the controller has not seen it high before: then there was nothing to acknowledge.
TEST_F(Pic8259Clocks, EdgeThatMeetsTheAcknowledgeIsKept) {
  for (int low = 1; low <= 3; ++low)
    for (int lead = 0; lead <= 6; ++lead) {
      SCOPED_TRACE(::testing::Message() << "low for " << low << ", acknowledge " << lead << " clocks after the fall");
      initialize();
      line(1, true);
      both.ref(5);
      line(1, false);
      for (int clock = 0; clock < 8; ++clock) {
        if (clock == low) line(1, true);
        both.in.rd = clock == lead;
        both.in.addr = kAcknowledge;
        if (clock == lead) {
          // Two flip-flops: the fall of clock 0 is seen at clock 2, the rise `low` later.
          const bool seen_low = lead >= 2 && lead < 2 + low;
          EXPECT_EQ(both.get("rdata"), seen_low ? 0x0Fu : 0x09u);
        }
        both.ref();
      }
      both.in.rd = false;
      const bool second_edge_taken = lead >= 2 + low;  // acknowledged after it had come
      EXPECT_EQ(both.get("irr"), second_edge_taken ? 0u : 0x02u);
      EXPECT_LOCKSTEP(both);
    }
}

// Line 2 falls for one clock around the acknowledge of line 1, and is asked for again.
TEST_F(Pic8259Clocks, EdgeOfAnotherLineThatMeetsAnAcknowledgeIsKept) {
  for (int lead = 0; lead <= 5; ++lead) {
    initialize();
    line(2, true);
    both.ref(5);
    both.in.addr = kAcknowledge;
    both.in.rd = true;
    both.ref();
    both.in.rd = false;
    EXPECT_EQ(both.get("irr"), 0u);
    line(1, true);
    both.ref(5);
    line(2, false);
    for (int clock = 0; clock < 8; ++clock) {
      if (clock == 1) line(2, true);
      both.in.rd = clock == lead;
      if (clock == lead) { EXPECT_EQ(both.get("rdata"), 0x09u); }
      both.ref();
    }
    both.in.rd = false;
    EXPECT_EQ(both.get("irr"), 0x04u) << "acknowledge " << lead << " clocks after the fall";
    EXPECT_LOCKSTEP(both);
  }
}

TEST_F(Pic8259Clocks, EdgeThatMeetsIcw1IsKept) {
  for (int lead = 0; lead <= 4; ++lead) {  // clocks from the line's rise to the write; it is seen at the second
    initialize();
    line(1, true);
    if (lead > 0) both.ref(lead);
    write(kCommand, 0x13);
    write(kMask, 0x08);
    write(kMask, 0x01);
    EXPECT_EQ(both.get("irr"), lead < 2 ? 0x02u : 0u) << "lead " << lead;
    EXPECT_LOCKSTEP(both);
  }
}

TEST_F(Pic8259Clocks, RandomLinesReadsAndWritesAgree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(random_seed(seed));
    both.lazy = seed % 2;
    for (int i = 0; i < 3000 && both.difference().empty(); ++i) {
      if (random() % 5 == 0) both.in.line ^= static_cast<std::uint8_t>(1u << random() % 8);
      if (both.now() % kTicksPerRef == 0) {
        both.in.addr = random() % 4;
        both.in.wr = random() % 4 == 0;
        both.in.rd = !both.in.wr && random() % 3 == 0;
        both.in.wdata = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 0x10 : random());
      }
      if (random() % 2000 == 0) both.reset();
      both.tick();
    }
    ASSERT_EQ(both.difference(), "") << "seed " << seed;
  }
}

TEST_F(Pic8259Clocks, ComparisonSeesALostAcknowledge) {
  both.mutate = [](Pic8259::Inputs& in) { in.rd = false; };
  initialize();
  line(1, true);
  both.ref(4);
  read(kAcknowledge);
  EXPECT_NE(both.difference(), "");
}

}  // namespace
}  // namespace brick
