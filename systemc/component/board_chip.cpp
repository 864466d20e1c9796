#include "systemc/component/board_chip.h"

#include <algorithm>
#include <stdexcept>

#include "systemc/component/board_words.h"
#include "systemc/component/error.h"
#include "systemc/cosim/engines.h"

namespace brick::component {
namespace {
using namespace board_words;

class BoardChip final : public Chip {
 public:
  BoardChip(std::unique_ptr<brick::Board> board, std::uint32_t fitted, bool foresees)
      : board_(std::move(board)), foresees_(foresees) {
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      if ((fitted >> ic & 1) != 0) {
        place_[ic] = static_cast<unsigned>(ics_.size());
        ics_.push_back(ic);
      }
    outputs_.resize(motor_output(static_cast<unsigned>(ics_.size())));
    watched_.resize(outputs_.size());
    inputs_.resize(motor_input(static_cast<unsigned>(ics_.size())));
    take_pins();
    board_->on_motor_change = [this](Tick, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
      motor_moved_ = true;
      take_motor(ic, after);
    };
  }

  Tick now() const override { return board_->now(); }
  const PinWords& outputs() const override { return outputs_; }

  void watch(const PinWords& outputs) override {
    watched_ = outputs;
    std::copy_n(watched_.begin(), kBoardOutputWords, pins_.w.begin());
    motors_ = false;
    for (const unsigned ic : ics_) {
      const unsigned word = motor_output(place_[ic]);
      const MotorOutputs select{{watched_[word], watched_[word + 1], 0, 0, 0, 0}};
      board_->watch_motor(ic, select);
      board_->stop_on_motor(ic, select);
      take_motor(ic, board_->motor_outputs(ic) & select);
      motors_ = motors_ || select != MotorOutputs{};
    }
    any_ = motors_ || pins_ != BoardOutputs{};
  }

  void set_inputs(const PinWords& inputs) override {
    for (const unsigned ic : ics_) {
      const auto first = motor_input(place_[ic]);
      if (set_ && std::equal(&inputs[first], &inputs[first + kChannels - 1] + 1, &inputs_[first])) continue;
      MotorInputs pins;
      pins.adc_a = pins.adc_b = 0;
      for (unsigned n = 0; n < kChannels; ++n) {
        const std::uint32_t word = inputs[first + n];
        pins.pins[n] = static_cast<std::uint16_t>(word & 0xFFF);
        pins.adc_a = static_cast<std::uint8_t>(pins.adc_a | (word >> servo_ic_words::kAdcA & 1) << n);
        pins.adc_b = static_cast<std::uint8_t>(pins.adc_b | (word >> servo_ic_words::kAdcB & 1) << n);
      }
      board_->set_motor_inputs(ic, pins);
    }
    bool moved = !set_ || inputs[kReset] != inputs_[kReset];
    pins_in_.rst_n = bit(inputs, kReset, 0);
    const auto take = [&](auto word) {
      if (set_ && inputs[word] == inputs_[word]) return;
      moved = true;
      take_fields<word>(inputs[word]);
    };
    each_word(take, std::make_integer_sequence<unsigned, kBoardInputWords>());
    if (moved) board_->set_inputs(pins_in_);
    inputs_ = inputs;
    set_ = true;
  }

  bool run_until(Tick limit) override {
    motor_moved_ = false;
    try {
      board_->run_until(limit, pins_);
    } catch (const LockstepDifference& difference) { raise_error("/brick/lockstep", difference.what()); }
    return take_pins() || motor_moved_;
  }

  bool foresees() const override { return foresees_; }
  Tick quiet_until() const override {
    static constexpr BoardOutputs kAll{{~0u, ~0u, ~0u, ~0u}};
    return any_ ? board_->quiet_until(motors_ ? kAll : pins_) : kNever;
  }

  void begin(unsigned, const Cycle&) override { throw std::logic_error("a board has no register face"); }
  void abandon(unsigned) override {}
  bool busy(unsigned) const override { return false; }
  std::uint32_t value(unsigned) const override { return 0; }
  Tick no_end_until() const override { return kNever; }
  std::uint32_t peek(unsigned, unsigned) override { return 0; }

 private:
  template <class F, unsigned... kWord>
  static void each_word(const F& f, std::integer_sequence<unsigned, kWord...>) {
    (f(std::integral_constant<unsigned, kWord>()), ...);
  }
  template <unsigned kWord>
  void take_fields(std::uint32_t word) {
    const auto take = [&](const auto& f) {
      using Field = std::remove_reference_t<decltype(pins_in_.*f.pin)>;
      if (f.word == kWord) pins_in_.*f.pin = static_cast<Field>(word >> f.lsb & pin_mask(f.width));
    };
    std::apply([&](const auto&... f) { (take(f), ...); }, kInputFields);
  }
  bool take_pins() {
    const BoardOutputs& now = board_->outputs();
    bool moved = false;
    for (unsigned i = 0; i < kBoardOutputWords; ++i) {
      moved = moved || ((now.w[i] ^ outputs_[i]) & watched_[i]) != 0;
      outputs_[i] = now.w[i];
    }
    return moved;
  }
  void take_motor(unsigned ic, const MotorOutputs& now) {
    outputs_[motor_output(place_[ic])] = now.w[0];
    outputs_[motor_output(place_[ic]) + 1] = now.w[1];
  }

  std::unique_ptr<brick::Board> board_;
  std::vector<unsigned> ics_;
  std::array<unsigned, kMaxServoIcs> place_{};
  BoardOutputs pins_;    // watched
  BoardInputs pins_in_;  // as last set
  PinWords inputs_, outputs_, watched_;
  bool foresees_, motors_ = false, any_ = false, set_ = false, motor_moved_ = false;
};

}  // namespace

std::unique_ptr<Chip> board_chip(std::unique_ptr<brick::Board> board, std::uint32_t fitted, bool foresees) {
  return std::make_unique<BoardChip>(std::move(board), fitted & kServoIcs, foresees);
}

}  // namespace brick::component
