// The register faces of a chip and the cycles under way at them, the same in all engines. A cycle is a row of beats,
// one an edge of the face's clock; what a beat drives and which one comes next is the block's (its *_model.cpp and
// *_rtl.cpp). In reset a cycle ends with its first edge. After one that was broken off its lines rest for some edges,
// so that the block sees its end before the next one's beginning.
#pragma once

#include <algorithm>
#include <vector>

#include "systemc/component/chip.h"
#include "systemc/core/model_block.h"

namespace brick::component {

enum class FaceClock { kRef, kPwm };

struct Face {
  FaceClock clock = FaceClock::kRef;
  Cycle cycle;
  unsigned beat = 0;
  std::uint32_t value = 0;  // that a read has taken
  Tick edge = kNever;       // of the beat; kNever: no cycle is under way
  Tick rest = 0;            // the lines rest up to here
  bool driven = false;      // a beat of it has been
};

class Faces {
 public:
  explicit Faces(const std::vector<FaceClock>& clocks) {
    for (const FaceClock clock : clocks) all_.push_back({clock, {}, 0, 0, kNever, 0, false});
  }

  unsigned count() const { return static_cast<unsigned>(all_.size()); }
  void begin(unsigned face, const Cycle& cycle, Tick now) {
    all_.at(face) = {all_[face].clock, cycle, 0, 0, 0, all_[face].rest, false};
    step(all_[face], std::max(now, all_[face].rest));
  }
  void break_off(unsigned face, Tick now) {
    if (all_[face].driven) all_[face].rest = now + kRest;
    all_[face].edge = kNever;
    schedule();
  }
  bool busy(unsigned face) const { return all_[face].edge != kNever; }
  std::uint32_t value(unsigned face) const { return all_[face].value; }
  Tick next() const { return next_; }  // edge of the next beat, kNever without one

  // Calls beat(number, face) for each face with a beat at edge t.
  template <class Beat>
  void at(Tick t, const Beat& beat) {
    for (unsigned i = 0; i < all_.size(); ++i)
      if (all_[i].edge == t) beat(i, all_[i]);
  }
  // After edge t: done(number, face) says whether the cycle has ended; if not, its next beat is at the next edge.
  template <class Done>
  bool after(Tick t, const Done& done) {
    bool ended = false;
    for (unsigned i = 0; i < all_.size(); ++i) {
      if (all_[i].edge != t) continue;
      if (done(i, all_[i])) {
        all_[i].edge = kNever;
        ended = true;
      } else {
        all_[i].driven = true;
        step(all_[i], t);
      }
    }
    schedule();
    return ended;
  }

 private:
  static constexpr Tick kRest = 6;  // more than the stages and the handshake of any block's lines

  void step(Face& face, Tick now) {
    face.edge = face.clock == FaceClock::kRef ? next_ref_edge(now) : now + 1;
    schedule();
  }
  void schedule() {
    next_ = kNever;
    for (const Face& face : all_) next_ = std::min(next_, face.edge);
  }
  std::vector<Face> all_;
  Tick next_ = kNever;
};

}  // namespace brick::component
