// What belongs to one instant of the kernel: when it has ended, and who can still change a pin in it.
#include <gtest/gtest.h>
#include <sysc/kernel/sc_dynamic_processes.h>

#include <brick/interrupt_controller.h>
#include <brick/rtl.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "testbench/unit/component/own_process.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::SC_NS;
using sc_core::SC_US;
using sc_core::SC_ZERO_TIME;

Engine engine_of(bool rtl) { return rtl ? rtl_engine() : model_engine(); }

// A reset of the controller shows at once in what a debug read gives; IRQ is bound, so that the RTL runs ahead.
struct Bench {
  explicit Bench(bool rtl) : pic("pic", time, engine_of(rtl)) {
    pic.ir[0](line);
    pic.irq(irq);
  }
  TimeBase time{"time"};
  InterruptController pic;
  sc_core::sc_signal<bool, sc_core::SC_UNCHECKED_WRITERS> line{"line"};
  sc_core::sc_signal<bool> irq{"irq"};
};

std::string error_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const sc_core::sc_report& report) { return report.get_msg_type(); }
  return "";
}

// An input changes, and a process goes on for some delta cycles: for ever when `deltas` is 0, as the components do that
// wait for it.
std::string waits_for_the_end(bool rtl, unsigned deltas) {
  Bench bench(rtl);
  sc_core::sc_spawn([&] {
    sc_core::wait(100, SC_NS);
    bench.line = true;
    sc_core::wait(SC_ZERO_TIME);
    if (deltas == 0)
      while (sc_core::sc_pending_activity_at_current_time()) sc_core::wait(SC_ZERO_TIME);
    for (unsigned i = 0; i < deltas; ++i) sc_core::wait(SC_ZERO_TIME);
  });
  return error_of([] { sc_core::sc_start(1, SC_US); });
}

TEST(Instant, ThatDoesNotEndIsAnError) {
  BRICK_COVERS("CARD-1");
  for (const bool rtl : {false, true}) {
    in_own_process([rtl] { EXPECT_EQ(waits_for_the_end(rtl, 0), "/brick/instant"); });
    in_own_process([rtl] { EXPECT_EQ(waits_for_the_end(rtl, 99'000), "") << "long is not for ever"; });
    in_own_process([rtl] { EXPECT_EQ(waits_for_the_end(rtl, 101'000), "/brick/instant") << "the bound"; });
  }
}

// sc_main() changes a pin and settles it by delta cycles, twice in one instant.
std::string two_changes(bool rtl, unsigned deltas_between) {
  Bench bench(rtl);
  sc_core::sc_start(1, SC_US);
  return error_of([&] {
    bench.line = true;
    for (unsigned i = 0; i < deltas_between; ++i) sc_core::sc_start(SC_ZERO_TIME);
    bench.line = false;
    sc_core::sc_start(1, SC_US);
  });
}

TEST(Instant, IsOverForTheRtlWhenItHasSettled) {
  BRICK_COVERS("CARD-1");
  for (const unsigned deltas : {0u, 1u, 2u})
    in_own_process([deltas] { EXPECT_EQ(two_changes(false, deltas), "") << deltas; });
  in_own_process([] { EXPECT_EQ(two_changes(true, 0), "") << "one change"; });
  in_own_process([] { EXPECT_EQ(two_changes(true, 2), "/brick/ahead"); });
}

// A level that a thread of the operating system sets, at no time of the kernel's own.
class OtherThread : public sc_core::sc_prim_channel {
 public:
  explicit OtherThread(sc_core::sc_signal<bool, sc_core::SC_UNCHECKED_WRITERS>& line)
      : sc_prim_channel("other_thread") {
    sc_core::sc_spawn_options writes;
    writes.spawn_method();
    writes.dont_initialize();
    writes.set_sensitivity(&updated_);
    sc_core::sc_spawn([this, &line] { line = level_; }, "writes", &writes);
  }
  ~OtherThread() override { stop(); }
  void run() {
    thread_ = std::thread([this] {
      while (!stop_) {
        level_ = !level_;
        async_request_update();
        std::this_thread::sleep_for(std::chrono::microseconds(50));  // or the kernel's instant would have no end
      }
    });
  }
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  unsigned updates = 0;

 private:
  void update() override {
    ++updates;
    updated_.notify(SC_ZERO_TIME);
  }
  sc_core::sc_event updated_;
  std::atomic<bool> level_{false}, stop_{false};
  std::thread thread_;
};

// Changes of the line that a component has seen without an error.
unsigned asynchronous(bool rtl, bool sampled, unsigned updates = 300) {
  Bench bench(rtl);
  sc_core::sc_signal<bool, sc_core::SC_UNCHECKED_WRITERS> raw("raw");
  OtherThread other(sampled ? raw : bench.line);
  unsigned changes = 0;
  sc_core::sc_spawn_options counts;
  counts.spawn_method();
  counts.dont_initialize();
  counts.set_sensitivity(&bench.line.value_changed_event());
  sc_core::sc_spawn([&] { ++changes; }, "counts", &counts);
  sc_core::sc_spawn([&] {
    for (;;) {
      sc_core::wait(100, SC_NS);
      if (sampled) bench.line = raw.read();
    }
  });
  other.run();
  while (other.updates < updates || changes < 10) sc_core::sc_start(100, SC_US);
  other.stop();
  return changes;
}

TEST(Instant, PinsOfAnotherThreadGoToTheModelOrAreSampled) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { EXPECT_GE(asynchronous(false, false), 10u); });
  in_own_process([] { EXPECT_GE(asynchronous(true, true), 10u); });
  in_own_process([] { EXPECT_EQ(error_of([] { asynchronous(true, false, 100'000); }), "/brick/ahead") << "neither"; });
}

}  // namespace
}  // namespace brick::component
