// The binary rotary transfer on the native firmware: what the ring has got of what stood in the dual-ported RAM.
#include <cctype>
#include <cstdlib>
#include <random>

#include "testbench/host/binary_commands.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_interrupts.h"
#include "testbench/unit/firmware_program/binary_buffer.h"
#include "testbench/unit/firmware_program/program_generator.h"

extern "C" {
#include "firmware/host/binary_rotary.h"
#include "firmware/language/binary_word.h"
}

namespace {

using brick::binary_line;
using brick::BinaryCommand;
using brick::BinaryLine;
using brick::BinaryResult;
using platform::host;

using Buffer = platform::BinaryBuffer;
constexpr BinaryCommand kEnd = Buffer::kEnd;

std::vector<word48_t> ring(unsigned cs = 1) {
  const rotary& r = rotary_buffers[cs - 1];
  std::vector<word48_t> words;
  for (std::uint32_t i = 0; i < r.used; ++i) words.push_back(user_memory_read(r.base + (r.read + i) % r.size));
  return words;
}

class BinaryRotary : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    period();
  }
  // Servo interrupts and one real-time task; a slice is half of this time.
  static void period() {
    for (int i = 0; i < (fake_interrupts_are_on() ? 300 : 3); ++i) {
      platform::pass_us(442);
      platform::servo_ticks(1);
    }
  }
  static void open(const std::string& definitions = "DEF ROT 100") {
    ASSERT_EQ(host(definitions), "");
    ASSERT_EQ(host("OPEN BINARY ROTARY"), "");
  }
  // With interrupts anywhere there is next to no time between them: a pass looks at one header, and at one command.
  static void pass() { platform::background(fake_interrupts_are_on() ? 300 : 1); }
};

TEST_F(BinaryRotary, LinesAreCopiedAsTheyAre) {
  BRICK_COVERS("BIN-3 BIN-6");
  open();
  Buffer buffer;
  buffer.set_up();
  buffer.put("X1000 Y-0.5 F100");
  buffer.put("LINEAR");
  pass();
  // host-bus:7.7: 1000 = 1000/1024 x 2^10, -0.5 = -1/2 x 2^0, 100 = 100/128 x 2^7.
  const std::vector<word48_t> expected = {
      (UINT64_C(1) << 47) | (UINT64_C(1) << 43) | (UINT64_C(6) << 30) | (UINT64_C(10) << 24) | 0x7D0000,
      (UINT64_C(1) << 43) | (UINT64_C(7) << 30) | 0xC00000,
      (UINT64_C(3) << 43) | (UINT64_C(7) << 24) | 0x640000,
      (UINT64_C(1) << 47) | (UINT64_C(2) << 43),
  };
  EXPECT_EQ(ring(), expected);
  EXPECT_EQ(host("PR"), "2");
  EXPECT_EQ(host("LIST ROT"), "X1000Y-0.5F100|LIN");
  EXPECT_EQ(buffer.pmac_index(), 8u);
  EXPECT_EQ(buffer.status(), 0u);
}

// Whatever the generators of other tests can make of the grammar: what the library takes gives the words of the ASCII
// route, what it refuses is what binary lines cannot say.
TEST_F(BinaryRotary, TheSameTextGivesTheSameWords) {
  BRICK_COVERS("BIN-3");
  ProgramGenerator generator(3, WHERE_ROTARY);
  ASSERT_EQ(host("&2 DEF ROT 600 &1 DEF ROT 600"), "");
  Buffer buffer;
  buffer.size = 1024;
  unsigned taken = 0, refused = 0;
  for (unsigned i = 0; i < 1200; ++i) {
    const std::string text = i % 8 == 0 ? generator.long_line() : generator.statement();
    const BinaryLine line = binary_line(text);
    ASSERT_EQ(host("&2 OPEN ROT CLEAR"), "");
    const std::string reply = host(text);
    ASSERT_EQ(host("CLOSE"), "");
    if (line.result != BinaryResult::kOk) {
      ++refused;
      continue;
    }
    ++taken;
    EXPECT_EQ(reply, "") << text;
    ASSERT_EQ(host("&1 OPEN BIN ROT CLEAR"), "");
    buffer.set_up();
    buffer.put(line.commands);
    for (unsigned passes = 0; buffer.pmac_index() != buffer.index && buffer.status() == 0 && passes < 100; ++passes)
      pass();
    ASSERT_EQ(buffer.status(), 0u) << text;
    ASSERT_EQ(ring(1), ring(2)) << text;
    ASSERT_EQ(host("CLOSE"), "");
  }
  EXPECT_GT(taken, 200u);
  EXPECT_GT(refused, 200u);
}

// host-bus:7.5/12.
TEST_F(BinaryRotary, LibraryRefusesByItsCodes) {
  const struct {
    BinaryResult result;
    std::vector<const char*> lines;
  } cases[] = {
      {BinaryResult::kOk,
       {"", " ; X1", "x1y2 ; z", "X 8388607 Y-.5", "M1==2 P1023=0.25 p 8191 = 3", "ABS(X,R)", "G1 P5", "X1 I5",
        "HM1..32", "ENA PLC 0,3..4", "N262143", "X-2147483392", "TM8388607", "FRAX"}},
      {BinaryResult::kFloat, {"X0.1", "X8388609", "X1.00000001", "P1=0.3", "X.0000000001", "X1234567890"}},
      {BinaryResult::kConversion, {"X-", "P1=", "X1^", "P1=-"}},
      {BinaryResult::kIllegal,
       {"X(P1)", "X$10", "P1=P2", "P(3)=4", "P1=2+3", "IF(P1=2)X1", "GOTO5", "SEND\"A\"", "CMD\"R\"", "P$10=1",
        "RETURN", "F(Q1)", "M1&=M2"}},
      {BinaryResult::kRange,
       {"X2147483648", "X99999999999999999999", "P8192=1", "N262144", "N1.5", "F0", "F-1", "TA-5", "TM8388608", "HM33",
        "HM0", "DIS PLC 32", "HM5..3"}},
      {BinaryResult::kSyntax,
       {"?", "X1 R", "P1", "I5", "I5X1", "OPEN ROT", "&2X1", "ABS(Q)", "FRAX(R)", "X1 P1", "ABS(X", "M1->*"}},
  };
  for (const auto& c : cases)
    for (const char* line : c.lines) EXPECT_EQ(binary_line(line).result, c.result) << line;
  EXPECT_EQ(binary_line("X1" + std::string(254, ' ')).result, BinaryResult::kSyntax) << "256 characters";
  EXPECT_TRUE(binary_line(" ; X1").commands.empty());
}

// Commands by their fields (host-bus:7.7); `first` begins a line.
BinaryCommand fields(unsigned code1, unsigned code2, unsigned n, int exponent = 0, std::uint32_t fraction = 0) {
  return {code1 << 19 | code2 << 16 | n << 6 | (static_cast<unsigned>(exponent) & 0x3F), fraction & 0xFFFFFF};
}
BinaryCommand first(BinaryCommand c) { return {c.first | 0x800000, c.second}; }
constexpr std::uint32_t kHalf = 0x400000;  // 0.5 x 2^n

constexpr std::uint32_t kError = 0x8000, kBusy = 0x4000;

// The header as it stands, one line in the buffer, and what becomes of it.
TEST_F(BinaryRotary, HeadersThatLieAreErrors) {
  BRICK_COVERS("BIN-6");
  open("&2 DEF ROT 50 &1 DEF ROT 50");
  struct Lie {
    std::uint32_t word, value, code;
  };
  const Lie lies[] = {
      {DPRAM_ROTARY_SIZE, 0, 2},       {DPRAM_ROTARY_SIZE, 4, 2},        {DPRAM_ROTARY_SIZE, 63, 2},
      {DPRAM_ROTARY_SIZE, 0xFFFF, 2},  {DPRAM_ROTARY_SIZE, 0xFFFE, 3},   {DPRAM_ROTARY_START, 15218, 3},
      {DPRAM_ROTARY_START, 0xFFFF, 3}, {DPRAM_ROTARY_HOST_INDEX, 1, 4},  {DPRAM_ROTARY_HOST_INDEX, 64, 4},
      {DPRAM_ROTARY_PMAC_INDEX, 3, 4}, {DPRAM_ROTARY_PMAC_INDEX, 66, 4}, {DPRAM_ROTARY_PMAC_INDEX, 0xFFFE, 4},
      {DPRAM_ROTARY_ENABLE, 2, 7},     {DPRAM_ROTARY_ENABLE, 17, 7},     {DPRAM_ROTARY_ENABLE, 0x8001, 7}};
  Buffer buffer;
  for (const Lie& lie : lies) {
    buffer.set_up();
    buffer.put("X1");
    buffer.write(lie.word, lie.value);
    pass();
    EXPECT_EQ(buffer.status(), kError | lie.code) << "word " << lie.word << " = " << lie.value;
    EXPECT_TRUE(ring(1).empty());
    EXPECT_TRUE(ring(2).empty());
  }
  buffer.start = 15216;  // the last place: $060450 + 15,280 items is the end of the RAM
  buffer.set_up();
  buffer.put("X1");
  pass();
  EXPECT_EQ(buffer.status(), 0u);
  EXPECT_EQ(ring(1).size(), 1u);
}

TEST_F(BinaryRotary, WithoutAnOpenBufferAWaitingLineIsAnError) {
  BRICK_COVERS("BIN-1");
  Buffer one, two;
  two.cs = 2;
  two.start = 64;
  one.set_up();
  two.set_up();
  platform::background(32);  // one header a pass while nothing is open
  EXPECT_EQ(one.status(), 0u) << "nothing waits";
  one.put("X1");
  platform::background(32);
  EXPECT_EQ(one.status(), kError | 1) << "no buffer";
  one.set_up();
  ASSERT_EQ(host("&1 DEF ROT 50 OPEN ROT"), "");
  one.put("X1");
  platform::background(32);
  EXPECT_EQ(one.status(), kError | 1) << "open for text";
  EXPECT_EQ(host("PR"), "0");
  ASSERT_EQ(host("CLOSE OPEN BIN ROT"), "");
  one.set_up();
  one.put("X1");
  two.put("X2");
  pass();
  pass();
  EXPECT_EQ(one.status(), 0u);
  EXPECT_EQ(host("PR"), "1");
  EXPECT_EQ(two.status(), kError | 1) << "&2 has none";
  ASSERT_EQ(host("CLOSE"), "");
  platform::background(32);
  EXPECT_EQ(one.status(), 0u) << "all had been copied";
}

// What cannot come as text of a rotary buffer does not enter; what was before it on its line neither.
TEST_F(BinaryRotary, CommandsAreJudged) {
  BRICK_COVERS("BIN-3");
  open();
  struct Case {
    std::vector<BinaryCommand> line;
    std::uint32_t code;
    const char* text;  // its listing, where it is good
  };
  const BinaryCommand x = fields(1, 0, 6, 1, kHalf), m = fields(8, 0, 1, 3, kHalf), p = fields(5, 0, 3, 1, kHalf);
  const Case cases[] = {
      {{x}, 0, "X1"},
      {{fields(0, 0, 0)}, 0, ""},
      {{fields(1, 0, 6, -31, kHalf)}, 0, nullptr},
      {{fields(1, 0, 6, 1, 0x800000)}, 0, "X-2"},  // -1 x 2^1
      {{fields(1, 0, 6, 2, 0xC00000)}, 0, "X-2"},  // -1/2 x 2^2
      {{fields(1, 0, 6, 0, 0)}, 0, "X0"},
      {{fields(1, 0, 6, 1, 0)}, 6, nullptr},  // zero is all zero
      {{fields(1, 0, 6, 2, 0x200000)}, 6, nullptr},
      {{fields(1, 0, 6, 2, 0xC00001)}, 6, nullptr},
      {{fields(1, 0, 9, 1, kHalf)}, 5, nullptr},
      {{fields(1, 1, 1, 1, kHalf)}, 0, "J1"},
      {{fields(1, 1, 0, 1, kHalf)}, 5, nullptr},  // I1 alone is a command
      {{x, fields(1, 1, 0, 1, kHalf)}, 0, "X1I1"},
      {{fields(1, 1, 4, 1, kHalf)}, 5, nullptr},
      {{x, fields(1, 2, 6, 1, kHalf)}, 0, "X1^1"},
      {{x, fields(1, 3, 6, 1, kHalf)}, 0, "X1:1"},
      {{x, fields(1, 2, 7, 1, kHalf)}, 5, nullptr},
      {{x, fields(0, 0, 0), fields(1, 2, 6, 1, kHalf)}, 5, nullptr},
      {{fields(1, 2, 6, 1, kHalf)}, 5, nullptr},
      {{fields(1, 4, 6, 1, kHalf)}, 5, nullptr},
      {{fields(2, 0, 1)}, 0, "RPD"},
      {{fields(2, 0, 1, 1, kHalf)}, 6, nullptr},
      {{fields(2, 0, 6, 1, kHalf)}, 0, "PVT1"},
      {{fields(2, 0, 6, 1, 0xC00000)}, 6, nullptr},
      {{fields(2, 0, 7)}, 5, nullptr},
      {{fields(2, 0, 19)}, 5, nullptr},  // RETURN
      {{fields(2, 0, 21)}, 5, nullptr},  // ELSE
      {{fields(2, 1, 0x1FF)}, 0, "ABS"},
      {{fields(2, 2, 0x200)}, 0, "INC(R)"},
      {{fields(2, 1, 0)}, 6, nullptr},
      {{fields(2, 1, 1, 1, 0)}, 6, nullptr},
      {{fields(2, 3, 0x1C0)}, 0, "FRAX"},
      {{fields(2, 3, 0)}, 0, "NOFRAX"},
      {{fields(2, 3, 0x200)}, 6, nullptr},
      {{fields(2, 4, 1)}, 5, nullptr},
      {{fields(3, 0, 0, 1, kHalf)}, 0, "F1"},
      {{fields(3, 0, 0)}, 6, nullptr},
      {{fields(3, 0, 0, 1, 0xC00000)}, 6, nullptr},
      {{fields(3, 0, 1, 23, 0x7FFFFF)}, 0, "TM8388607"},
      {{fields(3, 0, 1, 24, kHalf)}, 6, nullptr},
      {{fields(3, 0, 2, 1, 0xC00000)}, 6, nullptr},
      {{fields(3, 0, 4)}, 0, "DWE0"},
      {{fields(3, 0, 7, 1, kHalf)}, 5, nullptr},
      {{fields(3, 1, 0, 1, kHalf)}, 5, nullptr},
      {{p}, 0, "P3=1"},
      {{fields(4, 4, 3, 1, kHalf)}, 0, "M3^=1"},
      {{fields(4, 5, 3, 1, kHalf)}, 5, nullptr},
      {{fields(5, 1, 3, 1, kHalf)}, 5, nullptr},
      {{fields(7, 0, 15)}, 0, "I15=0"},
      {{fields(15, 0, 7), fields(5, 0, 1023, 1, kHalf)}, 0, "P8191=1"},
      {{fields(15, 0, 8), p}, 6, nullptr},
      {{fields(15, 0, 0), p}, 6, nullptr},
      {{fields(15, 0, 1), x}, 5, nullptr},
      {{fields(15, 0, 1), fields(15, 0, 1), p}, 5, nullptr},
      {{x, fields(15, 0, 1)}, 8, nullptr},
      {{m}, 0, "M4"},
      {{m, fields(8, 0, 31, 1, kHalf)}, 0, "M4P1"},
      {{x, fields(8, 0, 31, 1, kHalf)}, 5, nullptr},  // P1 is a query
      {{fields(8, 0, 5, 18, 0x7FFFE0)}, 0, "N262143"},
      {{fields(8, 0, 5, 19, kHalf)}, 6, nullptr},
      {{fields(8, 0, 5, 0, kHalf)}, 6, nullptr},
      {{fields(8, 0, 5, 2, 0x700000)}, 6, nullptr},  // 3.5
      {{fields(8, 0, 5, 1, 0xC00000)}, 6, nullptr},
      {{fields(8, 0, 7, 1, kHalf)}, 5, nullptr},
      {{fields(9, 0, 3, 1, kHalf)}, 0, "CALL1"},
      {{fields(9, 0, 10, 1, kHalf)}, 5, nullptr},       // GOTO
      {{fields(9, 1, 0 | 1 << 6, 0, 1)}, 0, "HM1,32"},  // motor 32 is bit 31
      {{fields(9, 1, 0)}, 6, nullptr},
      {{fields(9, 1, 4, 0x3F, 0xFFFFFF)}, 0, "DISPLC0..29"},
      {{fields(9, 1, 2, 0, 1)}, 5, nullptr},  // READ
      {{fields(9, 1, 9, 0, 1)}, 5, nullptr},  // ADDRESS
      {{fields(9, 1, 0x80, 0, 1)}, 5, nullptr},
      {{fields(9, 2, 0, 0, 1), fields(0, 0, 0, 0, 'A')}, 5, nullptr},  // SEND
      {{fields(10, 0, 0)}, 5, nullptr},
      {{fields(13, 7, 0x3FF)}, 5, nullptr},
      {{fields(14, 1, 1, 0, 5), fields(14, 4, 6)}, 5, nullptr},
  };
  Buffer buffer;
  for (const Case& c : cases) {
    SCOPED_TRACE(&c - cases);
    buffer.set_up();
    ASSERT_EQ(host("CLEAR"), "");
    std::vector<BinaryCommand> line = c.line;
    line[0] = first(line[0]);
    buffer.put({first(p)});
    buffer.put(line);
    pass();
    EXPECT_EQ(buffer.status(), c.code == 0 ? 0 : kError | c.code);
    EXPECT_EQ(ring().size(), c.code == 0 ? 1 + line.size() : 1) << "the line before it is stored in any case";
    EXPECT_EQ(buffer.pmac_index(), c.code == 0 ? buffer.index : 2);
    if (c.text != nullptr) { EXPECT_EQ(host("LIST ROT"), std::string("P3=1|") + c.text); }
    pass();
    EXPECT_EQ(ring().size(), c.code == 0 ? 1 + line.size() : 1) << "stopped until the host has seen to it";
  }
}

TEST_F(BinaryRotary, LineThatDoesNotBeginIsIncomplete) {
  open();
  Buffer buffer;
  buffer.set_up();
  const std::vector<BinaryCommand> line = binary_line("X1Y2Z3").commands;
  buffer.put({line[0], line[1]});  // the host's index stands in the middle of the line
  pass();
  buffer.put({line[2]});
  pass();
  EXPECT_EQ(buffer.status(), kError | 8);
  EXPECT_EQ(host("LIST ROT"), "X1Y2");
  buffer.set_up();
  buffer.put("Z3");
  pass();
  EXPECT_EQ(buffer.status(), 0u) << "the host has begun anew";
  EXPECT_EQ(host("LIST ROT"), "X1Y2|Z3");
}

// Either form of it, before the index or at it; it is no fault, and what comes in its place is copied.
TEST_F(BinaryRotary, EndOfBufferEndsThePass) {
  open();
  for (const BinaryCommand end : {kEnd, BinaryCommand{0xFF0800, 0}, BinaryCommand{0xFF0800, 0x123456}}) {
    Buffer buffer;
    buffer.set_up();
    ASSERT_EQ(host("CLEAR"), "");
    buffer.put("X1");
    const std::uint32_t at = buffer.index;
    buffer.put("X2");
    buffer.put("X3");
    buffer.command(at, end);
    pass();
    EXPECT_EQ(buffer.status(), 0u);
    EXPECT_LE(ring().size(), 1u);
    buffer.command(at, binary_line("X2").commands[0]);
    pass();
    EXPECT_EQ(host("LIST ROT"), "X1|X2|X3");
  }
}

// A line enters whole or not at all, and waits while there is no room: bit 14.
TEST_F(BinaryRotary, FullRingHoldsTheTransfer) {
  BRICK_COVERS("BIN-3");
  open("DEF ROT 5");
  Buffer buffer;
  buffer.set_up();
  buffer.put("P1=1 P2=2");
  buffer.put("P3=3 P4=4");
  buffer.put("P5=5 P6=6 P7=7");
  pass();
  EXPECT_EQ(host("PR"), "2");
  EXPECT_EQ(rotary_buffers[0].used, 4u);
  EXPECT_EQ(buffer.status(), kBusy);
  EXPECT_EQ(buffer.pmac_index(), 8u);
  pass();
  EXPECT_EQ(buffer.status(), kBusy);
  ASSERT_EQ(host("CLOSE B0 R"), "");
  platform::real_time();
  ASSERT_EQ(host("OPEN BIN ROT"), "");
  pass();
  EXPECT_EQ(buffer.status(), 0u);
  platform::real_time();
  EXPECT_EQ(host("P1..7"), "1|2|3|4|5|6|7");
}

// It would wait for ever.
TEST_F(BinaryRotary, ALineThatNoEmptyRingHoldsIsAnError) {
  open("DEF ROT 4");
  Buffer buffer;
  buffer.set_up();
  buffer.put("P1=1 P2=2 P3=3 P4=4");
  buffer.put("P5=1 P6=2 P7=3 P8=4 P9=5");
  pass();
  EXPECT_EQ(buffer.status(), kBusy) << "the first one fits";
  ASSERT_EQ(host("B0 R"), "");
  for (int i = 0; i < 3; ++i) {
    period();
    pass();
  }
  EXPECT_EQ(buffer.status(), DPRAM_ROTARY_ERROR | 9U);
  EXPECT_EQ(buffer.pmac_index(), 8U);
  EXPECT_EQ(host("PR P4..9"), "0|4|0|0|0|0|0");
}

TEST_F(BinaryRotary, NothingOfABegunLineSurvivesClearOrDelete) {
  for (const char* commands :
       {"CLEAR", "CLOSE DEL ROT DEF ROT 5 OPEN BIN ROT", "CLOSE DEL ALL TEMPS DEF ROT 7 OPEN BIN ROT"}) {
    platform::power_up();
    SetUp();
    open("DEF ROT 5");
    Buffer buffer;
    buffer.set_up();
    buffer.put("X1 Y1 Z1");
    buffer.put("P1=1 P2=2 P3=3");
    pass();  // two words of the second line stand in free space
    ASSERT_EQ(buffer.status(), kBusy);
    ASSERT_EQ(host(commands), "");
    pass();
    EXPECT_EQ(host("LIST ROT"), "P1=1P2=2P3=3") << commands;
    EXPECT_EQ(buffer.status(), 0u);
  }
}

// LIST ROT looks at words whose place the real-time task would use again.
// Text goes where the begun line stands: it is copied again from its first command.
TEST_F(BinaryRotary, TextBetweenTheHalvesOfALineLeavesItWhole) {
  open("&1 DEF ROT 4");
  Buffer buffer;
  buffer.set_up();
  buffer.put("P1=1 P1=2");
  buffer.put("P2=1 P2=2 P2=3");
  pass();
  ASSERT_EQ(buffer.status(), DPRAM_ROTARY_BUSY) << "two commands of the second line stand there";
  ASSERT_EQ(host("CLOSE OPEN ROT P3=1 CLOSE OPEN BIN ROT"), "");
  EXPECT_EQ(host("LIST ROT"), "P1=1P1=2|P3=1");
  ASSERT_EQ(host("B0 R"), "");
  for (int i = 0; i < 3; ++i) {
    period();
    pass();
  }
  EXPECT_EQ(host("PR P1..3"), "0|2|3|1");
  EXPECT_EQ(host("Q"), "");
}

TEST_F(BinaryRotary, NothingComesInWhileAListingIsMade) {
  open("DEF ROT 30");
  Buffer buffer;
  buffer.set_up();
  rotary_hold(true);
  buffer.put("X1");
  pass();
  EXPECT_EQ(buffer.status(), kBusy);
  EXPECT_EQ(host("LIST ROT"), "") << "which lets go of it";
  pass();
  EXPECT_EQ(buffer.status(), 0u);
  EXPECT_EQ(host("LIST ROT"), "X1");
}

TEST_F(BinaryRotary, ResetForgetsEverything) {
  BRICK_COVERS("BIN-2");
  open();
  Buffer buffer;
  buffer.set_up();
  buffer.put("X1");
  pass();
  ASSERT_EQ(host("PR"), "1");
  platform::reset();
  EXPECT_EQ(buffer.read(DPRAM_ROTARY_ENABLE), 0u) << "what the host wrote for the rings that were";
  platform::background(32);
  EXPECT_EQ(buffer.status(), 0u);
  EXPECT_EQ(host("PR").substr(0, 3), "ERR") << "no buffer";
}

TEST_F(BinaryRotary, I45ChoosesTheTask) {
  BRICK_COVERS("BIN-5");
  open();
  Buffer buffer;
  buffer.set_up();
  buffer.put("X1");
  period();
  EXPECT_EQ(host("PR"), "0") << "I45 = 0: not the real-time task";
  pass();
  EXPECT_EQ(host("PR"), "1");
  ASSERT_EQ(host("I45=1"), "");
  buffer.put("X2");
  pass();
  EXPECT_EQ(host("PR"), "1") << "I45 = 1: not the background";
  period();
  EXPECT_EQ(host("PR"), "2");
}

// The same lines by both routes: the edges of BREQ and Full are the same.
TEST_F(BinaryRotary, BreqAndFullAreThoseOfTheAsciiRoute) {
  BRICK_COVERS("BIN-3 BREQ-3");
  for (const bool foreground : {false, true}) {
    std::vector<bool> levels[2];
    std::vector<bool> full[2];
    for (const bool binary : {false, true}) {
      platform::power_up();
      SetUp();
      ASSERT_EQ(host(foreground ? "I45=1" : "I45=0"), "");
      ASSERT_EQ(host(binary ? "I16=3 I17=5 DEF ROT 40 B0 OPEN BIN ROT" : "I16=3 I17=5 DEF ROT 40 B0 OPEN ROT"), "");
      platform::clear_edges();
      Buffer buffer;
      buffer.set_up();
      for (int line = 1; line <= 8; ++line) {
        if (binary) {
          buffer.put("X1");
          if (foreground)
            period();
          else
            pass();
        } else {
          ASSERT_EQ(host("X1"), "");
        }
        ASSERT_EQ(host("PR"), std::to_string(line));
        full[binary].push_back(rotary_buffers[0].full);
      }
      for (const platform::Edge& edge : platform::edges()) levels[binary].push_back(edge.high);
      if (binary) {
        const std::vector<platform::Edge> edges = platform::edges();
        for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
          EXPECT_FALSE(edges[i].high);
          EXPECT_GE(edges[i + 1].us - edges[i].us, 1.0) << "T_PULSE";
        }
      }
    }
    EXPECT_EQ(levels[0], levels[1]);
    EXPECT_EQ(full[0], full[1]);
    EXPECT_EQ(levels[1].size(), 9u) << "four pulses, and the fall of the line that makes L = I17";
  }
}

TEST_F(BinaryRotary, SixteenAtOnce) {
  BRICK_COVERS("BIN-1 BIN-2");
  std::vector<Buffer> buffers(16);
  ASSERT_EQ(host("I68=15"), "");
  for (unsigned cs = 16; cs >= 1; --cs) {
    ASSERT_EQ(host("&" + std::to_string(cs) + "DEF ROT 40"), "");
    buffers[cs - 1].cs = cs;
    buffers[cs - 1].start = 100 * cs;
  }
  ASSERT_EQ(host("OPEN BIN ROT"), "");
  for (Buffer& b : buffers) b.set_up();
  for (Buffer& b : buffers)
    for (unsigned i = 0; i < b.cs; ++i) b.put("P" + std::to_string(b.cs) + "=" + std::to_string(i));
  pass();
  for (const Buffer& b : buffers) {
    EXPECT_EQ(b.status(), 0u) << b.cs;
    EXPECT_EQ(rotary_buffers[b.cs - 1].lines, b.cs);
    for (unsigned i = 0; i < b.cs; ++i) EXPECT_EQ(ring(b.cs)[i] >> 30 & 0x3FF, b.cs);
  }
}

// A pass ends with its time, wherever it stands, and the next ones go on; none is longer than its slice and one
// command.
TEST_F(BinaryRotary, TimeEndsAPass) {
  BRICK_COVERS("BIN-5");
  for (const bool foreground : {false, true}) {
    platform::power_up();
    SetUp();
    open("&2 DEF ROT 900 &1 DEF ROT 900");
    ASSERT_EQ(host(foreground ? "I45=1" : "I45=0"), "");
    Buffer one, two;
    one.size = two.size = 1000;
    two.cs = 2;
    two.start = 2000;
    for (Buffer* b : {&one, &two}) {
      b->set_up();
      for (int i = 0; i < 20; ++i) b->stage(binary_line("A1B1C1U1V1W1X1Y1Z1 F1 P1=1").commands);
      b->commit();
    }
    constexpr std::uint32_t kLook = 1000;  // the clock is looked at once a command
    fake_hal_set_look(kLook);
    unsigned passes = 0, parts = 0;
    for (; one.pmac_index() != one.index || two.pmac_index() != two.index; ++passes) {
      ASSERT_LT(passes, 1000u);
      const auto begin = static_cast<std::uint32_t>(hal_long_cycles());
      if (foreground) {
        period();
      } else {
        binary_rotary_pass();
        EXPECT_LE(hal_long_cycles() - begin, 663 * platform::kCyclesPerUs + 5 * kLook);
      }
      parts += rotary_buffers[0].used % 11 + rotary_buffers[1].used % 11;
    }
    fake_hal_set_look(0);
    EXPECT_GT(passes, foreground ? 25u : 7u) << "440 commands of 12.7 us at 166 and 663 us a pass";
    EXPECT_EQ(parts, 0u) << "a part of a line was counted";
    EXPECT_EQ(ring(1).size(), 220u);
    EXPECT_EQ(ring(1), ring(2));
  }
}

// A host that writes whatever it likes, at any time. BRICK_BINARY_STEPS: of each seed.
class HostileHost {
 public:
  explicit HostileHost(unsigned seed) : random_(seed) {
    for (unsigned cs = 1; cs <= 2; ++cs) {
      buffers_[cs - 1].cs = cs;
      buffers_[cs - 1].start = 80 * cs;
    }
  }

  void step() {
    Buffer& buffer = buffers_[below(2)];
    switch (below(12)) {
      case 0:
        buffer.write(2 * below(6), one_in(3) ? random_() & 0xFFFF : below(80));
        break;
      case 1:
        buffer.command(below(buffer.size),
                       {static_cast<std::uint32_t>(random_()), static_cast<std::uint32_t>(random_())});
        break;
      case 2:
        dpram_write(DPRAM_ROTARY_HEADERS + 2 * below(96), random_() & 0xFFFF);
        break;
      case 3:
        buffer.size = 2 * (3 + below(40));
        buffer.set_up();
        break;
      case 4: {
        static const char* const commands[] = {"&1",
                                               "&2",
                                               "I45=0",
                                               "I45=1",
                                               "CLEAR",
                                               "CLOSE",
                                               "OPEN BIN ROT",
                                               "&1B0R",
                                               "A",
                                               "&1 A &2 A CLOSE DEL ALL TEMPS &2 DEF ROT 9 &1 DEF ROT 30 OPEN BIN ROT",
                                               "OPEN ROT",
                                               "LIST ROT",
                                               "LIST PC",
                                               "Q",
                                               "DEL ROT",
                                               "DEF ROT 12",
                                               "I17=3"};
        (void)host(commands[below(17)]);
        break;
      }
      case 5:
        platform::background(1);
        break;
      case 6:
        platform::pass_us(200);
        platform::servo_ticks(1 + below(4));
        break;
      default: {
        const std::vector<BinaryCommand> line = binary_line(text()).commands;
        if (one_in(8) || buffer.has_room(line)) buffer.put(line);
        platform::background(1);
        break;
      }
    }
  }

 private:
  unsigned below(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(random_); }
  bool one_in(unsigned n) { return below(n) == 0; }
  std::string text() {
    std::string line;
    for (unsigned i = 0, count = 1 + below(4); i < count; ++i)
      line += std::vector<std::string>{"X1", "P5000=2", "F10", "Y-2^1", "M3==1", "DWELL1", "INC(X,R)", "N7"}[below(8)] +
              " ";
    return line;
  }

  std::mt19937 random_;
  Buffer buffers_[2];
};

// Empty when each word of the ring belongs to a line that could have come as text, and they are counted right.
std::string wrong_in_ring(unsigned cs) {
  const rotary& r = rotary_buffers[cs - 1];
  if (r.used > r.size || (r.size != 0 && (r.write >= r.size || r.read >= r.size))) return "indices";
  binary_judge line{};
  unsigned lines = 0;
  bool is_first = true;
  for (const word48_t word : ring(cs)) {
    const bool begins = (word & WORD_START_OF_LINE) != 0;
    if (is_first && !begins) line.begun = line.called = true;  // under calculation
    if (is_first || begins) ++lines;
    if (begins) line = {};
    if (begins && !is_first && binary_judge_end(&line) != BINARY_GOOD) return "a line without its end";
    const bool follows_unseen = is_first && !begins;
    if (binary_judge_word(&line, word) != BINARY_GOOD && !follows_unseen)
      return "a word that is none: " + std::to_string(word);
    is_first = false;
  }
  return lines == r.lines ? "" : std::to_string(r.lines) + " lines counted, " + std::to_string(lines) + " are there";
}

TEST_F(BinaryRotary, NothingAHostWritesDoesHarm) {
  BRICK_COVERS("BIN-3 BIN-6");
  constexpr word48_t kMark = 0x123456789ABC;
  const char* wanted = std::getenv("BRICK_BINARY_STEPS");
  const unsigned steps = wanted != nullptr ? static_cast<unsigned>(std::strtoul(wanted, nullptr, 10)) : 4000;
  unsigned long stored = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    platform::power_up();
    SetUp();
    for (std::uint32_t i = 0; i < USER_MEMORY_WORDS; ++i) user_memory_write(i, kMark);
    open("&2 DEF ROT 9 &1 DEF ROT 30");
    HostileHost hostile(seed);
    for (unsigned i = 0; i < steps; ++i) {
      hostile.step();
      for (unsigned cs = 1; cs <= 2; ++cs) {
        const std::uint32_t state = hal_mask_real_time();
        const std::string wrong = wrong_in_ring(cs);
        hal_unmask(state);
        ASSERT_EQ(wrong, "") << "&" << cs << " seed " << seed << " step " << i;
      }
      stored += rotary_buffers[0].lines;
    }
    for (std::uint32_t i = 0; i < USER_MEMORY_WORDS - 100; ++i) ASSERT_EQ(user_memory_read(i), kMark) << i;
  }
  EXPECT_GT(stored, 1000u) << "hardly a line came in";
}

}  // namespace
