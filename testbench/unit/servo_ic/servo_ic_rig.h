// A servo IC (or another IC with the same faces) on one engine, driven as the board drives it: register accesses at a
// clk_ref edge, pins at any tick. The RTL and the model rig take the same calls, so one test body runs on both, and the
// lock-step rig compares them at every tick.
#pragma once

#include <cstdint>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/rtl/comparison.h"
#include "testbench/unit/servo_ic/clock_words.h"
#include "testbench/unit/servo_ic/rtl_servo_ic.h"

namespace brick {

class ServoIcRig {
 public:
  virtual ~ServoIcRig() = default;
  virtual Tick now() const = 0;
  virtual void tick() = 0;
  virtual void reset(bool asserted) = 0;
  virtual void pins(bool phase, bool servo) = 0;
  virtual void write(bool x, unsigned offset,
                     std::uint32_t value) = 0;  // takes place at the next clk_ref edge, which is executed
  virtual std::uint32_t read(bool x, unsigned offset) = 0;
  virtual bool phase() = 0;
  virtual bool servo() = 0;
  virtual bool phase_oe() = 0;
  virtual bool servo_oe() = 0;

  void run(Tick ticks) {
    for (Tick i = 0; i < ticks; ++i) tick();
  }
  void power_up() {
    reset(true);
    run(4);
    reset(false);
  }
  // Runs until the level has the given edge; returns its tick.
  Tick edge_of(bool (ServoIcRig::*level)(), bool rising, Tick limit = 100'000'000) {
    const Tick end = now() + limit;
    bool last = (this->*level)();
    while (now() < end) {
      tick();
      const bool seen = (this->*level)();
      if (seen != last && seen == rising) return now();
      last = seen;
    }
    ADD_FAILURE() << "no edge within " << limit << " ticks";
    return kNever;
  }
};

// For TYPED_TEST_SUITE with the engines in this order.
class EngineNames {
 public:
  template <class T>
  static std::string GetName(int i) {
    return i == 0 ? "Rtl" : "Model";
  }
};

template <class RtlIc>
class RtlRigOf : public ServoIcRig {
 public:
  Tick now() const override { return ic_.now(); }
  void tick() override { ic_.tick(); }
  void reset(bool asserted) override { ic_.in.rst_n = !asserted; }
  void pins(bool phase, bool servo) override {
    ic_.in.phase = phase;
    ic_.in.servo = servo;
  }
  void write(bool x, unsigned offset, std::uint32_t value) override {
    begin_write(x, offset, value);
    do tick();
    while (now() % kTicksPerRef != 0);
    ic_.in.sel = ic_.in.we = false;
  }
  std::uint32_t read(bool x, unsigned offset) override {
    ic_.in.sel = true;
    ic_.in.x = x;
    ic_.in.addr = offset;
    const std::uint32_t value = ic_.rdata();
    ic_.in.sel = false;
    return value;
  }
  bool phase() override { return ic_.phase(); }
  bool servo() override { return ic_.servo(); }
  bool phase_oe() override { return ic_.phase_oe(); }
  bool servo_oe() override { return ic_.servo_oe(); }

  void begin_write(bool x, unsigned offset, std::uint32_t value) {
    ic_.in.sel = ic_.in.we = true;
    ic_.in.x = x;
    ic_.in.addr = offset;
    ic_.in.wdata = value;
  }
  void end_write() { ic_.in.sel = ic_.in.we = false; }
  RtlIc& ic() { return ic_; }

 private:
  RtlIc ic_;
};

// Lets the model sleep until its own next event: a wrong prediction shows up as a difference to the RTL.
template <class Ic>
class ModelRigOf : public ServoIcRig {
 public:
  ModelRigOf() : ic_(sc_core::sc_gen_unique_name("ic")) { ic_.reset(0); }

  Tick now() const override { return now_; }
  void tick() override {
    ++now_;
    if (in_reset_) {
      ic_.reset(now_);
      shown_ = {ic_.phase(), ic_.servo()};
    } else if (now_ >= ic_.next_event()) {
      ic_.advance(now_);
      shown_ = {ic_.phase(), ic_.servo()};
    }
  }
  void reset(bool asserted) override { in_reset_ = asserted; }
  void pins(bool phase, bool servo) override {
    if (!in_reset_) ic_.advance(now_);
    ic_.set_pins(phase, servo);
  }
  void write(bool x, unsigned offset, std::uint32_t value) override {
    do tick();
    while (now_ % kTicksPerRef != 0);
    write_now(x, offset, value);
  }
  // Who reads, brings it up to date first, as the board does: what is read makes no event (servo_ic.h).
  std::uint32_t read(bool x, unsigned offset) override {
    if (!in_reset_) ic_.advance(now_);
    return ic_.read(x, offset);
  }
  // Levels of pins that are not driven mean nothing outside; the model does not predict them.
  bool phase() override { return shown_.phase; }
  bool servo() override { return shown_.servo; }
  bool phase_oe() override { return ic_.phase_oe(); }
  bool servo_oe() override { return ic_.servo_oe(); }

  void write_now(bool x, unsigned offset, std::uint32_t value) {
    if (in_reset_) return;
    ic_.advance(now_);
    ic_.write(x, offset, value);
    shown_ = {ic_.phase(), ic_.servo()};
  }
  // Changes something that acts at once, such as a strap.
  template <class Action>
  void change(const Action& action) {
    if (!in_reset_) ic_.advance(now_);
    action(ic_);
    shown_ = {ic_.phase(), ic_.servo()};
  }
  Ic& ic() { return ic_; }

 private:
  struct Levels {
    bool phase, servo;
  };
  Ic ic_;
  Levels shown_{true, true};
  bool in_reset_ = false;
  Tick now_ = 0;
};

// Both, tick by tick. `difference` is empty as long as they agree.
template <class RtlIc, class Ic>
class LockstepRigOf : public ServoIcRig {
 public:
  Tick now() const override { return rtl_.now(); }
  void tick() override {
    rtl_.tick();
    model_.tick();
    const bool write_now = pending_ && now() % kTicksPerRef == 0;
    if (write_now) {
      model_.write_now(write_x_, write_offset_, write_value_);
      rtl_.end_write();
      pending_ = false;
    }
    compare();
  }
  void reset(bool asserted) override {
    rtl_.reset(asserted);
    model_.reset(asserted);
  }
  void pins(bool phase, bool servo) override {
    rtl_.pins(phase, servo);
    model_.pins(phase, servo);
  }
  void write(bool x, unsigned offset, std::uint32_t value) override {
    start_write(x, offset, value);
    while (pending_) tick();
  }
  // Only presents the write; a clk_ref edge among the ticks that follow executes it.
  void start_write(bool x, unsigned offset, std::uint32_t value) {
    rtl_.begin_write(x, offset, value);
    write_x_ = x;
    write_offset_ = offset;
    write_value_ = value;
    pending_ = true;
  }
  bool writing() const { return pending_; }
  std::uint32_t read(bool x, unsigned offset) override {
    const std::uint32_t value = rtl_.read(x, offset), other = model_.read(x, offset);
    if (value != other) {
      std::ostringstream what;
      what << std::hex << (x ? "X" : "Y") << ":+$" << offset << ", $" << value << " for the model's $" << other << ",";
      note(what.str());
    }
    return value;
  }
  bool phase() override { return rtl_.phase(); }
  bool servo() override { return rtl_.servo(); }
  bool phase_oe() override { return rtl_.phase_oe(); }
  bool servo_oe() override { return rtl_.servo_oe(); }

  RtlRigOf<RtlIc>& rtl() { return rtl_; }
  ModelRigOf<Ic>& model() { return model_; }

  std::string difference;
  Tick seeded_bug_at = kNever;  // negative control: the level of SERVO that the comparison sees is wrong at this tick

 private:
  void compare() {
    const bool servo = rtl_.servo() != (now() == seeded_bug_at);
    if (rtl_.phase_oe() != model_.phase_oe() || rtl_.servo_oe() != model_.servo_oe()) note("direction");
    if (rtl_.phase_oe() && rtl_.phase() != model_.phase()) note("PHASE");
    if (rtl_.servo_oe() && servo != model_.servo()) note("SERVO");
  }
  void note(const std::string& what) {
    if (difference.empty() && engines_compared()) difference = what + " differs at tick " + std::to_string(now());
  }

  RtlRigOf<RtlIc> rtl_;
  ModelRigOf<Ic> model_;
  bool pending_ = false, write_x_ = false;
  unsigned write_offset_ = 0;
  std::uint32_t write_value_ = 0;
};

using RtlRig = RtlRigOf<RtlServoIc>;
using ModelRig = ModelRigOf<ServoIc>;
using LockstepRig = LockstepRigOf<RtlServoIc, ServoIc>;

}  // namespace brick
