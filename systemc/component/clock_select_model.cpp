// The clock selection of the SystemC model behind the pins of its component.
#include "systemc/board/clock_select.h"

#include <algorithm>

#include "systemc/component/clock_select_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace clock_select_words;

class ClockSelectModel final : public ModelChip {
 public:
  ClockSelectModel() : ModelChip(1, {}), select_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned) override { return 0; }

 private:
  void drive(const PinWords& in) override {
    select_.in = {in[kPhaseOe] & in[kFitted], in[kServoOe] & in[kFitted], bit(in, kControl, kExtClock)};
    select_.phase_level = in[kPhaseIn];
    select_.servo_level = in[kServoIn];
    select_.ext_phase = bit(in, kControl, kExtPhase);
    select_.ext_servo = bit(in, kControl, kExtServo);
  }
  bool reset_low(const PinWords& in) const override { return !bit(in, kControl, kRstN); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : select_.next_event(); }
  void block_advance(Tick t) override {
    for (Tick event = select_.next_event(); event < t; event = select_.next_event()) select_.advance(event);
    select_.advance(t);
  }
  void block_reset(Tick t) override { select_.reset(t); }
  void before(unsigned, const Face&) override {}
  bool after(unsigned, Face&) override { return true; }
  void show(PinWords& words) const override {
    words[0] = std::uint32_t{select_.phase()} << kPhase | std::uint32_t{select_.servo()} << kServo |
               std::uint32_t{select_.conflict()} << kConflict | select_.phase_source() << kSource;
  }

  brick::ClockSelect select_;
};

}  // namespace

std::unique_ptr<Chip> model_clock_select() { return std::make_unique<ClockSelectModel>(); }

}  // namespace brick::component
