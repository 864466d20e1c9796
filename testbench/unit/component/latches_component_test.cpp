// The components of the host signals and of the watchdog against the blocks inside, as servo_ic_component_test.cpp.
#include <gtest/gtest.h>

#include <brick/host_signals.h>
#include <brick/rtl.h>
#include <brick/watchdog.h>

#include "systemc/board/watchdog.h"
#include "systemc/host/host_signals.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

// A block on clk_ref with a register strobe: the edge that makes a write is executed with it.
template <class Inner>
class StrobedBlock : public Block {
 public:
  StrobedBlock() : inner_("block") { inner_.reset(0); }

  void set(const std::string& pin, std::uint32_t value) override {
    inner_.advance(now_);
    if (pin == "rst_n") reset_ = value == 0;
    set_pin(pin, value);
    if (reset_) inner_.reset(now_);
    touched_ = true;
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      inner_.reset(t);
    else if (!write_)
      inner_.advance(t);
  }
  bool moved() override {
    const bool touched = touched_;
    touched_ = false;
    return touched || is_ref_edge(now_) || reset_;
  }
  void before(const Access& access) override { write_ = access.write; }
  void accessed(const Access& access) override {
    if (access.write && !reset_) strobe(access);
    write_ = false;
  }

 protected:
  virtual void set_pin(const std::string& pin, std::uint32_t value) = 0;
  virtual void strobe(const Access& access) = 0;
  Inner inner_;
  Tick now_ = 0;

 private:
  bool reset_ = false, write_ = false, touched_ = false;
};

class HostSignalsBlock final : public StrobedBlock<brick::HostSignals> {
 public:
  std::uint32_t read(unsigned address) override { return address == 0 ? inner_.rdata() : inner_.ctrl(); }
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"ipos", inner_.ipos()}, {"breq", inner_.breq()},       {"eror", inner_.eror()},
            {"f1er", inner_.f1er()}, {"ctrl0", inner_.ctrl() & 1u}, {"ctrl1", inner_.ctrl() >> 1 & 1u}};
  }

 private:
  void set_pin(const std::string&, std::uint32_t) override {}
  void strobe(const Access& access) override {
    inner_.in = {access.address == 0, access.address == 4, static_cast<std::uint8_t>(access.value & 0xF)};
    inner_.advance(now_);
    inner_.in = {};
  }
};

class WatchdogBlock final : public StrobedBlock<brick::Watchdog> {
 public:
  std::uint32_t read(unsigned) override { return 0; }
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"trip", inner_.trip()}, {"relay", inner_.relay()}};
  }

 private:
  void set_pin(const std::string& pin, std::uint32_t value) override {
    if (pin == "servo") inner_.servo = value != 0;
    if (pin == "pwr_good") inner_.pwr_good = value != 0;
  }
  void strobe(const Access&) override {
    inner_.strobe = true;
    inner_.advance(now_);
    inner_.strobe = false;
  }
};

struct Pace {
  Tick ticks;
  Picoseconds access, pins;  // between two, at most
  unsigned reset_one_in;     // changes of pins
};

// `lines`: pins that turn, the first most often; resets in between.
Traffic traffic_of(std::uint32_t seed, const Pace& pace, const std::vector<std::string>& lines, std::uint32_t words) {
  Traffic traffic;
  traffic.end = edge_time(pace.ticks);
  std::mt19937_64 random(seed);
  const auto below = [&random](std::uint64_t n) { return random() % n; };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}, {"servo", 1}, {"pwr_good", 1}};
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += 1 + below(pace.pins);
    if (below(4) == 0) now = edge_time(edge_after(now)) - below(2);
    if (!lines.empty() && below(8) != 0) turn(now, lines.front());
    for (std::size_t i = 1; i < lines.size(); ++i)
      if (below(100) == 0) turn(now, lines[i]), turn(now += below(200'000), lines[i]);
    if (below(pace.reset_one_in) == 0) turn(now, "rst_n"), turn(now += 1 + below(60'000), "rst_n");
  }
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500)
    traffic.accesses.push_back({below(pace.access), below(2) == 0, 4 * static_cast<std::uint32_t>(below(words)),
                                static_cast<std::uint32_t>(below(256))});
  return traffic;
}

void host_signals_agree(const Engine& engine, double quantum_us, std::uint32_t seed) {
  HostSignalsBlock block;
  agrees<HostSignals>(block, traffic_of(seed, {1'000'000, 1'500'000, 100'000'000, 10}, {}, 2), engine,
                      {quantum_us, sc_core::SC_US}, 4, all, 8000, 3000);
}
// 68 ms: strobes up to 40 ms apart, SERVO up to 8 ms, so that it trips.
void watchdogs_agree(const Engine& engine, double quantum_us, std::uint32_t seed) {
  WatchdogBlock block;
  agrees<Watchdog>(block, traffic_of(seed, {8'000'000, 40'000'000'000, 8'000'000'000, 6}, {"servo", "pwr_good"}, 1),
                   engine, {quantum_us, sc_core::SC_US}, 4, all, 2, 3);
}

TEST(HostSignalsComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { host_signals_agree(model_engine(), 0, 1); });
  in_own_process([] { host_signals_agree(model_engine(), 10, 2); });
  in_own_process([] { host_signals_agree(rtl_engine(), 3, 3); });
  in_own_process([] { host_signals_agree(lockstep_engine(), 0, 4); });
}

TEST(WatchdogComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { watchdogs_agree(model_engine(), 0, 1); });
  in_own_process([] { watchdogs_agree(lockstep_engine(), 10, 2); });
  in_own_process([] { watchdogs_agree(rtl_engine(), 3, 3); });
}

}  // namespace
}  // namespace brick::component
