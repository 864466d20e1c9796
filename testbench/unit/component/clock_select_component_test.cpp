// The component of the clock selection against the block inside, as servo_ic_component_test.cpp does it.
#include <gtest/gtest.h>

#include <brick/clock_select.h>

#include "systemc/board/clock_select.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

class ClockSelectBlock final : public Block {
 public:
  ClockSelectBlock() : select_("block") { select_.reset(0); }

  void set(const std::string& pin, std::uint32_t value) override {
    level_[pin] = value;
    select_.in.phase = bits("phase_oe_i", 0) & fitted();
    select_.in.servo = bits("servo_oe_i", 0) & fitted();
    select_.in.ext = level("ext_clock", 0) != 0;
    select_.phase_level = bits("phase_i", 1);
    select_.servo_level = bits("servo_i", 1);
    select_.ext_phase = level("ext_phase", 1) != 0;
    select_.ext_servo = level("ext_servo", 1) != 0;
    reset_ = level("rst_n", 1) == 0;
    if (reset_) select_.reset(now_);
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      select_.reset(t);
    else
      select_.advance(t);
  }
  bool moved() override {
    const unsigned before = shown_;
    shown_ = select_.phase() | select_.servo() << 1 | select_.conflict() << 2 | select_.phase_source() << 3;
    return shown_ != before;
  }
  std::uint32_t read(unsigned) override { return 0; }
  void accessed(const Access&) override {}
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"phase", select_.phase()},
            {"servo", select_.servo()},
            {"phase_source", select_.phase_source()},
            {"conflict", select_.conflict()}};
  }

 private:
  std::uint32_t level(const std::string& pin, std::uint32_t idle) const {
    const auto at = level_.find(pin);
    return at == level_.end() ? idle : at->second;
  }
  std::uint32_t fitted() const { return level("fitted", 0x3FFFFF); }
  std::uint32_t bits(const std::string& pin, std::uint32_t idle) const {
    std::uint32_t all = 0;
    for (unsigned ic = 0; ic < 22; ++ic) all |= level(pin + std::to_string(ic), idle) << ic;
    return all;
  }
  brick::ClockSelect select_;
  std::map<std::string, std::uint32_t> level_;
  bool reset_ = false;
  Tick now_ = 0;
  unsigned shown_ = 0;
};

// A source, often a second one that disagrees now and then, seldom none or clocks from outside.
Traffic clock_select_traffic(std::uint32_t seed) {
  Traffic traffic;
  traffic.end = edge_time(kTicks);
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}, {"ext_phase", 1}, {"ext_servo", 1}};
  for (unsigned ic = 0; ic < 22; ++ic)
    level["phase_i" + std::to_string(ic)] = level["servo_i" + std::to_string(ic)] = 1;
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  unsigned source[2] = {below(22), below(22)};
  for (Picoseconds now = 0; now < traffic.end;) {
    now += below(6) == 0 ? below(3) : 1000 + below(600'000);
    if (below(4) == 0) now = edge_time(edge_after(now)) - below(2);
    const std::string ic = std::to_string(source[below(2)]);
    switch (below(10)) {
      case 0:
        turn(now, (below(2) == 0 ? "phase_oe_i" : "servo_oe_i") + ic);
        break;
      case 1:
        source[below(2)] = below(22);
        break;
      case 2:
        turn(now, below(2) == 0 ? "ext_phase" : "ext_servo");
        if (below(6) == 0) turn(now, "ext_clock");
        break;
      case 3:
        if (below(4) == 0) traffic.pins.push_back({now, "fitted", below(4) == 0 ? below(1u << 22) : 0x3FFFFF});
        if (below(20) == 0) turn(now, "rst_n"), turn(now += 1 + below(60'000), "rst_n");
        break;
      default: {  // the two ICs together, or one alone or later by up to five ticks
        const std::string net = below(3) == 0 ? "servo_i" : "phase_i";
        turn(now, net + std::to_string(source[0]));
        if (below(2) == 0 && source[0] != source[1]) turn(now += below(45'000), net + std::to_string(source[1]));
        break;
      }
    }
  }
  return traffic;
}

TEST(ClockSelectComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    const Traffic traffic = clock_select_traffic(seed);
    ClockSelectBlock block;
    const Seen expected = run(block, traffic);
    counts(expected, {"phase", "servo", "phase_source", "conflict"}, 200);
    TimeBase time("time");
    ClockSelect select("select", time, engine);
    does(expected, traffic, select, quantum, 4, 4, all, [](Rig&, ClockSelect&) {});
  });
}

}  // namespace
}  // namespace brick::component
