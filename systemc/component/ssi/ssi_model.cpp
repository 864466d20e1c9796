// The serial encoder inputs of the SystemC model behind the pins of their component.
#include "systemc/ssi/ssi.h"

#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/ssi/ssi_words.h"

namespace brick::component {
namespace {
using namespace ssi_words;

class SsiModel final : public ModelChip {
 public:
  SsiModel() : ModelChip(kOutputWords), ssi_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override { return ssi_.read((address & 4) != 0, address / 8); }

 private:
  void drive(const PinWords& in) override {
    ssi_.geo = kGeo.is_set(in);
    ssi_.phase = kPhase.is_set(in);
    ssi_.servo = kServo.is_set(in);
    ssi_.data = static_cast<std::uint8_t>(kData.of(in));
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : ssi_.next_event(); }
  void block_advance(Tick t) override { ssi_.advance(t); }
  void block_reset(Tick t) override { ssi_.reset(t); }
  void before(unsigned, const Face& face) override {
    const Cycle& c = face.cycle;
    if (!c.write) ssi_.read_taken((c.address & 4) != 0, c.address / 8);
  }
  bool after(unsigned, Face& face) override {
    const Cycle& c = face.cycle;
    if (c.write) ssi_.write((c.address & 4) != 0, c.address / 8, c.value & 0xFFFFFF);
    return true;
  }
  void show(PinWords& words) const override { words[0] = kClk.at(ssi_.clk()); }

  brick::Ssi ssi_;
};

}  // namespace

std::unique_ptr<Chip> model_ssi() { return std::make_unique<SsiModel>(); }

}  // namespace brick::component
