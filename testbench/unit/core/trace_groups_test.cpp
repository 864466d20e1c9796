// What goes into a waveform: names and globs, the default, aliases, and that what is left out is neither declared nor
// recorded.
#include "systemc/core/trace_groups.h"

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "systemc/core/signals.h"
#include "systemc/core/trace.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

TEST(TraceGroups, TakeWholeNamesEndsBehindADotAndGlobs) {
  const struct {
    const char* pattern;
    std::vector<std::string> yes, no;
  } cases[] = {
      {"host.breq", {"host.breq"}, {"host.breqs", "xhost.breq", "host.irq"}},
      {"breq", {"host.breq"}, {"host.abreq", "breq.host"}},
      {"brick.host.breq", {"host.breq"}, {"clock.phase"}},
      {"host.*", {"host.breq", "host.isa.sa", "host.pic.ist"}, {"dpram.busy_host", "hosts.a"}},
      {"servo_ic?.ch1.pwm_*", {"servo_ic0.ch1.pwm_a_top"}, {"servo_ic0.ch2.pwm_a_top", "servo_ic10.ch1.pwm_a_top"}},
      {"ch2.*", {"servo_ic0.ch2.dac", "servo_ic2s.ch2.equ"}, {"servo_ic0.ch1.dac"}},
      {"all", {"clock.phase", "servo_ic0.ch1.dac_clk"}, {}},
  };
  for (const auto& c : cases) {
    const TraceGroups groups({c.pattern});
    for (const std::string& name : c.yes) EXPECT_TRUE(groups.select(name)) << c.pattern << " " << name;
    for (const std::string& name : c.no) EXPECT_FALSE(groups.select(name)) << c.pattern << " " << name;
  }
}

TEST(TraceGroups, LeaveOutTheSerialClocksByDefault) {
  const TraceGroups groups;
  EXPECT_FALSE(groups.select("servo_ic0.ch1.dac_clk"));
  EXPECT_FALSE(groups.select("servo_ic9s.ch4.adc_clk"));
  for (const char* name : {"clock.phase", "servo_ic0.ch1.dac", "servo_ic0.ch1.dac_strobe", "servo_ic0.ch1.adc_strobe"})
    EXPECT_TRUE(groups.select(name)) << name;
}

TEST(TraceGroups, NameThePatternThatNoSignalHas) {
  Signals signals;
  signals.add("clock.phase", 1, Radix::kBinary);
  EXPECT_EQ(TraceGroups({"phase", "clock.*", "all"}).unmatched(signals), std::nullopt);
  EXPECT_EQ(TraceGroups({"phase", "host.*", "none"}).unmatched(signals), "host.*");
  EXPECT_EQ(TraceGroups().unmatched(signals), std::nullopt);
}

// Keeps what a writer is told.
struct Recorder : TraceWriter {
  void declare(Signals::Id, const Signals::Info& info, Signals::Id of) override { names.emplace_back(info.name, of); }
  void record(Signals::Id id, TimeFs time, std::uint64_t value) override {
    if (time > 0) records.emplace_back(id, value);
  }
  void record_text(Signals::Id, TimeFs, const std::string&) override {}
  void flush_until(TimeFs) override {}
  void close() override {}
  std::vector<std::pair<std::string, Signals::Id>> names;
  std::vector<std::pair<Signals::Id, std::uint64_t>> records;
};

TEST(TracedSignals, ThatAreLeftOutAreNeitherDeclaredNorRecordedButAskedFor) {
  BRICK_COVERS("CARD-4");
  Signals signals;
  const auto phase = signals.add("clock.phase", 1, Radix::kBinary), bits = signals.add("x.dac_clk", 1, Radix::kBinary);
  signals.ask(bits, [] { return 7; });
  Recorder trace;
  signals.attach(&trace, TraceGroups());
  const auto late = signals.add("y.adc_clk", 1, Radix::kBinary);
  signals.set(phase, 10, 1);
  signals.set(bits, 10, 1);
  signals.set(late, 10, 1);
  EXPECT_THAT(trace.names, ElementsAre(Pair("clock.phase", phase)));
  EXPECT_THAT(trace.records, ElementsAre(Pair(phase, 1u)));
  EXPECT_TRUE(signals.traced(phase));
  EXPECT_FALSE(signals.traced(bits));
  EXPECT_EQ(signals.value(bits), 7u) << "nobody follows it";
  signals.attach(&trace);
  signals.set(bits, 20, 0);
  EXPECT_EQ(signals.value(bits), 0u) << "the waveform follows it";
  signals.attach(nullptr);
  EXPECT_FALSE(signals.traced(phase));
}

TEST(TracedSignals, WithSeveralNamesAreRecordedOnceUnderThoseSelected) {
  Signals signals;
  const auto clk = signals.add("ch1.clk", 1, Radix::kBinary);
  signals.add_alias("ch2.clk", clk);
  const auto third = signals.add_alias("ch3.clk", clk);
  Recorder trace;
  signals.attach(&trace, TraceGroups({"ch2.*", "ch3.*"}));
  signals.set(clk, 10, 1);
  EXPECT_THAT(trace.names, UnorderedElementsAre(Pair("ch2.clk", clk), Pair("ch3.clk", clk)));
  EXPECT_THAT(trace.records, ElementsAre(Pair(clk, 1u)));
  EXPECT_EQ(signals.value(third), 1u);
  Recorder none;
  signals.attach(&none, TraceGroups({"ch4.*"}));
  signals.set(clk, 20, 0);
  EXPECT_THAT(none.names, IsEmpty());
  EXPECT_THAT(none.records, IsEmpty());
}

}  // namespace
}  // namespace brick
