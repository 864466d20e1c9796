// What the background does and sees between two slices of a calculation (docs/firmware.md, Slices).
#include <algorithm>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/kernel/slice.h"
}

namespace {

using platform::host;
using platform::host_lines;
using Lines = std::vector<std::string>;

class Slices : public FirmwareTest {
 protected:
  static void store(const Lines& lines) {
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
  }
  static bool error() { return (motion_cs_status(0, 1) >> 22 & 1u) != 0; }
};

class SlicesStopped : public Slices, public ::testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(By, SlicesStopped, ::testing::Values("Q", "/"),
                         [](const auto& command) { return command.param[0] == 'Q' ? "Quit" : "EndBlock"; });

// 30 lines without a move are less than one round may take. The line under way is ended, no other is begun.
TEST_P(SlicesStopped, LinesWithoutAMoveEndBehindTheOneUnderWay) {
  constexpr double kStop = 3.0;
  ASSERT_EQ(host("DEF ROT 200 B0 OPEN ROT"), "");
  store(Lines(30, "P1=P1+1"));
  ASSERT_EQ(host("CLOSE R"), "");
  bool given = false;
  platform::real_time_in_slices([&] {
    if (given || p_variable_read(1) < kStop) return;
    given = true;
    EXPECT_EQ(host(GetParam()), "");
  });
  ASSERT_TRUE(given);
  platform::real_time();
  EXPECT_FALSE(run_is_running(0));
  EXPECT_LE(p_variable_read(1), kStop + 1.0);
  EXPECT_EQ(std::stod(host("PR")), 30.0 - p_variable_read(1));
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  EXPECT_EQ(p_variable_read(1), 30.0);
}

// PC is the line to be calculated next: whatever word the calculation stands at, listings begin where a line does. The
// ring is that small that lines go over its end.
TEST_F(Slices, ListingsBeginAtALineThatIsNotBegun) {
  const Lines lines = {"P1=Q1+1", "P2=Q2*2X(P1)", "P3=1234567890.5+P3", "P4=Q(P1+4)", "P5=Q5+Q6*(Q7-1)"};
  ASSERT_EQ(host("DEF ROT 33 B0 OPEN ROT"), "");
  store({"P1=Q1+1 P2=Q2+1 P3=Q3+1 P4=Q4+1"});
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  ASSERT_EQ(host("PR"), "0");
  store(lines);
  const Lines all = host_lines("LIST PC,9");
  ASSERT_EQ(all.size(), lines.size());
  EXPECT_LT(std::stoul(all.back()), std::stoul(all.front())) << "no line beyond the end of the ring";
  unsigned looks = 0, under_way = 0;
  for (int i = 0; i < 3; ++i)
    platform::real_time_in_slices([&] {
      ++looks;
      const std::size_t left = host_lines("LIST ROT").size(), stored = std::stoul(host("PR"));
      ASSERT_LE(left, lines.size());
      EXPECT_EQ(host_lines("LIST ROT"), Lines(lines.end() - static_cast<std::ptrdiff_t>(left), lines.end()));
      EXPECT_EQ(host_lines("LIST PC,9"), Lines(all.end() - static_cast<std::ptrdiff_t>(left), all.end()));
      if (left < stored) ++under_way;
      EXPECT_LE(stored - left, 1u) << "a line that is begun is not calculated, and not listed";
      if (left == 0) return;
      const std::string& next = all[all.size() - left];
      EXPECT_EQ(host("PC"), "P0:" + next.substr(0, next.find(':')));
    });
  EXPECT_GT(looks, 10u);
  EXPECT_GT(under_way, 5u);
  ASSERT_EQ(host("A"), "");
}

// R forgets the errors before it, not the one that is being found.
TEST_F(Slices, RunWhileABadLineIsSkippedDoesNotHideItsError) {
  ASSERT_EQ(host("DEF ROT 200 B0"), "");
  const word48_t bad = 9ull << 43;
  const word48_t line[] = {bad, bad, bad, bad};
  ASSERT_EQ(rotary_store(0, line, 4), ERR_NONE);
  ASSERT_EQ(host("R"), "");
  unsigned given = 0;
  platform::real_time_in_slices([&] {
    ++given;
    EXPECT_EQ(host("R"), "");
  });
  EXPECT_GT(given, 0u);
  platform::real_time();
  EXPECT_TRUE(error());
  EXPECT_FALSE(run_is_running(0));
  EXPECT_EQ(host("PR"), "0");
}

// A host that never stops sending holds what is under way up for 5 ms (docs/firmware.md, Slices), and no longer.
TEST_F(Slices, RoundOfFiveMillisecondsGivesWayNoMore) {
  constexpr std::uint32_t kPiece = 1'000, kSlice = 20'000, kPeriod = 7'864, kPieces = 120;  // cycles; 0.1 ms
  static std::uint32_t done;
  done = 0;
  fake_hal_slices_leave(true);
  slice_initialize([] {
    for (; done < kPieces; ++done) {
      fake_hal_pass(kPiece);
      slice_pause();
    }
  });
  slice_hurry = 1;
  const std::uint32_t began = hal_cycles();
  double waited_ms = 0.0;
  do {
    slice_run(kSlice);
    if (done < 2) waited_ms = (hal_cycles() - began) / static_cast<double>(hal_cycles_per_ms());
    fake_hal_pass(kPeriod);
  } while (slice_is_under_way());
  const double took_ms = (hal_cycles() - began) / static_cast<double>(hal_cycles_per_ms());
  slice_hurry = 0;
  fake_hal_slices_leave(false);
  EXPECT_EQ(done, kPieces);
  EXPECT_NEAR(waited_ms, 5.0, 0.3) << "one piece, as the first slice works for 500 cycles before it gives way";
  EXPECT_LT(took_ms, 5.0 + 4.0) << "whole slices from there on";
}

}  // namespace
