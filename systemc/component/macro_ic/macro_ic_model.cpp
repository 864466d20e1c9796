// The MACRO IC of the SystemC model behind the pins of its component.
#include "systemc/macro_ic/macro_ic.h"

#include "systemc/component/macro_ic/macro_ic_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace macro_ic_words;

class MacroIcModel final : public ModelChip {
 public:
  MacroIcModel() : ModelChip(kOutputWords), ic_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override { return ic_.read((address & 4) != 0, address / 8); }

 private:
  void drive(const PinWords& in) override {
    ic_.set_gate(kGate.is_set(in));
    ic_.set_pins(kPhaseI.is_set(in), kServoI.is_set(in));
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
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
    words[0] = kPhaseO.at(ic_.phase() || !ic_.phase_oe()) | kPhaseOe.at(ic_.phase_oe()) |
               kServoO.at(ic_.servo() || !ic_.servo_oe()) | kServoOe.at(ic_.servo_oe());
  }

  brick::MacroIc ic_;
};

}  // namespace

std::unique_ptr<Chip> model_macro_ic() { return std::make_unique<MacroIcModel>(); }

}  // namespace brick::component
