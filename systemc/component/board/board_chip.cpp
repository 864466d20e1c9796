#include "systemc/component/board/board_chip.h"

#include <algorithm>
#include <optional>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/component/board/board_buses.h"
#include "systemc/component/board/board_words.h"
#include "systemc/component/error.h"
#include "systemc/cosim/engines.h"

namespace brick::component {
namespace {
using namespace board_words;

class BoardChip final : public Chip {
 public:
  BoardChip(std::unique_ptr<brick::Board> board, std::uint32_t fitted, bool foresees)
      : board_(std::move(board)), buses_(*board_), foresees_(foresees) {
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
        pins.adc_a = static_cast<std::uint8_t>(pins.adc_a | (word >> servo_ic_words::kAdcA.lsb & 1) << n);
        pins.adc_b = static_cast<std::uint8_t>(pins.adc_b | (word >> servo_ic_words::kAdcB.lsb & 1) << n);
      }
      board_->set_motor_inputs(ic, pins);
    }
    bool moved = !set_ || inputs[kReset] != inputs_[kReset];
    pins_in_.rst_n = (inputs[kReset] & 1) != 0;
    const auto take = [&](auto word) {
      if (set_ && inputs[word] == inputs_[word]) return;
      moved = true;
      take_fields<word>(inputs[word]);
    };
    each_word(take, std::make_integer_sequence<unsigned, kBoardInputWords>());
    if (moved) buses_.set_inputs(pins_in_);
    inputs_ = inputs;
    set_ = true;
  }

  bool run_until(Tick limit) override {
    motor_moved_ = false;
    return compared([&] {
      while (now() < limit) {
        BoardOutputs stop = buses_.stops();
        for (unsigned i = 0; i < kBoardOutputWords; ++i) stop.w[i] |= pins_.w[i];
        board_->run_until(std::min(limit, buses_.next()), stop);
        const bool moved = take_pins() || motor_moved_;
        if (buses_.step() || moved) return true;
      }
      return false;
    });
  }

  bool foresees() const override { return foresees_; }
  Tick quiet_until() const override {
    static constexpr BoardOutputs kAll{{~0u, ~0u, ~0u, ~0u}};
    return std::min(any_ ? board_->quiet_until(motors_ ? kAll : pins_) : kNever, no_end_until());
  }

  // A cycle goes from stand to stand. What it drives there the next edge sees, so what is foreseen ends there too.
  void begin(unsigned face, const Cycle& cycle) override {
    compared([&] { buses_.begin(face, cycle); });
  }
  void abandon(unsigned face) override { buses_.abandon(face); }
  bool busy(unsigned face) const override { return buses_.busy(face); }
  std::uint32_t value(unsigned face) const override { return buses_.value(face); }
  std::optional<BusEnd> bus_end(unsigned face) const override { return buses_.end(face); }
  Tick no_end_until() const override {
    const Tick next = buses_.next();
    return next == kNever ? kNever : next - 1;
  }
  bool peeks(unsigned face, unsigned address) const override {
    return (face == kPortAFace && BoardBuses::is_control(address)) || dpram_index(face, address).has_value();
  }
  std::uint32_t peek(unsigned face, unsigned address) override {
    if (face == kPortAFace && BoardBuses::is_control(address)) return buses_.control(address);
    return compared([&] { return dpram_word(face, address); });
  }

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
  // In lock-step the two boards may differ.
  template <class Act>
  auto compared(const Act& act) const -> decltype(act()) {
    try {
      return act();
    } catch (const LockstepDifference& difference) { raise_error("/brick/lockstep", difference.what()); }
  }
  // The word of the dual-ported RAM at this byte address, if it is one: of Port A, or of a window without pages.
  std::optional<unsigned> dpram_index(unsigned face, unsigned address) const {
    constexpr unsigned kPortABytes = 8 * regs::kDpramBase, kWords = 2 * regs::kDpramSize;
    const BoardInputs& in = buses_.inputs();
    if (face == kIsaFace && ((address & kIsaMemory) == 0 || !in.window_flat)) return {};
    const unsigned first =
        face == kPortAFace ? kPortABytes : kIsaMemory | (unsigned{in.window} & (in.slot8 ? 0x3Cu : 0x3FCu)) << 14;
    const unsigned index = (address - first) / (face == kPortAFace ? 4 : 2);
    if (address < first || index >= kWords || !board_->dpram_word(index)) return {};
    return index;
  }
  std::uint32_t dpram_word(unsigned face, unsigned address) const {
    constexpr unsigned kSmallWords = 8192;
    const unsigned index = *dpram_index(face, address);
    return buses_.inputs().dpram_small && index >= kSmallWords ? 0 : *board_->dpram_word(index);
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
  BoardBuses buses_;
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
