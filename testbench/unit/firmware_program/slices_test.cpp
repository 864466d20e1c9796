// What the background does and sees between two slices of a calculation (docs/firmware.md, Slices).
#include <algorithm>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/kernel/tasks.h"
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

// Half of the time from one real-time interrupt to the next, 5 ms at most, whoever comes in between for motors. Each
// line has more words than a slice, 32 lines an interrupt are never calculated.
TEST_F(Slices, PlanningHasItsTimeWhateverI8Is) {
  constexpr std::uint32_t kServo = 34816, kLook = 500;  // cycles, of 0.4427 ms
  ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
  std::string line;
  for (int i = 0; i < 30; ++i) line += "P1=P1+1";
  store(Lines(120, line));
  ASSERT_EQ(host("CLOSE"), "");
  for (const unsigned i8 : {0u, 2u, 5u, 6u, 9u, 20u, 255u}) {
    ASSERT_EQ(host("I8=" + std::to_string(i8) + " B1R"), "");
    fake_hal_slices_leave(true);
    fake_hal_set_look(kLook);
    fake_tasks_servo_clock(kServo);
    std::vector<std::uint64_t> had;
    for (unsigned period = 0; period < 4; ++period) {
      const std::uint64_t before = fake_hal_slice_cycles();
      for (const std::uint32_t first = tasks_servo_count(); tasks_servo_count() - first < i8 + 1;) {
        (void)hal_cycles();
        (void)fake_task_take(FAKE_REAL_TIME);
      }
      had.push_back(fake_hal_slice_cycles() - before);
    }
    const double slice = std::min((i8 + 1) * kServo / 2.0, 5.0 * hal_cycles_per_ms());
    const double average = static_cast<double>(had[1] + had[2] + had[3]) / 3;
    EXPECT_GT(average, 0.7 * slice) << "I8=" << i8 << ", less its last section, which is not begun";
    EXPECT_LT(average, 1.1 * slice) << "I8=" << i8;
    EXPECT_TRUE(run_is_running(0));
    fake_tasks_servo_clock(0);
    fake_hal_set_look(0);
    fake_hal_slices_leave(false);
    ASSERT_EQ(host("A"), "");
    platform::real_time();
  }
}

}  // namespace
