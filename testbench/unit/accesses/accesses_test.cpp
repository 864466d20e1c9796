// Random accesses of host and CPU on both engines in lock-step, at random phases, with the checkers that every run has
// (testbench/checkers/timing_book.h): no difference, no rule broken, and neither a line of a bus nor a rule of a
// checker rests. Both sides keep the rules here; what breaks them is in testbench/unit/cosim/board_lockstep_test.cpp.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <iostream>

#include "systemc/cosim/engines.h"
#include "testbench/unit/accesses/access_host.h"
#include "testbench/unit/accesses/bus_activity.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr std::uint64_t kLife = 12'500;  // accesses of one machine
constexpr std::uint32_t kTwoIcs = 0x3, kFiveIcs = 0x4000F;

struct Fault {
  bool memory = true;     // false: the host leaves the dual-ported RAM alone
  bool too_fast = false;  // gate ICs with 2 wait states
};

// Boards of all kinds by the seed, every second one with pins that are taken early or late, and in turns with lines of
// Port A that have a delay each.
MachineConfig config(std::uint64_t seed) {
  MachineConfig c;
  c.seed = seed;
  const bool long_run = std::getenv("BRICK_ACCESSES") != nullptr;
  c.aperture = seed % 2 == 0 || long_run ? Aperture::kMost : 0;
  c.skew = seed % 4 < 2 || long_run;
  BoardConfig& b = c.board;
  b.bus = "isa";
  b.fitted = seed % 3 == 0 ? kFiveIcs : kTwoIcs;
  b.slot8 = seed % 4 >= 2;
  b.window_flat = seed % 8 < 4;
  b.window = b.window_flat ? 0xD0000 : 0xD4000;
  b.io_decode16 = seed % 5 != 0;
  b.dpram_words = seed % 3 == 1 ? 8192 : 32768;
  b.pic_8259 = seed % 4 == 3;
  b.jpan = seed % 2 != 0;
  constexpr std::uint32_t kLines[] = {0x951, 0xDC1, 0xBA5, 0x2FE};  // EQU, WDO; MI1, MI2; CTRL0, CTRL1; AXEXP
  b.line_select = kLines[seed % 4];
  return c;
}

struct Made {
  std::uint64_t all = 0;
  std::map<std::string, std::uint64_t> by_kind;
  Aperture::Counts moves;
};

void live(Engine engine, std::uint64_t seed, std::uint64_t accesses, const Fault& fault, BusActivity& activity,
          Made& made) {
  MachineConfig c = config(seed);
  c.engine = engine;
  Machine machine(sc_core::sc_gen_unique_name("machine"), c);
  TimingBook book(machine);
  activity.watch(machine);
  AccessCpu cpu(machine, seed, fault.too_fast);
  AccessHost host(machine, cpu, seed + 1, fault.memory);
  while (cpu.made() + host.made() < accesses) host.step();
  activity.finish(book);
  made.all += cpu.made() + host.made();
  for (unsigned r = 0; r < AccessCpu::kRegions; ++r)
    for (const bool write : {false, true})
      made.by_kind[fmt::format("CPU, {}, {}", AccessCpu::kNames[r], write ? "write" : "read")] +=
          cpu.made(static_cast<AccessCpu::Region>(r), write);
  for (unsigned k = 0; k < AccessHost::kKinds; ++k)
    made.by_kind[fmt::format("host, {}", AccessHost::kNames[k])] += host.made(static_cast<AccessHost::Kind>(k));
  const Aperture::Counts& moves = machine.aperture().counts();
  made.moves.early += moves.early;
  made.moves.late += moves.late;
  made.moves.split += moves.split;
}

// BRICK_ACCESSES=10000000 in the environment asks for more than the hundred thousand of the test suite, all of them
// with aperture and skew.
TEST(Accesses, AHundredThousandInLockstepBreakNoRuleAndLeaveNoLineAtRest) {
  BRICK_COVERS("CARD-5 CARD-6");
  const char* asked = std::getenv("BRICK_ACCESSES");
  const std::uint64_t least = asked != nullptr ? std::strtoull(asked, nullptr, 10) : 100'000;
  ASSERT_GE(least, 100'000u) << "BRICK_ACCESSES";
  BusActivity activity;
  Made made;
  for (std::uint64_t seed = 0; made.all < least; ++seed)
    ASSERT_NO_THROW(live(Engine::kLockstep, random_seed(seed), kLife, {}, activity, made)) << "seed " << seed;
  EXPECT_THAT(activity.violations(), ::testing::IsEmpty());
  EXPECT_THAT(activity.lacks(made.all), ::testing::IsEmpty());
  for (const auto& [kind, times] : made.by_kind) EXPECT_GE(times, made.all / 100) << kind;
  EXPECT_GT(activity.ta_moves().seen, 0u);
  EXPECT_GT(activity.ta_moves().missed, 0u);
  const Aperture::Counts& m = made.moves;
  EXPECT_GT(std::min({m.early, m.late, m.split}), made.all / 100);
  std::cout << fmt::format("{} accesses; /TA in its window {} times seen, {} not; {} moves early, {} late, {} split\n",
                           made.all, activity.ta_moves().seen, activity.ta_moves().missed, m.early, m.late, m.split);
  for (const auto& [kind, times] : made.by_kind) std::cout << fmt::format("{}: {}\n", kind, times);
  std::cout << activity.text();
}

// The same accesses, two of them wrong: what is said of them means something.
TEST(AccessesControl, GateIcsWithTooFewWaitStatesBreakRow104) {
  BRICK_COVERS("CARD-5");
  BusActivity activity;
  Made made;
  live(Engine::kSystemC, 1, 2'000, {true, true}, activity, made);
  EXPECT_THAT(activity.violations(), ::testing::Contains(::testing::HasSubstr("Port A rule 104 (")));
}

TEST(AccessesControl, LinesAndRulesThatRestAreNamed) {
  BusActivity activity;
  Made made;
  for (std::uint64_t seed = 0; seed < 8; ++seed) live(Engine::kSystemC, seed, kLife, {false, false}, activity, made);
  EXPECT_THAT(activity.violations(), ::testing::IsEmpty());
  const std::vector<std::string> lacks = activity.lacks(made.all);
  for (const char* name : {"MEMR#: 0 of 10", "MEMW#: 0 of 10", "dpram.busy_host: 0 of 2", "dpram.busy_cpu: 0 of 2",
                           "host.isa.iochrdy: 0 of 10", "LA.0: 0 of 10", "ISA t13, memory of 16 bits: 0 of 10",
                           "ISA t9, memory of 8 bits: 0 of 10"})
    EXPECT_THAT(lacks, ::testing::Contains(name));
}

}  // namespace
}  // namespace brick
