// Both engines under random life on the motor side, every pin and counter compared at every tick. What moved is
// counted, so that no pin can rest and be equal. A long run: BRICK_MOTOR_TICKS=1000000000 bin/unit_cosim
// --gtest_filter='*MotorLockstep*OneIc' (seed: BRICK_RANDOM_SEED).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>

#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_map.h"
#include "testbench/unit/cosim/distorted_board.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 0);
}

constexpr std::uint32_t kServoIcMask = (1u << kMaxServoIcs) - 1;
constexpr std::uint32_t kAllIcs = 0x3FFFFF;  // as BoardInputs::fitted

// Ticks at which a pin moves at least in any of the lives below, with any seed: where clocks of chance are slow it
// lasts up to kLongest times as long.
constexpr Tick kLongest = 10;
constexpr std::pair<MotorField, unsigned> kMotorChanges[] = {
    {motor_pin::kPwmATop, 10},  {motor_pin::kPwmABot, 10},    {motor_pin::kPwmBTop, 10},  {motor_pin::kPwmBBot, 10},
    {motor_pin::kPwmCTop, 10},  {motor_pin::kPwmCBot, 10},    {motor_pin::kPfmPulse, 10}, {motor_pin::kPfmDir, 5},
    {motor_pin::kDac, 5},       {motor_pin::kDacB, 5},        {motor_pin::kAena, 4},      {motor_pin::kEqu, 4},
    {motor_pin::kDacClk, 5000}, {motor_pin::kDacStrobe, 500}, {motor_pin::kAdcClk, 5000}, {motor_pin::kAdcStrobe, 500},
    {motor_pin::kCount, 200},
};

struct MotorLife {
  const char* name;
  MotorTrafficOptions options;
  Tick ticks;
};

// Clocks at reset values that nobody touches, and one trip of the watchdog.
MotorTrafficOptions left_alone(std::uint32_t ics) {
  MotorTrafficOptions options{ics, 20'000, 2'000, false, 0};
  options.silent_at = 800'000;
  return options;
}
// Its longest life is shorter than a trip.
MotorTrafficOptions without_trip(std::uint32_t ics) {
  MotorTrafficOptions options{ics};
  options.may_trip = false;
  return options;
}
MotorTrafficOptions by_macro(std::uint32_t ics) {
  MotorTrafficOptions options = without_trip(ics);
  options.macro_drives = true;
  return options;
}

// What moved on a board.
class SeenPins {
 public:
  explicit SeenPins(Board& board) {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      for (unsigned n = 0; n < kChannels; ++n) fields_[i].set(kMotorChanges[i].first, n, ~0u);
    board.on_change = [this](Tick, const BoardOutputs& before, const BoardOutputs& after) {
      sources |= 1u << after.get(pin::kPhaseSource);
      trips += after.get(pin::kWdTripped) & ~before.get(pin::kWdTripped);
    };
    board.watch_motors(~0u);
    board.on_motor_change = [this](Tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
      for (std::size_t i = 0; i < fields_.size(); ++i) changes_[i] += before.differs(after, fields_[i]);
      for (unsigned i = 0; i < kMotorOutputWords; ++i) moved_[ic].w[i] |= before.w[i] ^ after.w[i];
    };
  }
  // Names what did not move often enough: of the board each kind of pin, of each fitted servo IC a switch and a
  // counter.
  std::vector<std::string> lacks(std::uint32_t fitted) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (changes_[i] < kMotorChanges[i].second)
        names.push_back(fmt::format("{}: {} of {}", kMotorChanges[i].first.name, changes_[i], kMotorChanges[i].second));
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
      if ((fitted >> ic & 1) == 0) continue;
      const auto& w = moved_[ic].w;
      if ((w[0] & 0xFFFFFF) == 0) names.push_back("no switch of " + servo_ic_scope(ic));
      if ((w[2] | w[3] | w[4] | w[5]) == 0) names.push_back("no counter of " + servo_ic_scope(ic));
    }
    return names;
  }
  std::uint32_t sources = 0, trips = 0;  // ICs whose PHASE the board took; of the watchdog

 private:
  std::array<MotorOutputs, std::size(kMotorChanges)> fields_{};  // all bits of each
  std::array<unsigned, std::size(kMotorChanges)> changes_{};
  std::array<MotorOutputs, kMaxServoIcs> moved_{};
};

MotorTrafficOptions five_volts_fail(std::uint32_t ics) {
  MotorTrafficOptions options{ics};
  options.reset_one_in = 0;
  options.fail_every = 300;
  return options;
}

class MotorLockstep : public ::testing::TestWithParam<MotorLife> {};

TEST_P(MotorLockstep, IsEqualAtEveryTickUnderRandomLife) {
  BRICK_COVERS("CARD-6");
  const MotorLife& life = GetParam();
  const std::uint32_t ics = life.options.ics;
  auto board = make_lockstep_board(make_rtl_board(ics), make_model_board(ics));
  const Tick ticks = static_cast<Tick>(from_environment("BRICK_MOTOR_TICKS", static_cast<std::uint64_t>(life.ticks)));
  const std::uint64_t seed = random_seed(1);
  const SeenPins seen(*board);
  MotorTraffic traffic(seed, life.options);
  const std::uint32_t drivers = ics & (life.options.macro_drives ? ~kServoIcMask : kServoIcMask);
  Tick end = ticks;
  ASSERT_NO_THROW(traffic.run(*board, end, 65'536)) << "seed " << seed;
  while ((!seen.lacks(ics).empty() || (seen.sources & drivers) == 0) && end < kLongest * ticks)
    ASSERT_NO_THROW(traffic.run(*board, end += ticks, 65'536)) << "seed " << seed;
  EXPECT_EQ(board->now(), end);
  EXPECT_THAT(seen.lacks(ics), ::testing::IsEmpty());
  EXPECT_NE(seen.sources & drivers, 0u);
  if (life.options.silent_at != kNever) { EXPECT_NE(seen.trips, 0u); }
  if (life.options.fail_every != 0) {  // by construction a trip has 12 writes of a control word behind it
    EXPECT_GE(seen.trips, 2u);
    EXPECT_GE(traffic.writes_tripped(), 12 * (seen.trips - 1));
  }
}

INSTANTIATE_TEST_SUITE_P(Lives, MotorLockstep,
                         ::testing::Values(MotorLife{"OneIc", {0x1}, 400'000},
                                           MotorLife{"TwoIcs", {kTwoServoIcs}, 400'000},
                                           MotorLife{"TwoIcsRarely", {kTwoServoIcs, 3'000, 400}, 2'400'000},
                                           MotorLife{"TwoIcsLeftAlone", left_alone(kTwoServoIcs), 6'000'000},
                                           MotorLife{"TwoIcsFiveVoltsFail", five_volts_fail(kTwoServoIcs), 1'200'000},
                                           MotorLife{"AllIcs", without_trip(kAllIcs), 120'000},
                                           MotorLife{"AllIcsByMacro", by_macro(kAllIcs), 120'000}),
                         [](const auto& life) { return std::string(life.param.name); });

// One motor cable of one engine is wired wrongly: A and B are swapped.
TEST(MotorLockstepControl, SwappedEncoderLinesAreFoundAtTheirCounter) {
  BRICK_COVERS("CARD-6");
  auto model = std::make_unique<DistortedBoard>(make_model_board(kTwoServoIcs));
  model->distort_motor = [](unsigned ic, MotorInputs& in) {
    std::uint16_t& pins = in.pins[1];
    if (ic == 1) pins = static_cast<std::uint16_t>((pins & ~3u) | (pins & 1u) << 1 | (pins >> 1 & 1u));
  };
  auto board = make_lockstep_board(make_rtl_board(kTwoServoIcs), std::move(model));
  try {
    MotorTraffic(3, {kTwoServoIcs}).run(*board, 100'000);
    FAIL() << "not found";
  } catch (const LockstepDifference& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("\n  servo_ic1.ch2.count: rtl "));
  }
}

// Nobody writes a register: both engines would agree, and nothing would be shown of what must be set up first.
TEST(MotorLockstepControl, PinsThatRestAreNamed) {
  DistortedBoard board(make_model_board(0x1));
  board.distort = [](BoardInputs& in) { in.pa_wr_n = true; };
  const SeenPins seen(board);
  MotorTraffic(1, {0x1}).run(board, 400'000);
  EXPECT_THAT(seen.lacks(0x1),
              ::testing::ElementsAre("pfm_pulse: 0 of 10", "pfm_dir: 0 of 5", "dac: 0 of 5", "dac_b: 0 of 5",
                                     "aena: 0 of 4", "equ: 0 of 4", "dac_clk: 0 of 5000", "dac_strobe: 0 of 500",
                                     "adc_clk: 0 of 5000", "adc_strobe: 0 of 500"));
}

}  // namespace
}  // namespace brick
