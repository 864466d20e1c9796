// The Verilated host port behind the pins of its component.
#include "Vhost_port.h"
#include "Vhost_port___024root.h"
#include "systemc/component/host_port/host_port_cycle.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace host_port_words;

struct Ports : PortMap {
  static const std::vector<FaceClock>& faces() {
    static const std::vector<FaceClock> both{FaceClock::kRef, FaceClock::kRef};
    return both;
  }
  static void access(Vhost_port& v, unsigned number, bool on, const Face& face) {
    HostPortInputs in;
    host_port_cycle::set_lines(in, number, on, face);
    if (number == kHost) {
      v.hp_sel_i = in.hp_sel;
      v.hp_rd_i = in.hp_rd;
      v.hp_rd_done_i = in.hp_rd_done;
      v.hp_wr_i = in.hp_wr;
      v.hp_addr_i = in.hp_addr;
      v.hp_wdata_i = in.hp_wdata;
    } else {
      v.dsp_sel_i = in.dsp_sel;
      v.dsp_we_i = in.dsp_we;
      v.dsp_rd_i = in.dsp_rd;
      v.dsp_addr_i = in.dsp_addr;
      v.dsp_wdata_i = in.dsp_wdata;
    }
  }
  static bool after(const Vhost_port&, unsigned number, Face& face) { return host_port_cycle::after(number, face); }
  static std::uint32_t read(const Vhost_port& v, unsigned number, unsigned) {
    return number == kHost ? v.hp_rdata_o : v.dsp_rdata_o;
  }
};

}  // namespace

std::unique_ptr<Chip> rtl_host_port(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vhost_port, Ports>>(seed);
}

}  // namespace brick::component
