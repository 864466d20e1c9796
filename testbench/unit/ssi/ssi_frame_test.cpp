// Frames of both products with an encoder at the wires, the same expectations on both engines. Edges of the clock are
// compared with arithmetic on servo-ic:11.3 and servo-ic:11.4, results with the position that the encoder had.
#include "testbench/unit/covers.h"
#include "testbench/unit/ssi/ssi_fixture.h"

namespace brick {
namespace {

template <class Rig>
class SsiFrames : public SsiOn<Rig> {};
TYPED_TEST_SUITE(SsiFrames, SsiEngines, SsiNames);

constexpr std::uint32_t kFastSsi = 0x180302;  // 4 MHz, falling SERVO: bits 9, 8

TYPED_TEST(SsiFrames, GeoReadsEveryLengthAndCodeAtEveryClock) {
  BRICK_COVERS("SSI-1");
  std::uint64_t position = 0xA5C396;
  for (unsigned clock = 0; clock < 4; ++clock)
    for (unsigned length = 0; length < 4; ++length)
      for (unsigned mode = 2; mode < 4; ++mode)
        for (unsigned channel = 1; channel <= 2; ++channel) {
          SCOPED_TRACE(::testing::Message() << clock << " " << length << " " << mode << " channel " << channel);
          if (channel == 1 && clock != 3 && length != 3) continue;  // one channel is enough for most
          const unsigned bits = 12 + 4 * length;
          this->rig.encoders = nullptr;
          this->rig.reset(true);
          SsiEncoderParameters p;
          p.bits = bits;
          p.gray = mode == 3;
          position = position * 5 + 7;
          this->wire(channel, p, position);
          this->rig.write(true, kGeoClock, clock);
          this->rig.write(true, kGeoResult[channel - 1], length << 2 | mode);
          const Tick seen = this->trigger();
          this->frame_over();
          ASSERT_EQ(this->edges.size(), 2 * (bits + 1));
          const Tick half = 384 >> clock;
          for (std::size_t i = 0; i < this->edges.size(); ++i)
            ASSERT_EQ(this->edges[i], seen + static_cast<Tick>(i) * half) << i;
          const std::uint32_t expected = position & ((1u << bits) - 1);
          EXPECT_EQ(this->rig.read(false, kGeoResult[channel - 1]), expected);
          EXPECT_EQ(this->rig.read(false, kGeoResult[2 - channel]), 0u);
        }
}

TYPED_TEST(SsiFrames, BrickReadsEveryNumberOfBitsWithParityAndGray) {
  BRICK_COVERS("SSI-1");
  std::uint64_t position = 0x9D2C5680;
  for (unsigned bits = 12; bits <= 32; ++bits) {
    const unsigned channel = 1 + bits % 8, gray = bits & 1, parity = bits % 3;
    SCOPED_TRACE(::testing::Message() << bits << " bits, channel " << channel);
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    SsiEncoderParameters p;
    p.bits = bits;
    p.gray = gray != 0;
    p.parity = static_cast<Parity>(parity);
    position = position * 6364136223846793005u + 1442695040888963407u;
    this->wire(channel, p, position >> 20);
    this->rig.write(true, brick_group(channel), 0x180302);  // 4 MHz, falling SERVO: bits 9, 8
    this->rig.write(true, brick_word(channel), parity << 14 | 1u << 12 | gray << 11 | 1u << 10 | bits);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->edges.size(), 2 * (bits + 1 + (parity != 0 ? 1 : 0)));
    const std::uint64_t expected = (position >> 20) & ((std::uint64_t{1} << bits) - 1);
    EXPECT_EQ(this->rig.read(false, brick_word(channel)), expected & 0xFFFFFF);
    EXPECT_EQ(this->rig.read(false, brick_word(channel) + 1), expected >> 24);
  }
}

// The first ends with the 13th rise, 13 periods of 29.5 ticks after the trigger, the second with the 21st.
TYPED_TEST(SsiFrames, AShorterWordIsLoadedWithoutTheLongerBesideIt) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->rig.write(true, brick_group(1), 0x180302);  // 4 MHz, falling SERVO
  this->rig.write(true, brick_word(1), 0x1400 | 12);
  this->rig.write(true, brick_word(2), 0x1400 | 20);
  this->rig.data(0xFF);
  this->trigger();
  this->rig.run(21 * 30 + kRest + 10);
  EXPECT_EQ(this->rig.read(false, brick_word(1)), 0xFFFu);
  EXPECT_EQ(this->rig.read(false, brick_word(2)), 0xFFFFFu);
  this->rig.data(0);
  const Tick seen = this->trigger();
  this->rig.run(seen + 17 * 30 - this->rig.now());
  EXPECT_EQ(this->rig.read(false, brick_word(1)), 0u);
  EXPECT_EQ(this->rig.read(false, brick_word(2)), 0xFFFFFu) << "still shifted in";
  this->rig.run(5 * 30);
  EXPECT_EQ(this->rig.read(false, brick_word(2)), 0u);
}

// A line that shows each bit to one edge alone, and its inverse else, beside one that moves each tick: two flip-flops
// take it to the rise of the clock (servo-ic:11.9/2).
TYPED_TEST(SsiFrames, ABitIsTheLevelThatTheEdgeTwoBeforeTheRiseFinds) {
  BRICK_COVERS("SSI-1");
  constexpr std::uint32_t kPosition = 0x5A3C96;
  constexpr Tick kHalf = 48, kPeriod = 2 * kHalf;  // 1.23 MHz
  this->rig.reset(true);
  this->rig.write(true, kGeoClock, 3);
  this->rig.write(true, kGeoResult[0], 3 << 2 | 2);             // 24 bits
  const Tick seen = this->rig.now() + 1, first = seen + kHalf;  // its first rise, which takes no bit
  this->rig.encoders = [first](Tick now, unsigned) -> unsigned {
    const Tick behind = now + 3 - first, bit = (behind + kHalf) / kPeriod;  // the nearest
    const bool right = behind == bit * kPeriod;
    return (bit < 1 || bit > 24 || ((kPosition >> (24 - bit) & 1) != 0) == right) | (now % 2 != 0 ? 2 : 0);
  };
  ASSERT_EQ(this->trigger(), seen);
  this->rig.run(26 * kPeriod);
  EXPECT_EQ(this->rig.read(false, kGeoResult[0]), kPosition);
}

TYPED_TEST(SsiFrames, BrickTellsAParityError) {
  BRICK_COVERS("SSI-1");
  for (const unsigned parity : {1u, 2u}) {
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    SsiEncoderParameters p;
    p.parity = parity == 1 ? Parity::kEven : Parity::kOdd;  // the other one
    this->wire(3, p, 0x654321);
    this->rig.write(true, 0x2F, 0x180302);
    this->rig.write(true, brick_word(3), parity << 14 | 0x1400 | 24);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->rig.read(false, brick_word(3)), 0x654321u);
    EXPECT_EQ(this->rig.read(false, brick_word(3) + 1), 0x800000u);
  }
}

// The error belongs to the word: the next right one takes it away.
TYPED_TEST(SsiFrames, BrickTellsAParityErrorOfTheLastWordOnly) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->rig.write(true, 0x2F, 0x180302);
  this->rig.write(true, brick_word(3), 1u << 14 | 0x1400 | 24);
  for (const Parity parity : {Parity::kEven, Parity::kOdd, Parity::kEven}) {
    SsiEncoderParameters p;
    p.parity = parity;
    this->wire(3, p, 0x654321);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->rig.read(false, brick_word(3)), 0x654321u);
    EXPECT_EQ(this->rig.read(false, brick_word(3) + 1), parity == Parity::kEven ? 0x800000u : 0u);
  }
}

// Bits 15, 14 = 11 are reserved: no parity, no clock for it, no error.
TYPED_TEST(SsiFrames, BrickTakesTheReservedParityForNone) {
  BRICK_COVERS("SSI-1");
  for (const std::uint64_t position : {0x654321u, 0x654320u}) {
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    this->wire(3, {}, position);
    this->rig.write(true, 0x2F, 0x180302);
    this->rig.write(true, brick_word(3), 3u << 14 | 0x1400 | 24);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->edges.size(), 50u);
    EXPECT_EQ(this->rig.read(false, brick_word(3)), position);
    EXPECT_EQ(this->rig.read(false, brick_word(3) + 1), 0u);
  }
}

// servo-ic:11.3/6.
TYPED_TEST(SsiFrames, BrickTakesTwelveToThirtyTwoBits) {
  BRICK_COVERS("SSI-1");
  struct Case {
    unsigned asked, bits;
  };
  for (const Case c : {Case{0, 12}, {4, 12}, {11, 12}, {33, 32}, {48, 32}, {63, 32}}) {
    SCOPED_TRACE(c.asked);
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    SsiEncoderParameters p;
    p.bits = c.bits;
    this->wire(6, p, 0x89ABCDEF);
    this->rig.write(true, 0x3F, 0x180302);
    this->rig.write(true, brick_word(6), 0x1400 | c.asked);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->edges.size(), 2 * (c.bits + 1));
    EXPECT_EQ(this->rig.read(false, brick_word(6)), c.bits == 12 ? 0xDEFu : 0xABCDEFu);
    EXPECT_EQ(this->rig.read(false, brick_word(6) + 1), c.bits == 12 ? 0u : 0x89u);
  }
}

// Cycle n of 100 MHz ends at the first tick not before n x 18432/15625 (servo-ic:11.3/3).
TYPED_TEST(SsiFrames, BrickDividesAHundredMegahertz) {
  BRICK_COVERS("SSI-1");
  struct Case {
    unsigned word;
    Tick period;
  };
  for (const Case c : {Case{0x630302, 100},
                       {0x180302, 25},
                       {0x000302, 25},
                       {0x0C1302, 26},
                       {0x1A0302, 27},
                       {0x015302, 64},
                       {0x002302, 25},
                       {0xFF2302, 1024}}) {
    SCOPED_TRACE(::testing::Message() << std::hex << c.word);
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    this->wire(5, {}, 0);
    this->rig.write(true, 0x3F, c.word);
    this->rig.write(true, brick_word(5), 0x1400 | 12);
    const Tick seen = this->trigger();
    this->frame_over();
    ASSERT_EQ(this->edges.size(), 26u);
    for (Tick i = 0; i < 26; ++i) {
      const Tick cycles = i / 2 * c.period + i % 2 * (c.period / 2);
      ASSERT_EQ(this->edges[static_cast<std::size_t>(i)], seen + (cycles * 18432 + 15624) / 15625) << i;
    }
  }
}

// The first low half at each power of two that is at least 25 cycles.
TYPED_TEST(SsiFrames, BrickDividesByEveryPowerOfTwo) {
  BRICK_COVERS("SSI-1");
  for (unsigned power = 5; power < 16; ++power) {
    const unsigned divisor = power < 15 ? 1 : 2, half = divisor << power >> 1;
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    this->wire(1, {}, 0);
    this->rig.write(true, 0x2F, (divisor - 1) << 16 | power << 12 | 0x302);
    this->rig.write(true, brick_word(1), 0x1400 | 12);
    const Tick seen = this->trigger(), rise = seen + (Tick{half} * 18432 + 15624) / 15625;
    this->rig.run(rise - this->rig.now());
    EXPECT_EQ(this->edges, (std::vector<Tick>{seen, rise})) << power;
  }
}

// Of the longest periods, 2^23 and 255 * 2^15 cycles as delay, the beginning: a frame is there, which refuses a
// trigger, and its clock stands. To the end SsiModel.TheLongestDelayEndsAtItsTick and the proof of ssi_group have them.
TYPED_TEST(SsiFrames, BrickWaitsLongByTheLargestDivisors) {
  BRICK_COVERS("SSI-1");
  for (const unsigned divisor : {255u, 254u}) {
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    this->wire(1, {}, 0);
    this->rig.write(true, 0x2F, divisor << 16 | 15 << 12 | 0x312);
    this->rig.write(true, brick_word(1), 0x1400 | 12);
    this->trigger();
    this->rig.run(100'000);
    this->trigger();
    EXPECT_EQ(this->rig.read(true, brick_word(1) + 1), 1u) << divisor;
    EXPECT_TRUE(this->edges.empty()) << divisor;
  }
  this->rig.reset(false);
}

// Of triggers in a frame a channel that is enabled later counts fewer; the first of an enabled one starts its group.
// The next frame reads 32 bits of one level. Each channel has data and count of its own (servo-ic:11.3,
// servo-ic:11.9/6).
TYPED_TEST(SsiFrames, EachChannelReadsEveryBitAtBothLevelsAndCountsWhatItRefuses) {
  BRICK_COVERS("SSI-1");
  constexpr unsigned kEach = 40, kAll = 600;
  for (const bool level : {true, false}) {
    this->rig.reset(false);
    this->rig.encoders = [level](Tick, unsigned) { return level ? 0xFFu : 0u; };
    for (const unsigned channel : {1u, 5u}) this->rig.write(true, brick_group(channel), 0x637302);  // 12,800 cycles
    for (unsigned trigger = 0; trigger < kAll; ++trigger) {
      if (trigger % kEach == 0 && trigger / kEach < 8)
        this->rig.write(true, brick_word(1 + trigger / kEach), 0x1400 | 32);
      this->rig.nets(true, false);
      this->rig.run(3);
      this->rig.nets(true, true);
      this->rig.run(3);
    }
    for (unsigned channel = 1; channel <= 8; ++channel) {
      const unsigned taken = channel == 1 || channel == 5 ? 1 : 0;
      EXPECT_EQ(this->rig.read(true, brick_word(channel) + 1), (kAll - (channel - 1) * kEach - taken) % 256) << channel;
    }
    for (const unsigned channel : {1u, 5u}) this->rig.write(true, brick_group(channel), kFastSsi);
    this->rig.run(16'000 + 34 * 30 + kRest);  // a slow half, the rest of the frame
    this->trigger();
    this->rig.run(34 * 30 + kRest);
    for (unsigned channel = 1; channel <= 8; ++channel) {
      EXPECT_EQ(this->rig.read(false, brick_word(channel)), level ? 0xFFFFFFu : 0u) << channel;
      EXPECT_EQ(this->rig.read(false, brick_word(channel) + 1), level ? 0xFFu : 0u) << channel;
    }
  }
}

// servo-ic:11.3/7: the high part that is read belongs to the low part that was read last.
TYPED_TEST(SsiFrames, BrickHoldsTheHighPartOfAReadPosition) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  SsiEncoderParameters p;
  p.bits = 32;
  std::uint64_t position = 0x12345678;
  this->wire(7, p, position);
  this->rig.write(true, 0x3F, 0x180302);
  this->rig.write(true, brick_word(7), 0x1400 | 32);
  this->trigger();
  this->frame_over();
  EXPECT_EQ(this->rig.read(false, brick_word(7) + 1), 0u);
  EXPECT_EQ(this->rig.read(false, brick_word(7)), 0x345678u);
  this->wire(7, p, 0x9ABCDEF0);
  this->trigger();
  this->frame_over();
  EXPECT_EQ(this->rig.read(false, brick_word(7) + 1), 0x12u);
  EXPECT_EQ(this->rig.read(false, brick_word(7)), 0xBCDEF0u);
  EXPECT_EQ(this->rig.read(false, brick_word(7) + 1), 0x9Au);
}

// servo-ic:11.3/7: nothing but a read of data A moves data B: no read of another word, no write.
TYPED_TEST(SsiFrames, BrickHoldsTheHighPartThroughAllButAReadOfItsLowPart) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  SsiEncoderParameters p;
  p.bits = 32;
  this->wire(6, p, 0x12345678);
  this->rig.write(true, 0x3F, kFastSsi);
  this->rig.write(true, brick_word(6), 0x1400 | 32);
  this->trigger();
  this->frame_over();
  EXPECT_EQ(this->rig.read(false, brick_word(6)), 0x345678u);
  this->wire(6, p, 0x9ABCDEF0);
  this->trigger();
  this->frame_over();
  for (unsigned address = 0x20; address < 0x40; ++address) {
    SCOPED_TRACE(address);
    this->rig.read(true, address);
    if (address != brick_word(6)) this->rig.read(false, address);
    this->rig.write(false, address, 0);
    EXPECT_EQ(this->rig.read(false, brick_word(6) + 1), 0x12u);
  }
  this->rig.write(true, brick_word(6), 0x1400 | 32);
  EXPECT_EQ(this->rig.read(false, brick_word(6) + 1), 0x12u);
  EXPECT_EQ(this->rig.read(false, brick_word(6)), 0xBCDEF0u);
  EXPECT_EQ(this->rig.read(false, brick_word(6) + 1), 0x9Au);
}

// servo-ic:11.3/1: behind a frame, too, there is nothing but the words of the table, each of its own group. The lines
// are high: 32 ones and a one of even parity, which is an error.
TYPED_TEST(SsiFrames, BrickShowsAFrameInItsWordsAndNowhereElse) {
  BRICK_COVERS("SSI-1");
  constexpr std::uint32_t kTiming[] = {kFastSsi, 0x180102};  // SERVO falls, PHASE falls
  constexpr unsigned kRefused[] = {3, 5};
  this->rig.reset(false);
  for (unsigned n = 1; n <= 8; ++n) {
    this->rig.write(true, brick_group(n), kTiming[(n - 1) / 4]);
    this->rig.write(true, brick_word(n), 2u << 14 | 0x1400 | 32);
  }
  for (unsigned refused = 0; refused <= 5; ++refused) {  // the first is taken
    this->rig.nets(false, refused > kRefused[0]);
    this->rig.run(3);
    this->rig.nets(true, true);
    this->rig.run(3);
  }
  this->rig.run(40 * 30 + kRest);
  for (unsigned address = 0; address < 64; ++address) {
    SCOPED_TRACE(address);
    const bool here = address >= 0x20;
    const unsigned group = address >= 0x30 ? 1 : 0, word = address % 4;
    const std::uint32_t y = word == 0 ? 0xFFFFFF : word == 1 ? 0x8000FF : 0;  // data A, then data B
    const std::uint32_t x = word == 0 ? 0x9020 : word == 1 ? kRefused[group] : address % 16 == 15 ? kTiming[group] : 0;
    EXPECT_EQ(this->rig.read(false, address), here ? y : 0u);
    EXPECT_EQ(this->rig.read(true, address), here ? x : 0u);
  }
}

// servo-ic:11.4/5: what is not listed reads 0.
TYPED_TEST(SsiFrames, GeoShowsAFrameInItsWordsAndNowhereElse) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(true);
  this->rig.write(true, kGeoClock, 3);
  for (const unsigned result : kGeoResult) this->rig.write(true, result, 0xE);
  for (int triggers = 0; triggers < 4; ++triggers, this->rig.run(3)) this->trigger();
  this->rig.run(25 * 96 + kRest);
  for (unsigned address = 0; address < 64; ++address) {
    SCOPED_TRACE(address);
    const bool result = address == kGeoResult[0] || address == kGeoResult[1];
    const bool refused = address == kGeoRefused[0] || address == kGeoRefused[1];
    EXPECT_EQ(this->rig.read(false, address), result ? 0xFFFFFFu : 0u);
    EXPECT_EQ(this->rig.read(true, address), result ? 0xEu : refused ? 3u : address == kGeoClock ? 3u : 0u);
  }
}

// servo-ic:11.9/2: at 96 ticks a period a line may be late by 93; by 94 each bit is read as the one before.
TYPED_TEST(SsiFrames, ALineMayBeLateByAPeriodLessThreeTicks) {
  BRICK_COVERS("SSI-1");
  for (const Tick delay : {0, 48, 93, 94}) {
    this->rig.encoders = nullptr;
    this->rig.reset(true);
    SsiEncoderParameters p;
    p.delay = delay;
    this->wire(1, p, 0x2A5A5A);
    this->rig.write(true, kGeoClock, 3);
    this->rig.write(true, kGeoResult[0], 0xE);
    this->trigger();
    this->frame_over();
    EXPECT_EQ(this->rig.read(false, kGeoResult[0]), delay == 94 ? 0x800000u | 0x2A5A5A >> 1 : 0x2A5A5Au) << delay;
  }
}

// The result stands until one edge after the last rise, and then is the next as a whole.
TYPED_TEST(SsiFrames, TheResultIsLoadedOneTickAfterTheLastRise) {
  BRICK_COVERS("SSI-1");
  for (Tick place = 0; place < 3; ++place) {  // of the trigger between edges of clk_ref
    this->rig.encoders = nullptr;
    this->rig.reset(true);
    this->wire(1, {}, 0xFFFFFF);
    this->rig.write(true, kGeoClock, 3);
    this->rig.write(true, kGeoResult[0], 0xE);
    this->rig.run(place);
    const Tick loaded = this->trigger() + (2 * 24 + 1) * 48 + 1;
    const Tick last = loaded / 3 * 3;  // edge of clk_ref that sees the old one
    this->rig.run(last - 3 - this->rig.now());
    EXPECT_EQ(this->rig.read(false, kGeoResult[0]), 0u) << place;
    EXPECT_EQ(this->rig.read(false, kGeoResult[0]), 0xFFFFFFu) << place;
  }
}

}  // namespace
}  // namespace brick
