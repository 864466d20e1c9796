// The host signals of the SystemC model behind the pins of their component.
#include "systemc/host/host_signals.h"

#include "systemc/component/host_signals_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace host_signals_words;

class HostSignalsModel final : public ModelChip {
 public:
  HostSignalsModel() : ModelChip(1), latches_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override {
    return address == kSignalsByte ? latches_.rdata() : latches_.ctrl();
  }

 private:
  void drive(const PinWords&) override {}
  bool reset_low(const PinWords& in) const override { return !bit(in, 0, kRstN); }
  Tick next_event() const override { return latches_.next_event(); }
  void block_advance(Tick t) override { latches_.advance(t); }
  void block_reset(Tick t) override { latches_.reset(t); }
  void before(unsigned, const Face& face) override {
    const Cycle& c = face.cycle;
    latches_.in = {c.write && c.address == kSignalsByte, c.write && c.address == kControlByte,
                   static_cast<std::uint8_t>(c.value & 0xF)};
  }
  bool after(unsigned, Face&) override {
    latches_.in = {};
    return true;
  }
  void show(PinWords& words) const override {
    words[0] = latches_.rdata() << kSignals | std::uint32_t{latches_.ctrl()} << kControl;
  }

  brick::HostSignals latches_;
};

}  // namespace

std::unique_ptr<Chip> model_host_signals() { return std::make_unique<HostSignalsModel>(); }

}  // namespace brick::component
