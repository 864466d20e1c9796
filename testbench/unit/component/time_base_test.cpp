// Components at each resolution of the kernel and from an epoch of their own, each edge computed here; how often one
// wakes.
#include <gtest/gtest.h>
#include <sysc/kernel/sc_dynamic_processes.h>

#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::sc_time;
constexpr unsigned kPwmControl = 8 * 28 + 4;                          // byte of X:+$1C
constexpr std::uint32_t kPeriod = 200u << 8 | 15, kDrive = 0x0008D2;  // 403 ticks; PHASE and SERVO are outputs
constexpr Tick kTimeBaseTicks = 60'000;                               // the period before ends first, 13057 ticks

struct Kernel {
  std::uint64_t unit_fs, epoch;  // the epoch in units
  // Where edge t acts: the first unit after epoch + t x 78125/9216 ns.
  std::uint64_t instant(Tick t) const {
    return epoch + static_cast<std::uint64_t>(static_cast<unsigned __int128>(t) * 78'125'000'000 / 9216 / unit_fs) + 1;
  }
};

struct Happened {
  std::vector<std::uint64_t> phase, writes;  // instants: PHASE turned, a write was made
};

// The two writes are asked for at the epoch.
Happened expected_in(const Kernel& kernel) {
  Happened happened;
  ServoIcBlock block;
  bool phase = true;
  for (Tick t = 1; t < kTimeBaseTicks; ++t) {
    block.edge(t);
    if (t == 3) block.accessed({0, true, kPwmControl, kPeriod});
    if (t == 6) block.accessed({0, true, kClockControl, kDrive});
    if (t == 3 || t == 6) happened.writes.push_back(kernel.instant(t));
    if (!block.moved()) continue;
    if (const bool now = block.outputs().at("phase_o") != 0; now != phase) {
      happened.phase.push_back(kernel.instant(t));
      phase = now;
    }
  }
  return happened;
}

void runs(const Engine& engine, std::uint64_t unit_fs, std::uint64_t epoch_ns) {
  sc_core::sc_set_time_resolution(static_cast<double>(unit_fs), sc_core::SC_FS);
  const Kernel kernel{unit_fs, epoch_ns * 1'000'000 / unit_fs};
  const Happened right = expected_in(kernel);
  ASSERT_GT(right.phase.size(), 90u);
  TimeOptions options;
  options.epoch = sc_time::from_value(kernel.epoch);
  TimeBase time("time", options);
  ServoIc ic("ic", time, engine);
  sc_core::sc_signal<bool> phase("phase", true);
  ic.phase_o(phase);
  Happened seen;
  Initiator initiator("initiator", [&](Initiator& i) {
    if (kernel.epoch != 0) sc_core::wait(options.epoch);
    for (const auto& [address, word] : {std::pair{kPwmControl, kPeriod}, {kClockControl, kDrive}}) {
      i.write(address, word);
      seen.writes.push_back(sc_core::sc_time_stamp().value());
    }
  });
  initiator.socket.bind(ic.registers);
  sc_core::sc_spawn_options process;
  process.spawn_method();
  process.dont_initialize();
  process.set_sensitivity(&phase.value_changed_event());
  sc_core::sc_spawn([&] { seen.phase.push_back(sc_core::sc_time_stamp().value()); }, "see", &process);
  sc_core::sc_start(sc_time::from_value(kernel.instant(kTimeBaseTicks) - 1));
  EXPECT_EQ(seen.writes, right.writes);
  EXPECT_EQ(seen.phase, right.phase);
}

TEST(ComponentTime, EdgesActInTheFirstUnitAfterThemAtEachResolutionFromEachEpoch) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine(), lockstep_engine()})
    for (const std::uint64_t unit_fs : {1, 1'000, 1'000'000})
      for (const std::uint64_t epoch_ns : {0, 12'345}) {
        SCOPED_TRACE(::testing::Message() << "unit " << unit_fs << " fs, epoch " << epoch_ns << " ns");
        in_own_process([&] { runs(engine, unit_fs, epoch_ns); });
      }
}

// Instants with anything to do in 100 us of a component in which nothing happens.
unsigned wakes(const Engine& engine, bool bound) {
  TimeBase time("time");
  ServoIc ic("ic", time, engine);
  sc_core::sc_signal<bool> equ("equ");
  if (bound) ic.ch[0].equ(equ);
  const sc_time end(100, sc_core::SC_US);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  unsigned count = 0;
  for (sc_time next; (next = sc_core::sc_time_to_pending_activity()) <= end - sc_core::sc_time_stamp();) {
    count += next != sc_core::SC_ZERO_TIME;
    sc_core::sc_start(next);
  }
  return count;
}

TEST(ComponentTime, SilentRtlWakesOncePerGridTheModelSeldom) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { EXPECT_EQ(wakes(rtl_engine(), true), 100u); });
  in_own_process([] { EXPECT_EQ(wakes(rtl_engine(), false), 0u) << "nothing is bound"; });
  in_own_process([] { EXPECT_LE(wakes(model_engine(), true), 20u); });
}

}  // namespace
}  // namespace brick::component
