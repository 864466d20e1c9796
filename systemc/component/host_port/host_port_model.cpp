// The host port of the SystemC model behind the pins of its component.
#include "systemc/host/host_port.h"

#include "systemc/component/host_port/host_port_cycle.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {
namespace {
using namespace host_port_words;

class HostPortModel final : public ModelChip {
 public:
  HostPortModel() : ModelChip(kOutputWords, {FaceClock::kRef, FaceClock::kRef}), port_("model") { power_on(); }

  std::uint32_t peek(unsigned face, unsigned address) override {
    return face == kHost ? port_.host_read(address) : port_.cpu_read(host_port_cycle::cpu_register(address));
  }

 private:
  void drive(const PinWords& in) override { port_.in.hp_reset = kResetdrv.is_set(in); }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return watched_[0] == 0 ? kNever : port_.next_event(); }
  void block_advance(Tick t) override { port_.advance(t); }
  void block_reset(Tick t) override { port_.reset(t); }
  void before(unsigned number, const Face& face) override { host_port_cycle::set_lines(port_.in, number, true, face); }
  bool after(unsigned number, Face& face) override {
    const bool ended = host_port_cycle::after(number, face);
    if (ended) idle(number);
    return ended;
  }
  void idle(unsigned number) override { host_port_cycle::set_lines(port_.in, number, false, Face{}); }
  void show(PinWords& words) const override {
    words[0] = kHreq.at(port_.hreq()) | kIrq.at(port_.irq()) | kTxde.at(port_.txde()) | kRxdf.at(port_.rxdf());
  }

  brick::HostPort port_;
};

}  // namespace

std::unique_ptr<Chip> model_host_port() { return std::make_unique<HostPortModel>(); }

}  // namespace brick::component
