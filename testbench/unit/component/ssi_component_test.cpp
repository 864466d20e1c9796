// The component of the serial encoder inputs against the block inside, as servo_ic_component_test.cpp does it.
#include <gtest/gtest.h>

#include <brick/ssi.h>

#include "systemc/ssi/ssi.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr Tick kSsiTicks = 500'000;

class SsiBlock final : public Block {
 public:
  SsiBlock() : ssi_("block") { ssi_.reset(0); }

  void set(const std::string& pin, std::uint32_t value) override {
    if (!reset_) ssi_.advance(now_);
    if (pin == "rst_n") reset_ = value == 0;
    if (pin == "geo") ssi_.geo = value != 0;
    if (pin == "phase") ssi_.phase = value != 0;
    if (pin == "servo") ssi_.servo = value != 0;
    if (pin.rfind("data", 0) == 0) {
      const unsigned bit = 1u << (pin.back() - '0');
      ssi_.data = static_cast<std::uint8_t>((ssi_.data & ~bit) | (value != 0 ? bit : 0));
    }
    if (reset_) ssi_.reset(now_);
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      ssi_.reset(t);
    else
      ssi_.advance(t);
  }
  bool moved() override {
    const unsigned before = shown_;
    shown_ = ssi_.clk();
    return shown_ != before;
  }
  std::uint32_t read(unsigned address) override { return ssi_.read(address % 8 == 4, address / 8); }
  void before(const Access& a) override {
    if (!a.write && !reset_) ssi_.read_taken(a.address % 8 == 4, a.address / 8);
  }
  void accessed(const Access& a) override {
    if (a.write && !reset_) ssi_.write(a.address % 8 == 4, a.address / 8, a.value & 0xFFFFFF);
  }
  std::map<std::string, std::uint32_t> outputs() const override {
    std::map<std::string, std::uint32_t> levels;
    for (unsigned n = 0; n < 8; ++n) levels["clk" + std::to_string(n)] = ssi_.clk() >> n & 1u;
    return levels;
  }

 private:
  brick::Ssi ssi_;
  bool reset_ = false;
  Tick now_ = 0;
  unsigned shown_ = 0xFF;
};

// Frames at the fastest clocks one after the other, of whatever the data lines show; a reset now and then, with the
// product's strap beside it.
Traffic ssi_traffic(std::uint32_t seed) {
  Traffic traffic;
  traffic.end = edge_time(kSsiTicks);
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}, {"phase", 1}, {"servo", 1}};
  for (unsigned n = 0; n < 8; ++n) level["data" + std::to_string(n)] = 1;
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += below(6) == 0 ? below(3) : 1000 + below(800'000);
    if (below(4) == 0) now = edge_time(edge_after(now)) - below(2);
    if (below(20) != 0)
      turn(now, "data" + std::to_string(below(8)));
    else
      turn(now, below(3) == 0 ? "phase" : "servo");
    if (below(4000) == 0) {
      turn(now, "rst_n");
      if (below(2) == 0) turn(now, "geo");
      turn(now += 1 + below(60'000), "rst_n");
    }
  }
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500) {
    const auto x = [](std::uint32_t address) { return 8 * address + 4; };
    Access a{below(6) == 0 ? below(40'000) : below(1'500'000), below(3) == 0, 4 * below(128), below(1u << 24)};
    if (a.write) a.address = x(0x20 + 4 * below(8)), a.value = below(1u << 16) | 0x1400;
    if (below(8) == 0) a = {a.idle, true, x(below(2) == 0 ? 0x2F : 0x3F), below(30) << 16 | below(4) << 8 | 2};
    if (below(8) == 0) a = {a.idle, true, x(below(2) == 0 ? 0x14 : 0x34), 2 | below(16)};
    if (below(8) == 0) a = {a.idle, true, x(0x15), 3};
    traffic.accesses.push_back(a);
  }
  return traffic;
}

TEST(SsiComponent, AgreesWithTheBlock) {
  BRICK_COVERS("SSI-1");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    SsiBlock block;
    agrees<Ssi>(block, ssi_traffic(seed), engine, quantum, 4, all, 4000, 1000);
  });
}

}  // namespace
}  // namespace brick::component
