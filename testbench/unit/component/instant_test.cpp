// What belongs to one instant of the kernel: when it has ended, and who can still change a pin in it.
#include <gtest/gtest.h>
#include <sysc/kernel/sc_dynamic_processes.h>

#include <brick/interrupt_controller.h>
#include <brick/rtl.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "testbench/unit/component/engines.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::SC_NS;
using sc_core::SC_US;
using sc_core::SC_ZERO_TIME;

// A reset of the controller shows at once in what a debug read gives; IRQ is bound, so that the RTL runs ahead.
struct PicBench {
  explicit PicBench(bool rtl) : pic("pic", time, model_or_rtl(rtl)) {
    pic.ir[0](line);
    pic.irq(irq);
  }
  TimeBase time{"time"};
  InterruptController pic;
  sc_core::sc_signal<bool, sc_core::SC_UNCHECKED_WRITERS> line{"line"};
  sc_core::sc_signal<bool> irq{"irq"};
};

// An input changes, and a process goes on for some delta cycles.
std::string goes_on(bool rtl, unsigned deltas) {
  PicBench bench(rtl);
  sc_core::sc_spawn([&] {
    sc_core::wait(100, SC_NS);
    bench.line = true;
    for (unsigned i = 0; i < deltas; ++i) sc_core::wait(SC_ZERO_TIME);
  });
  return error_of([] { sc_core::sc_start(1, SC_US); });
}

// The line turns over in each delta cycle.
std::string goes_round(bool rtl, unsigned turns) {
  PicBench bench(rtl);
  sc_core::sc_spawn_options circle;
  circle.spawn_method();
  circle.dont_initialize();
  circle.set_sensitivity(&bench.line.value_changed_event());
  sc_core::sc_spawn([&] { bench.line = turns-- > 1 ? !bench.line.read() : bench.line.read(); }, "circle", &circle);
  sc_core::sc_spawn([&] {
    sc_core::wait(100, SC_NS);
    bench.line = true;
  });
  return error_of([] { sc_core::sc_start(1, SC_US); });
}

TEST(Instant, WhosePinsDoNotComeToRestIsAnError) {
  BRICK_COVERS("CARD-1");
  for (const bool rtl : {false, true}) {
    in_own_process([rtl] { EXPECT_EQ(goes_on(rtl, 101'000), "") << "other processes"; });
    in_own_process([rtl] { EXPECT_EQ(goes_round(rtl, 99'000), "") << "long is not for ever"; });
    in_own_process([rtl] { EXPECT_EQ(goes_round(rtl, 101'000), "/brick/instant") << "the bound"; });
  }
}

// At 100 ns a line rises, a register is read, and a process asks in each delta cycle, as the components do, whether
// anything is pending in this instant; then it sets the line anew.
struct Polled {
  unsigned asked = 0;
  sc_core::sc_time end, answered;
  std::uint32_t signals = 0;  // of the lines, some time later
};
enum class Asks { kNobody, kThread, kMethod };

Polled polled(bool rtl, Asks who, bool line_after) {
  PicBench bench(rtl);
  Polled seen;
  Initiator initiator("initiator", [&](Initiator& i) {
    const auto read = [&i] { EXPECT_EQ(i.send(i.payload(tlm::TLM_READ_COMMAND, 1, 1)), tlm::TLM_OK_RESPONSE); };
    sc_core::wait(100, SC_NS);
    read();
    seen.answered = sc_core::sc_time_stamp();
    sc_core::wait(1, SC_US);
    read();
    seen.signals = i.data & 0xFF;
  });
  initiator.socket.bind(bench.pic.registers);
  const auto over = [&seen] {
    ++seen.asked;
    return !sc_core::sc_pending_activity_at_current_time();
  };
  const auto ended = [&] {
    seen.end = sc_core::sc_time_stamp();
    bench.line = line_after;
  };
  sc_core::sc_event ask;
  sc_core::sc_spawn_options method;
  method.spawn_method();
  method.dont_initialize();
  method.set_sensitivity(&ask);
  sc_core::sc_spawn([&] { over() ? ended() : ask.notify(SC_ZERO_TIME); }, "method", &method);
  sc_core::sc_spawn([&] {
    sc_core::wait(100, SC_NS);
    bench.line = true;
    sc_core::wait(SC_ZERO_TIME);
    if (who == Asks::kMethod) return ask.notify(SC_ZERO_TIME);
    while (who == Asks::kThread && !over()) sc_core::wait(SC_ZERO_TIME);
    ended();
  });
  EXPECT_EQ(error_of([] { sc_core::sc_start(10, SC_US); }), "");
  return seen;
}

TEST(Instant, EndsForAProcessThatAsksForItToo) {
  BRICK_COVERS("CARD-1");
  for (const bool rtl : {false, true})
    for (const bool line_after : {false, true})
      for (const Asks who : {Asks::kNobody, Asks::kThread, Asks::kMethod}) {
        SCOPED_TRACE(::testing::Message() << "rtl " << rtl << ", line " << line_after << ", " << static_cast<int>(who));
        in_own_process([=] {
          const Polled seen = polled(rtl, who, line_after);
          EXPECT_EQ(seen.end, sc_core::sc_time(100, SC_NS));
          EXPECT_EQ(seen.asked > 0, who != Asks::kNobody);
          EXPECT_LE(seen.asked, 100u);
          // edge 12 is the first of clk_ref after 100 ns, at 12 x 78125/9216 ns = 101.72526 ns
          EXPECT_EQ(seen.answered, sc_core::sc_time(101726, sc_core::SC_PS));
          EXPECT_EQ(seen.signals, line_after ? 1u : 0u) << "the last level of the instant";
        });
      }
}

// sc_main() changes a pin and settles it by delta cycles, twice in one instant.
std::string two_changes(bool rtl, unsigned deltas_between) {
  PicBench bench(rtl);
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
  PicBench bench(rtl);
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
