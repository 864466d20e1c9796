// The watchdog of the SystemC model behind the pins of its component.
#include "systemc/board/watchdog.h"

#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/watchdog/watchdog_words.h"

namespace brick::component {
namespace {
using namespace watchdog_words;

class WatchdogModel final : public ModelChip {
 public:
  WatchdogModel() : ModelChip(kOutputWords), watchdog_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned) override { return 0; }

 private:
  void drive(const PinWords& in) override {
    watchdog_.servo = kServo.is_set(in);
    watchdog_.pwr_good = kPwrGood.is_set(in);
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : watchdog_.next_event(); }
  void block_advance(Tick t) override { watchdog_.advance(t); }
  void block_reset(Tick t) override { watchdog_.reset(t); }
  void before(unsigned, const Face& face) override { watchdog_.strobe = face.cycle.write; }
  bool after(unsigned, Face&) override {
    watchdog_.strobe = false;
    return true;
  }
  void show(PinWords& words) const override { words[0] = kTrip.at(watchdog_.trip()) | kRelay.at(watchdog_.relay()); }

  brick::Watchdog watchdog_;
};

}  // namespace

std::unique_ptr<Chip> model_watchdog() { return std::make_unique<WatchdogModel>(); }

}  // namespace brick::component
