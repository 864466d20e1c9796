// The read-outs that backup clients make: every variable by ranges, on the real image (firmware:1.4). Counts and forms;
// that each value is the data sheet's is shown natively (testbench/unit/firmware_platform/i_table_test.cpp).
#include <map>
#include <regex>

#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned kCount = 8192;

class ReadOut : public Controller {
 protected:
  // The fastest CPU: most of the time is spent on digits. It takes effect at a reset.
  void start_fast() {
    start();
    ASSERT_EQ(ask("I52=31 SAVE"), "");
    ASSERT_EQ(ask("$$$"), "");
  }

  // In blocks of a hundred. Each line has to match `form` as a whole.
  std::vector<std::string> all(const std::string& letter, const std::string& behind, const std::string& form) {
    const std::regex shape(form);
    std::vector<std::string> lines;
    for (unsigned first = 0; first < kCount; first += 100) {
      const unsigned last = std::min(first + 99, kCount - 1);
      const Reply reply = link().command(letter + std::to_string(first) + ".." + std::to_string(last) + behind);
      EXPECT_TRUE(reply.complete && !reply.error) << letter << first;
      EXPECT_EQ(reply.lines.size(), last - first + 1) << letter << first;
      for (const std::string& line : reply.lines) {
        EXPECT_TRUE(std::regex_match(line, shape)) << letter << lines.size() << ": " << line;
        lines.push_back(line);
      }
    }
    return lines;
  }
};

const char* const kDecimal = R"(-?\d+(\.\d+)?)";

TEST_P(ReadOut, OfEveryIVariable) {
  BRICK_COVERS("I9-1 I9-2");
  start_fast();
  const auto bare = all("I", "", std::string(kDecimal) + R"(|\$[0-9A-F]+)");
  ASSERT_EQ(bare.size(), kCount);
  EXPECT_EQ(bare[16], "5");
  EXPECT_EQ(bare[102], "$78002");
  EXPECT_EQ(bare[7005], "$7FFFC0");
  EXPECT_EQ(bare[8191], "$0");
  ASSERT_EQ(ask("I9=1"), "");
  const auto full = all("I", "", R"(I\d+=)" + std::string(kDecimal));
  ASSERT_EQ(full.size(), kCount);
  for (unsigned number = 0; number < kCount; ++number)
    EXPECT_EQ(full[number].rfind("I" + std::to_string(number) + "=", 0), 0u) << full[number];
}

TEST_P(ReadOut, OfEveryPAndMVariable) {
  start_fast();
  ASSERT_EQ(ask("P8191=-0.5 M8190->X:$78001,24,S M8191->Y:$78002,8,16,S M0..4=1"), "");
  EXPECT_EQ(all("P", "", kDecimal).back(), "-0.5");
  EXPECT_EQ(all("M", "", kDecimal).at(4), "1");
  const auto definitions = all("M", "->", R"(\*|[XY]:\$[0-9A-F]+,\d+(,\d+)?(,S)?)");
  ASSERT_EQ(definitions.size(), kCount);
  EXPECT_EQ(definitions[8190], "X:$78001,24,S");
  EXPECT_EQ(definitions[8191], "Y:$78002,8,16,S");
  EXPECT_EQ(definitions[8189], "*");
}

TEST_P(ReadOut, OfEachCoordinateSystemsQVariables) {
  start_fast();
  for (unsigned cs = 1; cs <= 16; ++cs) {
    const std::string address = "&" + std::to_string(cs);
    ASSERT_EQ(ask(address + "Q199=" + std::to_string(cs)), "");
    const Reply reply = link().command(address + "Q1..199");
    EXPECT_EQ(reply.lines.size(), 199u);
    ASSERT_FALSE(reply.lines.empty());
    EXPECT_EQ(reply.lines.back(), std::to_string(cs));
  }
}

// As clients list programs: 80 words at a time, on from the last offset. Behind the beginning of the last line nothing
// begins (no line), behind its last word nothing is (ERR003): both say that there is no more.
TEST_P(ReadOut, OfProgramsInParts) {
  BRICK_COVERS("I9-1");
  start_fast();
  constexpr unsigned kLines = 60, kWords = 4;  // of each line, and ENTRY_WORDS
  for (const char* program : {"PLC 3", "PROG 5"}) {
    ASSERT_EQ(ask(std::string("OPEN ") + program + " CLEAR"), "");
    for (unsigned line = 0; line < kLines; ++line)
      ASSERT_EQ(ask("p" + std::to_string(100 + line) + " = p1 + " + std::to_string(line + 1)), "");
    ASSERT_EQ(ask("CLOSE"), "");
    std::map<unsigned, std::string> lines;
    unsigned parts = 0;
    for (unsigned start = 0;; ++parts) {
      ASSERT_LE(parts, kLines) << "the parts do not come to an end";
      const Reply reply = link().command("list " + std::string(program) + "," + std::to_string(start) + ",80");
      ASSERT_TRUE(reply.complete);
      if (reply.error || reply.lines.empty()) break;
      ASSERT_LE(reply.raw.size(), 1400u);
      for (const std::string& line : reply.lines) {
        const std::size_t colon = line.find(':');
        ASSERT_NE(colon, std::string::npos) << line;
        lines[static_cast<unsigned>(std::stoul(line))] = line.substr(colon + 1);
      }
      const unsigned last = lines.rbegin()->first;
      start = last > start ? last : last + 1;
    }
    ASSERT_EQ(lines.size(), kLines + 1) << program;
    EXPECT_EQ(lines[kWords * kLines], "RET") << "of CLOSE";
    for (unsigned line = 0; line < kLines; ++line)
      EXPECT_EQ(lines[kWords * line], "P" + std::to_string(100 + line) + "=P1+" + std::to_string(line + 1));
    EXPECT_GE(parts, 2u);
  }
}

BRICK_ON_ENGINES(ReadOut, Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
