// A Verilated board behind the Board face: two clocks, one evaluation a tick, changes of pins found by comparing the
// packed words. A template over the Verilated class, because each set of built ICs is a class of its own.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "systemc/core/start_value.h"
#include "systemc/cosim/drive.h"
#include "systemc/cosim/engines.h"
#include "systemc/cosim/verilated_module.h"

namespace brick {

// The memory of the dual-ported RAM, where the Verilated class has it as an array.
template <class Root>
auto dpram_word(const Root& root, unsigned index, int) -> decltype(std::optional<std::uint16_t>(
    root.board_sim__DOT__u_board__DOT__u_core__DOT__u_dpram__DOT__u_memory__DOT__mem[index])) {
  return root.board_sim__DOT__u_board__DOT__u_core__DOT__u_dpram__DOT__u_memory__DOT__mem[index];
}
template <class Root>
std::optional<std::uint16_t> dpram_word(const Root&, unsigned, long) {
  return {};
}

template <class Model>
class RtlBoard : public Board {
 public:
  RtlBoard(std::uint32_t fitted, const RtlOptions& options) : model_(options.seed), fitted_(fitted) {
    model_->start_seed_i = start_seed(options.ram_seed.value_or(options.seed));
    model_->seeded_bug_i = options.seeded_bug;
    // What acts without a clock acts on an edge here: rst_ni must have been high once, and /RD, which turns the data
    // pins off, low. Power-on is tick 0, in reset.
    BoardInputs start;
    start.fitted = fitted;
    start.rst_n = true;
    start.pa_rd_n = false;
    set_inputs(start);
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) set_motor_inputs(ic, {});
    model_->eval();
    start.rst_n = false;
    start.pa_rd_n = true;
    set_inputs(start);
    model_->eval();
    model_.count_coverage();
    for (unsigned i = 0; i < kBoardOutputWords; ++i) outputs_.w[i] = model_->pins_o[i];
  }
  Tick now() const override { return now_; }
  const BoardOutputs& outputs() const override { return outputs_; }
  BoardOutputs port_a_at_once() const override {
    static constexpr BoardOutputs kPortA = select_pins(pin::kPaData, pin::kPaDataOe, pin::kPaTaN);
    if (!settled_) model_->eval();
    settled_ = true;
    BoardOutputs out = outputs_;
    for (unsigned i = 0; i < kBoardOutputWords; ++i)
      out.w[i] = (out.w[i] & ~kPortA.w[i]) | (model_->pins_o[i] & kPortA.w[i]);
    return out;
  }

  std::optional<std::uint16_t> dpram_word(unsigned index) const override {
    return brick::dpram_word(*model_->rootp, index, 0);
  }

  void set_inputs(const BoardInputs& in) override {
    BoardInputs built = in;
    built.fitted &= fitted_;  // the Verilated board may have more
    drive(*model_, built);
    // What has no clock acts at once, before the next edge: the reset, and flip-flops that a strobe clocks.
    const bool now = in.rst_n != rst_n_ || in.pa_rd_n != rd_n_ || in.pa_wr_n != wr_n_;
    rst_n_ = in.rst_n;
    rd_n_ = in.pa_rd_n;
    wr_n_ = in.pa_wr_n;
    if (now) model_->eval();
    settled_ = now;
  }

  Tick run_until(Tick limit, const BoardOutputs& stop_on) override {
    Model& m = *model_;
    Tick to_ref = kTicksPerRef - now_ % kTicksPerRef;
    while (now_ < limit) {
      ++now_;
      m.clk_pwm_i = 1;
      if (--to_ref == 0) {
        m.clk_ref_i = 1;
        to_ref = kTicksPerRef;
      }
      m.eval();
      model_.lower_clocks();
      bool stop = false;
      const auto& pins = m.pins_o;
      std::uint32_t moved = 0;
      for (unsigned i = 0; i < kBoardOutputWords; ++i) moved |= pins[i] ^ outputs_.w[i];
      if (__builtin_expect(moved != 0, 0)) {
        const BoardOutputs before = outputs_;
        for (unsigned i = 0; i < kBoardOutputWords; ++i) outputs_.w[i] = pins[i];
        if (on_change) on_change(now_, before, outputs_);
        stop = before.differs(outputs_, stop_on);
      }
      for (Watched& w : watched_)
        if (__builtin_expect(motor_differs(w, to_ref == kTicksPerRef || m.rst_ni == 0), 0)) stop |= motor_changed(w);
      if (stop) break;
    }
    return now_;
  }

  void set_motor_inputs(unsigned ic, const MotorInputs& in) override {
    if (has(ic)) drive_motor(*model_, ic, in);
  }
  MotorOutputs motor_outputs(unsigned ic) const override {
    MotorOutputs out;
    if (!has(ic)) return out;
    out.w[0] = static_cast<std::uint32_t>(model_->motor_o[ic]);
    out.w[1] = static_cast<std::uint32_t>(model_->motor_o[ic] >> 32);
    for (unsigned n = 0; n < kChannels; ++n) out.w[2 + n] = model_->count_o[4 * ic + n];
    return out;
  }
  void watch_motor(unsigned ic, const MotorOutputs& select) override {
    if (!has(ic)) return;
    const auto place = std::find_if(watched_.begin(), watched_.end(), [ic](const Watched& w) { return w.ic >= ic; });
    const bool there = place != watched_.end() && place->ic == ic;
    if (select == MotorOutputs{}) {
      if (there) watched_.erase(place);
    } else {
      const Watched watched{ic, select, motor_outputs(ic) & select};
      if (there)
        *place = watched;
      else
        watched_.insert(place, watched);
    }
  }
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic < kMaxServoIcs) stop_[ic] = select;
  }

 private:
  struct Watched {
    unsigned ic;
    MotorOutputs select, last;
  };
  bool has(unsigned ic) const { return ic < kMaxServoIcs && (fitted_ >> ic & 1) != 0; }
  // Counters move with clk_ref and with the asynchronous reset only; a serial clock of 39.3216 MHz is lowered and
  // raised by clk_pwm.
  bool motor_differs(const Watched& w, bool counters) const {
    const Model& m = *model_;
    const auto pair = [](const MotorOutputs& o) { return static_cast<std::uint64_t>(o.w[1]) << 32 | o.w[0]; };
    std::uint64_t d = (m.motor_o[w.ic] & pair(w.select)) ^ pair(w.last);
    if (counters)
      for (unsigned n = 0; n < kChannels; ++n) d |= (m.count_o[4 * w.ic + n] & w.select.w[2 + n]) ^ w.last.w[2 + n];
    return d != 0;
  }
  bool motor_changed(Watched& w) {
    const MotorOutputs before = w.last;
    w.last = motor_outputs(w.ic) & w.select;
    if (on_motor_change) on_motor_change(now_, w.ic, before, w.last);
    return before.differs(w.last, stop_[w.ic]);
  }

  VerilatedModule<Model> model_;
  std::uint32_t fitted_;
  BoardOutputs outputs_;
  std::vector<Watched> watched_;
  std::array<MotorOutputs, kMaxServoIcs> stop_{};
  bool rst_n_ = true, rd_n_ = true, wr_n_ = true;
  mutable bool settled_ = true;  // what has no clock follows the inputs
  Tick now_ = 0;
};

}  // namespace brick
