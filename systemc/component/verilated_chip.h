// A Verilated module (systemc/cosim/verilated_module.h) behind the pins of a component, one evaluation an edge. A
// module adds a struct with what its ports are called, beside its Verilated header:
//   static constexpr unsigned kOutputWords
//   static void drive(V& v, const PinWords& in)            every input port but the clocks and the register bus
//   static void sample(const V& v, PinWords& out)
//   static void access(V& v, unsigned face, bool on, const Face& cycle)   lines of a register face for a beat, or idle
//   static std::uint32_t read(const V& v, unsigned face, unsigned address)   the word that it shows then
// and if it has other faces than one on clk_ref, or cycles of more than a beat, or words that show with no access line:
//   static const std::vector<FaceClock>& faces()
//   static bool after(const V& v, unsigned face, Face& cycle)   with the edge of a beat: the cycle has ended
//   static std::uint32_t peek(const V& v, unsigned face, unsigned address)
#pragma once

#include <functional>
#include <utility>

#include "systemc/component/faces.h"
#include "systemc/cosim/verilated_module.h"

namespace brick::component {

template <class Ports>
auto faces_of(int) -> decltype(Ports::faces()) {
  return Ports::faces();
}
template <class Ports>
std::vector<FaceClock> faces_of(long) {
  return {FaceClock::kRef};
}
template <class Ports, class V>
auto after_beat(const V& v, unsigned face, Face& cycle, int) -> decltype(Ports::after(v, face, cycle)) {
  return Ports::after(v, face, cycle);
}
template <class Ports, class V>
bool after_beat(const V&, unsigned, Face&, long) {
  return true;
}

template <class V, class Ports>
class VerilatedChip final : public Chip {
 public:
  // `prepare`: inputs that are read once, when the simulation begins.
  explicit VerilatedChip(
      std::uint64_t seed, const std::function<void(V&)>& prepare = [](V&) {})
      : top_(seed),
        faces_(faces_of<Ports>(0)),
        outputs_(Ports::kOutputWords),
        sampled_(Ports::kOutputWords),
        watched_(Ports::kOutputWords) {
    prepare(*top_);
    every_edge_ = set_pwm(*top_, false, 0);
    top_->clk_ref_i = false;
    for (unsigned face = 0; face < faces_.count(); ++face) Ports::access(*top_, face, false, Face{});
    top_.pulse_reset();
    top_.count_coverage();
    Ports::sample(*top_, outputs_);
  }

  Tick now() const override { return now_; }
  const PinWords& outputs() const override { return outputs_; }
  void watch(const PinWords& outputs) override { watched_ = outputs; }
  void set_inputs(const PinWords& inputs) override {
    const bool before = top_->rst_ni;
    Ports::drive(*top_, inputs);
    if (top_->rst_ni != before) {
      top_->eval();
      reset_moved_ = true;
    }
  }
  bool run_until(Tick limit) override {
    while (now_ < limit) {
      if (!every_edge_ && !reset_moved_) {  // nothing happens between the edges of clk_ref
        now_ = std::min(limit, next_ref_edge(now_));
        if (!is_ref_edge(now_)) break;
      } else {
        ++now_;
      }
      if (faces_.next() == now_ ? beat() : edge()) return true;
    }
    return false;
  }

  void begin(unsigned face, const Cycle& cycle) override { faces_.begin(face, cycle, now_); }
  void abandon(unsigned face) override {
    if (!faces_.busy(face)) return;
    Ports::access(*top_, face, false, Face{});
    faces_.break_off(face, now_);
  }
  bool busy(unsigned face) const override { return faces_.busy(face); }
  std::uint32_t value(unsigned face) const override { return faces_.value(face); }
  Tick no_end_until() const override { return faces_.next() == kNever ? kNever : faces_.next() - 1; }
  std::uint32_t peek(unsigned face, unsigned address) override { return peek_at(face, address, 0); }

 private:
  template <class P = Ports>
  auto peek_at(unsigned face, unsigned address, int) -> decltype(P::peek(std::declval<V&>(), face, address)) {
    return P::peek(*top_, face, address);
  }
  std::uint32_t peek_at(unsigned face, unsigned address, long) {
    Face read;
    read.cycle.address = address;
    Ports::access(*top_, face, true, read);
    top_->eval();
    const std::uint32_t value = Ports::read(*top_, face, address);
    Ports::access(*top_, face, false, Face{});
    top_->eval();
    return value;
  }
  // Edge now_ has a beat; true if a cycle ends with it or a watched output changes.
  bool beat() {
    faces_.at(now_, [this](unsigned i, Face& face) {
      Ports::access(*top_, i, true, face);
      if (face.cycle.write || face.beat != 0) return;
      top_->eval();
      face.value = Ports::read(*top_, i, face.cycle.address);
    });
    const bool moved = edge();
    const bool ended = faces_.after(now_, [this](unsigned i, Face& face) {
      const bool done = !top_->rst_ni || after_beat<Ports>(*top_, i, face, 0);
      if (done) Ports::access(*top_, i, false, Face{});
      return done;
    });
    return moved || ended;
  }
  bool edge() {
    top_.edge(true, is_ref_edge(now_));
    reset_moved_ = false;
    Ports::sample(*top_, sampled_);
    if (sampled_ == outputs_) return false;
    sampled_.swap(outputs_);
    return differ(sampled_, outputs_, watched_);
  }

  VerilatedModule<V> top_;
  Faces faces_;
  PinWords outputs_, sampled_, watched_;
  bool every_edge_ = true, reset_moved_ = false;
  Tick now_ = 0;
};

}  // namespace brick::component
