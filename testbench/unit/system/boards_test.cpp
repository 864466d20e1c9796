// Every board of the tree with the real image: it starts, names its clock source, and tells the host what it is.
#include <algorithm>
#include <filesystem>

#include "systemc/machine/board_file.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr Tick kServo = 4 * (2 * 6527 + 3);  // default servo period in ticks

// What a host of that board should see, from docs/boards.md and the data sheets. `kind` is `???` word 2, bits 23
// and 16.
struct Expected {
  const char *board, *i19, *type, *i4900, *i4902, *dpram_end, *kind;
};
constexpr Expected kExpected[] = {
    {"all-ics", "7007", "TURBO2, X4", "$FF3FF", "$F", "$64000", "00"},
    {"geo-pmac", "7007", "TURBO2, X4", "$1", "$0", "$61000", "00"},
    {"geobrick-lv-4", "7007", "TURBO2, X4", "$1", "$0", "$64000", "00"},
    {"geobrick-lv-8", "7007", "TURBO2, X4", "$3", "$0", "$64000", "00"},
    {"pmac-pc", "7007", "TURBO1, X4", "$3", "$0", "$61000", "00"},
    {"turbo-pmac-pci", "7007", "TURBO1, X4", "$3", "$0", "$61000", "00"},
    {"turbo-pmac2-pc", "7007", "TURBO2, X4", "$3", "$1", "$64000", "00"},
    {"turbo-pmac2-pci", "7007", "TURBO2, X4", "$3", "$1", "$64000", "00"},
    {"turbo-pmac2-pci-lite", "7007", "TURBO2, X4", "$1", "$1", "$64000", "00"},
    {"turbo-pmac2-ultralite", "6807", "TURBOU, X4", "$0", "$1", "$64000", "80"},
    {"umac-turbo", "6807", "TURBO2, X4", "$C", "$1", "$64000", "01"},
};

class Boards : public Controller {
 protected:
  void start_board(const std::string& name) {
    MachineConfig config;
    config.board = read_board_file("boards/" + name + ".toml");
    start(config);
  }
  std::uint64_t signal(const char* name) { return machine().signals().value(*machine().signals().find(name)); }
};

class OpenInputs : public Boards {};

TEST_P(Boards, EachBoardStartsAndHasTheRightClockSource) {
  BRICK_COVERS("I19-1 I19-2 I19-3");
  for (const Expected& e : kExpected) {
    SCOPED_TRACE(e.board);
    start_board(e.board);
    EXPECT_EQ(ask("I19"), e.i19);
    EXPECT_EQ(std::to_string(signal("clock.source")), e.i19);
    EXPECT_EQ(ask("TYPE"), e.type);
    EXPECT_EQ(ask("CID"), "603382");
    EXPECT_EQ(ask("I4900 I4902"), std::string(e.i4900) + "|" + e.i4902);
    EXPECT_EQ("$" + ask("RHY$3F"), e.dpram_end);
    const std::string status = ask("???");
    ASSERT_EQ(status.size(), 12u);
    EXPECT_EQ(status.substr(0, 6), "000000") << "no phase clock, configuration or flash error";
    EXPECT_EQ(std::string({static_cast<char>(status[6]), status[7]}), e.kind);
    const auto edges = falling_edges(pin::kServo, 2, 3 * kServo);
    ASSERT_EQ(edges.size(), 2u);
    EXPECT_EQ(edges[1] - edges[0], kServo);
  }
}

// servo-ic:5.15/6: FAULT is open where no amplifier is built in, and with the factory's Ixx24 an open input is no
// fault; the healthy amplifier of a Geo Brick shows 0, which bit 23 declares good.
TEST_P(OpenInputs, FaultIsOneWhereNoAmplifierIsBuiltIn) {
  BRICK_COVERS("CARD-1");
  for (const auto& [board, open] : {std::pair{"turbo-pmac2-pc", true}, std::pair{"geobrick-lv-4", false}}) {
    SCOPED_TRACE(board);
    start_board(board);
    ask("M1->X:$78000,15 M2->X:$78005,14");
    EXPECT_EQ(ask("M1"), open ? "1" : "0");
    for (const bool high_is_fault : {false, true}) {
      ask(high_is_fault ? "I124=$800001" : "I124=$1");
      ask("#1J/");
      wait(ms_to_ticks(20));
      EXPECT_EQ(ask("M2"), open != high_is_fault ? "1" : "0") << "bit 23 of I124 is " << high_is_fault;
      ask("#1K");
    }
  }
}

BRICK_ON_ENGINES(Boards, Engine::kSystemC, Engine::kLockstep);
BRICK_ON_ENGINES(OpenInputs, Engine::kSystemC, at_night(Engine::kLockstep));

TEST(BoardList, TheTestAboveKnowsEveryBoardFile) {
  std::vector<std::string> files, known;
  for (const auto& entry : std::filesystem::directory_iterator("boards")) files.push_back(entry.path().stem());
  for (const Expected& e : kExpected) known.emplace_back(e.board);
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, known);
}

}  // namespace
}  // namespace brick
