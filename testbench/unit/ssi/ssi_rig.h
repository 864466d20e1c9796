// Serial encoder inputs on one engine or on both, edge by edge of clk_pwm; a register access belongs to the next edge
// of clk_ref. The model sleeps until its own next event: a wrong prediction shows up as a difference to the RTL.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "systemc/ssi/ssi.h"
#include "testbench/unit/rtl/comparison.h"
#include "testbench/unit/ssi/rtl_ssi.h"

namespace brick {

struct SsiAccess {
  bool write, x;
  unsigned address;
  std::uint32_t value;
};

class RtlSsiRig {
 public:
  Tick now() const { return ssi_.now(); }
  unsigned clk() const { return ssi_.outputs().clk; }
  void reset(bool geo) {
    ssi_.in = {};
    ssi_.in.geo = geo;
    ssi_.reset();
  }
  void nets(bool phase, bool servo) {
    ssi_.in.phase = phase;
    ssi_.in.servo = servo;
  }
  void data(unsigned pins) { ssi_.in.data = pins; }
  void begin(const SsiAccess& a) {
    ssi_.in.sel = true;
    ssi_.in.x = a.x;
    ssi_.in.addr = a.address;
    ssi_.in.we = a.write;
    ssi_.in.rd = !a.write;
    ssi_.in.wdata = a.value;
  }
  void tick() {
    if (ssi_.in.sel && (now() + 1) % kTicksPerRef == 0) {
      ssi_.settle();
      taken_ = ssi_.outputs().rdata;
      ssi_.tick();
      ssi_.in.sel = ssi_.in.we = ssi_.in.rd = false;
      return;
    }
    ssi_.tick();
  }
  std::uint32_t taken() const { return taken_; }

 private:
  RtlSsi ssi_;
  std::uint32_t taken_ = 0;
};

class ModelSsiRig {
 public:
  explicit ModelSsiRig(bool awake = false) : ssi_(sc_core::sc_gen_unique_name("ssi")), awake_(awake) {}

  Tick now() const { return now_; }
  unsigned clk() const { return clk_; }
  void reset(bool geo) {
    ssi_.geo = geo;
    ssi_.phase = ssi_.servo = true;
    ssi_.data = 0xFF;
    ssi_.reset(now_);
    clk_ = ssi_.clk();
  }
  void nets(bool phase, bool servo) {
    ssi_.advance(now_);
    ssi_.phase = phase;
    ssi_.servo = servo;
  }
  void data(unsigned pins) {
    if (ssi_.data == pins) return;  // it sleeps on
    ssi_.advance(now_);
    ssi_.data = static_cast<std::uint8_t>(pins);
  }
  void begin(const SsiAccess& a) {
    access_ = a;
    pending_ = true;
  }
  void tick() {
    const bool here = pending_ && (now_ + 1) % kTicksPerRef == 0;
    if (here) {
      ssi_.advance(now_);
      taken_ = ssi_.read(access_.x, access_.address);
      if (!access_.write) ssi_.read_taken(access_.x, access_.address);
    }
    const Tick next = ssi_.next_event();
    if (next <= now_)  // the vectors' runner knows no failures of GoogleTest
      throw std::logic_error("at tick " + std::to_string(now_) + " it asks for " + std::to_string(next));
    ++now_;
    const bool due = awake_ || now_ >= next;
    woken_ += due ? 1 : 0;
    if (here || due) {
      ssi_.advance(now_);
      clk_ = ssi_.clk();
    }
    if (here && access_.write) ssi_.write(access_.x, access_.address, access_.value);
    if (here) pending_ = false;
  }
  int woken() const { return woken_; }  // edges that it asked for
  std::uint32_t taken() const { return taken_; }

 private:
  Ssi ssi_;
  const bool awake_;
  SsiAccess access_{};
  bool pending_ = false;
  unsigned clk_ = 0xFF;
  std::uint32_t taken_ = 0;
  int woken_ = 0;
  Tick now_ = 0;
};

// It executes each edge.
class AwakeSsiRig : public ModelSsiRig {
 public:
  AwakeSsiRig() : ModelSsiRig(true) {}
};

// The model and a twin; `difference` is empty as long as they agree.
template <class Twin>
class SsiPair {
 public:
  std::string difference;
  Tick seeded_bug_at = kNever;  // negative control: clock 1 as the comparison sees it is wrong at this tick

  Tick now() const { return twin_.now(); }
  unsigned clk() const { return twin_.clk(); }
  template <class F>
  void both(const F& f) {
    f(twin_);
    f(model_);
  }
  void reset(bool geo) {
    both([geo](auto& r) { r.reset(geo); });
  }
  void nets(bool phase, bool servo) {
    both([phase, servo](auto& r) { r.nets(phase, servo); });
  }
  void data(unsigned pins) {
    both([pins](auto& r) { r.data(pins); });
  }
  void begin(const SsiAccess& a) {
    both([&a](auto& r) { r.begin(a); });
  }
  void tick() {
    both([](auto& r) { r.tick(); });
    if (std::is_same_v<Twin, RtlSsiRig> && !engines_compared()) return;
    if (difference.empty() && (twin_.clk() ^ (now() == seeded_bug_at ? 1u : 0u)) != model_.clk())
      difference = "clocks differ at tick " + std::to_string(now());
    if (difference.empty() && twin_.taken() != model_.taken())
      difference = "a read differs at tick " + std::to_string(now());
  }
  std::uint32_t taken() const { return twin_.taken(); }

 private:
  Twin twin_;
  ModelSsiRig model_;
};
using LockstepSsiRig = SsiPair<RtlSsiRig>;

// What a test does with either: an access, and time in which encoders look at the clocks.
template <class Rig>
class SsiBench : public Rig {
 public:
  std::function<unsigned(Tick, unsigned clk)> encoders;  // data pins, after each edge

  void run(Tick ticks) {
    for (Tick i = 0; i < ticks; ++i) {
      this->tick();
      if (encoders) this->data(encoders(this->now(), this->clk()));
    }
  }
  std::uint32_t access(const SsiAccess& a) {
    this->begin(a);
    do run(1);
    while (this->now() % kTicksPerRef != 0);
    return this->taken();
  }
  void write(bool x, unsigned address, std::uint32_t value) { access({true, x, address, value}); }
  std::uint32_t read(bool x, unsigned address) { return access({false, x, address, 0}); }
  // A fall of SERVO, seen by the next edge, and its rise some time later.
  void trigger() {
    this->nets(true, false);
    run(10);
    this->nets(true, true);
  }
};

}  // namespace brick
