// The two engines are one machine: random traffic on all pins but the motors', compared at every tick. What moved is
// counted, so that no pin can rest and be equal. Boards of two servo ICs, of four with a MACRO IC, and of servo ICs 0,
// 1, 2 and 2* with two MACRO ICs.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>

#include "systemc/cosim/engines.h"
#include "systemc/host/dpram_memory.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/distorted_board.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr std::uint32_t kTwoIcs = 0x3, kFiveIcs = 0x4000F, kSixIcs = 0xC0407;  // as BoardInputs::fitted

constexpr PinField kEquLines{"host.pic.sig 7..5", 2, 13, 3, true};  // EQU1..EQU8, WDO: whatever is strapped to them

// How often something is seen at least, in a million ticks of dense traffic and in 4 million with long pauses: about
// a third of what the least of 40 seeds gave. 0: not in this life.
struct Least {
  unsigned dense, sparse;
};
constexpr std::pair<PinField, Least> kChanges[] = {
    {pin::kPaDataOe, {4000, 100}},
    {pin::kPaData, {12000, 200}},
    {pin::kPaTaN, {2700, 40}},
    {pin::kIrqHost, {60, 0}},
    {pin::kPhase, {150, 80}},
    {pin::kServo, {90, 60}},
    {pin::kBreq, {42, 0}},
    {pin::kIpos, {42, 0}},
    {pin::kEror, {42, 0}},
    {pin::kF1er, {42, 0}},
    {pin::kIsaSd, {1500, 600}},
    {pin::kIsaIochrdy, {12, 0}},
    {pin::kIsaMemcs16N, {1500, 700}},
    {pin::kIsaIrq, {15, 1}},
    {pin::kHreq, {15, 3}},
    {pin::kWdo, {0, 2}},
    {pin::kWdTripped, {0, 2}},
    {pin::kBusyHost, {12, 0}},
    {pin::kBusyCpu, {54, 0}},
    {pin::kPhaseSource, {24, 7}},
    {pin::kSourceConflict, {6, 0}},
    {pin::kPicIst, {18, 2}},
    {pin::kPicSig, {180, 9}},
    {pin::kPicMsk, {48, 20}},
    {pin::kPicElr, {48, 25}},
    {kEquLines, {45, 2}},
    {pin::kBrldN, {25, 0}},
    {pin::kErldN, {25, 0}},
    {pin::kF1ldN, {25, 0}},
    {pin::kIpldN, {25, 0}},
    {pin::kCtrl0, {45, 0}},
    {pin::kCtrl1, {45, 0}},
};
// Of the CPU's cycles and the host's, and of the CPU's: a million ticks are some 40 000 and 12 000.
constexpr Least kAccesses{40000, 3000}, kTooShort{6000, 40}, kBackToBack{6000, 80}, kBothStrobes{400, 4},
    kAddressMoved{400, 5}, kResetInCycle{10, 0};
constexpr Least kDpramAccessesOfCpu{2700, 40}, kDpramAccessesOfHost{1200, 500};

class Life {
 public:
  explicit Life(Board& board) {
    board.on_change = [this](Tick, const BoardOutputs& before, const BoardOutputs& after) {
      for (std::size_t i = 0; i < changes_.size(); ++i)
        changes_[i] += before.get(kChanges[i].first) != after.get(kChanges[i].first);
    };
  }
  // Names what was not seen often enough.
  std::vector<std::string> lacks(const BoardTraffic& traffic, unsigned Least::*least) const {
    std::vector<std::string> names;
    const auto check = [&](std::string_view name, const Least& expected, unsigned seen) {
      if (seen < expected.*least) names.push_back(fmt::format("{}: {} of {}", name, seen, expected.*least));
    };
    for (std::size_t i = 0; i < changes_.size(); ++i) check(kChanges[i].first.name, kChanges[i].second, changes_[i]);
    check("accesses", kAccesses, traffic.accesses());
    check("strobes too short", kTooShort, traffic.seen().too_short);
    check("cycles back to back", kBackToBack, traffic.seen().back_to_back);
    check("both strobes", kBothStrobes, traffic.seen().both_strobes);
    check("address moved", kAddressMoved, traffic.seen().address_moved);
    check("reset in a cycle", kResetInCycle, traffic.seen().reset_in_cycle);
    check("DPRAM accesses of the CPU", kDpramAccessesOfCpu, traffic.dpram_accesses_of_cpu());
    check("DPRAM accesses of the host", kDpramAccessesOfHost, traffic.dpram_accesses_of_host());
    return names;
  }

 private:
  std::array<unsigned, std::size(kChanges)> changes_{};
};

void play(std::uint32_t ics, int seed, BoardTraffic::Options options, Tick end, unsigned Least::*least) {
  options.ics = ics;
  auto board = make_lockstep_board(make_rtl_board(ics), make_model_board(ics));
  const Life life(*board);
  BoardTraffic traffic(random_seed(static_cast<std::uint64_t>(seed)), options);
  const Tick longest = 4 * end, step = end / 4;  // with a seed that makes something seldom
  ASSERT_NO_THROW(traffic.run(*board, end));
  while (!life.lacks(traffic, least).empty() && end < longest) ASSERT_NO_THROW(traffic.run(*board, end += step));
  EXPECT_EQ(board->now(), end);
  EXPECT_THAT(life.lacks(traffic, least), ::testing::IsEmpty());
  for (unsigned word = 0; word < DpramMemory::kWords; ++word) ASSERT_NO_THROW(board->dpram_word(word));
}

class BoardLockstep : public ::testing::TestWithParam<std::tuple<std::uint32_t, int>> {
 protected:
  std::uint32_t ics() const { return std::get<0>(GetParam()); }
  int seed() const { return std::get<1>(GetParam()); }
};

TEST_P(BoardLockstep, IsEqualAtEveryTickUnderDenseTraffic) {
  BRICK_COVERS("CARD-1 CARD-2 CARD-6 I19-2 CLK-6");
  play(ics(), seed(), {}, 1'000'000, &Least::dense);
}

TEST_P(BoardLockstep, IsEqualAtEveryTickOverLongPausesAndATripOfTheWatchdog) {
  BRICK_COVERS("CARD-1 CARD-2 CARD-6 I19-2 CLK-6");
  BoardTraffic::Options options;
  options.dense = false;
  options.silent_at = 500'000;
  play(ics(), seed(), options, 4'000'000, &Least::sparse);
}

// 5 V fails, and both sides go on: writes of the control outputs among them (servo-ic:10/10).
TEST_P(BoardLockstep, IsEqualAtEveryTickAfterTripsWithWritesBehindThem) {
  constexpr unsigned kTrips = 10;
  BoardTraffic::Options options;
  options.ics = ics();
  options.reset_one_in = 0;
  options.fail_every = 200;
  auto board = make_lockstep_board(make_rtl_board(ics()), make_model_board(ics()));
  unsigned trips = 0, high = 0;
  board->on_change = [&](Tick, const BoardOutputs& before, const BoardOutputs& after) {
    trips += after.get(pin::kWdTripped) & ~before.get(pin::kWdTripped);
    high += after.get(pin::kWdTripped) != 0 && (after.get(pin::kCtrl0) | after.get(pin::kCtrl1)) != 0;
  };
  BoardTraffic traffic(random_seed(static_cast<std::uint64_t>(seed())), options);
  for (Tick end = 50'000; trips < kTrips; end += 50'000) ASSERT_NO_THROW(traffic.run(*board, end));
  EXPECT_EQ(high, 0u) << "a control output is high after a trip";
  EXPECT_GE(traffic.seen().writes_tripped, 10 * (kTrips - 1));
}

std::string name_of(const ::testing::TestParamInfo<BoardLockstep::ParamType>& info) {
  return (std::get<0>(info.param) == kTwoIcs ? "TwoIcs" : "FiveIcs") + std::to_string(std::get<1>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Boards, BoardLockstep,
                         ::testing::Combine(::testing::Values(kTwoIcs, kFiveIcs), ::testing::Values(1, 2)), name_of);

// Random accesses of host and CPU, at random phases, by seeds of a million ticks each. BRICK_ACCESSES=10000000 in the
// environment asks for more than the hundred thousand of the test suite.
TEST(BoardLockstepAccesses, AHundredThousandLeaveNoDifference) {
  BRICK_COVERS("CARD-6");
  const char* asked = std::getenv("BRICK_ACCESSES");
  const unsigned long least = asked != nullptr ? std::strtoul(asked, nullptr, 10) : 100'000;
  ASSERT_GE(least, 100'000ul) << "BRICK_ACCESSES";
  unsigned long made = 0;
  for (std::uint64_t seed = 100; made < least; ++seed) {
    auto board = make_lockstep_board(make_rtl_board(kTwoIcs), make_model_board(kTwoIcs));
    BoardTraffic traffic(random_seed(seed));
    ASSERT_NO_THROW(traffic.run(*board, 1'000'000)) << "seed " << seed;
    made += traffic.accesses();
  }
  RecordProperty("accesses", std::to_string(made));
}

// Starred ICs and several MACRO ICs are built on the largest board only, which is slow.
TEST(BoardLockstepOfSixIcs, IsEqualAtEveryTickUnderDenseTraffic) {
  BRICK_COVERS("CARD-1 CARD-6 I19-2 CLK-6");
  play(kSixIcs, 1, {}, 1'000'000, &Least::dense);
}

// Bug of rtl/board/board_sim.sv: the fifth fall of SERVO since a reset comes one tick late.
TEST(BoardLockstepControl, TheSeededBugIsFoundUnderTraffic) {
  BRICK_COVERS("CARD-6");
  Tick fifth_fall = kNever;
  unsigned falls = 0;
  auto model = make_model_board(kTwoIcs);
  model->on_change = [&](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    falls += before.get(pin::kServo) & ~after.get(pin::kServo);
    if (falls == 5) fifth_fall = std::min(fifth_fall, t);
  };
  BoardTraffic::Options options;
  options.reset_one_in = 0;
  BoardTraffic(1, options).run(*model, 100'000);
  ASSERT_NE(fifth_fall, kNever);

  auto board = make_lockstep_board(make_rtl_board(kTwoIcs, {0, true}), make_model_board(kTwoIcs));
  try {
    BoardTraffic(1, options).run(*board, 100'000);
    FAIL() << "not found";
  } catch (const LockstepDifference& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr(fmt::format("differ at tick {} ", fifth_fall)));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("\n  clock.servo: rtl 1, systemc 0"));
  }
}

// A board whose host never reaches the DPRAM: both engines would agree, and nothing would be shown.
TEST(BoardLockstepControl, PinsThatRestAreNamed) {
  DistortedBoard board(make_model_board(kTwoIcs));
  board.distort = [](BoardInputs& in) { in.isa_memr_n = in.isa_memw_n = true; };
  const Life life(board);
  BoardTraffic traffic(1);
  traffic.run(board, 1'000'000);
  EXPECT_THAT(
      life.lacks(traffic, &Least::dense),
      ::testing::ElementsAre("host.isa.iochrdy: 0 of 12", "dpram.busy_host: 0 of 12", "dpram.busy_cpu: 0 of 54"));
}

// What a reset does not clear and nobody has written: the DPRAM, which starts by another seed than the model's. The
// pins show it under traffic only; on an idle board a flip-flop without reset would go unseen as well.
TEST(BoardLockstepControl, StartValuesThatNoResetClearsAreFound) {
  BRICK_COVERS("CARD-6");
  for (std::uint64_t seed = 2; seed < 8; ++seed) {
    auto board = make_lockstep_board(make_rtl_board(kTwoIcs, {seed, false}), make_model_board(kTwoIcs, seed + 100));
    try {
      BoardTraffic(seed).run(*board, 50'000);
      ADD_FAILURE() << "not found with seed " << seed;
    } catch (const LockstepDifference& e) {
      EXPECT_THAT(e.what(), ::testing::ContainsRegex("\n  (bus|host.isa).rdata: rtl "));
    }
  }
}

}  // namespace
}  // namespace brick
