// Text to commands by the host library, and what of commands the firmware takes: words of the ASCII route, or codes.
// codes.
#include "testbench/unit/firmware_program/binary_fixture.h"
#include "testbench/unit/random_seed.h"

namespace binary_rotary {
namespace {

// Whatever the generators of other tests can make of the grammar: what the library takes gives the words of the ASCII
// route, what it refuses is what binary lines cannot say.
TEST_F(BinaryRotary, TheSameTextGivesTheSameWords) {
  BRICK_COVERS("BIN-3");
  ProgramGenerator generator(brick::random_seed(3), WHERE_ROTARY);
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
        "HM1..32", "ENA PLC 0,3..4", "N262143", "X-2147483392", "TM8388607", "FRAX", "F0"}},
      {BinaryResult::kFloat, {"X0.1", "X8388609", "X1.00000001", "P1=0.3", "X.0000000001", "X1234567890"}},
      {BinaryResult::kConversion, {"X-", "P1=", "X1^", "P1=-"}},
      {BinaryResult::kIllegal,
       {"X(P1)", "X$10", "P1=P2", "P(3)=4", "P1=2+3", "IF(P1=2)X1", "GOTO5", "SEND\"A\"", "CMD\"R\"", "P$10=1",
        "RETURN", "F(Q1)", "M1&=M2"}},
      {BinaryResult::kRange,
       {"X2147483648", "X99999999999999999999", "P8192=1", "N262144", "N1.5", "F-1", "TA-5", "TM8388608", "HM33", "HM0",
        "DIS PLC 32", "HM5..3"}},
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
      {{fields(3, 0, 0)}, 0, "F0"},
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
      {{fields(9, 1, 0 | 1 << 6)}, 0, "HM32"},          // alone: bits 29..0 are 0
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

}  // namespace
}  // namespace binary_rotary
