// What segments and lookahead cost on the cross-compiled image: cycles of the CPU that they take for themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "systemc/cpu/elf_file.h"
#include "testbench/unit/firmware_platform/image_board.h"

namespace brick {
namespace {

constexpr std::uint32_t kSideStack = 0x20000000, kSideStackBytes = 8192;

// Own cycles of one function with all that it calls on the stack of slices, interrupts above it taken off.
class OwnCycles {
 public:
  OwnCycles(ImageBoard& board, const std::string& function) : board_(board), elf_(BRICK_FIRMWARE_ELF) {
    begin_ = *elf_.symbol(function);
    pause_ = *elf_.symbol("slice_pause");
    point_ = *elf_.symbol("lookahead_add");
    trap_ = *elf_.symbol("trap_vector"), trap_end_ = *elf_.symbol("trap_real_time");
    board.on_instruction = [this] { look(); };
  }
  ~OwnCycles() { board_.on_instruction = nullptr; }
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t longest() const { return longest_; }  // between two pauses
  std::string longest_at() const { return longest_at_; }
  unsigned points() const { return points_; }
  void from_here() { cycles_ = points_ = 0; }

 private:
  void look() {
    const std::uint64_t now = board_.cpu().cycle(), spent = now - last_;
    const std::uint32_t sp = board_.cpu().reg(2), pc = board_.cpu().pc();
    last_ = now;
    if (interrupted_) {
      interrupted_ = pc != before_pc_ || sp != before_sp_;
      if (interrupted_) return;
    } else if (sp - kSideStack < kSideStackBytes) {
      if (pc >= trap_ && pc < trap_end_)
        interrupted_ = true;
      else
        count(pc, sp, spent);
    }
    if (!interrupted_) before_pc_ = pc, before_sp_ = sp;
  }
  void count(std::uint32_t pc, std::uint32_t sp, std::uint64_t spent) {
    if (inside_) {
      cycles_ += spent, since_pause_ += spent;
      if (pc == pause_ || pc == return_) {
        if (since_pause_ > longest_) longest_ = since_pause_, longest_at_ = elf_.symbol_at(board_.cpu().reg(1));
        since_pause_ = 0;
      }
      points_ += pc == point_;
      inside_ = pc != return_ || sp != sp_;
    } else if (pc == begin_) {
      inside_ = true, since_pause_ = 0;
      return_ = board_.cpu().reg(1), sp_ = sp;
    }
  }
  ImageBoard& board_;
  const ElfFile elf_;
  std::uint32_t begin_, pause_, point_, trap_, trap_end_;
  bool inside_ = false, interrupted_ = false;
  std::uint32_t return_ = 0, sp_ = 0, before_pc_ = 0, before_sp_ = 0;
  std::uint64_t last_ = 0, cycles_ = 0, since_pause_ = 0, longest_ = 0;
  std::string longest_at_;
  unsigned points_ = 0;
};

class PathsImage : public ::testing::Test {
 protected:
  void SetUp() override { EXPECT_EQ(board.send("I6=1 I3=2\r"), "\x06"); }
  void accepted(const std::string& line) { ASSERT_EQ(board.send(line + "\r"), "\x06") << line; }
  double value(const std::string& name) { return std::stod(board.send(name + "\r")); }

  // Eight motors along blended lines and arcs without end, 5 ms a segment.
  void start(int ahead, const std::string& acceleration, const std::vector<std::string>& lines) {
    const char* axes = "XYZABCUV";
    for (int m = 1; m <= 8; ++m) {
      const std::string n = std::to_string(m);
      accepted("I" + n + "00=1 I" + n + "24=$120001 I" + n + "11=0 I" + n + "16=60 I" + n + "17=" + acceleration);
      accepted("&1#" + n + "->1000" + axes[m - 1]);
    }
    accepted("I5113=5 I5120=" + std::to_string(ahead));
    accepted("DELETE GATHER");
    accepted("&1 DELETE LOOKAHEAD");
    accepted("&1 DEFINE LOOKAHEAD " + std::to_string(ahead + 20) + ",0");
    accepted("A");
    board.run_ms(20);
    accepted("OPEN PROG 1 CLEAR");
    accepted("TM40 TA10 TS0 INC P2=0 WHILE(1=1)");
    for (const std::string& line : lines) accepted(line);
    accepted("ENDWHILE CLOSE");
    accepted("B1R");
  }
  // Mean of `count` segments behind the first `before`.
  double cycles_a_segment(OwnCycles& own, unsigned before, unsigned count) {
    for (int i = 0; own.points() < before && i < 1000; ++i) board.run_ms(5);
    own.from_here();
    for (int i = 0; own.points() < count && i < 3000; ++i) board.run_ms(5);
    EXPECT_GE(own.points(), count);
    const double mean = static_cast<double>(own.cycles()) / own.points();
    std::printf("%.0f cycles a segment, %llu between two pauses at %s\n", mean,
                static_cast<unsigned long long>(own.longest()), own.longest_at().c_str());
    EXPECT_EQ(value("RY$2014"), 0) << "a run-time error: the servo task came to the end of the segments";
    return mean;
  }
  ImageBoard board{BRICK_FIRMWARE_ELF, 0x3};
};

const std::vector<std::string> kCorners = {"LINEAR X.9 Y.2 Z(SIN(P2*10)) A-1 B.3 C.1 U1 V-.5",
                                           "CIRCLE1 X1 Y1 I1 J0 Z-.3 A1 B-.3 C-.1 U-1 V.5 P2=P2+1"};
// Tangents of circles: at speed, a stop takes 40 segments.
const std::vector<std::string> kSmooth = {
    "LINEAR X(COS(P2)) Y(SIN(P2)) Z.4 A-1 B.3 C.1 U1 V-.5",
    "CIRCLE2 X(COS(P2+2.387)) Y(SIN(P2+2.387)) R12 Z.4 A-1 B.3 C.1 U1 V-.5 P2=P2+4.7746"};

TEST_F(PathsImage, ASegmentOfEightAxesAtSpeed) {
  start(54, "0.06", kSmooth);
  OwnCycles own(board, "segment_work");
  EXPECT_LE(cycles_a_segment(own, 60, 400), 20000);
}

TEST_F(PathsImage, ASegmentOfEightAxesWithCorners) {
  start(54, "1", kCorners);
  OwnCycles own(board, "segment_work");
  const double few = cycles_a_segment(own, 60, 1000);
  EXPECT_LE(few, 20000);
  EXPECT_LE(own.longest(), 500u) << own.longest_at();
  accepted("A");
  board.run_ms(500);
  own.from_here();
  start(1000, "1", kCorners);
  const double many = cycles_a_segment(own, 1100, 500);
  EXPECT_LE(many, 1.2 * few);
  EXPECT_GE(many, few / 1.2);
}

}  // namespace
}  // namespace brick
