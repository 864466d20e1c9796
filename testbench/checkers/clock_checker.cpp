#include "testbench/checkers/clock_checker.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {

const char* level_name(bool level) { return level ? "high" : "low"; }

}  // namespace

const char* kind_name(ClockChecker::Kind kind) {
  static constexpr const char* kNames[] = {"runt", "doubled",  "missing",  "early",
                                           "late", "relation", "conflict", "unsettled"};
  return kNames[static_cast<unsigned>(kind)];
}

Tick ClockChecker::settling(const ClockSetting& from, const ClockSetting& to) {
  const Tick period = std::max(from.half(), to.half()) * (std::max(from.phase_divider, to.phase_divider) + 1);
  // Release and its wait, the turnaround of the new source, two SERVO periods to its first fall of SERVO.
  return kHandOver + period * (from.servo_divider + 2 * to.servo_divider + 8);
}

void ClockChecker::violate(Tick now, Kind kind, const std::string& text) {
  violations_.push_back({now, kind, fmt::format("tick {}: {}: {}", now, kind_name(kind), text)});
}

// What the host does
// ----------------------------------------------------------------------------------------------------

void ClockChecker::begin(Mode mode, std::optional<ClockSetting> to, Stage stage) {
  mode_ = mode;
  next_ = to;
  stage_ = stage;
  first_servo_ = false;
}

void ClockChecker::run(Tick now, const ClockSetting& s) {
  finish(now);
  if (mode_ == Mode::kMove && stage_ != Stage::kNew && !(now_is_ == s))
    violate(now, Kind::kUnsettled, "the new source is not seen");
  now_is_ = s;
  shortest_.end();
  begin(Mode::kRun, std::nullopt, Stage::kOld);
}

void ClockChecker::change(Tick now, const ClockSetting& to) {
  finish(now);
  begin(Mode::kChange, to, Stage::kOld);
}

void ClockChecker::move(Tick now, const ClockSetting& to, Tick hand_over) {
  finish(now);
  hand_over_ = hand_over;
  shortest_.begin(now_is_, to);
  begin(Mode::kMove, to, Stage::kOld);
}

void ClockChecker::start(Tick now, const ClockSetting& to, Tick within) {
  hand_over_ = within;
  begin(Mode::kMove, to, Stage::kIdle);
  if (phase_) phase_since_ = now;
  falls_ = 0;
}

void ClockChecker::stop(Tick now) {
  finish(now);
  begin(Mode::kStop, std::nullopt, Stage::kOld);
}

// What it sees
// ----------------------------------------------------------------------------------------------------------

void ClockChecker::pins(Tick now, bool phase, bool servo, bool conflict) {
  if (conflict && !conflict_ && !conflict_allowed_)
    violate(now, Kind::kConflict, "two sources disagree for more than 2 ticks");
  conflict_ = conflict;
  shortest_.pins(now, phase, servo);
  const bool phase_changed = phase != phase_;
  if (mode_ == Mode::kIgnore) {
    falls_.reset();
  } else {
    if (phase_changed) phase_edge(now, phase);
    servo_pin(now, phase_changed, phase, servo);
  }
  if (phase_changed) {
    phase_since_ = now;
    if (!phase) last_fall_ = now;
  }
  phase_ = phase;
  servo_ = servo;
}

// The longest that PHASE may stay at its present level.
Tick ClockChecker::longest(bool level) const {
  const ClockSetting& to = next_.value_or(now_is_);
  const ClockSetting& s = mode_ == Mode::kMove && stage_ == Stage::kNew ? to : now_is_;
  const Tick exact_length = level ? s.high() : s.low();
  switch (mode_) {
    case Mode::kIgnore:
      return kNever;
    case Mode::kRun:
      return exact_length;
    case Mode::kChange:
      return (std::max(now_is_.half(), to.half()) * (std::max(now_is_.phase_divider, to.phase_divider) + 1) + 1) / 2;
    case Mode::kMove:
      if (stage_ == Stage::kNew) return exact_length;
      if (!level) return now_is_.low();
      return (stage_ == Stage::kOld ? now_is_.high() + release(now_is_) : 0) + hand_over_ + 2 * to.phase() + to.high();
    case Mode::kStop:
      return level ? kNever : exact_length;
  }
  return kNever;
}

void ClockChecker::finish(Tick now) {
  if (!phase_since_ || longest(phase_) == kNever || now - *phase_since_ <= longest(phase_)) return;
  violate(
      now, Kind::kMissing,
      fmt::format("PHASE {} since tick {}, {} ticks are the most", level_name(phase_), *phase_since_, longest(phase_)));
  phase_since_.reset();
  falls_.reset();
}

// `level` is the new one; it ends a pulse of the other level.
void ClockChecker::phase_edge(Tick now, bool level) {
  if (!level) ++counts_.phase_falls;
  if (!phase_since_) return;
  const Tick length = now - *phase_since_;
  switch (mode_) {
    case Mode::kIgnore:
      break;
    case Mode::kRun:
      exact(now, now_is_, level, length);
      break;
    case Mode::kChange:
      changing(now, level, length);
      break;
    case Mode::kMove:
      moving(now, level, length);
      break;
    case Mode::kStop:
      if (level || length <= now_is_.high()) {
        exact(now, now_is_, level, length);
      } else {
        violate(now, Kind::kRelation, "PHASE moves without a source");
        falls_.reset();
      }
      break;
  }
}

// A pulse of `length` ended, which should have the length of `s`.
void ClockChecker::exact(Tick now, const ClockSetting& s, bool level, Tick length) {
  const Tick due = level ? s.low() : s.high(), other = level ? s.high() : s.low();
  if (length == due) return;
  const std::string text = fmt::format("PHASE {} for {} ticks instead of {}", level_name(!level), length, due);
  const bool twice = !level && last_fall_ >= 0 && now - last_fall_ <= (s.phase() + 1) / 2;
  if (length > due)
    violate(now, length >= due + other ? Kind::kMissing : Kind::kLate, text);
  else if (twice)
    violate(now, Kind::kDoubled, text + fmt::format(", two falls within {} ticks", now - last_fall_));
  else
    violate(now, 2 * length < due ? Kind::kRunt : Kind::kEarly, text);
}

// Whole and half triangles, old or new.
void ClockChecker::changing(Tick now, bool level, Tick length) {
  const Tick half = std::min(now_is_.half(), next_->half());
  const Tick shortest = half * (std::min(now_is_.phase_divider, next_->phase_divider) + 1) / 2;
  if (length < shortest)
    violate(now, 2 * length < shortest ? Kind::kRunt : Kind::kEarly,
            fmt::format("PHASE {} for {} ticks while its variables change, at least {}", level_name(!level), length,
                        shortest));
  else if (length > longest(!level))
    violate(now, Kind::kLate,
            fmt::format("PHASE {} for {} ticks while its variables change, at most {}", level_name(!level), length,
                        longest(!level)));
}

// A fall of PHASE is the new source's first.
void ClockChecker::first_fall() {
  ++counts_.odd_highs;
  stage_ = Stage::kNew;
  falls_ = 0;
  first_servo_ = true;
}

void ClockChecker::moving(Tick now, bool level, Tick length) {
  if (stage_ == Stage::kNew) return exact(now, *next_, level, length);
  if (level) {  // a low level ended
    if (length != now_is_.low() && length == next_->low() && now_is_.high() >= next_->high()) {
      first_fall();  // its first high level was as long as one of the old source
      falls_ = 1;
      return;
    }
    return exact(now, now_is_, level, length);
  }
  if (stage_ == Stage::kOld && length == now_is_.high()) return;
  if (length < next_->high())
    violate(now, 2 * length < next_->high() ? Kind::kRunt : Kind::kEarly,
            fmt::format("PHASE high for {} ticks, the new source's first is {} at least", length, next_->high()));
  else if (length > longest(true))
    violate(now, Kind::kLate,
            fmt::format("PHASE high for {} ticks, {} at most while the source moves", length, longest(true)));
  first_fall();
}

// SERVO. Called after phase_edge() of the same tick.
void ClockChecker::servo_pin(Tick now, bool phase_changed, bool phase, bool servo) {
  const bool changed = servo != servo_;
  if (!phase_changed) {
    if (changed)
      violate(now, Kind::kRelation, fmt::format("SERVO {} without an edge of PHASE", servo ? "rises" : "falls"));
    return;
  }
  if (phase)
    with_rise(now, changed, servo);
  else
    with_fall(now, changed, servo);
}

// Dividers that may be in force: one, or the old and the new one while they change.
bool ClockChecker::divider_may_be(unsigned divider) const {
  if (mode_ == Mode::kChange) return divider == now_is_.servo_divider || divider == next_->servo_divider;
  if (mode_ == Mode::kMove && stage_ != Stage::kOld) return divider == next_->servo_divider;
  return divider == now_is_.servo_divider;
}

unsigned ClockChecker::largest_divider() const {
  if (mode_ == Mode::kChange) return std::max(now_is_.servo_divider, next_->servo_divider);
  if (mode_ == Mode::kMove && stage_ != Stage::kOld) return next_->servo_divider;
  return now_is_.servo_divider;
}

// Falls of PHASE after which SERVO must have fallen.
unsigned ClockChecker::latest_servo_fall() const {
  return first_servo_ ? 2 * largest_divider() + 1 : largest_divider() + 1;
}

// PHASE rises: SERVO rises with it when it is as fast, else it stays.
void ClockChecker::with_rise(Tick now, bool changed, bool servo) {
  if (changed && (!servo || !divider_may_be(0)))
    return violate(now, Kind::kRelation, "SERVO moves with a rise of PHASE");
  if (!changed && !servo && largest_divider() == 0 && mode_ != Mode::kChange)
    violate(now, Kind::kRelation, "SERVO stays low at a rise of PHASE");
}

void ClockChecker::with_fall(Tick now, bool changed, bool servo) {
  if (falls_) ++*falls_;
  const bool falls = changed && !servo;
  if (!servo_ && !changed) violate(now, Kind::kRelation, "SERVO low for longer than one phase period");
  if (changed && servo && falls_ && *falls_ != 1)
    violate(now, Kind::kRelation, "SERVO rises at the wrong fall of PHASE");
  if (falls) {
    ++counts_.servo_falls;
    const unsigned number = falls_.value_or(0);
    const bool due =
        first_servo_ ? number > largest_divider() && number <= latest_servo_fall() : divider_may_be(number - 1);
    if (falls_ && !due)
      violate(now, *falls_ <= largest_divider() ? Kind::kDoubled : Kind::kMissing,
              fmt::format("SERVO falls after {} phase periods instead of {}", *falls_, largest_divider() + 1));
    falls_ = 0;
    first_servo_ = false;
  } else if (falls_ && *falls_ >= latest_servo_fall()) {
    violate(now, Kind::kMissing, fmt::format("SERVO does not fall after {} phase periods", latest_servo_fall()));
    falls_.reset();
    first_servo_ = false;
  }
}

}  // namespace brick
