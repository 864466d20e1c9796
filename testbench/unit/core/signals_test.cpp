// Named signals: look-up by name, present values, text.
#include "systemc/core/signals.h"

#include <stdexcept>
#include <vector>

#include "systemc/core/trace.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

TEST(Signals, AreFoundWithAndWithoutTopScope) {
  Signals s;
  const auto phase = s.add("clock.phase", 1, Radix::kBinary, 1);
  EXPECT_EQ(s.find("clock.phase"), phase);
  EXPECT_EQ(s.find("brick.clock.phase"), phase);
  EXPECT_FALSE(s.find("clock"));
  EXPECT_FALSE(s.find("brick."));
  EXPECT_EQ(s.value(phase), 1u);
}

TEST(Signals, HoldTheValueSetLast) {
  Signals s;
  const auto a = s.add("host.isa.sa", 20, Radix::kHex);
  const auto t = s.add("cpu.symbol", 1, Radix::kText);
  s.set(a, 100, 0xD0000);
  s.set_text(t, 100, "main");
  EXPECT_EQ(s.value(a), 0xD0000u);
  EXPECT_EQ(s.text(t), "main");
}

TEST(Signals, RefuseASecondSignalOfTheSameName) {
  Signals s;
  s.add("bus.addr", 19, Radix::kHex);
  EXPECT_THROW(s.add("bus.addr", 19, Radix::kHex), std::logic_error);
}

class TimesOfFlushes : public TraceWriter {
 public:
  void declare(Signals::Id, const Signals::Info&, Signals::Id) override {}
  void record(Signals::Id, TimeFs, std::uint64_t) override {}
  void record_text(Signals::Id, TimeFs, const std::string&) override {}
  void flush_until(TimeFs time) override { times.push_back(time); }
  void close() override {}
  std::vector<TimeFs> times;
};

TEST(Signals, TellTheWaveformHowFarTheyAre) {
  Signals s;
  TimesOfFlushes trace;
  s.flush_until(1);
  s.attach(&trace);
  s.flush_until(2);
  s.flush_until(5);
  s.attach(nullptr);
  s.flush_until(6);
  EXPECT_EQ(trace.times, (std::vector<TimeFs>{2, 5}));
}

}  // namespace
}  // namespace brick
