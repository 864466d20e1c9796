// Each rule of the host bus: kept at its limit, broken one femtosecond beyond it, and reported by its name and address.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "testbench/checkers/isa_checker.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr TimeFs kNs = kFsPerNs;

// The points of one cycle, and of what the board does in it; kNever does not happen. Whatever is not set keeps the
// rules.
struct Points {
  TimeFs la = -200 * kNs, sa = -200 * kNs, data = -100 * kNs;  // from the fall of the command
  TimeFs width = 600 * kNs;
  TimeFs release = 40 * kNs, data_release = 40 * kNs;  // from its end
  TimeFs next = 300 * kNs;
  TimeFs valid = kNever, off = 8 * kNs;               // of read data; off from the end
  TimeFs ready_low = kNever, ready_high = 200 * kNs;  // from the fall
  TimeFs memcs16 = 30 * kNs;                          // from LA
};

class IsaCheckerTest : public ::testing::Test {
 protected:
  using Rule = IsaChecker::Rule;

  IsaCheckerTest() {
    in_.rst_n = true;
    out_.set(pin::kIsaIochrdy, 1);
    out_.set(pin::kIsaMemcs16N, 1);
    out_.set(pin::kTxde, 1);
    show();
  }

  void show() { checker_.pins(now_, in_, out_); }
  template <class Edit>
  void at(TimeFs time, Edit edit) {
    plan_.push_back({time, edit});
  }
  void play() {
    std::stable_sort(plan_.begin(), plan_.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    for (const auto& step : plan_) {
      now_ = step.time;
      step.edit();
      show();
    }
    plan_.clear();
  }

  // One cycle whose command falls `points.next` after the end of the last one.
  void cycle(bool BoardInputs::*command, std::uint32_t address, const Points& p) {
    const TimeFs low = end_ + p.next, high = low + p.width;
    const bool memory = command == &BoardInputs::isa_memr_n || command == &BoardInputs::isa_memw_n;
    if (memory) {
      at(low + p.la, [=] { in_.isa_la = static_cast<std::uint8_t>(address >> 17); });
      at(low + p.la + p.memcs16, [=] { out_.set(pin::kIsaMemcs16N, address >> 17 != 6); });
    }
    at(low + p.sa, [=] { in_.isa_sa = address & 0xFFFFF, in_.isa_sbhe_n = !memory; });
    at(low + p.data, [=] { in_.isa_sd = ++data_; });
    at(low, [=] { in_.*command = false; });
    if (p.valid != kNever) {
      at(low + p.valid, [=] { out_.set(pin::kIsaSdOe, 3); });
      at(high + p.off, [=] { out_.set(pin::kIsaSdOe, 0); });
    }
    if (p.ready_low != kNever) {
      at(low + p.ready_low, [=] { out_.set(pin::kIsaIochrdy, 0); });
      at(low + p.ready_high, [=] { out_.set(pin::kIsaIochrdy, 1); });
    }
    at(high, [=] { in_.*command = true; });
    at(high + p.release, [=] { in_.isa_sa = 0xFFFFF, in_.isa_sbhe_n = true, in_.isa_la = 0x7F; });
    at(high + p.data_release, [=] { in_.isa_sd = 0xFFFF; });
    if (memory) at(high + p.release, [=] { out_.set(pin::kIsaMemcs16N, 1); });
    end_ = high;
    play();
  }
  void io(const Points& p, std::uint32_t address = 0x212) { cycle(&BoardInputs::isa_ior_n, address, p); }
  void iow(const Points& p, std::uint32_t address = 0x213) { cycle(&BoardInputs::isa_iow_n, address, p); }
  void memr(const Points& p, std::uint32_t address = 0xD0000) { cycle(&BoardInputs::isa_memr_n, address, p); }
  void memw(const Points& p, std::uint32_t address = 0xD0000) { cycle(&BoardInputs::isa_memw_n, address, p); }

  std::vector<std::string> broken() const {
    std::vector<std::string> ids;
    for (const TimingViolation& v : checker_.ledger().violations()) ids.push_back(checker_.ledger().rules()[v.rule].id);
    return ids;
  }
  // `limit` keeps the rule with margin 0 and nothing else is broken; `beyond` breaks it alone.
  template <class Run>
  void expect_limit(Rule rule, Run run, const Points& limit, const Points& beyond,
                    IsaChecker::Region region = IsaChecker::kIo) {
    const std::string id = checker_.ledger().rules()[rule].id;
    SCOPED_TRACE(id);
    checker_.ledger().forget();
    run(limit);
    EXPECT_THAT(broken(), ::testing::IsEmpty());
    EXPECT_EQ(checker_.ledger().row(rule, region).margin, 0);
    run(beyond);
    ASSERT_EQ(broken(), std::vector<std::string>{id});
    EXPECT_EQ(checker_.ledger().row(rule, region).margin, -1);
  }
  template <class Run>
  void expect_limit(Rule rule, Run run, TimeFs Points::*point, TimeFs limit, int worse,
                    IsaChecker::Region region = IsaChecker::kIo, Points usual = {}) {
    Points beyond = usual;
    usual.*point = limit;
    beyond.*point = limit + worse;
    expect_limit(rule, run, usual, beyond, region);
  }

  struct Step {
    TimeFs time;
    std::function<void()> edit;
  };
  IsaChecker checker_;
  BoardInputs in_;
  BoardOutputs out_;
  std::vector<Step> plan_;
  TimeFs now_ = 0, end_ = 1000 * kNs;
  std::uint16_t data_ = 0;
};

TEST_F(IsaCheckerTest, EachRowOfTheIoCycleHasItsLimit) {
  const auto read = [this](const Points& p) { io(p); };
  const auto write = [this](const Points& p) { iow(p); };
  Points answered;
  answered.valid = 50 * kNs;
  expect_limit(IsaChecker::kT1, read, &Points::sa, -91 * kNs, 1);
  expect_limit(IsaChecker::kT2, read, &Points::width, 530 * kNs, -1);
  expect_limit(IsaChecker::kT3, read, &Points::release, 25 * kNs, -1);
  expect_limit(IsaChecker::kT4, read, &Points::valid, 489 * kNs, 1, IsaChecker::kIo, answered);
  expect_limit(IsaChecker::kT5, read, &Points::off, 0, -1, IsaChecker::kIo, answered);
  expect_limit(IsaChecker::kT5Off, read, &Points::off, 30 * kNs, 1, IsaChecker::kIo, answered);
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
  Points answered = usual, stretched = usual;
  answered.valid = 50 * kNs;
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
  expect_limit(IsaChecker::kT14, read, &Points::valid, 173 * kNs, 1, kWide, answered);
  expect_limit(IsaChecker::kT15, write, &Points::data_release, 25 * kNs, -1, kWide, usual);
  expect_limit(IsaChecker::kT16, read, &Points::memcs16, 66 * kNs, 1, kWide, usual);
  expect_limit(IsaChecker::kT18, read, &Points::sa, -34 * kNs, 1, kWide, usual);
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
  EXPECT_EQ(broken(), std::vector<std::string>{"t16"});
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
}

TEST_F(IsaCheckerTest, UnsoundHostsAreNamed) {
  at(end_ + 300 * kNs, [this] { in_.isa_sa = 0x217; });
  at(end_ + 500 * kNs, [this] { in_.isa_iow_n = false; });
  at(end_ + 900 * kNs, [this] { in_.isa_ior_n = false; });
  at(end_ + 1100 * kNs, [this] { in_.isa_iow_n = in_.isa_ior_n = true; });
  play();
  EXPECT_EQ(broken(), std::vector<std::string>{"one-command"});
  EXPECT_EQ(timing_address(checker_.ledger().violations()[0].where), "I/O 0x217");
  checker_.ledger().forget();

  end_ = now_;
  at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
  at(end_ + 700 * kNs, [this] { in_.isa_sa = 0x219; });
  at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true; });
  play();
  EXPECT_EQ(broken(), std::vector<std::string>{"address-stands"});
  checker_.ledger().forget();

  end_ = now_;
  iow({}, 0x217);
  out_.set(pin::kTxde, 0);
  show();
  EXPECT_THAT(broken(), ::testing::IsEmpty());
  iow({}, 0x217);
  EXPECT_EQ(broken(), std::vector<std::string>{"room-in-tx"});
  checker_.ledger().forget();

  for (const bool line : {false, true}) {
    end_ = now_;
    at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
    at(end_ + 700 * kNs, [=] { line ? in_.isa_resetdrv = true : in_.rst_n = false; });
    at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true; });
    at(end_ + 1200 * kNs, [=] { in_.isa_resetdrv = false, in_.rst_n = true; });
    play();
    EXPECT_EQ(broken(), std::vector<std::string>{"whole-cycle"});
    checker_.ledger().forget();
  }
}

TEST_F(IsaCheckerTest, BoardThatDrivesWhereItMayNotIsNamed) {
  Points p;
  p.valid = 50 * kNs;
  io(p, 0x210);
  memr(p, 0xD0000);
  EXPECT_THAT(broken(), ::testing::IsEmpty());
  io(p, 0x220);
  memr(p, 0xE0000);
  memr(p, 0x1D0000);
  iow(p, 0x210);
  in_.isa_aen = true;
  show();
  io(p, 0x211);
  EXPECT_EQ(broken(), std::vector<std::string>(5, "ours-only"));
}

TEST_F(IsaCheckerTest, CyclesAreCountedByKindWidthAndIochrdy) {
  Points stretched;
  stretched.ready_low = 70 * kNs;
  io({});
  io({});
  memr(stretched);
  memw({}, 0xD8000);
  in_.slot8 = true;
  memw({});
  EXPECT_EQ(checker_.cycles(IsaChecker::kIoRead, 0, 0), 2u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryRead, 1, 1), 1u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryWrite, 1, 0), 1u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryWrite, 0, 0), 1u);
}

}  // namespace
}  // namespace brick
