// How long the firmware holds a task off, seen instruction by instruction on the CPU model: the longest section of each
// kind is printed with the function that asked for it, and bounded. A section begins when a task takes bits of mie away
// that it has, and ends when they are back; interrupts between are not counted.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "systemc/cpu/elf_file.h"
#include "testbench/unit/firmware_platform/image_board.h"
#include "testbench/unit/random_lines.h"

namespace brick {
namespace {

constexpr Cycle kLimit = 400;
constexpr unsigned kMie = 0x304, kReturnAddress = 1;
constexpr std::array<CpuInterrupt, 4> kLines = {kIrqRealTime, kIrqServo, kIrqPhase, kIrqHostPort};

std::string line_name(CpuInterrupt line) {
  static const std::map<CpuInterrupt, std::string> names = {
      {kIrqRealTime, "real-time"}, {kIrqServo, "servo"}, {kIrqPhase, "phase"}, {kIrqHostPort, "host port"}};
  return names.at(line);
}

std::uint32_t above(std::uint32_t cause) {  // what a handler leaves enabled (docs/firmware.md, Tasks)
  const std::uint32_t host = 1u << kIrqHostPort, phase = 1u << kIrqPhase, servo = 1u << kIrqServo;
  switch (cause & 0x7FFFFFFF) {
    case kIrqRealTime:
      return host | phase | servo;
    case kIrqServo:
      return host | phase;
    case kIrqPhase:
      return host;
    default:
      return 0;
  }
}

class MaskWatch {
 public:
  MaskWatch(ImageBoard& board, const std::string& elf) : board_(board), elf_(elf) {
    Cpu& cpu = board.cpu();
    levels_.push_back({above(kIrqRealTime) | 1u << kIrqRealTime, 0, {}});
    cpu.on_trap = [this](std::uint32_t cause, std::uint32_t, Cycle now) { levels_.push_back({above(cause), now, {}}); };
    cpu.on_mret = [this](std::uint32_t, Cycle now) { leave(now); };
    board.on_instruction = [this] { look(); };
  }
  ~MaskWatch() {
    board_.cpu().on_trap = nullptr;
    board_.cpu().on_mret = nullptr;
    board_.on_instruction = nullptr;
  }

  struct Worst {
    Cycle cycles = 0;
    std::string function;
    unsigned sections = 0;
  };
  Worst worst(CpuInterrupt line) const {
    const auto found = worst_.find(line);
    return found == worst_.end() ? Worst{} : found->second;
  }
  std::map<std::pair<Cycle, std::string>, std::string> table() const {  // the longest of each function
    std::map<std::pair<Cycle, std::string>, std::string> sorted;
    for (const auto& [key, cycles] : longest_) sorted[{-cycles, key.second}] = line_name(key.first);
    return sorted;
  }

 private:
  struct Section {
    bool open = false;
    Cycle since = 0, interrupted = 0;
    std::string function;
  };
  struct Level {
    std::uint32_t enabled;
    Cycle entered;
    std::array<Section, 4> sections;
  };

  void leave(Cycle now) {
    if (levels_.size() == 1) return;
    const Cycle took = now - levels_.back().entered;
    levels_.pop_back();
    for (Section& section : levels_.back().sections) section.interrupted += took;
  }

  void look() {
    Level& level = levels_.back();
    const std::uint32_t off = level.enabled & ~board_.cpu().csr(kMie);
    const Cycle now = board_.cpu().cycle();
    for (unsigned i = 0; i < kLines.size(); ++i) {
      Section& section = level.sections[i];
      const bool is_off = (off >> kLines[i] & 1) != 0;
      if (is_off == section.open) continue;
      if (is_off)
        section = {true, now, 0, elf_.symbol_at(board_.cpu().reg(kReturnAddress))};
      else
        close(kLines[i], section, now);
    }
  }

  void close(CpuInterrupt line, Section& section, Cycle now) {
    section.open = false;
    if (section.function == "start") return;  // a reset: there are no tasks
    const Cycle cycles = now - section.since - section.interrupted;
    Worst& worst = worst_[line];
    ++worst.sections;
    if (cycles > worst.cycles) {
      worst.cycles = cycles;
      worst.function = section.function;
    }
    Cycle& longest = longest_[{line, section.function}];
    if (cycles > longest) longest = cycles;
  }

  ImageBoard& board_;
  ElfFile elf_;
  std::vector<Level> levels_;
  std::map<CpuInterrupt, Worst> worst_;
  std::map<std::pair<CpuInterrupt, std::string>, Cycle> longest_;
};

// A host that uses everything: programs, variables of each kind, reports, buffers, SAVE, and lines by chance.
TEST(Mask, LongestSectionThatHoldsATaskOff) {
  ImageBoard board(firmware_image(), 0x3);
  ASSERT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  MaskWatch watch(board, firmware_image());
  EXPECT_EQ(board.send("I111=0 I112=0 I124=$120001 I192=1 #1J/\r", 30.0), "\x06") << "a motor that nothing turns";
  board.run_ms(10.0);
  for (const char* line : {"&1DEF ROT 2000 B0", "#1->100X+20.5Y-0.25Z+7", "OPEN ROT", "TM20000 X7", "CLOSE", "R"})
    EXPECT_EQ(board.send(std::string(line) + "\r", 30.0), "\x06") << line;
  board.run_ms(30.0);
  // Words that are made when they are read, during a move.
  EXPECT_EQ(board.send("RL$2047 RL$CF\r"), "7\r100\r\x06");
  for (const char* line :
       {"M6->L:$2047 M7->X:$2015 M8->Y:$2015,8,8 M9->X:$6,22 M10->L:$5010 M11->L:$CF", "P2=M6 P3=M11 P4=M7 P5=M9",
        "M7=500 M8=5 M9=0", "RD$2015 RX$2040 RHL$2047,4 RL$CF,4", "WD$2015,30000000000", "WL$2047,3 WX$6,0 WY$203F,0",
        "WX$5010,0 WY$5010,$1FFF", "RL$5010", "P6=M10 RY$5010", /* a float of 36 leading zeros */
        "M12->Y:$5011,24,D M12=5000000123 RHY$5011", "&1A"})
    EXPECT_EQ(board.send(std::string(line) + "\r", 30.0).find("ERR"), std::string::npos) << line;
  for (const char* line : {"B0",
                           "M1->X:$5000",
                           "M2->L:$5001",
                           "M3->D:$5002",
                           "M4->DP:$60000",
                           "M5->Y:$78005,3,4,S",
                           "M1=1.5 M2=-3.25E M3=1E M4=-5 M5=3",
                           "P1=M1+M2+M3+M4+M5",
                           "OPEN ROT",
                           "TA10 TS2 INC F100 FRAX(A,B,X,Y)",
                           "A1B2C3U4V5W6X7Y8Z9",
                           "M2=P1*0.1 X(M2)",
                           "I5189=5 P(P1)=Q1",
                           "X.5 DWELL2",
                           "CLOSE R",
                           "I7016=3 I124=$20001",
                           "RX$5000 RL$5001,4 WL$5001,1.25,-3",
                           "I5111=500",
                           "?",
                           "??",
                           "???",
                           "%50",
                           "H",
                           "R",
                           "A",
                           "SAVE",
                           "I16=3 I17=7",
                           "OPEN PROG 1 CLEAR",
                           "X1 Y2",
                           "I18=20",
                           "CLOSE",
                           "OPEN PLC 2 CLEAR P1=1 CLOSE OPEN PROG 1 CLEAR",
                           "N1 P1=P1+1 IF(P1<9) GOSUB 5 M1==P1",
                           "X(P1) M1|=1 GOTO 1",
                           "N5 M5==1 CALL 1.00006 X1 RETURN",
                           "N6 READ(X) RETURN",
                           "CLOSE",
                           "B1.00001R",
                           "PC PE",
                           "OPEN PLC 2 CLOSE",
                           "LIST PE",
                           "A",
                           "#1J/",
                           "I100=0 I100=1"})
    board.send(std::string(line) + "\r", 30.0);
  RandomLines random(21);
  for (int i = 0; i < 300; ++i) board.send(random.next() + "\r", 3.0);
  for (const auto& [key, line] : watch.table())
    std::printf("%5d cycles %-10s %s\n", static_cast<int>(-key.first), line.c_str(), key.second.c_str());
  for (const CpuInterrupt line : kLines) {
    const auto worst = watch.worst(line);
    RecordProperty(line_name(line), worst.function + " " + std::to_string(worst.cycles));
    std::printf("%s held off %d cycles at most, by %s; %u sections\n", line_name(line).c_str(),
                static_cast<int>(worst.cycles), worst.function.c_str(), worst.sections);
    EXPECT_LE(worst.cycles, kLimit);
    EXPECT_GT(worst.sections, 100u) << "hardly any section seen";
  }
}

// All tables there can be are of motor 1: where it counts from is changed between two servo interrupts all the same.
TEST(Mask, ZerosOfAMotorWithEveryTable) {
  ImageBoard board(firmware_image(), 0x3);
  ASSERT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  ASSERT_EQ(board.send("I111=0 I112=0 I124=$120001 I192=1\r", 30.0), "\x06") << "a motor that nothing turns";
  for (int table = 32; table > 0; --table) {
    const std::string source = table % 4 == 0 ? "#2" : table % 2 == 0 ? "#1D" : "#1";
    const std::string line = "#" + std::to_string(table) + "DEFINE COMP 4," + source + ",#1,1000";
    ASSERT_EQ(board.send(line + "\r", 30.0), "\x06") << line;
    ASSERT_EQ(board.send("16 -32 48 -64\r", 30.0), "\x06");
  }
  MaskWatch watch(board, firmware_image());
  for (const char* line : {"I51=1", "#1HMZ", "J/", "HMZ", "J=100", "HMZ", "I106=3", "HMZ", "K", "HMZ", "$*",
                           "I60=0 I61=0 J/", "HMZ", "K", "OPEN PROG 1 CLEAR HOMEZ1 CLOSE &1B1R", "I51=0"}) {
    EXPECT_EQ(board.send(std::string(line) + "\r", 30.0), "\x06") << line;
    board.run_ms(5.0);
  }
  for (const auto& [key, line] : watch.table())
    std::printf("%5d cycles %-10s %s\n", static_cast<int>(-key.first), line.c_str(), key.second.c_str());
  for (const CpuInterrupt line : {kIrqServo, kIrqRealTime}) {
    const auto worst = watch.worst(line);
    EXPECT_LE(worst.cycles, kLimit) << worst.function;
    EXPECT_GT(worst.sections, 100u) << "hardly any section seen";
  }
}

// Programs read axis definitions at their addresses (docs/variables.md, Live words), and preempt who changes them.
TEST(Mask, AxisDefinitionsChangeWhileTheRealTimeTaskIsHeldOff) {
  ImageBoard board(firmware_image(), 0x3);
  ASSERT_EQ(board.send("I6=1 I3=2\r"), "\x06");
  constexpr std::uint32_t kBytes = 88;  // of one: two bools, the system, nine scales, the offset
  const auto first = ElfFile(firmware_image()).symbol("axis_definitions");
  ASSERT_TRUE(first.has_value());
  const auto* memory = board.cpu().memory(*first, kBytes);
  std::array<std::uint8_t, kBytes> last{};
  unsigned changes = 0, open_changes = 0;
  board.on_instruction = [&] {
    if (std::memcmp(last.data(), memory, kBytes) == 0) return;
    std::memcpy(last.data(), memory, kBytes);
    ++changes;
    if ((board.cpu().csr(kMie) >> kIrqRealTime & 1) != 0) ++open_changes;
  };
  for (const char* line : {"&1#1->100.1X+20.5Y-0.25Z+7.3", "#1->5B", "UNDEFINE", "#1->3.3W", "#1->0", "UNDEFINE ALL"})
    EXPECT_EQ(board.send(std::string(line) + "\r"), "\x06") << line;
  board.on_instruction = nullptr;
  EXPECT_GT(changes, 15u) << "hardly any change seen";
  EXPECT_EQ(open_changes, 0u);
}

}  // namespace
}  // namespace brick
