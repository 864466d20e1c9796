#include <functional>

#include "Vdpram.h"
#include "Vhost_port.h"
#include "Vhost_signals.h"
#include "Vinterrupt_controller.h"
#include "Visa_slave.h"
#include "Visa_slave_variant.h"
#include "testbench/unit/host/rtl_block.h"
#include "verilated.h"

namespace brick {
namespace {

// Only the DPRAM has a clk_pwm.
template <class V>
auto set_pwm(V& v, int level, int) -> decltype(v.clk_pwm_i = 1, void()) {
  v.clk_pwm_i = static_cast<CData>(level);
}
template <class V>
void set_pwm(V&, int, long) {}

template <class V, class Inputs>
class Verilated : public RtlBlock<Inputs> {
 public:
  using Drive = void (*)(V&, const Inputs&);
  using Show = Outputs (*)(const V&);
  Verilated(Drive driver, Show shower) : drive_(driver), show_(shower) { reset(); }
  ~Verilated() override { top_.final(); }

  void drive(const Inputs& in) override {
    drive_(top_, in);
    top_.eval();
  }
  void clock(bool ref) override {
    set_pwm(top_, 1, 0);
    if (ref) top_.clk_ref_i = 1;
    top_.eval();
    set_pwm(top_, 0, 0);
    top_.clk_ref_i = 0;
    top_.eval();
  }
  void reset() override {
    for (int level : {1, 0, 1}) {  // the asynchronous reset acts on its falling edge
      top_.rst_ni = static_cast<CData>(level);
      top_.eval();
    }
  }
  Outputs outputs() override { return show_(top_); }

 private:
  VerilatedContext context_;
  V top_{&context_};
  Drive drive_;
  Show show_;
};

template <class V>
std::unique_ptr<RtlBlock<DpramInputs>> make_dpram() {
  return std::make_unique<Verilated<V, DpramInputs>>(
      [](V& v, const DpramInputs& in) {
        v.small_i = in.small;
        v.cpu_sel_i = in.cpu_sel;
        v.cpu_x_i = in.cpu_x;
        v.cpu_addr_i = in.cpu_addr;
        v.cpu_rd_ni = in.cpu_rd_n;
        v.cpu_wr_ni = in.cpu_wr_n;
        v.cpu_wdata_i = in.cpu_wdata;
        v.mem_sel_i = in.mem_sel;
        v.mem_rd_i = in.mem_rd;
        v.mem_wr_i = in.mem_wr;
        v.mem_addr_i = in.mem_addr;
        v.mem_be_i = in.mem_be;
        v.mem_wdata_i = in.mem_wdata;
      },
      [](const V& v) {
        return Outputs{{"cpu_rdata", v.cpu_rdata_o},
                       {"cpu_busy", v.cpu_busy_o},
                       {"mem_rdata", v.mem_rdata_o},
                       {"mem_busy", v.mem_busy_o},
                       {"host_busy", v.host_busy_o}};
      });
}

template <class V>
std::unique_ptr<RtlBlock<IsaSlaveInputs>> make_isa_slave() {
  return std::make_unique<Verilated<V, IsaSlaveInputs>>(
      [](V& v, const IsaSlaveInputs& in) {
        v.isa_sa_i = in.isa_sa;
        v.isa_sd_i = in.isa_sd;
        v.isa_ior_ni = in.isa_ior_n;
        v.isa_iow_ni = in.isa_iow_n;
        v.isa_memr_ni = in.isa_memr_n;
        v.isa_memw_ni = in.isa_memw_n;
        v.isa_aen_i = in.isa_aen;
        v.isa_sbhe_ni = in.isa_sbhe_n;
        v.hp_rdata_i = in.hp_rdata;
        v.pic_rdata_i = in.pic_rdata;
        v.mem_rdata_i = in.mem_rdata;
        v.mem_busy_i = in.mem_busy;
      },
      [](const V& v) {
        return Outputs{
            {"isa_sd", v.isa_sd_o},     {"isa_iochrdy", v.isa_iochrdy_o}, {"isa_memcs16_n", v.isa_memcs16_no},
            {"hp_sel", v.hp_sel_o},     {"hp_rd_done", v.hp_rd_done_o},   {"hp_wr", v.hp_wr_o},
            {"hp_addr", v.hp_addr_o},   {"hp_wdata", v.hp_wdata_o},       {"pic_sel", v.pic_sel_o},
            {"pic_wr", v.pic_wr_o},     {"pic_addr", v.pic_addr_o},       {"pic_wdata", v.pic_wdata_o},
            {"mem_sel", v.mem_sel_o},   {"mem_rd", v.mem_rd_o},           {"mem_wr", v.mem_wr_o},
            {"mem_addr", v.mem_addr_o}, {"mem_be", v.mem_be_o},           {"mem_wdata", v.mem_wdata_o}};
      });
}

}  // namespace

std::unique_ptr<RtlBlock<InterruptControllerInputs>> make_rtl_interrupt_controller() {
  using V = Vinterrupt_controller;
  return std::make_unique<Verilated<V, InterruptControllerInputs>>(
      [](V& v, const InterruptControllerInputs& in) {
        v.line_i = in.line;
        v.wr_i = in.wr;
        v.addr_i = in.addr;
        v.wdata_i = in.wdata;
      },
      [](const V& v) {
        return Outputs{{"rdata", v.rdata_o}, {"ist", v.ist_o}, {"sig", v.sig_o},
                       {"msk", v.msk_o},     {"elr", v.elr_o}, {"irq", v.irq_o}};
      });
}

std::unique_ptr<RtlBlock<HostSignalsInputs>> make_rtl_host_signals() {
  using V = Vhost_signals;
  return std::make_unique<Verilated<V, HostSignalsInputs>>(
      [](V& v, const HostSignalsInputs& in) {
        v.wr_i = in.wr;
        v.wdata_i = in.wdata & 0xF;
      },
      [](const V& v) {
        return Outputs{
            {"rdata", v.rdata_o}, {"ipos", v.ipos_o}, {"breq", v.breq_o}, {"eror", v.eror_o}, {"f1er", v.f1er_o}};
      });
}

std::unique_ptr<RtlBlock<HostPortInputs>> make_rtl_host_port() {
  using V = Vhost_port;
  return std::make_unique<Verilated<V, HostPortInputs>>(
      [](V& v, const HostPortInputs& in) {
        v.hp_sel_i = in.hp_sel;
        v.hp_rd_done_i = in.hp_rd_done;
        v.hp_wr_i = in.hp_wr;
        v.hp_addr_i = in.hp_addr;
        v.hp_wdata_i = in.hp_wdata;
        v.dsp_sel_i = in.dsp_sel;
        v.dsp_we_i = in.dsp_we;
        v.dsp_rd_done_i = in.dsp_rd_done;
        v.dsp_addr_i = in.dsp_addr;
        v.dsp_wdata_i = in.dsp_wdata;
      },
      [](const V& v) {
        return Outputs{{"hp_rdata", v.hp_rdata_o}, {"dsp_rdata", v.dsp_rdata_o}, {"hreq", v.hreq_o}, {"irq", v.irq_o}};
      });
}

std::unique_ptr<RtlBlock<DpramInputs>> make_rtl_dpram() { return make_dpram<Vdpram>(); }
std::unique_ptr<RtlBlock<IsaSlaveInputs>> make_rtl_isa_slave() { return make_isa_slave<Visa_slave>(); }
std::unique_ptr<RtlBlock<IsaSlaveInputs>> make_rtl_isa_slave_variant() { return make_isa_slave<Visa_slave_variant>(); }

}  // namespace brick
