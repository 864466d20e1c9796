// The MACRO IC of the SystemC model behind the pins of its component.
#include "systemc/macro_ic/macro_ic.h"

#include "systemc/component/macro_ic_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace macro_ic_words;

class MacroIcModel final : public ModelChip {
 public:
  MacroIcModel() : ModelChip(1), ic_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override { return ic_.read((address & 4) != 0, address / 8); }

 private:
  void drive(const PinWords& in) override {
    ic_.set_gate(bit(in, 0, kGate));
    ic_.set_pins(bit(in, 0, kPhaseIn), bit(in, 0, kServoIn));
  }
  bool reset_low(const PinWords& in) const override { return !bit(in, 0, kRstN); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : ic_.next_event(); }
  void block_advance(Tick t) override { ic_.advance(t); }
  void block_reset(Tick t) override { ic_.reset(t); }
  void before(unsigned, const Face&) override {}
  bool after(unsigned, Face& face) override {
    const Cycle& c = face.cycle;
    if (c.write) ic_.write((c.address & 4) != 0, c.address / 8, c.value & 0xFFFFFF);
    return true;
  }
  void show(PinWords& words) const override {
    const std::uint32_t phase_oe = ic_.phase_oe(), servo_oe = ic_.servo_oe();
    words[0] = (ic_.phase() | (phase_oe ^ 1u)) << kPhase | phase_oe << kPhaseOe |
               (ic_.servo() | (servo_oe ^ 1u)) << kServo | servo_oe << kServoOe;
  }

  brick::MacroIc ic_;
};

}  // namespace

std::unique_ptr<Chip> model_macro_ic() { return std::make_unique<MacroIcModel>(); }

}  // namespace brick::component
