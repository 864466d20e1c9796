// Checker of the PHASE and SERVO nets (servo-ic:5.1/3 to servo-ic:5.1/9, servo-ic:7.2/5; docs/clock_select.md). It is
// told what the host programs and sees every edge of the two nets and of clock.conflict; it knows nothing of the
// engines. In steady state each edge must come at its very tick. While the host writes dividers or moves the source the
// rules of taking over allow a little more, see `change` and `move`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"
#include "testbench/checkers/shortest_levels.h"

namespace brick {

// Three variables of the source: I7m00, I7m01, I7m02 (or I6800, I6801, I6802), and what they mean in ticks.
struct ClockSetting {
  unsigned max_count = 6527, phase_divider = 0, servo_divider = 3;

  Tick half() const { return 2 * Tick{max_count} + 3; }  // from turnaround to turnaround, one period of MaxPhase
  Tick phase() const { return half() * (phase_divider + 1); }
  Tick high() const { return phase() / 2; }
  Tick low() const { return phase() - high(); }
  Tick servo() const { return phase() * (servo_divider + 1); }
  bool operator==(const ClockSetting& o) const {
    return max_count == o.max_count && phase_divider == o.phase_divider && servo_divider == o.servo_divider;
  }
};

class ClockChecker {
 public:
  // Between the last input and the new output firmware needs this long at most, besides its wait for the release.
  static constexpr Tick kHandOver = ns_to_ticks(50'000);
  // An IC that is to let go drives on until both its clocks are high, at most this long: SERVO just fell, so it is low
  // for a phase period, and PHASE, which fell again with its rise, for its low time.
  static Tick release(const ClockSetting& s) { return s.phase() + s.low(); }

  // From the acknowledge of the line that writes the variables or moves the source until every edge is exact again.
  static Tick settling(const ClockSetting& from, const ClockSetting& to);

  enum class Kind { kRunt, kDoubled, kMissing, kEarly, kLate, kRelation, kConflict, kUnsettled };
  struct Violation {
    Tick tick;
    Kind kind;
    std::string text;
  };

  // What the host does
  // --------------------------------------------------------------------------------------------------
  void ignore() {  // reset, watchdog: no rule until told otherwise
    mode_ = Mode::kIgnore;
    shortest_.end();
  }
  // Every edge from now on is exact. Ends a transition, which must be over: no odd pulse is pending, the new setting is
  // seen.
  void run(Tick now, const ClockSetting& s);
  // The variables of the source are about to be written. Every pulse is made of whole and half triangles of the old or
  // the new length, so it lies between the shorter and the longer of both settings; a servo period has the old or the
  // new divider.
  void change(Tick now, const ClockSetting& to);
  // Another IC, with these variables, is about to become the source. The old one lets go while both nets are high and
  // the new one begins with a full high time, so every low level is exact, of the old or of the new source, and one
  // high level of PHASE is odd: at least a full one of the new source; at most one of the old, the release, the
  // hand-over, two periods of the new source (its running one, and the one that ends with the rise at which it takes
  // the pin) and its high time. SERVO first falls with fall number divider + 1 at the earliest and, because its pin is
  // taken a SERVO period after PHASE, 2 x divider + 1 at the latest.
  void move(Tick now, const ClockSetting& to, Tick hand_over = kHandOver);
  // The same from no source; `within` is the longest time until the new one drives.
  void start(Tick now, const ClockSetting& to, Tick within);
  void stop(Tick now);  // ... to no source: all is exact until a high level that does not end any more
  void allow_conflict(bool allowed) { conflict_allowed_ = allowed; }

  // What it sees
  // --------------------------------------------------------------------------------------------------------
  void pins(Tick now, bool phase, bool servo, bool conflict);  // after each edge that changes one of them
  void finish(Tick now);  // nothing changed since the last call: an edge may be overdue

  // Results
  // -------------------------------------------------------------------------------------------------------------
  const std::vector<Violation>& violations() const { return violations_; }
  struct Counts {
    unsigned phase_falls = 0, servo_falls = 0, odd_highs = 0;
  };
  const Counts& counts() const { return counts_; }
  const ShortestLevels& shortest_levels() const { return shortest_; }  // while the source moved
  Tick last_phase_fall() const { return last_fall_; }

 private:
  enum class Mode { kIgnore, kRun, kChange, kMove, kStop };
  enum class Stage {
    kOld,
    kIdle,
    kNew
  };  // of a transition: old source exact, none before the new one, new source exact

  void begin(Mode mode, std::optional<ClockSetting> to, Stage stage);
  void phase_edge(Tick now, bool level);
  void exact(Tick now, const ClockSetting& s, bool level, Tick length);
  void changing(Tick now, bool level, Tick length);
  void moving(Tick now, bool level, Tick length);
  void first_fall();
  void servo_pin(Tick now, bool phase_changed, bool phase, bool servo);
  void with_rise(Tick now, bool changed, bool servo);
  void with_fall(Tick now, bool changed, bool servo);
  bool divider_may_be(unsigned divider) const;
  unsigned largest_divider() const;
  unsigned latest_servo_fall() const;
  Tick longest(bool level) const;
  void violate(Tick now, Kind kind, const std::string& text);

  Mode mode_ = Mode::kIgnore;
  Stage stage_ = Stage::kOld;
  Tick hand_over_ = kHandOver;
  ClockSetting now_is_;               // old setting in a transition
  std::optional<ClockSetting> next_;  // new one
  bool phase_ = true, servo_ = true;
  std::optional<Tick> phase_since_;  // last edge; unknown at first
  Tick last_fall_ = -1;
  std::optional<unsigned> falls_;  // PHASE falls since the last SERVO fall
  bool first_servo_ = false;       // the new source's first fall of SERVO is still to come
  bool conflict_ = false, conflict_allowed_ = false;
  Counts counts_;
  ShortestLevels shortest_;
  std::vector<Violation> violations_;
};

const char* kind_name(ClockChecker::Kind kind);

}  // namespace brick
