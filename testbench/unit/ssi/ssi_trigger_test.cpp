// When frames begin and when not, on both engines: edges, delays, refused triggers, single frames, and what words do
// that are written in a frame.
#include "testbench/unit/covers.h"
#include "testbench/unit/ssi/ssi_fixture.h"

namespace brick {
namespace {

template <class Rig>
class SsiTriggers : public SsiOn<Rig> {};
TYPED_TEST_SUITE(SsiTriggers, SsiEngines, SsiNames);

constexpr std::uint32_t kFast = 0x180302;  // 4 MHz, falling SERVO: bits 9, 8

TYPED_TEST(SsiTriggers, BrickTriggersOnEveryEdgeAfterEveryDelay) {
  BRICK_COVERS("SSI-1");
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

// Both channels share the trigger: the shorter word waits for the longer (servo-ic:11.9/6).
TYPED_TEST(SsiTriggers, TriggersAreRefusedUntilTheClockHasRested) {
  BRICK_COVERS("SSI-1");
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

TYPED_TEST(SsiTriggers, BrickTakesOneShotOnly) {
  BRICK_COVERS("SSI-1");
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
  EXPECT_EQ(this->rig.read(true, brick_word(2)), 0x2000u | 24) << "the second as the first";
  this->frame_over();
  EXPECT_EQ(this->edges.size(), 100u);
}

// Bit 12 is there up to the edge of clk_ref that clears it (servo-ic:11.3/5): a second fall of SERVO that this edge or
// one before finds is refused, one that the next edge finds is none of the channel's.
TYPED_TEST(SsiTriggers, BrickCountsNoTriggerBehindTheOneShot) {
  BRICK_COVERS("SSI-1");
  for (Tick phase = 0; phase < 2 * kTicksPerRef; ++phase)
    for (const Tick later : {2, 3, 4}) {
      SCOPED_TRACE(::testing::Message() << phase << ", " << later << " later");
      this->rig.reset(false);
      this->rig.write(true, 0x2F, 0x180302);
      this->rig.write(true, brick_word(2), 0x3400 | 24);
      this->rig.run(30 + phase);
      const Tick first = this->rig.now() + 1, clears = (first / kTicksPerRef + 1) * kTicksPerRef;
      this->rig.nets(true, false);
      this->rig.run(later - 1);
      this->rig.nets(true, true);
      this->rig.run(1);
      this->rig.nets(true, false);
      this->rig.run(20);
      EXPECT_EQ(regs::ssi_brick::refused::kCount.get(this->rig.read(true, brick_word(2) + 1)),
                first + later <= clears ? 1u : 0u);
    }
}

TYPED_TEST(SsiTriggers, BrickIsSilentWithoutProtocolEnableOrDriver) {
  BRICK_COVERS("SSI-1");
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

TYPED_TEST(SsiTriggers, GeoModesZeroAndOneLeaveTheClockHigh) {
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

// What a channel has refused is counted modulo 256, and only while it is enabled (servo-ic:11.9/6).
TYPED_TEST(SsiTriggers, RefusedOnesAreCountedModulo256) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(true);
  this->wire(1, {}, 0);
  this->rig.write(true, kGeoClock, 0);
  this->rig.write(true, kGeoResult[0], 0xE);
  this->trigger();
  for (int i = 0; i < 200; ++i) {
    this->rig.run(3);
    this->trigger();
  }
  EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 200u);
  EXPECT_EQ(this->rig.read(true, kGeoRefused[1]), 0u);
  this->rig.write(true, kGeoResult[1], 0xE);
  for (int i = 0; i < 100; ++i) {
    this->rig.run(3);
    this->trigger();
  }
  EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 300u - 256u);
  EXPECT_EQ(this->rig.read(true, kGeoRefused[1]), 100u);
  this->frame_over();
  EXPECT_EQ(this->edges.size(), 50u);
  this->trigger();
  EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 300u - 256u) << "a trigger that is taken leaves the count";
}

TYPED_TEST(SsiTriggers, OfAnotherProtocolAreNeitherTakenNorRefused) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->wire(1, {}, 0x5A5A5A);
  this->rig.write(true, 0x2F, kFast);
  this->rig.write(true, brick_word(1), 0x1400 | 24);
  this->trigger();
  for (const unsigned protocol : {0u, 1u, 3u, 6u, 10u, 11u}) {
    this->rig.write(true, 0x2F, (kFast & ~0xFu) | protocol);
    this->trigger();
  }
  this->frame_over();
  EXPECT_EQ(this->edges.size(), 50u) << "the frame that had begun";
  EXPECT_EQ(this->rig.read(false, brick_word(1)), 0x5A5A5Au);
  this->trigger();
  this->rig.run(500);
  EXPECT_EQ(this->edges.size(), 50u);
  EXPECT_EQ(this->rig.read(true, brick_word(1) + 1), 0u);
}

// A trigger that no channel waits for begins nothing, so the next one is not refused.
TYPED_TEST(SsiTriggers, WithoutAnEnabledChannelLeaveTheGroupIdle) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->wire(3, {}, 0x123456);
  this->rig.write(true, 0x2F, kFast);
  this->rig.write(true, brick_word(3), 0x0400 | 24);
  this->trigger();
  this->rig.write(true, brick_word(3), 0x1400 | 24);
  const Tick seen = this->trigger();
  ASSERT_FALSE(this->edges.empty());
  EXPECT_EQ(this->edges[0], seen);
  EXPECT_EQ(this->rig.read(true, brick_word(3) + 1), 0u);
}

// The groups have their own: one at work refuses nothing for the other.
TYPED_TEST(SsiTriggers, OfOneGroupAreNothingToTheOther) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->wire(8, {}, 0xC0FFEE);
  this->rig.write(true, 0x2F, 0x630202);  // PHASE would be bit 9 = 0: SERVO rises, 1 MHz
  this->rig.write(true, 0x3F, 0x180102);  // PHASE falls, 4 MHz
  this->rig.write(true, brick_word(2), 0x1400 | 32);
  this->rig.write(true, brick_word(8), 0x1400 | 24);
  this->rig.nets(true, false);
  this->rig.run(5);
  this->rig.nets(true, true);
  this->rig.run(100);
  EXPECT_TRUE(this->edges.empty());
  const Tick seen = this->rig.now() + 1;
  this->rig.nets(false, true);
  this->rig.run(5);
  this->rig.nets(true, true);
  this->rig.run(1);
  ASSERT_FALSE(this->edges.empty());
  EXPECT_EQ(this->edges[0], seen);
  EXPECT_EQ(this->rig.read(true, brick_word(2) + 1), 0u);
  EXPECT_EQ(this->rig.read(true, brick_word(8) + 1), 0u);
  this->rig.nets(false, true);
  this->rig.run(5);
  EXPECT_EQ(this->rig.read(true, brick_word(2) + 1), 0u);
  EXPECT_EQ(this->rig.read(true, brick_word(8) + 1), 1u);
}

// servo-ic:11.3/5: a word that is written at the edge that sees the trigger of a single frame (place 2), or at the edge
// of clk_ref that would end its enable, stands. The frame is that of the word before; a next one follows, and with a
// continuous word one more. So it is for the first single frame of a channel and for the second.
TYPED_TEST(SsiTriggers, AWriteStandsAgainstTheEndOfASingleFrame) {
  BRICK_COVERS("SSI-1");
  for (const bool single : {true, false})
    for (Tick place = 0; place < 6; ++place) {  // the last three behind a single frame
      SCOPED_TRACE(::testing::Message() << (single ? "single, place " : "continuous, place ") << place);
      const std::uint32_t word = (single ? 0x3000u : 0x1000u) | 13;
      this->rig.encoders = nullptr;
      this->rig.reset(false);
      this->wire(2, {}, 0);
      this->rig.write(true, 0x2F, kFast);
      this->rig.write(true, brick_word(2), 0x3400 | 12);
      if (place >= 3) {
        this->trigger();
        this->frame_over();
        this->rig.write(true, brick_word(2), 0x3400 | 12);
        this->edges.clear();
      }
      this->rig.run(place % 3);
      this->rig.begin({true, true, brick_word(2), word | 0x0400});
      this->trigger();
      EXPECT_EQ(this->rig.read(true, brick_word(2)), word);
      this->frame_over();
      EXPECT_EQ(this->edges.size(), 26u) << "of 12 bits";
      this->trigger();
      EXPECT_EQ(this->rig.read(true, brick_word(2)), single ? 0x2000u | 13 : word);
      this->frame_over();
      EXPECT_EQ(this->edges.size(), 26u + 28u);
      this->trigger();
      this->frame_over();
      EXPECT_EQ(this->edges.size(), 26u + (single ? 28u : 2 * 28u));
    }
}

// servo-ic:11.9/7: what is written in a frame. Enable and number of bits wait for the next trigger.
TYPED_TEST(SsiTriggers, AFrameEndsAsItBeganThoughItsChannelIsDisabled) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->wire(4, {}, 0x89ABCD);
  this->rig.write(true, 0x2F, kFast);
  this->rig.write(true, brick_word(4), 0x1400 | 24);
  this->trigger();
  this->rig.run(200);
  this->rig.write(true, brick_word(4), 0x0400 | 12);
  this->frame_over();
  EXPECT_EQ(this->edges.size(), 50u);
  EXPECT_EQ(this->rig.read(false, brick_word(4)), 0x89ABCDu);
  this->trigger();
  this->rig.run(500);
  EXPECT_EQ(this->edges.size(), 50u);
}

// A Geo PMAC's word has no driver bit, and its mode is enable and code in one: off in a frame, with another length, it
// changes nothing of that frame. Nor does what is off for a part of it only.
TYPED_TEST(SsiTriggers, AGeoFrameEndsAsItBeganThoughItsChannelIsSwitchedOff) {
  BRICK_COVERS("SSI-1");
  for (const unsigned mode : {2u, 3u})
    for (const unsigned off : {0u, 1u})
      for (const bool on_again : {false, true}) {
        SCOPED_TRACE(::testing::Message() << mode << " then " << off << (on_again ? ", on again" : ""));
        this->rig.encoders = nullptr;
        this->rig.reset(true);
        SsiEncoderParameters p;
        p.bits = 20;
        p.gray = mode == 3;
        this->wire(2, p, 0x9C6B5);
        this->rig.write(true, kGeoClock, 3);
        this->rig.write(true, kGeoResult[1], 2u << 2 | mode);
        const Tick seen = this->trigger();
        this->rig.run(seen + 6 * 96 + 20 - this->rig.now());
        this->rig.write(true, kGeoResult[1], 3u << 2 | off);
        EXPECT_EQ(this->rig.read(true, kGeoResult[1]), 3u << 2 | off);
        this->rig.run(5 * 96);
        if (on_again) this->rig.write(true, kGeoResult[1], 2u << 2 | mode);
        this->frame_over();
        ASSERT_EQ(this->edges.size(), 2u * 21);
        for (Tick i = 0; i < 42; ++i) ASSERT_EQ(this->edges[static_cast<std::size_t>(i)], seen + i * 48) << i;
        EXPECT_EQ(this->rig.read(false, kGeoResult[1]), 0x9C6B5u);
        this->trigger();
        this->frame_over();
        EXPECT_EQ(this->edges.size(), on_again ? 2u * 42 : 2u * 21);
      }
}

// The driver acts at the next fall, and a pulse that has begun is never cut.
TYPED_TEST(SsiTriggers, TheDriverActsAtOnceAndCutsNoPulse) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(false);
  this->wire(1, {}, 0);
  this->rig.write(true, 0x2F, 0x630302);  // falls 0, 118, 236, 354, 472 ticks after the trigger, rises 59 later
  this->rig.write(true, brick_word(1), 0x1400 | 12);
  const Tick seen = this->trigger();
  this->rig.run(seen + 120 - this->rig.now());  // low
  this->rig.write(true, brick_word(1), 0x1000 | 12);
  this->rig.run(seen + 360 - this->rig.now());
  EXPECT_EQ(this->edges, (std::vector<Tick>{seen, seen + 59, seen + 118, seen + 177}));
  this->rig.write(true, brick_word(1), 0x1400 | 12);
  this->rig.run(seen + 480 - this->rig.now());
  ASSERT_EQ(this->edges.size(), 5u);
  EXPECT_EQ(this->edges[4], seen + 472);
}

// Parity and Gray act at once: the number of clocks stands, and the last is parity if it is asked for by then. Of the
// 13 bits that the encoder sends, 101101 0011101, six have been taken when the word is written.
TYPED_TEST(SsiTriggers, ParityAndGrayActAtOnceOnANumberOfClocksThatStands) {
  BRICK_COVERS("SSI-1");
  constexpr unsigned kOdd = 1u << 14, kGray = 1u << 11;
  struct Case {
    unsigned before, after;
    std::uint32_t result;
    unsigned clocks;
  };
  for (const Case c : {Case{0, kOdd, 0b101101'00111, 13},
                       {kOdd, 0, 0b101101'0011101, 14},
                       {0, kGray, 0b101101'110100, 13},  // 1 ^ 0, 1 ^ 0, 1 ^ 1, 0 ^ 1, 1 ^ 1, 0 ^ 0
                       {kGray, 0, 0b110110'001110, 13}}) {
    SCOPED_TRACE(::testing::Message() << std::hex << c.before << " then " << c.after);
    this->rig.encoders = nullptr;
    this->rig.reset(false);
    SsiEncoderParameters p;
    p.bits = 13;
    this->wire(1, p, 0b101101'0011101);
    this->rig.write(true, 0x2F, 0x630302);
    this->rig.write(true, brick_word(1), c.before | 0x1400 | 12);
    const Tick seen = this->trigger();
    this->rig.run(seen + 7 * 118 - this->rig.now());  // the seventh rise was at 6 x 118 + 59
    this->rig.write(true, brick_word(1), c.after | 0x1400 | 12);
    this->frame_over();
    EXPECT_EQ(this->edges.size(), 2 * c.clocks);
    EXPECT_EQ(this->rig.read(false, brick_word(1)), c.result);
  }
}

// servo-ic:11.9/9: a reset in a frame lets the clock up at once; nothing of the frame is left.
TYPED_TEST(SsiTriggers, AResetInAFrameLetsTheClockUpAndTheGroupIdle) {
  BRICK_COVERS("SSI-1");
  this->rig.reset(true);
  this->wire(1, {}, 0xFFFFFF);
  for (int i = 0; i < 2; ++i) {
    this->rig.write(true, kGeoClock, 3);
    this->rig.write(true, kGeoResult[0], 0xE);
    const Tick seen = this->trigger();
    this->rig.run(seen + 20 * 96 + 20 - this->rig.now());
    EXPECT_EQ(this->edges.size(), 41u);
    EXPECT_EQ(this->rig.clk() & 1, 0u);
    this->rig.reset(true);
    EXPECT_EQ(this->rig.clk(), 0xFFu);
    this->rig.run(3000);
    EXPECT_EQ(this->edges.size(), 42u);
    EXPECT_EQ(this->rig.read(true, kGeoResult[0]), 0u);
    EXPECT_EQ(this->rig.read(false, kGeoResult[0]), 0u);
    EXPECT_EQ(this->rig.read(true, kGeoRefused[0]), 0u);
    this->edges.clear();
  }
}
// Cycle n of 100 MHz ends at the first tick not before n x 18432/15625 (servo-ic:11.3/3), 2^23 of them, too.
TEST(SsiModel, TheLongestDelayEndsAtItsTick) {
  for (const Tick divisor : {255, 254}) {
    Ssi ssi(sc_core::sc_gen_unique_name("ssi"));
    ssi.geo = false;
    ssi.phase = ssi.servo = true;
    ssi.data = 0xFF;
    ssi.reset(0);
    ssi.write(true, 0x2F, static_cast<std::uint32_t>(divisor) << 16 | 15 << 12 | 0x312);
    ssi.write(true, brick_word(1), 0x1400 | 12);
    ssi.advance(3);
    ssi.servo = false;
    ssi.advance(4);
    const Tick fall = 4 + (((divisor + 1) << 15) * 18432 + 15624) / 15625;
    EXPECT_EQ(ssi.next_event(), fall);
    ssi.advance(fall - 1);
    EXPECT_EQ(ssi.clk(), 0xFFu);
    ssi.advance(fall);
    EXPECT_EQ(ssi.clk(), 0xFEu);
  }
}

// What the model costs: it asks for the edges of the serial clock and for none else, neither for nets that move while
// no channel waits, nor for refused triggers, the rest, the end of a frame.
TEST(SsiModel, WakesForTheEdgesOfFramesOnly) {
  SsiBench<ModelSsiRig> rig;
  rig.reset(true);
  rig.write(true, kGeoClock, 3);
  for (int i = 0; i < 100; ++i) {
    rig.run(500);
    rig.trigger();
  }
  EXPECT_EQ(rig.woken(), 0);
  rig.write(true, kGeoResult[0], 0xE);
  rig.write(true, kGeoResult[1], 0x2);
  for (int frame = 1; frame <= 10; ++frame) {
    rig.trigger();
    for (int i = 0; i < 9; ++i) {
      rig.run(470);
      rig.trigger();
    }
    rig.run(500);
    EXPECT_EQ(rig.woken(), 50 * frame);
  }
}

}  // namespace
}  // namespace brick
