// What makes the trigger of a capture, and what a read does to it: index with gate and inversion, CAPT_GI, hall edges,
// the edge at which capture and read meet; and the loss of the encoder (servo-ic:5.8, servo-ic:5.9, servo-ic:5.15).
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelIndexTest : public ChannelTest {
 protected:
  void pins(unsigned levels) {  // of channel 1
    rig_.in.pins[0] = levels;
    rig_.ticks(kHold);
  }
  // From one set of levels to another with the trigger armed in between: whether that captures.
  bool captures(std::uint32_t word, unsigned from, unsigned to) {
    control(1, word);
    pins(from);
    arm();
    EXPECT_FALSE(status(1, status_bit::kCaptured));
    pins(to);
    return bool{status(1, status_bit::kCaptured)};
  }
  void arm() {
    rig_.read(1, words::kFlagPosition);
    rig_.ticks(kHold);
  }

  static constexpr unsigned kAbc = 7;
};

// The gated index is high in one state of A and B; inverted, the whole of it is turned over: it is low there with C
// high, and high everywhere else.
TEST_F(ChannelIndexTest, InversionTurnsTheGatedIndexOverAndNotC) {
  for (const bool gate_low : {false, true}) {
    const std::uint32_t gated = kX4 | kIndex | kGated | (gate_low ? kGateLow : 0);
    const unsigned open = gate_low ? 0u : 3u;
    const auto index = [&](unsigned abc) { return (abc & 4) != 0 && (abc & 3) == open; };
    for (unsigned from = 0; from <= kAbc; ++from) {
      for (unsigned to = 0; to <= kAbc; ++to) {
        EXPECT_EQ(captures(gated, from, to), !index(from) && index(to)) << gate_low << from << to;
        EXPECT_EQ(captures(gated | kIndexInvert, from, to), index(from) && !index(to)) << gate_low << from << to;
      }
    }
  }
}

TEST_F(ChannelIndexTest, WithoutGatingTheGateStateDoesNothing) {
  for (const std::uint32_t gate : {0u, kGateLow})
    for (unsigned ab = 0; ab < 4; ++ab) {
      EXPECT_TRUE(captures(kX4 | kIndex | gate, ab, ab | 4)) << ab;
      EXPECT_TRUE(captures(kX4 | kIndex | kIndexInvert | gate, ab | 4, ab)) << ab;
    }
}

// CAPT_GI says that the index was in the term and gated, and nothing else.
TEST_F(ChannelIndexTest, CaptGiNeedsTheIndexInTheTermAndTheGate) {
  const std::uint32_t software = kX4, both = kX4 | field::kCaptureSource.at(regs::capture_source::kIndexAndFlag);
  const unsigned all = 3u | 1u << kC | 1u << kHmfl;
  struct Row {
    std::uint32_t word;
    unsigned from, to;
    bool gated_index;
  };
  for (const Row& row :
       {Row{kX4 | kIndex, 3, all, false}, Row{kX4 | kIndex | kGated, 3, all, true}, Row{both, 3, all, false},
        Row{both | kGated, 3, all, true}, Row{kX4 | kFlag, 3, all, false},
        Row{software | kGated, 3, 3 | 1u << kU, false}, Row{kX4 | kFlag | kGated, 3, 3 | 1u << kU, false}}) {
    EXPECT_TRUE(captures(row.word, row.from, row.to)) << std::hex << row.word;
    EXPECT_EQ(bool{status(1, status_bit::kCapturedGatedIndex)}, row.gated_index) << std::hex << row.word;
    arm();
    EXPECT_FALSE(status(1, status_bit::kCapturedGatedIndex)) << "cleared with CAPT";
  }
}

// With the gate on and no index in the source the hall lines fire, at either edge of each, and nothing else does.
TEST_F(ChannelIndexTest, HallEdgesFireInsteadOfSoftwareAndFlag) {
  for (const std::uint32_t source : {0u, kFlag}) {
    const std::uint32_t word = kX4 | kGated | source;
    EXPECT_FALSE(captures(word, 0, 1u << kHmfl | 1u << kC | 3)) << source;
    for (const unsigned line : {kU, kV, kW}) {
      const unsigned others = (7u << kW) & ~(1u << line);
      EXPECT_TRUE(captures(word, others, 7u << kW)) << line;
      EXPECT_EQ(status_bit::kHallCapture.get(rig_.peek(1, words::kStatus)), 7u) << "the new levels, W in bit 0";
      EXPECT_TRUE(captures(word, 7u << kW, others)) << line;
      EXPECT_EQ(status_bit::kHallCapture.get(rig_.peek(1, words::kStatus)), others >> kW);
    }
  }
  const unsigned kept = status_bit::kHallCapture.get(rig_.peek(1, words::kStatus));
  EXPECT_TRUE(captures(kX4 | kFlag, 0, 1u << kHmfl | 7u << kW));
  EXPECT_EQ(status_bit::kHallCapture.get(rig_.peek(1, words::kStatus)), kept) << "no hall edge captured this";
}

// C, U, V and W of the multiplexed line replace the pins everywhere: in the trigger too.
TEST_F(ChannelIndexTest, DemultiplexedLinesAreTheTriggersInputs) {
  const std::uint32_t index = kX4 | kIndex | kDemux, halls = kX4 | kGated | kDemux;
  pins(0);
  control(1, index);
  for (const unsigned ab : {1u, 3u, 2u, 0u}) pins(ab);  // a whole cycle with the line low
  EXPECT_FALSE(captures(index, 0, 1u << kC)) << "in 00 it is V";
  EXPECT_FALSE(captures(index, 1, 1 | 1u << kC)) << "in 10 it is U";
  EXPECT_TRUE(captures(index, 3, 3 | 1u << kC)) << "in 11 it is C";
  pins(3);
  EXPECT_TRUE(captures(halls, 2, 2 | 1u << kC)) << "in 01 it is W";
  EXPECT_FALSE(captures(halls, 2 | 1u << kC, 2 | 1u << kC | 1u << kU)) << "the pin U is out of the game";
}

// With the gate too the index is that of the 11 in which the line has it: neither the next one's, at which the trigger
// has been armed anew, nor a later SCLK edge's: the position is that of the count into the state.
TEST_F(ChannelIndexTest, TheGatedIndexOfADemultiplexedLineIsThatOfItsOwnState) {
  const std::uint32_t word = kX4 | kIndex | kGated | kDemux;
  pins(0);
  control(1, word | kCounterReset);
  control(1, word);
  for (int cycle = 0; cycle < 6; ++cycle) {
    const bool has_index = cycle % 2 == 1;
    for (const unsigned ab : {1u, 3u, 2u, 0u}) {
      pins(ab | (ab == 3 && has_index ? 1u << kC : 0));
      EXPECT_EQ(bool{status(1, status_bit::kCaptured)}, has_index && ab != 1) << cycle << ' ' << ab;
    }
    if (!has_index) continue;
    EXPECT_TRUE(status(1, status_bit::kCapturedGatedIndex));
    EXPECT_EQ(rig_.read(1, words::kFlagPosition), static_cast<std::uint32_t>(4 * cycle + 2));
  }
}

TEST_F(ChannelIndexTest, EachOfTheFourStatesCompletesTheDemultiplexing) {
  for (unsigned missing = 0; missing < 4; ++missing) {
    rig_.in.pins[0] = missing ^ 3;
    rig_.reset();
    rig_.ticks(2 * kHold);
    for (const unsigned ab : {0u, 1u, 3u, 2u, 0u, 1u})
      if (ab != missing) pins(ab);
    EXPECT_TRUE(status(1, status_bit::kDemuxInvalid)) << missing;
    pins(missing);
    EXPECT_FALSE(status(1, status_bit::kDemuxInvalid)) << missing;
  }
}

// What the line carried before a reset is gone with it: C, U, V and W are low until a state has been seen again.
TEST_F(ChannelIndexTest, AResetEmptiesTheDemultiplexedLines) {
  for (const bool line : {false, true}) {
    control(1, kX4 | kDemux);
    for (const unsigned ab : {0u, 1u, 3u, 2u, 0u}) pins(line ? ab | 1u << kC : ab);
    const std::uint32_t lines =
        status_bit::kChc.mask() | status_bit::kFlagU.mask() | status_bit::kFlagV.mask() | status_bit::kFlagW.mask();
    EXPECT_EQ(rig_.peek(1, words::kStatus) & lines, line ? lines : 0);
    rig_.reset();
    control(1, kX4 | kDemux);  // before the filter has a sample: all levels are 0, DMX_INV is 1
    EXPECT_EQ(rig_.peek(1, words::kStatus), status_bit::kDemuxInvalid.mask()) << "line " << line;
  }
}

TEST_F(ChannelIndexTest, OnlyTheReadOfTheCapturedPositionArms) {
  control(1, kX4 | kFlag);
  arm();
  pin(1, kHmfl, true);
  for (unsigned offset = 0; offset < 8; ++offset)
    for (const bool x : {false, true})
      if (offset != 3 || !x) rig_.read(x, base(1) + offset);
  for (const unsigned other : {2u, 3u, 4u}) rig_.read(other, words::kFlagPosition);
  rig_.write(1, words::kFlagPosition, 0);
  EXPECT_TRUE(status(1, status_bit::kCaptured)) << "none of these clears";
  steps(1, 5, true);
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_EQ(rig_.read(1, words::kFlagPosition), 0u) << "nor arms: the first position is still there";
  pin(1, kHmfl, false);
  pin(1, kHmfl, true);
  EXPECT_EQ(rig_.read(1, words::kFlagPosition), 5u) << "this one did";
}

// A capture at the reference edge at which the read takes its sample wins over it: CAPT stays, the trigger is not
// armed, and the read shows the old position. One edge earlier the read takes the new one, one edge later it is over.
TEST_F(ChannelIndexTest, CaptureAtTheEdgeOfTheSampleWins) {
  const auto edge_of_sclk = [&] {  // the same place in the period of SCLK each time
    while (rig_.now() % kSclk != 0) rig_.tick();
  };
  const auto prepare = [&](int position) {
    control(1, kX4 | kFlag | kCounterReset);
    control(1, kX4 | kFlag);
    pin(1, kHmfl, false);
    steps(1, position, true);
    arm();
    edge_of_sclk();
  };
  prepare(0);
  const Tick start = rig_.now();
  rig_.pin(1, kHmfl, true);
  wait_until([&] { return status(1, status_bit::kCaptured); });
  const Tick capture = rig_.now() - start;
  ASSERT_EQ(capture % kTicksPerRef, 0);

  int position = 4;  // of the capture before; the place in the cycle of A and B comes round
  for (const Tick end : {capture - kTicksPerRef, capture, capture + kTicksPerRef}) {
    SCOPED_TRACE(end - capture);
    prepare(position);
    rig_.pin(1, kHmfl, true);
    rig_.ticks(end - kTicksPerRef);
    const std::uint32_t old = rig_.peek(1, words::kFlagPosition);
    const std::uint32_t word = rig_.read(1, words::kFlagPosition);  // takes its sample at the next edge
    EXPECT_EQ(word, end <= capture ? old : static_cast<std::uint32_t>(position));
    EXPECT_EQ(bool{status(1, status_bit::kCaptured)}, end == capture) << "at its edge";
    rig_.ticks(kHold);
    EXPECT_EQ(bool{status(1, status_bit::kCaptured)}, end <= capture);
    EXPECT_EQ(rig_.peek(1, words::kFlagPosition), static_cast<std::uint32_t>(position)) << "the capture is kept";
    pin(1, kHmfl, false);
    steps(1, 4, true);
    pin(1, kHmfl, true);
    EXPECT_EQ(rig_.peek(1, words::kFlagPosition), static_cast<std::uint32_t>(end <= capture ? position : position + 4))
        << "armed only by a read that came after it";
    position += 4;
  }
}

// Which trigger is selected neither arms nor disarms.
TEST_F(ChannelIndexTest, ChangingTheTriggerNeitherArmsNorDisarms) {
  control(1, kX4 | kFlag);
  arm();
  const std::uint32_t plim = kX4 | kFlag | field::kFlagSelect.at(regs::flag_select::kPlim);
  control(1, kX4 | kIndex);
  rig_.ticks(kHold);
  control(1, plim);
  rig_.ticks(kHold);
  EXPECT_FALSE(status(1, status_bit::kCaptured));
  pin(1, kPlim, true);
  EXPECT_TRUE(status(1, status_bit::kCaptured)) << "still armed";
  steps(1, 3, true);
  control(1, kX4 | kIndex);
  rig_.ticks(kHold);
  control(1, plim);
  rig_.ticks(kHold);
  pin(1, kC, true);
  pin(1, kPlim, false);
  pin(1, kPlim, true);
  EXPECT_EQ(rig_.peek(1, words::kFlagPosition), 0u) << "not armed again";
}

// --- Encoder loss. A line and its inverse never change at the same sample, so equal levels count when they last.

class EncoderLossTest : public ChannelTest {
 protected:
  static constexpr unsigned kSound = 1u << kT | 1u << kV;  // T differs from U, V from W

  // Both lines of a pair change, the second so many samples after the first; whether that was a loss.
  bool loss(unsigned first, unsigned second, Tick samples) {
    rig_.in.pins[0] = kSound;
    rig_.ticks(kHold);
    rig_.write(1, words::kStatus, 0);
    rig_.ticks(kHold);
    EXPECT_FALSE(status(1, status_bit::kEncoderLoss));
    rig_.in.pins[0] ^= 1u << first;
    rig_.ticks(samples * kSclk);
    rig_.in.pins[0] ^= 1u << second;
    rig_.ticks(kHold);
    return bool{status(1, status_bit::kEncoderLoss)};
  }
};

TEST_F(EncoderLossTest, OneSampleOfEqualLevelsIsNoneTwoAre) {
  for (const auto& [first, second] : {std::pair<unsigned, unsigned>{kT, kU}, {kU, kT}, {kV, kW}, {kW, kV}}) {
    EXPECT_FALSE(loss(first, second, 1)) << first;
    EXPECT_TRUE(loss(first, second, 2)) << first;
    EXPECT_TRUE(loss(first, second, 3)) << first;
  }
}

// One pair in one sample and the other in the next are two samples in a row.
TEST_F(EncoderLossTest, EitherPairCountsInEachSample) {
  rig_.in.pins[0] = kSound;
  rig_.ticks(kHold);
  rig_.write(1, words::kStatus, 0);
  rig_.in.pins[0] ^= 1u << kT;
  rig_.ticks(kSclk);
  rig_.in.pins[0] ^= 1u << kU | 1u << kV;
  rig_.ticks(kSclk);
  rig_.in.pins[0] ^= 1u << kW;
  rig_.ticks(kHold);
  EXPECT_TRUE(status(1, status_bit::kEncoderLoss));
}

// Equal levels before a reset are no sample before the first one behind it: of two changes an SCLK apart, at any place
// behind the reset, one sample alone finds equal levels.
TEST_F(EncoderLossTest, SamplesBeforeAResetDoNotCount) {
  for (Tick delay = 0; delay < 2 * kHold; delay += kTicksPerRef) {
    rig_.in.pins[0] = kSound ^ 1u << kT;
    rig_.ticks(kHold);
    ASSERT_TRUE(status(1, status_bit::kEncoderLoss));
    rig_.in.pins[0] = kSound;
    rig_.reset();
    rig_.ticks(delay);
    rig_.in.pins[0] ^= 1u << kT;
    rig_.ticks(kSclk);
    rig_.in.pins[0] ^= 1u << kU;
    rig_.ticks(2 * kHold);
    EXPECT_FALSE(status(1, status_bit::kEncoderLoss)) << delay << " ticks behind the reset";
  }
}

// 0 in bit 7 clears, a 1 does not; a cause that lasts sets it again with the next SCLK. A clear at the edge of an SCLK,
// one of the four edges of its period, swallows nothing.
TEST_F(EncoderLossTest, ClearedWhileTheCauseLastsItIsBackWithTheNextSclk) {
  rig_.in.pins[0] = 1u << kV;
  rig_.ticks(kHold);
  unsigned cleared = 0;
  for (Tick phase = 0; phase < kSclk; phase += kTicksPerRef) {
    while (rig_.now() % kSclk != phase) rig_.tick();
    rig_.write(1, words::kStatus, 0xFFFFFF);
    EXPECT_TRUE(status(1, status_bit::kEncoderLoss));
    rig_.write(1, words::kStatus, 0xFFFF7F);
    cleared += !status(1, status_bit::kEncoderLoss);
    const Tick written = rig_.now();
    while (!status(1, status_bit::kEncoderLoss) && rig_.now() < written + 2 * kSclk) rig_.tick();
    EXPECT_LT(rig_.now() - written, kSclk);
  }
  EXPECT_EQ(cleared, 3u);
}

}  // namespace
}  // namespace brick
