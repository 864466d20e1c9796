// The SSI encoder of the plant, by its two wires alone: what it shows after each edge of a clock of 100 ticks.
#include "testbench/plant/ssi_encoder.h"

#include <gtest/gtest.h>

#include <string>

namespace brick::plant {
namespace {

using Parity = SsiEncoderParameters::Parity;

class Wires {
 public:
  explicit Wires(const SsiEncoderParameters& p, std::uint64_t seed = 1) : encoder(p, seed, 1) {}

  // Levels at the falls that follow the rises, one for each clock.
  std::string clocks(int n, std::uint64_t position) {
    std::string seen;
    for (int i = 0; i < n; ++i) {
      encoder.clock(now, false, position);
      now += 50;
      encoder.clock(now, true, position + 1);  // it has moved on
      now += 49;
      seen += encoder.level(now) ? '1' : '0';
      now += 1;
    }
    return seen;
  }
  SsiEncoder encoder;
  Tick now = 1000;
};

SsiEncoderParameters of(unsigned bits) {
  SsiEncoderParameters p;
  p.bits = bits;
  return p;
}

TEST(SsiEncoder, HoldsAtTheFirstFallAndSendsTheHighestBitFirst) {
  Wires w(of(6));
  EXPECT_TRUE(w.encoder.level(w.now));
  EXPECT_EQ(w.clocks(6, 0b101100), "101100");
  EXPECT_EQ(w.encoder.held(), 0b101100u);
}

TEST(SsiEncoder, IsLowAfterTheLastBitUntilTheMonoflopEnds) {
  Wires w(of(4));
  EXPECT_EQ(w.clocks(7, 0b1111), "1111000");
  const Tick rise = w.now - 50;
  EXPECT_FALSE(w.encoder.level(rise + 2358));
  EXPECT_TRUE(w.encoder.level(rise + 2359));
}

TEST(SsiEncoder, RepeatsTheWordWithinTheMonoflopTime) {
  Wires w(of(4));
  EXPECT_EQ(w.clocks(5, 0b1001), "10010");
  w.now += 1000;
  EXPECT_EQ(w.clocks(5, 0b0110), "10010");
  w.now += 3000;
  EXPECT_EQ(w.clocks(5, 0b0110), "01100");
}

TEST(SsiEncoder, SendsGrayCode) {
  SsiEncoderParameters p = of(4);
  p.gray = true;
  const std::string codes[] = {"0000", "0001", "0011", "0010", "0110", "0111", "0101", "0100"};
  for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(Wires(p).clocks(4, i), codes[i]);
}

TEST(SsiEncoder, AddsParity) {
  SsiEncoderParameters p = of(4);
  p.parity = Parity::kOdd;
  EXPECT_EQ(Wires(p).clocks(5, 0b1011), "10110");
  EXPECT_EQ(Wires(p).clocks(5, 0b1010), "10101");
  p.parity = Parity::kEven;
  EXPECT_EQ(Wires(p).clocks(5, 0b1011), "10111");
}

TEST(SsiEncoder, IsLateByItsDelay) {
  SsiEncoderParameters p = of(4);
  p.delay = 20;
  Wires w(p);
  w.encoder.clock(1000, false, 0);
  w.encoder.clock(1050, true, 0);
  EXPECT_TRUE(w.encoder.level(1069));
  EXPECT_EQ(w.encoder.next_change(), 1070);
  EXPECT_FALSE(w.encoder.level(1070));
}

TEST(SsiEncoder, IsOneWhereThereIsNone) {
  SsiEncoderParameters p = of(4);
  p.missing = true;
  EXPECT_EQ(Wires(p).clocks(6, 0), "111111");
}

TEST(SsiEncoder, SpoilsOneBitOfSomeWords) {
  SsiEncoderParameters p = of(24);
  p.error_every = 3;
  Wires w(p, 7);
  int spoilt = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string seen = w.clocks(24, 0);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), '1'), w.encoder.spoilt() ? 1 : 0);
    spoilt += w.encoder.spoilt() ? 1 : 0;
    w.now += 3000;
  }
  EXPECT_NEAR(spoilt, 100, 40);  // seven standard deviations
}

}  // namespace
}  // namespace brick::plant
