// The MACRO IC's component against the IC inside, as servo_ic_component_test.cpp does it.
#include <gtest/gtest.h>

#include <brick/macro_ic.h>

#include "systemc/macro_ic/macro_ic.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

class MacroIcBlock final : public Block {
 public:
  MacroIcBlock() : ic_("block") { ic_.reset(0); }

  void set(const std::string& pin, std::uint32_t value) override {
    if (pin == "rst_n") reset_ = value == 0;
    if (pin == "gate") ic_.set_gate(value != 0);
    if (pin == "phase_i") phase_ = value != 0;
    if (pin == "servo_i") servo_ = value != 0;
    ic_.set_pins(phase_, servo_);
    if (reset_) ic_.reset(now_);
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      ic_.reset(t);
    else
      ic_.advance(t);
  }
  bool moved() override {
    const unsigned before = shown_;
    shown_ = ic_.phase() | ic_.servo() << 1 | ic_.phase_oe() << 2 | ic_.servo_oe() << 3;
    return shown_ != before;
  }
  std::uint32_t read(unsigned address) override { return ic_.read(address % 8 == 4, address / 8); }
  void accessed(const Access& a) override {
    if (a.write && !reset_) ic_.write(a.address % 8 == 4, a.address / 8, a.value & 0xFFFFFF);
  }
  // A pin that is not driven is pulled up.
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"phase_o", !ic_.phase_oe() || ic_.phase()},
            {"servo_o", !ic_.servo_oe() || ic_.servo()},
            {"phase_oe", ic_.phase_oe()},
            {"servo_oe", ic_.servo_oe()}};
  }

 private:
  brick::MacroIc ic_;
  bool phase_ = true, servo_ = true, reset_ = false;
  Tick now_ = 0;
  unsigned shown_ = 0;
};

// Short clocks, directions both ways, kinds and resets now and then; some accesses to every word.
Traffic macro_ic_traffic(std::uint32_t seed) {
  constexpr unsigned kClock = 8 * 0x0C + 4, kPwm = 8 * 0x0D + 4;  // X words (servo-ic:6.2)
  Traffic traffic;
  traffic.end = edge_time(kTicks);
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}, {"phase_i", 1}, {"servo_i", 1}};
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += below(6) == 0 ? below(3) : 1000 + below(1'500'000);
    if (below(4) == 0) now = edge_time(edge_after(now)) - below(2);
    turn(now, below(3) == 0 ? "servo_i" : "phase_i");
    if (below(60) == 0) turn(now, "gate");
    if (below(3000) == 0) turn(now, "rst_n"), turn(now += 1 + below(60'000), "rst_n");
  }
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500) {
    Access a{below(6) == 0 ? below(40'000) : below(1'500'000), below(2) == 0, 4 * below(128), below(1u << 24)};
    if ((a.address == kPwm || a.address == kClock) && below(8) != 0) a.write = false;  // a long triangle lasts
    if (below(3) == 0) a = {a.idle, true, kPwm, (20 + below(60)) << 8 | below(256)};
    const std::uint32_t direction = below(3) == 0 ? below(4) : 0;
    if (below(20) == 0 || traffic.accesses.empty())
      a = {a.idle, true, kClock, below(2) << 20 | below(3) << 16 | direction << 12 | below(1u << 12)};
    traffic.accesses.push_back(a);
  }
  return traffic;
}

TEST(MacroIcComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    MacroIcBlock block;
    agrees<MacroIc>(block, macro_ic_traffic(seed), engine, quantum, 4, all, 8000, 3000);
  });
}

TEST(MacroIcComponent, UnboundPinsAreIdle) {
  BRICK_COVERS("CARD-1");
  const Binds few = [](const std::string& pin) { return pin == "phase_o" || pin == "servo_i"; };
  on_each_engine([&few](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    MacroIcBlock block;
    Traffic traffic = macro_ic_traffic(100 + seed);
    traffic.end = edge_time(kTicks / 5);
    agrees<MacroIc>(block, traffic, engine, quantum, 4, few, 1000, 300);
  });
}

}  // namespace
}  // namespace brick::component
