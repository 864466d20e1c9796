// Frames of both products with an encoder at the wires, the same expectations on both engines. Edges of the clock are
// compared with arithmetic on servo-ic:11.3 and servo-ic:11.4, results with the position that the encoder had.
#include <gtest/gtest.h>

#include <vector>

#include "testbench/plant/ssi_encoder.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/ssi/ssi_rig.h"

namespace brick {
namespace {

using plant::SsiEncoder;
using plant::SsiEncoderParameters;
using Parity = SsiEncoderParameters::Parity;

constexpr Tick kRest = 2360;  // 20 us
constexpr unsigned kGeoResult[] = {0x14, 0x34}, kGeoClock = 0x15, kGeoRefused[] = {0x16, 0x36};
constexpr unsigned brick_word(unsigned channel) { return 0x20 + 4 * (channel - 1); }
constexpr unsigned brick_group(unsigned channel) { return channel <= 4 ? 0x2F : 0x3F; }

class SsiNames {
 public:
  template <class T>
  static std::string GetName(int i) {
    return i == 0 ? "Rtl" : "Model";
  }
};

template <class Rig>
class SsiOn : public ::testing::Test {
 protected:
  // An encoder at channel n; its clock's edges are written down.
  void wire(unsigned channel, const SsiEncoderParameters& parameters, std::uint64_t position) {
    encoder.emplace(parameters, 1, 1);
    edges.clear();
    bool last = true;
    rig.encoders = [=, this_ = this](Tick now, unsigned clk) mutable {
      const bool level = (clk >> (channel - 1) & 1) != 0;
      if (level != last) {
        this_->edges.push_back(now);
        this_->encoder->clock(now, level, position);
        last = level;
      }
      const unsigned others = 0xFFu & ~(1u << (channel - 1));
      return others | (this_->encoder->level(now) ? 1u : 0u) << (channel - 1);
    };
  }
  void frame_over() {
    Tick quiet = 0;
    for (std::size_t seen = edges.size(); quiet < kRest + 20; ++quiet) {
      rig.run(1);
      if (edges.size() != seen || edges.size() % 2 != 0) quiet = 0;
      seen = edges.size();
    }
  }
  // Triggers at a fall of SERVO; returns the tick whose edge sees it.
  Tick trigger() {
    const Tick seen = rig.now() + 1;
    rig.trigger();
    return seen;
  }

  SsiBench<Rig> rig;
  std::optional<SsiEncoder> encoder;
  std::vector<Tick> edges;
};
using Engines = ::testing::Types<RtlSsiRig, ModelSsiRig>;
TYPED_TEST_SUITE(SsiOn, Engines, SsiNames);

TYPED_TEST(SsiOn, GeoReadsEveryLengthAndCodeAtEveryClock) {
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

TYPED_TEST(SsiOn, GeoModesZeroAndOneLeaveTheClockHigh) {
  BRICK_COVERS("SSI-1");
  for (unsigned mode = 0; mode < 2; ++mode) {
    this->rig.encoders = nullptr;
    this->rig.reset(true);
    this->wire(1, {}, 0x123456);
    this->rig.write(true, kGeoResult[0], 0xC | mode);
    this->trigger();
    this->rig.run(30'000);
    EXPECT_TRUE(this->edges.empty());
    EXPECT_EQ(this->rig.read(false, kGeoResult[0]), 0u);
  }
}

// Both channels share the trigger: the shorter word waits for the longer (servo-ic:11.9/6).
TYPED_TEST(SsiOn, TriggersAreRefusedUntilTheClockHasRested) {
  this->rig.reset(true);
  this->wire(1, {}, 0x777777);
  this->rig.write(true, kGeoClock, 3);
  this->rig.write(true, kGeoResult[0], 0x2);
  this->rig.write(true, kGeoResult[1], 0xE);
  const Tick seen = this->trigger(), last_rise = seen + (2 * 24 + 1) * 48;
  const auto trigger_at = [&](Tick edge) {
    this->rig.run(edge - 1 - this->rig.now());
    this->trigger();
  };
  trigger_at(seen + 50);
  trigger_at(seen + (2 * 12 + 1) * 48 + 500);  // channel 1 has its word
  trigger_at(last_rise + kRest);
  EXPECT_EQ(this->edges.size(), 26u);
  EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 3u);
  EXPECT_EQ(this->rig.read(true, kGeoRefused[1]), 3u);
  this->frame_over();
  const Tick again = this->trigger();
  trigger_at(again + (2 * 24 + 1) * 48 + kRest + 1);
  EXPECT_EQ(this->edges.size(), 2 * 26u + 1);
  EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 3u);
}

TYPED_TEST(SsiOn, BrickReadsEveryNumberOfBitsWithParityAndGray) {
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

TYPED_TEST(SsiOn, BrickTellsAParityError) {
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

// Cycle n of 100 MHz ends at the first tick not before n x 18432/15625 (servo-ic:11.3/3).
TYPED_TEST(SsiOn, BrickDividesAHundredMegahertz) {
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

TYPED_TEST(SsiOn, BrickTriggersOnEveryEdgeAfterEveryDelay) {
  for (unsigned source = 0; source < 4; ++source) {  // bit 1 SERVO, bit 0 falling
    for (const unsigned delay : {0u, 1u, 2u, 15u}) {
      SCOPED_TRACE(::testing::Message() << source << " delay " << delay);
      const bool servo = (source & 2) != 0, falling = (source & 1) != 0;
      this->rig.encoders = nullptr;
      this->rig.reset(false);
      this->rig.nets(servo || falling, !servo || falling);
      this->rig.run(5);
      this->wire(1, {}, 0);
      this->rig.write(true, 0x2F, 0x180002 | source << 8 | delay << 4);
      this->rig.write(true, brick_word(1), 0x1400 | 12);
      this->rig.nets(servo != falling, true);  // the other net's edges of both kinds, and this one's of the other
      this->rig.nets(servo || falling, !servo || falling);
      for (int i = 0; i < 2; ++i) {
        this->rig.nets(servo ? i == 0 : falling, servo ? falling : i == 0);
        this->rig.run(9);
      }
      ASSERT_TRUE(this->edges.empty());
      const Tick seen = this->rig.now() + 1;
      this->rig.nets(servo ? false : !falling, servo ? !falling : false);
      this->rig.run(1000);
      ASSERT_FALSE(this->edges.empty());
      EXPECT_EQ(this->edges[0], seen + (Tick{delay} * 25 * 18432 + 15624) / 15625);
    }
  }
}

TYPED_TEST(SsiOn, BrickTakesOneShotOnly) {
  this->rig.reset(false);
  this->wire(2, {}, 0xABCDEF);
  this->rig.write(true, 0x2F, 0x180302);
  this->rig.write(true, brick_word(2), 0x3400 | 24);
  EXPECT_EQ(this->rig.read(true, brick_word(2)), 0x3000u | 24);
  this->trigger();
  EXPECT_EQ(this->rig.read(true, brick_word(2)), 0x2000u | 24);
  this->frame_over();
  EXPECT_EQ(this->rig.read(false, brick_word(2)), 0xABCDEFu);
  this->trigger();
  this->rig.run(5000);
  EXPECT_EQ(this->edges.size(), 50u);
  EXPECT_EQ(this->rig.read(true, brick_word(2) + 1), 0u);
  this->rig.write(true, brick_word(2), 0x3400 | 24);
  this->trigger();
  this->frame_over();
  EXPECT_EQ(this->edges.size(), 100u);
}

TYPED_TEST(SsiOn, BrickIsSilentWithoutProtocolEnableOrDriver) {
  struct Case {
    unsigned group, control;
    std::uint32_t result;
  };
  for (const Case c : {Case{0x18030B, 0x1418, 0}, {0x180302, 0x0418, 0}, {0x180302, 0x1018, 0xFFFFFF}}) {  // pulled up
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    this->wire(1, {}, 0x111111);
    this->rig.write(true, 0x2F, c.group);
    this->rig.write(true, brick_word(1), c.control);
    this->trigger();
    this->rig.run(5000);
    EXPECT_TRUE(this->edges.empty());
    EXPECT_EQ(this->rig.read(false, brick_word(1)), c.result);
  }
}

// servo-ic:11.3/7: the high part that is read belongs to the low part that was read last.
TYPED_TEST(SsiOn, BrickHoldsTheHighPartOfAReadPosition) {
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

// servo-ic:11.9/2: at 96 ticks a period a line may be late by 93; by 94 each bit is read as the one before.
TYPED_TEST(SsiOn, ALineMayBeLateByAPeriodLessThreeTicks) {
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
TYPED_TEST(SsiOn, TheResultIsLoadedOneTickAfterTheLastRise) {
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
