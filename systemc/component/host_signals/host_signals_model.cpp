// The host signals of the SystemC model behind the pins of their component.
#include "systemc/host/host_signals.h"

#include "systemc/component/host_signals/host_signals_registers.h"
#include "systemc/component/host_signals/host_signals_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace host_signals_words;

class HostSignalsModel final : public ModelChip {
 public:
  HostSignalsModel() : ModelChip(kOutputWords), latches_("model") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override {
    return address == kSignalsByte ? latches_.rdata() : latches_.ctrl();
  }

 private:
  void drive(const PinWords& in) override { latches_.in.trip = kTrip.is_set(in); }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return latches_.next_event(); }
  void block_advance(Tick t) override { latches_.advance(t); }
  void block_reset(Tick t) override { latches_.reset(t); }
  void before(unsigned, const Face& face) override {
    const Cycle& c = face.cycle;
    latches_.in.wr = c.write && c.address == kSignalsByte;
    latches_.in.ctrl_wr = c.write && c.address == kControlByte;
    latches_.in.wdata = static_cast<std::uint8_t>(c.value & 0xF);
  }
  bool after(unsigned, Face&) override {
    latches_.in.wr = latches_.in.ctrl_wr = false;
    return true;
  }
  void show(PinWords& words) const override {
    const std::uint32_t signals = latches_.rdata(), control = latches_.ctrl();
    words[0] = kIpos.at(signals) | kBreq.at(signals >> 1) | kEror.at(signals >> 2) | kF1er.at(signals >> 3) |
               kCtrl0.at(control) | kCtrl1.at(control >> 1);
  }

  brick::HostSignals latches_;
};

}  // namespace

std::unique_ptr<Chip> model_host_signals() { return std::make_unique<HostSignalsModel>(); }

}  // namespace brick::component
