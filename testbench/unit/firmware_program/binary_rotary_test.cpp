// The binary rotary transfer on the native firmware: what the ring has got of what stood in the dual-ported RAM.
#include "testbench/unit/firmware_program/binary_fixture.h"

namespace binary_rotary {
namespace {

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

// The header as it stands, one line in the buffer, and what becomes of it.
TEST_F(BinaryRotary, HeadersThatLieAreErrors) {
  BRICK_COVERS("BIN-6");
  open("&2 DEF ROT 50 &1 DEF ROT 50");
  struct Lie {
    std::uint32_t word, value, code;
  };
  const Lie lies[] = {
      {DPRAM_ROTARY_SIZE, 0, 2},       {DPRAM_ROTARY_SIZE, 4, 2},        {DPRAM_ROTARY_SIZE, 63, 2},
      {DPRAM_ROTARY_SIZE, 0xFFFF, 2},  {DPRAM_ROTARY_SIZE, 0xFFFE, 3},   {DPRAM_ROTARY_START, 15217, 3},
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
  buffer.start = 0;
  buffer.size = 6;  // the least: room for one command
  buffer.set_up();
  buffer.put("X2");
  pass();
  EXPECT_EQ(buffer.status(), 0u);
  EXPECT_EQ(ring(1).size(), 2u);
}

// host-bus:7.5/10: what has been mended is not looked at before the host has written status 0.
TEST_F(BinaryRotary, AnErrorStopsTheTransferUntilItsBitIs0) {
  open();
  Buffer buffer;
  buffer.set_up();
  buffer.put("X1");
  buffer.write(DPRAM_ROTARY_SIZE, 63);
  pass();
  ASSERT_EQ(buffer.status(), kError | 2);
  buffer.write(DPRAM_ROTARY_SIZE, 64);
  pass();
  EXPECT_EQ(buffer.status(), kError | 2);
  EXPECT_TRUE(ring().empty());
  buffer.write(DPRAM_ROTARY_STATUS, 0);
  pass();
  EXPECT_EQ(buffer.status(), 0u);
  EXPECT_EQ(ring().size(), 1u);
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

// host-bus:7.3/7: what stands there when the header is enabled again is another line.
TEST_F(BinaryRotary, NothingOfABegunLineSurvivesADisabledHeader) {
  open("DEF ROT 5");
  Buffer buffer;
  buffer.set_up();
  buffer.put("P4=4 P5=5 P6=6");
  const std::uint32_t begun = buffer.index;
  buffer.put("P1=1 P2=2 P3=3");
  pass();  // two words of it stand in free space
  ASSERT_EQ(buffer.status(), kBusy);
  buffer.write(DPRAM_ROTARY_ENABLE, 0);
  pass();
  buffer.index = begun;
  buffer.put("P1=7 P2=8 P3=9");
  buffer.write(DPRAM_ROTARY_ENABLE, 1);
  ASSERT_EQ(host("B0 R"), "");
  for (int i = 0; i < 3; ++i) {
    period();
    pass();
  }
  EXPECT_EQ(host("P1..6"), "7|8|9|4|5|6");
  EXPECT_EQ(buffer.status(), 0u);
}

// host-bus:7.2/7, also of a host that is there again before the first pass.
TEST_F(BinaryRotary, NothingOfABegunLineSurvivesAReset) {
  for (const unsigned cs : {1u, 2u, 16u}) {
    platform::power_up();
    SetUp();
    const std::string define = "&" + std::to_string(cs) + "DEF ROT 5";
    ASSERT_EQ(host("I68=15"), "");
    open(define);
    Buffer buffer;
    buffer.cs = cs;
    buffer.set_up();
    buffer.put("X1 Y1 Z1");
    const std::uint32_t begun = buffer.index;
    buffer.put("P1=1 P2=2 P3=3");
    pass();
    ASSERT_EQ(buffer.status(), kBusy);
    platform::reset();
    period();
    ASSERT_EQ(host("I68=15"), "");
    open(define);
    buffer.set_up();
    buffer.write(DPRAM_ROTARY_PMAC_INDEX, begun);
    buffer.index = begun;
    buffer.put("P1=7 P2=8 P3=9");
    pass();
    EXPECT_EQ(host("LIST ROT"), "P1=7P2=8P3=9") << "&" << cs;
  }
}

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

// LIST ROT looks at words whose place the real-time task would use again.
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

// A reply of more than the 4096 characters of the port's queue waits for its host.
TEST_F(BinaryRotary, NothingComesInWhileAListingWaits) {
  static unsigned waits, lines;
  ASSERT_EQ(host("I45=1 DEF ROT 2000 OPEN ROT"), "");
  std::string line;
  for (int i = 0; i < 85; ++i) line += "LIN";
  for (int i = 0; i < 20; ++i) ASSERT_EQ(host(line), "");
  ASSERT_EQ(host("CLOSE OPEN BINARY ROTARY"), "");
  static Buffer buffer;
  buffer = {};
  buffer.set_up();
  waits = lines = 0;
  fake_hal_on_wait([] {
    std::uint8_t c = 0;
    while (host_port_next_output(&c)) {}
    if (waits++ == 0) buffer.put("X1");  // before, an interrupt may copy it ahead of the listing
    period();
    lines = rotary_buffers[0].lines;
  });
  (void)host("LIST ROT");
  fake_hal_on_wait(nullptr);
  EXPECT_GE(waits, 1u) << "nothing has waited: the test shows nothing";
  EXPECT_EQ(lines, 20u);
  period();
  EXPECT_EQ(host("PR"), "21");
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
    constexpr std::uint32_t kLook = 1000;  // the clock is looked at once a command
    // A period with its other tasks and nothing to copy. The looks lengthen it, and a slice is a part of the last one.
    std::uint64_t idle = 0, last = 0;
    if (foreground) {
      fake_hal_set_look(kLook);
      const std::uint64_t begin = hal_long_cycles();
      period();
      idle = last = hal_long_cycles() - begin;
      fake_hal_set_look(0);
    }
    Buffer one, two;
    one.size = two.size = 1000;
    two.cs = 2;
    two.start = 2000;
    for (Buffer* b : {&one, &two}) {
      b->set_up();
      for (int i = 0; i < 20; ++i) b->stage(binary_line("A1B1C1U1V1W1X1Y1Z1 F1 P1=1").commands);
      b->commit();
    }
    fake_hal_set_look(kLook);
    unsigned passes = 0, parts = 0;
    for (; one.pmac_index() != one.index || two.pmac_index() != two.index; ++passes) {
      ASSERT_LT(passes, 1000u);
      const std::uint64_t begin = hal_long_cycles();
      if (foreground) {
        period();
        const std::uint64_t now = hal_long_cycles() - begin;
        EXPECT_LE(now, idle + last / 8 + 5 * kLook) << "a quarter of half a period";
        last = now;
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

}  // namespace
}  // namespace binary_rotary
