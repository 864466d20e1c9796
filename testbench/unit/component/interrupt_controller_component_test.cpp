// The interrupt controller's component against the block inside, as servo_ic_component_test.cpp does it.
#include <gtest/gtest.h>

#include <brick/interrupt_controller.h>
#include <brick/rtl.h>

#include "systemc/host/host_interrupt.h"
#include "systemc/host/interrupt_controller.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

class PicBlock final : public Block {
 public:
  PicBlock() : pic_("block"), line_("line") {
    pic_.reset(0);
    line_.reset(0);
  }

  void set(const std::string& pin, std::uint32_t value) override {
    if (pin == "rst_n") reset_ = value == 0;
    if (pin == "resetdrv") pic_.in.reset = value != 0;
    if (pin.rfind("ir", 0) == 0) {
      const unsigned line = static_cast<unsigned>(pin[2] - '0');
      pic_.in.line = static_cast<std::uint8_t>((pic_.in.line & ~(1u << line)) | value << line);
    }
    if (reset_) reset(now_);
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      reset(t);
    else if (!is_ref_edge(t) || !write_)
      step(t);
  }
  bool moved() override { return true; }
  std::uint32_t read(unsigned address) override { return pic_.read(address); }
  void before(const Access& access) override { write_ = access.write; }
  void accessed(const Access& access) override {
    if (access.write && !reset_) {
      pic_.in.wr = true;
      pic_.in.addr = static_cast<std::uint8_t>(access.address);
      pic_.in.wdata = static_cast<std::uint8_t>(access.value);
      step(now_);
      pic_.in.wr = false;
    }
    write_ = false;
  }
  std::map<std::string, std::uint32_t> outputs() const override { return {{"irq", line_.irq()}}; }

 private:
  // The line of the bus sees what the controller showed before the edge.
  void step(Tick t) {
    line_.in = {pic_.request(), pic_.served()};
    line_.advance(t);
    pic_.advance(t);
  }
  void reset(Tick t) {
    pic_.reset(t);
    line_.reset(t);
  }

  brick::InterruptController pic_;
  HostInterrupt line_;
  bool reset_ = false, write_ = false;
  Tick now_ = 0;
};

Traffic interrupt_traffic(std::uint32_t seed) {
  Traffic traffic;
  traffic.end = edge_time(kTicks);
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}};
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += below(6) == 0 ? below(3) : 1000 + below(500'000);
    if (below(4) == 0) now = edge_time(edge_after(now)) - below(2);
    turn(now, "ir" + std::to_string(below(8)));
    if (below(100) == 0) turn(now, "resetdrv");
    if (below(300) == 0) {
      turn(now, "rst_n");
      now += 1 + below(60'000);
      turn(now, "rst_n");
    }
  }
  std::stable_sort(traffic.pins.begin(), traffic.pins.end(),
                   [](const PinChange& a, const PinChange& b) { return a.time < b.time; });
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500)
    traffic.accesses.push_back({below(6) == 0 ? below(40'000) : below(1'500'000), below(2) == 0, below(4), below(256)});
  return traffic;
}

TEST(InterruptControllerComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    PicBlock block;
    agrees<InterruptController>(block, interrupt_traffic(seed), engine, quantum, 1, all, 8000, 1000);
  });
}

}  // namespace
}  // namespace brick::component
