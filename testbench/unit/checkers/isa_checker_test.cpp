// Each rule of the host bus that has a time: kept at its limit, broken one femtosecond beyond it, and reported by its
// name and address. Cycles are counted.
#include "testbench/unit/checkers/isa_checker_fixture.h"

namespace brick {
namespace {

TEST_F(IsaCheckerTest, EachRowOfTheIoCycleHasItsLimit) {
  const auto read = [this](const Points& p) { io(p); };
  const auto write = [this](const Points& p) { iow(p); };
  expect_limit(IsaChecker::kT1, read, &Points::sa, -91 * kNs, 1);
  expect_limit(IsaChecker::kT2, read, &Points::width, 530 * kNs, -1);
  expect_limit(IsaChecker::kT3, read, &Points::release, 25 * kNs, -1);
  expect_limit(IsaChecker::kT4, read, &Points::valid, 489 * kNs, 1);
  expect_limit(IsaChecker::kT5, read, &Points::off, 0, -1);
  expect_limit(IsaChecker::kT5Off, read, &Points::off, 30 * kNs, 1);
  expect_limit(IsaChecker::kT6, write, &Points::data, 22 * kNs, 1);
  expect_limit(IsaChecker::kT7, write, &Points::data_release, 25 * kNs, -1);
  expect_limit(IsaChecker::kT11, read, &Points::next, 170 * kNs, -1, IsaChecker::kIo, [] {
    Points p;
    p.sa = -120 * kNs;
    return p;
  }());
}

TEST_F(IsaCheckerTest, EachRowOfTheMemoryCycleHasItsLimit) {
  constexpr auto kWide = IsaChecker::kMemory16;
  const auto read = [this](const Points& p) { memr(p); };
  const auto write = [this](const Points& p) { memw(p); };
  Points usual;
  usual.width = 250 * kNs;
  Points stretched = usual;
  stretched.ready_low = 70 * kNs;
  stretched.width = 400 * kNs;
  expect_limit(IsaChecker::kT8, read, &Points::ready_low, 366 * kNs, 1, kWide, [&] {
    Points p = stretched;
    p.ready_high = 500 * kNs;
    p.width = 700 * kNs;
    return p;
  }());
  expect_limit(IsaChecker::kT9, read, &Points::width, 320 * kNs, -1, kWide, stretched);
  expect_limit(IsaChecker::kT10, read, &Points::ready_high, 15'670 * kNs, 1, kWide, [&] {
    Points p = stretched;
    p.width = 16'000 * kNs;
    return p;
  }());
  expect_limit(IsaChecker::kT12, read, &Points::la, -111 * kNs, 1, kWide, usual);
  expect_limit(IsaChecker::kT13, read, &Points::width, 219 * kNs, -1, kWide, usual);
  expect_limit(IsaChecker::kT14, read, &Points::valid, 173 * kNs, 1, kWide, usual);
  expect_limit(IsaChecker::kT15, write, &Points::data_release, 25 * kNs, -1, kWide, usual);
  expect_limit(IsaChecker::kT16, read, &Points::memcs16, 66 * kNs, 1, kWide, usual);
  expect_limit(IsaChecker::kT18, read, &Points::sa, -34 * kNs, 1, kWide, usual);
}

// Rows 3, 5, 6 and 11 are those of memory cycles too, row 2 that of one of 8 bits.
TEST_F(IsaCheckerTest, RowsOfTheIoCycleHoldForMemoryToo) {
  const auto read = [this](const Points& p) { memr(p); };
  const auto write = [this](const Points& p) { memw(p); };
  Points close;
  close.sa = close.la = -120 * kNs;
  for (const auto region : {IsaChecker::kMemory16, IsaChecker::kMemory8}) {
    in_.slot8 = region == IsaChecker::kMemory8;
    show();
    expect_limit(IsaChecker::kT3, read, &Points::release, 25 * kNs, -1, region);
    expect_limit(IsaChecker::kT5Off, read, &Points::off, 30 * kNs, 1, region);
    expect_limit(IsaChecker::kT6, write, &Points::data, 22 * kNs, 1, region);
    expect_limit(IsaChecker::kT11, read, &Points::next, 170 * kNs, -1, region, close);
  }
  expect_limit(IsaChecker::kT2, read, &Points::width, 530 * kNs, -1, IsaChecker::kMemory8);
}

// Behind IOCHRDY: one BCLK to the command's end (row 9), and the host looks at the data as long before that as without
// it, t13 - t14 = 46 ns or t2 - t4 = 41 ns.
TEST_F(IsaCheckerTest, DataBehindIochrdyHaveTheirLimit) {
  Points stretched;
  stretched.ready_low = 70 * kNs;
  stretched.ready_high = 700 * kNs;
  stretched.width = 1000 * kNs;
  expect_limit(
      IsaChecker::kT14, [this](const Points& p) { memr(p); }, &Points::valid, (700 + 120 - 46) * kNs, 1,
      IsaChecker::kMemory16, stretched);
  in_.slot8 = true;
  expect_limit(
      IsaChecker::kT4, [this](const Points& p) { memr(p); }, &Points::valid, (700 + 120 - 41) * kNs, 1,
      IsaChecker::kMemory8, stretched);
  in_.slot8 = false;
  stretched.ready_high = 80 * kNs;  // the row itself is the later one
  expect_limit(
      IsaChecker::kT14, [this](const Points& p) { memr(p); }, &Points::valid, 173 * kNs, 1, IsaChecker::kMemory16,
      stretched);
}

// MEMCS16# also follows switches and resets, and SA in a slot of 8 bits: row 16 is about LA alone.
TEST_F(IsaCheckerTest, Row16IsJudgedForMovesOfLaToTheWindow) {
  const auto select = [this](TimeFs t, unsigned level) { at(t, [=] { out_.set(pin::kIsaMemcs16N, level); }); };
  const std::vector<std::function<void()>> others{
      [this] { in_.window ^= 8; }, [this] { in_.slot8 = !in_.slot8; }, [this] { in_.rst_n = !in_.rst_n; },
      [this] { in_.isa_resetdrv = !in_.isa_resetdrv; }, [this] { in_.isa_sa ^= 0x20000; }};
  at(1000 * kNs, [this] { in_.isa_la = 6; });
  select(1030 * kNs, 0);
  play();
  const auto evaluations = [this] {
    return checker_.ledger().row(IsaChecker::kT16, IsaChecker::kMemory16).evaluations;
  };
  ASSERT_EQ(evaluations(), 1u);
  for (const auto& other : others) {  // away and back, with LA as it was
    for (const unsigned level : {1u, 0u}) {
      at(now_ + 5000 * kNs, other);
      select(now_ + 5100 * kNs, level);
      play();
    }
  }
  EXPECT_EQ(evaluations(), 1u);

  select(now_ + 1000 * kNs, 1);
  at(now_ + 1000 * kNs, [this] { in_.isa_la = 7; });
  at(now_ + 2000 * kNs, [this] { in_.isa_la = 6; });
  at(now_ + 2040 * kNs, [this] { in_.isa_la = 7; });  // too short for it
  at(now_ + 3000 * kNs, [this] { in_.isa_la = 6; });
  play();
  EXPECT_THAT(broken(), ::testing::IsEmpty());
  at(now_ + 200 * kNs, [this] { in_.isa_memr_n = false; });  // it never came
  play();
  ASSERT_EQ(broken(), std::vector<std::string>{"t16"});
  EXPECT_EQ(timing_address(checker_.ledger().violations()[0].where), "memory 0x0C0000");
}

// host-bus:3.3 at 80 MHz: TC is 12.5 ns, so read strobes are low for 17.45 ns, 34.55 ns apart after a slow byte.
TEST_F(IsaCheckerTest, StrobesOfTheHostPortHaveTheirLimits) {
  const auto only = [this](Rule rule, const auto& run, TimeFs Points::*point, TimeFs limit) {
    for (const TimeFs less : {TimeFs{0}, TimeFs{1}}) {
      checker_.ledger().forget();
      Points p;
      p.sa = p.la = -1;
      p.data = -1;
      p.release = p.data_release = 1;
      p.*point = limit - less;
      run(p);
      EXPECT_EQ(checker_.ledger().row(rule, IsaChecker::kIo).margin, -less) << checker_.ledger().rules()[rule].id;
    }
  };
  only(
      IsaChecker::kH1, [this](const Points& p) { io(p); }, &Points::width, 17'450'000);
  io({}, 0x215);
  only(
      IsaChecker::kH2, [this](const Points& p) { io(p, 0x215); }, &Points::next, 4'950'000);
  io({}, 0x217);
  only(
      IsaChecker::kH3, [this](const Points& p) { io(p, 0x212); }, &Points::next, 34'550'000);
  only(
      IsaChecker::kH4, [this](const Points& p) { iow(p); }, &Points::width, 6'600'000);
  iow({}, 0x217);
  only(
      IsaChecker::kH5, [this](const Points& p) { iow(p, 0x217); }, &Points::next, 34'550'000);
  iow({}, 0x215);
  only(
      IsaChecker::kH6, [this](const Points& p) { iow(p, 0x215); }, &Points::next, 8'250'000);
  checker_.set_cpu_period([] { return TimeFs{6'250'000}; });
  only(
      IsaChecker::kH1, [this](const Points& p) { io(p); }, &Points::width, 11'200'000);
}

// host-bus:3.3, rows 3, 5 and 6: after which byte, before which one.
TEST_F(IsaCheckerTest, BytesOfTheHostPortHaveTheirDistances) {
  const auto evaluated = [this](Rule rule) { return checker_.ledger().row(rule, IsaChecker::kIo).evaluations; };
  for (std::uint32_t first = 0; first < 8; ++first)
    for (std::uint32_t second = 0; second < 8; ++second) {
      SCOPED_TRACE(::testing::Message() << "+" << first << ", then +" << second);
      const auto is = [](std::uint32_t byte, const std::vector<std::uint32_t>& bytes) {
        return std::find(bytes.begin(), bytes.end(), byte) != bytes.end();
      };
      io({}, 0x210 + first);
      checker_.ledger().forget();
      io({}, 0x210 + second);
      EXPECT_EQ(evaluated(IsaChecker::kH2), 1u);
      EXPECT_EQ(evaluated(IsaChecker::kH3), is(first, {0, 1, 2, 7}) && is(second, {0, 1, 2, 7}) ? 1u : 0u);
      iow({}, 0x210 + first);
      checker_.ledger().forget();
      iow({}, 0x210 + second);
      EXPECT_EQ(evaluated(IsaChecker::kH5), is(first, {0, 1, 7}) ? 1u : 0u);
      EXPECT_EQ(evaluated(IsaChecker::kH6), is(first, {0, 1, 7}) ? 0u : 1u);
    }
  checker_.ledger().forget();
  for (const std::uint32_t other : {0x218u, 0x21Fu, 0x222u, 0x227u}) io({}, other), iow({}, other);
  for (const Rule rule :
       {IsaChecker::kH1, IsaChecker::kH2, IsaChecker::kH3, IsaChecker::kH4, IsaChecker::kH5, IsaChecker::kH6})
    EXPECT_EQ(evaluated(rule), 0u) << "the interrupt controller's, or another device's";
}

// A write between two reads is nothing to the high time of the read strobe, nor a read to that of the write strobe.
TEST_F(IsaCheckerTest, StrobesOfTheHostPortAreTwo) {
  constexpr TimeFs kBetween = (300 + 600 + 300) * kNs;  // a cycle of the other, and what is on its two sides
  const auto margin = [this](Rule rule) { return checker_.ledger().row(rule, IsaChecker::kIo).margin; };
  io({}, 0x215);
  iow({}, 0x215);
  io({}, 0x215);
  EXPECT_EQ(margin(IsaChecker::kH2), kBetween - 4'950'000);
  iow({}, 0x215);
  EXPECT_EQ(margin(IsaChecker::kH6), kBetween - 8'250'000);
}

// Low for the 25.43 ns of every access to the RAM is not waiting (host-bus:3.4).
TEST_F(IsaCheckerTest, CyclesAreCountedByKindWidthAndIochrdy) {
  Points waits;
  waits.ready_low = 70 * kNs;
  Points asks = waits;
  asks.ready_high = asks.ready_low + 25'430'000;
  io({});
  io({});
  memr(waits);
  memr(asks);
  asks.ready_high += kNs;
  memr(asks);
  memw({}, 0xD8000);
  in_.slot8 = true;
  memw({});
  EXPECT_EQ(checker_.cycles(IsaChecker::kIoRead, 0, 0), 2u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryRead, 1, 1), 2u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryRead, 1, 0), 1u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryWrite, 1, 0), 1u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryWrite, 0, 0), 1u);
}

// As reports name them: of the host bus, and of Port A.
TEST(TimingText, TimesAndPlaces) {
  EXPECT_EQ(timing_text(12'345'678), "12.346 ns");
  TimingPlace place;
  place.address = 0x300;
  place.space = 'I';
  EXPECT_EQ(timing_address(place), "I/O 0x300");
  place.address = 0xD0002;
  place.space = 'M';
  EXPECT_EQ(timing_address(place), "memory 0x0D0002");
  place.address = 0x78005;
  place.space = 'X';
  EXPECT_EQ(timing_address(place), "X:$078005");
}

}  // namespace
}  // namespace brick
