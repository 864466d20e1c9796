// What the chips of the SystemC model share: reset, time, register cycles, and the comparison after each event. A block
// gives its next event and executes edges; it stands at now() always.
#pragma once

#include <algorithm>

#include "systemc/component/chip.h"
#include "systemc/component/faces.h"
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
      const Tick quiet = stale_ ? now_ + 1 : in_reset_ ? limit : std::min(limit, next());
      const bool ended = faces_.next() <= quiet ? beat(faces_.next()) : advance(quiet);
      if (take() || ended) return true;
    }
    return false;
  }

  bool foresees() const final { return true; }
  Tick quiet_until() const final { return stale_ ? now_ : std::min(in_reset_ ? kNever : next() - 1, no_end_until()); }

  void begin(unsigned face, const Cycle& cycle) final { faces_.begin(face, cycle, now_); }
  void abandon(unsigned face) final {
    if (!faces_.busy(face)) return;
    idle(face);
    faces_.break_off(face, now_);
  }
  bool busy(unsigned face) const final { return faces_.busy(face); }
  std::uint32_t value(unsigned face) const final { return faces_.value(face); }
  Tick no_end_until() const final { return faces_.next() == kNever ? kNever : faces_.next() - 1; }

 protected:
  explicit ModelChip(std::size_t output_words, const std::vector<FaceClock>& faces = {FaceClock::kRef})
      : watched_(output_words), faces_(faces), outputs_(output_words), shown_(output_words) {}

  virtual void drive(const PinWords& inputs) = 0;
  virtual bool reset_low(const PinWords& inputs) const = 0;
  virtual Tick next_event() const = 0;  // of the watched outputs
  virtual void block_advance(Tick t) = 0;
  virtual void block_reset(Tick t) = 0;
  virtual void show(PinWords& words) const = 0;  // outputs as they stand
  virtual void watch_changed() {}
  // A beat: the block has executed the edge before and executes the next between these two. after() says whether the
  // cycle has ended; what before() has driven must then be away, or is taken away by idle().
  virtual void before(unsigned face, const Face& cycle) = 0;
  virtual bool after(unsigned face, Face& cycle) = 0;
  virtual void idle(unsigned face) { (void)face; }
  // What a read takes before the edge of its first beat.
  virtual std::uint32_t sample(unsigned face, unsigned address) { return peek(face, address); }
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
  bool advance(Tick t) {
    if (in_reset_)
      block_reset(t);
    else
      block_advance(t);
    now_ = t;
    return false;
  }
  // Edge t has a beat; true if a cycle ends with it.
  bool beat(Tick t) {
    if (now_ < t - 1) advance(t - 1);
    faces_.at(t, [this](unsigned i, Face& face) {
      if (!face.cycle.write && face.beat == 0) face.value = sample(i, face.cycle.address);
      if (!in_reset_) before(i, face);
    });
    advance(t);
    return faces_.after(t, [this](unsigned i, Face& face) {
      if (!in_reset_) return after(i, face);
      idle(i);
      return true;
    });
  }

  Faces faces_;
  PinWords outputs_, shown_;
  Tick now_ = 0;
  bool in_reset_ = false;
  bool stale_ = false;  // an output has changed without an edge: the next one shows it
};

}  // namespace brick::component
