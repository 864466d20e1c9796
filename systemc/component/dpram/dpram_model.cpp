// The dual-ported RAM of the SystemC model behind the pins of its component.
#include "systemc/host/dpram.h"

#include "systemc/board/bus_strobes.h"
#include "systemc/component/dpram/dpram_cycle.h"
#include "systemc/component/model_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/core/start_value.h"

namespace brick::component {
namespace {
using namespace dpram_words;

class DpramModel final : public ModelChip {
 public:
  explicit DpramModel(std::uint64_t seed) : ModelChip(kOutputWords, {FaceClock::kRef, FaceClock::kPwm}), ram_("model") {
    for (unsigned i = 0; i < brick::Dpram::kWords; ++i) ram_.poke(i, start_word(start_seed(seed), i));
    power_on();
  }

  std::uint32_t peek(unsigned, unsigned address) override { return ram_.peek(dpram_cycle::word_of(address)); }

 private:
  void drive(const PinWords& in) override {
    ram_.in.small = kSmall.is_set(in);
    rst_n_ = kRstN.is_set(in);
  }
  bool reset_low(const PinWords& in) const override { return !kRstN.is_set(in); }
  Tick next_event() const override { return watched_[0] == 0 && watched_[1] == 0 ? kNever : ram_.next_event(); }
  void block_advance(Tick t) override { ram_.advance(t); }
  void block_reset(Tick t) override {
    set_cpu(pins_);
    ram_.reset(t);
  }
  void before(unsigned number, const Face& face) override {
    if (number == kHost)
      dpram_cycle::set_host_lines(ram_.in, true, face);
    else
      set_cpu(dpram_cycle::cpu_pins(true, face));
  }
  bool after(unsigned number, Face& face) override {
    const bool ended = number == kHost ? dpram_cycle::host_after(face, ram_.mem_busy(), ram_.mem_rdata())
                                       : dpram_cycle::cpu_after(face, ram_.cpu_wait(), ram_.cpu_rdata());
    if (ended) idle(number);
    return ended;
  }
  void idle(unsigned number) override {
    if (number == kHost)
      dpram_cycle::set_host_lines(ram_.in, false, Face{});
    else
      set_cpu(dpram_cycle::cpu_pins(false, Face{}));
  }
  std::uint32_t sample(unsigned, unsigned) override { return 0; }  // the word comes with a later edge; none in reset
  void show(PinWords& words) const override {
    words[kBusyHost.word] = kBusyHost.at(ram_.host_busy()) | kBusyCpu.at(ram_.cpu_busy());
    words[kCpuRdata.word] = kCpuRdata.at(ram_.cpu_rdata()) | kMemRdata.at(ram_.mem_rdata());
  }

  void set_cpu(const PortAPins& pins) {
    pins_ = pins;
    strobes_.set_pins(pins, rst_n_);
    ram_.in.set_cpu_pins(pins, strobes_.rd_falls(), strobes_.wr_falls());
    ram_.rd_moved();
  }

  brick::Dpram ram_;
  BusStrobes strobes_;
  PortAPins pins_;
  bool rst_n_ = false;
};

}  // namespace

std::unique_ptr<Chip> model_dpram(std::uint64_t seed) { return std::make_unique<DpramModel>(seed); }

}  // namespace brick::component
