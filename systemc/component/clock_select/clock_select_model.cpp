// The clock selection of the SystemC model behind the pins of its component.
#include "systemc/board/clock_select.h"

#include <algorithm>

#include "systemc/component/clock_select/clock_select_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace clock_select_words;

class ClockSelectModel final : public ModelChip {
 public:
  ClockSelectModel() : ModelChip(kOutputWords, {}), select_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned) override { return 0; }

 private:
  void drive(const PinWords& in) override {
    const std::uint32_t fitted = kFitted.of(in);
    select_.in = {kPhaseOeI.of(in) & fitted, kServoOeI.of(in) & fitted, kExtClock.is_set(in)};
    select_.phase_level = kPhaseI.of(in);
    select_.servo_level = kServoI.of(in);
    select_.ext_phase = kExtPhase.is_set(in);
    select_.ext_servo = kExtServo.is_set(in);
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : select_.next_event(); }
  void block_advance(Tick t) override {
    for (Tick event = select_.next_event(); event < t; event = select_.next_event()) select_.advance(event);
    select_.advance(t);
  }
  void block_reset(Tick t) override { select_.reset(t); }
  void before(unsigned, const Face&) override {}
  bool after(unsigned, Face&) override { return true; }
  void show(PinWords& words) const override {
    words[kPhase.word] = kPhase.at(select_.phase()) | kServo.at(select_.servo()) | kConflict.at(select_.conflict()) |
                         kPhaseSource.at(select_.phase_source());
  }

  brick::ClockSelect select_;
};

}  // namespace

std::unique_ptr<Chip> model_clock_select() { return std::make_unique<ClockSelectModel>(); }

}  // namespace brick::component
