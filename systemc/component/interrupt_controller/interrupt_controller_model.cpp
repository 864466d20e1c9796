// The interrupt controller of the SystemC model behind the pins of its component.
#include "systemc/host/interrupt_controller.h"

#include <algorithm>

#include "systemc/component/interrupt_controller/interrupt_controller_words.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/host/host_interrupt.h"

namespace brick::component {
namespace {
using namespace interrupt_controller_words;

class InterruptControllerModel final : public ModelChip {
 public:
  InterruptControllerModel() : ModelChip(kOutputWords), pic_("model"), line_("line") { power_on(); }

  std::uint32_t peek(unsigned, unsigned address) override { return pic_.read(address); }

 private:
  void drive(const PinWords& in) override {
    pic_.in.line = static_cast<std::uint8_t>(kIr.of(in));
    pic_.in.reset = kResetdrv.is_set(in);
    wire();
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override {
    if (watched_[0] == 0 && watched_[1] == 0) return kNever;
    return std::min(pic_.next_event(), line_.next_event());
  }
  void block_advance(Tick t) override {
    while (pic_.now() < t) {
      wire();
      both(std::min({t, pic_.next_event(), line_.next_event()}));
    }
    wire();
  }
  void block_reset(Tick t) override {
    pic_.reset(t);
    line_.reset(t);
    wire();
  }
  void before(unsigned, const Face& face) override {
    pic_.in.wr = face.cycle.write;
    pic_.in.addr = static_cast<std::uint8_t>(face.cycle.address);
    pic_.in.wdata = static_cast<std::uint8_t>(face.cycle.value);
    wire();
  }
  bool after(unsigned, Face&) override {
    pic_.in.wr = false;
    wire();
    return true;
  }
  void show(PinWords& words) const override {
    words[kIst.word] = kIst.at(pic_.ist()) | kSig.at(pic_.sig()) | kMsk.at(pic_.msk()) | kElr.at(pic_.elr());
    words[kIrq.word] = kIrq.at(line_.irq());
  }

  void wire() { line_.in = {pic_.request(), pic_.served()}; }
  void both(Tick t) {  // the line sees what the controller showed before edge t
    line_.advance(t);
    pic_.advance(t);
  }

  brick::InterruptController pic_;
  HostInterrupt line_;
};

}  // namespace

std::unique_ptr<Chip> model_interrupt_controller() { return std::make_unique<InterruptControllerModel>(); }

}  // namespace brick::component
