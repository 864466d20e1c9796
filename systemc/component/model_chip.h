// What the chips of the SystemC model share: reset, time, and the comparison after each event. A block gives its next
// event and executes edges; it stands at now() always.
#pragma once

#include <algorithm>

#include "systemc/component/chip.h"
#include "systemc/core/model_block.h"

namespace brick::component {

class ModelChip : public Chip {
 public:
  Tick now() const final { return now_; }
  const PinWords& outputs() const final { return outputs_; }
  void watch(const PinWords& outputs) final {
    watched_ = outputs;
    watch_changed();
  }

  // A reset without an edge in it counts too.
  void set_inputs(const PinWords& inputs) final {
    const bool in_reset = reset_low(inputs);
    drive(inputs);
    if (in_reset) block_reset(now_);
    in_reset_ = in_reset;
    stale_ = in_reset || differ(show(), outputs_, watched_);
  }

  bool run_until(Tick limit) final {
    while (now_ < limit) {
      const Tick target = stale_ ? now_ + 1 : in_reset_ ? limit : std::min(limit, next());
      if (in_reset_)
        block_reset(target);
      else
        block_advance(target);
      if (now_ = target; take()) return true;
    }
    return false;
  }

  bool foresees() const final { return true; }
  Tick quiet_until() const final { return stale_ ? now_ : in_reset_ ? kNever : next() - 1; }

  std::uint32_t read(unsigned address) final {
    const std::uint32_t value = peek(address);
    edge(false, address, 0);
    return value;
  }
  void write(unsigned address, std::uint32_t value) final { edge(true, address, value); }

 protected:
  explicit ModelChip(std::size_t output_words) : watched_(output_words), outputs_(output_words), shown_(output_words) {}

  virtual void drive(const PinWords& inputs) = 0;
  virtual bool reset_low(const PinWords& inputs) const = 0;
  virtual Tick next_event() const = 0;  // of the watched outputs
  virtual void block_advance(Tick t) = 0;
  virtual void block_reset(Tick t) = 0;
  virtual void block_access(Tick t, bool write, unsigned address, std::uint32_t value) = 0;  // executes edge t too
  virtual void show(PinWords& words) const = 0;                                              // outputs as they stand
  virtual void watch_changed() {}
  void power_on() {
    block_reset(0);
    take();
  }

  PinWords watched_;

 private:
  Tick next() const { return std::max(next_event(), now_ + 1); }
  const PinWords& show() {
    show(shown_);
    return shown_;
  }
  bool take() {
    stale_ = false;
    const bool moved = differ(show(), outputs_, watched_);
    outputs_.swap(shown_);
    return moved;
  }
  void edge(bool write, unsigned address, std::uint32_t value) {
    ++now_;
    if (in_reset_)
      block_reset(now_);
    else
      block_access(now_, write, address, value);
    take();
  }

  PinWords outputs_, shown_;
  Tick now_ = 0;
  bool in_reset_ = false;
  bool stale_ = false;  // an output has changed without an edge: the next one shows it
};

}  // namespace brick::component
