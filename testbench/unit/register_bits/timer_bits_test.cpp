// Words whose upper bits take millions of SCLK periods: T1 and T2, and the carry of the position counter into each of
// its 24 bits. One long run an engine; every word that it reads is kept with the value it should have, and the stuck
// bits are then put into the words read. (The other words and bits are in register_bits_test.cpp.)
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "testbench/unit/register_bits/bits_rig.h"
#include "testbench/unit/register_bits/rtl_servo_channel.h"
#include "testbench/unit/servo_channel/channel_words.h"

namespace brick {
namespace {

// A step of the pins counts with the third SCLK edge after it: the second sample passes the filter, the one after it
// counts (servo-ic:5.3/2).
constexpr std::int64_t kCountsAt = 3;

// Channel 1 of either engine, one SCLK period a step.
class Channel {
 public:
  virtual ~Channel() = default;
  virtual void step(std::int64_t periods) = 0;
  virtual void pins(unsigned levels) = 0;
  virtual std::int64_t latch() = 0;             // PHASE and SERVO; returns the periods that passed until then
  virtual std::int64_t latch_edge() const = 0;  // the SCLK edge of latch() that takes what was there before it
  virtual void write(bool x, unsigned offset, std::uint32_t word) = 0;
  virtual std::uint32_t read(bool x, unsigned offset) = 0;
  virtual void read_capture() = 0;  // X:+3, with its side effect
};

class RtlChannel : public Channel {
 public:
  void step(std::int64_t periods) override { rtl_.step(periods); }
  void pins(unsigned levels) override { rtl_.pins(levels); }
  std::int64_t latch() override {
    rtl_.latch();
    return 1;
  }
  std::int64_t latch_edge() const override { return 1; }
  void write(bool x, unsigned offset, std::uint32_t word) override { rtl_.write(x, offset, word); }
  std::uint32_t read(bool x, unsigned offset) override { return rtl_.read(x, offset); }
  void read_capture() override { rtl_.read_capture(); }

 private:
  RtlServoChannel rtl_;
};

class ModelChannel : public Channel {
 public:
  ModelChannel() { rig_.start(); }
  void step(std::int64_t periods) override { rig_.run(periods * kTicksPerRef); }
  void pins(unsigned levels) override { rig_.in.pins[0] = levels; }
  std::int64_t latch() override {
    const Tick before = rig_.now();
    rig_.latch();
    return (rig_.now() - before) / kTicksPerRef;
  }
  // SERVO from outside acts at the third tick, which is a reference edge here; the one after it latches
  // (servo-ic:5.1/7).
  std::int64_t latch_edge() const override { return 2; }
  void write(bool x, unsigned offset, std::uint32_t word) override { rig_.write(x, offset, word); }
  std::uint32_t read(bool x, unsigned offset) override { return rig_.peek(x, offset); }
  void read_capture() override { rig_.read(true, 3); }

 private:
  BitsRig rig_{BitsEngine::kModel};
};

struct Reading {
  bool x;
  unsigned offset;
  std::uint32_t expected, got;
};

class LongWords : public ::testing::TestWithParam<BitsEngine> {
 protected:
  void SetUp() override {
    if (GetParam() == BitsEngine::kRtl)
      channel_ = std::make_unique<RtlChannel>();
    else
      channel_ = std::make_unique<ModelChannel>();
    channel_->step(20);
    channel_->write(true, 5, 3);
  }
  void quarter(bool up) {
    constexpr unsigned kAb[4] = {0, 1, 3, 2};
    place_ = (place_ + (up ? 1u : 3u)) & 3;
    channel_->pins(kAb[place_]);
  }
  void expect(bool x, unsigned offset, std::uint32_t value) {
    readings_.push_back({x, offset, value, channel_->read(x, offset)});
  }
  bool sound(const std::function<std::uint32_t(const Reading&)>& stuck) const {
    for (const Reading& r : readings_)
      if (stuck(r) != r.expected) return false;
    return true;
  }
  // All readings are right; each of `bits` stuck at either level makes one wrong, each of `always_0` stuck at 1.
  void check(bool x, unsigned offset, std::uint32_t bits, std::uint32_t always_0 = 0) const {
    for (unsigned bit = 0; bit < 24; ++bit) {
      for (bool level : {false, true}) {
        if ((((level ? bits | always_0 : bits) >> bit) & 1) == 0) continue;
        const StuckBit stuck{Side::kRead, x, offset, bit, level};
        EXPECT_FALSE(sound([&](const Reading& r) { return stuck.apply(Side::kRead, r.x, r.offset, r.got); }))
            << (x ? "X:+" : "Y:+") << offset << " bit " << bit << " stuck at " << level;
      }
    }
  }
  void check_readings() const {
    for (const Reading& r : readings_)
      EXPECT_EQ(r.got, r.expected) << (r.x ? "X:+" : "Y:+") << r.offset << ", expected " << std::hex << r.expected
                                   << ", read " << r.got;
  }

  std::unique_ptr<Channel> channel_;
  unsigned place_ = 0;
  std::vector<Reading> readings_;
};

// T2 is read at 2^k for every k on the way to its limit, where it stays. T1 is the distance of the counts.
TEST_P(LongWords, TimersShowEveryBitAndStayAtTheirLimit) {
  constexpr std::int64_t kLimit = 0x7FFFFF;
  Channel& c = *channel_;
  std::int64_t since = 0;  // periods since the last step of the pins
  const auto turn = [&](std::int64_t at, bool up) {
    c.step(at - since);
    since = 0;
    quarter(up);
  };
  const auto latch = [&](std::int64_t at) {
    c.step(at - since);
    since = at + c.latch();
  };
  for (const std::int64_t distance : {100, 155}) {  // no bit in common
    for (int i = 0; i < 3; ++i) turn(distance, true);
    latch(50);
    expect(false, 0, static_cast<std::uint32_t>(distance));
  }
  turn(100, false);
  const std::int64_t delay = kCountsAt - (c.latch_edge() - 1);  // of T2 = 0 after the step, less that of the latch
  latch(64 + delay);
  expect(false, 0, 0x800000 | 100);
  expect(false, 1, 64);
  for (std::int64_t t2 = 128; t2 <= kLimit; t2 *= 2) {
    latch(t2 + delay);
    expect(false, 1, static_cast<std::uint32_t>(t2));
  }
  latch(kLimit + 100);
  expect(false, 1, kLimit);
  // 4096 T2 / T1 of T1 at its limit passes 2048 where T2 is half of it; of a count down it is taken from 4095.
  c.write(true, 5, 3 | kFine);
  turn(kLimit + 200, false);
  for (const int past : {-10, 10}) {
    latch(kLimit / 2 + past + delay);
    EXPECT_EQ(fine2::kServo.get(c.read(false, 1)), 4095u - (past < 0 ? 2047 : 2048));
  }
  c.write(true, 5, 3);
  latch(kLimit / 2 + 100);
  expect(false, 0, kLimit);
  turn(kLimit / 2 + 200, false);
  turn(100, false);
  latch(50);
  expect(false, 0, 100);
  check_readings();
  check(false, 0, 0xFFFFFF);
  check(false, 1, 0x7FFFFF, 1 << 23);
}

// Up from 0 to 2^23: the carry reaches every bit. X:+1, X:+2, and X:+3 by the home flag at each power of two; then down
// by one, which borrows through all of them.
TEST_P(LongWords, PositionCountsThroughAllItsBits) {
  Channel& c = *channel_;
  const auto count = [&](std::uint32_t n, bool up) {
    while (n-- > 0) {
      quarter(up);
      c.step(1);
    }
    c.step(8);  // the filter
  };
  const auto read_all = [&](std::uint32_t position, bool down) {
    c.write(true, 5, 3);
    c.step(4);
    c.read_capture();
    c.write(true, 5, 3 | 1 << 6);  // software trigger
    c.step(4);
    c.latch();
    expect(true, 1, position);
    expect(true, 2, (position << 1 & 0xFFFFFF) | (down ? 1 : 0));
    expect(true, 3, position);
  };
  read_all(0, false);
  std::uint32_t position = 0;
  for (std::uint32_t next = 1; next <= 0x800000; next *= 2) {
    count(next - position, true);
    read_all(position = next, false);
  }
  count(1, false);
  read_all(0x7FFFFF, true);
  check_readings();
  for (unsigned offset : {1u, 2u, 3u}) check(true, offset, 0xFFFFFF);
}

INSTANTIATE_TEST_SUITE_P(Engines, LongWords, ::testing::Values(BitsEngine::kRtl, BitsEngine::kModel),
                         [](const auto& engine) { return engine.param == BitsEngine::kRtl ? "Rtl" : "Model"; });

}  // namespace
}  // namespace brick
