// The Verilated dual-ported RAM behind the pins of its component.
#include "Vdpram_pins.h"
#include "Vdpram_pins___024root.h"
#include "systemc/component/dpram/dpram_cycle.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"
#include "systemc/core/start_value.h"

namespace brick::component {
namespace {
using namespace dpram_words;
using Module = Vdpram_pins;

struct Ports : PortMap {
  static const std::vector<FaceClock>& faces() {
    static const std::vector<FaceClock> both{FaceClock::kRef, FaceClock::kPwm};
    return both;
  }
  static void access(Module& v, unsigned number, bool on, const Face& face) {
    if (number == kHost) {
      DpramInputs in;
      dpram_cycle::set_host_lines(in, on, face);
      v.mem_sel_i = in.mem_sel;
      v.mem_wr_i = in.mem_wr;
      if (!on) return;
      v.mem_rd_i = in.mem_rd;
      v.mem_addr_i = in.mem_addr;
      v.mem_be_i = in.mem_be;
      v.mem_wdata_i = in.mem_wdata;
      return;
    }
    const PortAPins pins = dpram_cycle::cpu_pins(on, face);
    v.cpu_sel_i = DpramInputs::selected(pins);
    v.cpu_x_i = pins.pa_x;
    v.cpu_addr_i = static_cast<SData>(pins.pa_addr & 0x3FFF);
    v.cpu_rd_ni = pins.pa_rd_n;
    v.cpu_wr_ni = pins.pa_wr_n;
    v.cpu_wdata_i = static_cast<SData>(pins.pa_wdata);
    v.eval();  // the strobes clock flip-flops
  }
  static bool after(const Module& v, unsigned number, Face& face) {
    return number == kHost ? dpram_cycle::host_after(face, v.host_busy_o, v.mem_rdata_o)
                           : dpram_cycle::cpu_after(face, v.cpu_wait_o, v.cpu_rdata_o);
  }
  static std::uint32_t read(const Module&, unsigned, unsigned) { return 0; }  // the word comes with a later edge
  static std::uint32_t peek(Module& v, unsigned, unsigned address) {
    if (v.small_i && address >= kSmallBytes) return 0;
    v.peek_addr_i = static_cast<SData>(dpram_cycle::word_of(address));
    v.eval();
    return v.peek_o;
  }
};

}  // namespace

std::unique_ptr<Chip> rtl_dpram(std::uint64_t seed, std::uint64_t ram_seed) {
  return std::make_unique<VerilatedChip<Module, Ports>>(seed, [ram_seed](Module& v) {
    for (unsigned i = 0; i < kBytes / 2; ++i) v.start_i[i] = start_word(start_seed(ram_seed), i);
  });
}

}  // namespace brick::component
