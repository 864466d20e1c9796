// A board that is reset in the middle of a bus cycle, with pads: what it had on its way to the CPU comes there, so that
// nobody believes later that D is still driven.
#include <gmock/gmock.h>

#include <utility>

#include "systemc/machine/machine.h"
#include "testbench/checkers/timing_book.h"

namespace brick {
namespace {

constexpr unsigned kRest = 16;  // the board's part of the reset ends after the CPU's

// Reads of the RAM until the reset, writes to a latch from then on.
struct Master final : BusMaster {
  explicit Master(Machine& m) : machine(m) { machine.attach_bus_master(this); }
  ~Master() override { machine.attach_bus_master(nullptr); }
  std::optional<Access> next() override {
    return Access{true, writes ? 0x070010u : 0x060000u, writes, 0, std::exchange(rest, 0)};
  }
  void done(const Access&, std::uint32_t) override {}
  void restart() { machine.reset(), writes = true, rest = kRest; }

  Machine& machine;
  bool writes = false;
  unsigned rest = kRest;
};

// At each tick of one read, of 11 clocks at I52 = 7: 16.5 ticks.
TEST(ResetOnPortA, DIsLetGoWheneverItComes) {
  constexpr Tick kReady = 600, kCycle = 17, kResetAndWrites = 300;
  unsigned driven = 0;
  for (const bool skew : {false, true})
    for (Tick at = kReady; at < kReady + kCycle; ++at) {
      MachineConfig config;
      config.skew = skew;
      Machine machine(sc_core::sc_gen_unique_name("brick"), config);
      TimingBook book(machine);
      Master master(machine);
      machine.run_until(at);
      driven += machine.outputs().get(pin::kPaDataOe);
      master.restart();
      machine.run_until(at + kResetAndWrites);
      const TimingLedger& ledger = *book.ledgers().front();
      EXPECT_GT(ledger.row(PortATiming::kBoardLetsGo, PortATiming::kDefaultArea).evaluations, 0u);
      for (const TimingViolation& v : ledger.violations()) ADD_FAILURE() << book.text(ledger, v) << ", reset at " << at;
    }
  EXPECT_GT(driven, kCycle / 2);
}

}  // namespace
}  // namespace brick
