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
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      inner_.reset(t);
    else if (!write_)
      inner_.advance(t);
  }
  bool moved() override {
    const unsigned before = shown_;
    shown_ = levels();
    return shown_ != before;
  }
  void before(const Access& access) override { write_ = access.write; }
  void accessed(const Access& access) override {
    if (access.write && !reset_) strobe(access);
    write_ = false;
  }

 protected:
  virtual void set_pin(const std::string& pin, std::uint32_t value) = 0;
  virtual void strobe(const Access& access) = 0;
  virtual unsigned levels() const = 0;  // of all outputs
  Inner inner_;
  Tick now_ = 0;

 private:
  bool reset_ = false, write_ = false;
  unsigned shown_ = 0;
};

class HostSignalsBlock final : public StrobedBlock<brick::HostSignals> {
 public:
  std::uint32_t read(unsigned address) override { return address == 0 ? inner_.rdata() : inner_.ctrl(); }
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"ipos", inner_.ipos()}, {"breq", inner_.breq()},       {"eror", inner_.eror()},
            {"f1er", inner_.f1er()}, {"ctrl0", inner_.ctrl() & 1u}, {"ctrl1", inner_.ctrl() >> 1 & 1u}};
  }

 private:
  void set_pin(const std::string& pin, std::uint32_t value) override {
    if (pin == "trip") inner_.in.trip = value != 0;
  }
  unsigned levels() const override {
    return inner_.ipos() | inner_.breq() << 1 | inner_.eror() << 2 | inner_.f1er() << 3 | inner_.ctrl() << 4;
  }
  void strobe(const Access& access) override {
    inner_.in = {access.address == 0, access.address == 4, static_cast<std::uint8_t>(access.value & 0xF),
                 inner_.in.trip};
    inner_.advance(now_);
    inner_.in.wr = inner_.in.ctrl_wr = false;
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
  unsigned levels() const override { return inner_.trip() | inner_.relay() << 1; }
  void strobe(const Access&) override {
    inner_.strobe = true;
    inner_.advance(now_);
    inner_.strobe = false;
  }
};

class Instants {
 public:
  explicit Instants(std::uint32_t seed) : random_(seed) {}
  Picoseconds below(Picoseconds n) { return random_() % n; }
  // Up to `most` after `now`; one in four in the instant of an edge, or right before.
  Picoseconds after(Picoseconds now, Picoseconds most) {
    now += 1 + below(most);
    return below(4) == 0 ? edge_time(edge_after(now)) - below(2) : now;
  }

 private:
  std::mt19937_64 random_;
};

void add_pulse(Traffic& traffic, Picoseconds at, const std::string& pin, Picoseconds length) {
  traffic.pins.push_back({at, pin, 0});
  traffic.pins.push_back({at + length, pin, 1});
}

Traffic host_signals_traffic(std::uint32_t seed) {
  Traffic traffic;
  traffic.end = edge_time(1'000'000);
  Instants random(seed);
  for (Picoseconds now = 0; now < traffic.end; now = traffic.pins.back().time)
    add_pulse(traffic, random.after(now, 1'000'000'000), "rst_n", 1 + random.below(60'000));
  bool trip = false;
  for (Picoseconds at = random.after(0, 300'000'000); at < traffic.end; at = random.after(at, 300'000'000))
    traffic.pins.push_back({at, "trip", trip = !trip});
  std::stable_sort(traffic.pins.begin(), traffic.pins.end(),
                   [](const PinChange& a, const PinChange& b) { return a.time < b.time; });
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500)
    traffic.accesses.push_back({random.below(1'500'000), random.below(2) == 0,
                                4 * static_cast<std::uint32_t>(random.below(2)),
                                static_cast<std::uint32_t>(random.below(256))});
  return traffic;
}

constexpr Picoseconds kUs = 1'000'000, kMs = 1000 * kUs;

// Lives from one reset to the next: a millisecond with strobes a few microseconds apart and SERVO running, then the
// watchdog trips, because one of the two rests for 25 ms (servo-ic:10) or because 5 V fail.
enum class Trip { kStrobe, kServo, kPower };
constexpr Trip kLives[] = {Trip::kStrobe, Trip::kServo, Trip::kPower, Trip::kStrobe};

Traffic watchdog_traffic(std::uint32_t seed) {
  Traffic traffic;
  Instants random(seed);
  Picoseconds begun = 0, free = 0;  // the life; the last access ends about then
  bool servo = true;
  const auto accesses = [&](Picoseconds end, Picoseconds most, bool only_writes) {
    for (; free < end; free += traffic.accesses.back().idle + 3 * 8'500)
      traffic.accesses.push_back({random.below(most), only_writes || random.below(2) == 0, 0, 0});
  };
  const auto turns = [&](Picoseconds from, Picoseconds end, Picoseconds most) {
    for (Picoseconds at = random.after(from, most); at < end; at = random.after(at, most))
      traffic.pins.push_back({at, "servo", servo = !servo});
  };
  for (const Trip trip : kLives) {
    const Picoseconds busy = begun + kMs, rest = trip == Trip::kPower ? kMs : 26 * kMs + random.below(2 * kMs);
    accesses(busy, 4 * kUs, false);
    turns(begun, busy, 100 * kUs);
    if (trip == Trip::kPower) add_pulse(traffic, busy, "pwr_good", 200'000);
    if (trip == Trip::kServo) accesses(busy + rest, 100 * kUs, true);
    if (trip == Trip::kStrobe) turns(busy, busy + rest, 5 * kMs);
    begun = busy + rest;
    if (free < begun) {  // the next strobe is in the next life
      traffic.accesses.push_back({begun - free, true, 0, 0});
      free = begun;
    }
    add_pulse(traffic, begun, "rst_n", 1 + random.below(60'000));
    begun += 100'000;
  }
  traffic.end = begun;
  std::stable_sort(traffic.pins.begin(), traffic.pins.end(),
                   [](const PinChange& a, const PinChange& b) { return a.time < b.time; });
  return traffic;
}

template <class C>
void latches_agree(Block& block, const Traffic& traffic, const Engine& engine, const sc_core::sc_time& quantum,
                   std::size_t least_accesses, const std::vector<std::string>& pins, std::size_t least) {
  const Seen expected = run(block, traffic);
  EXPECT_GE(expected.answers.size(), least_accesses);
  counts(expected, pins, least);
  TimeBase time("time");
  C component("component", time, engine);
  does(expected, traffic, component, quantum, 4, 4, all, [](Rig& rig, C& c) { rig.socket().bind(c.registers); });
}

TEST(HostSignalsComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    HostSignalsBlock block;
    latches_agree<HostSignals>(block, host_signals_traffic(seed), engine, quantum, 8000,
                               {"ipos", "breq", "eror", "f1er", "ctrl0", "ctrl1"}, 500);
  });
}

// Each life has one trip, and the reset that ends it.
TEST(WatchdogComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    WatchdogBlock block;
    latches_agree<Watchdog>(block, watchdog_traffic(seed), engine, quantum, 1000, {"trip", "relay"},
                            2 * std::size(kLives) - 1);
  });
}

}  // namespace
}  // namespace brick::component
