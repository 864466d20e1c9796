// What the ports of the Verilated modules of rtl/host are called.
#include "testbench/unit/host/rtl_blocks.h"

#include <algorithm>

#include "Vdpram.h"
#include "Vdpram___024root.h"
#include "Vhost_interrupt.h"
#include "Vhost_interrupt___024root.h"
#include "Vhost_port.h"
#include "Vhost_port___024root.h"
#include "Vhost_signals.h"
#include "Vhost_signals___024root.h"
#include "Vinterrupt_controller.h"
#include "Vinterrupt_controller___024root.h"
#include "Visa_slave.h"
#include "Visa_slave___024root.h"
#include "Vpic_8259.h"
#include "Vpic_8259___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vinterrupt_controller& v, const InterruptControllerInputs& in) {
  v.reset_i = in.reset;
  v.line_i = in.line;
  v.wr_i = in.wr;
  v.addr_i = in.addr;
  v.wdata_i = in.wdata;
}
Outputs sample(const Vinterrupt_controller& v) {
  return {{"rdata", v.rdata_o}, {"ist", v.ist_o},         {"sig", v.sig_o},      {"msk", v.msk_o},
          {"elr", v.elr_o},     {"request", v.request_o}, {"served", v.served_o}};
}

void drive(Vpic_8259& v, const Pic8259Inputs& in) {
  v.line_i = in.line;
  v.rd_i = in.rd;
  v.wr_i = in.wr;
  v.addr_i = in.addr;
  v.wdata_i = in.wdata;
}
Outputs sample(const Vpic_8259& v) {
  const bool request = v.request_o && !v.served_o;  // as host_interrupt takes it
  return {{"rdata", v.rdata_o}, {"irr", v.irr_o},     {"isr", v.isr_o},      {"imr", v.imr_o},
          {"level", v.level_o}, {"request", request}, {"served", v.served_o}};
}

void drive(Vhost_interrupt& v, const HostInterruptInputs& in) {
  v.request_i = in.request;
  v.served_i = in.served;
}
Outputs sample(const Vhost_interrupt& v) { return {{"irq", v.irq_o}}; }

void drive(Vhost_signals& v, const HostSignalsInputs& in) {
  v.wr_i = in.wr;
  v.ctrl_wr_i = in.ctrl_wr;
  v.wdata_i = in.wdata & 0xF;
  v.trip_i = in.trip;
}
Outputs sample(const Vhost_signals& v) {
  return {{"rdata", v.rdata_o}, {"ctrl", v.ctrl_o}, {"ipos", v.ipos_o},
          {"breq", v.breq_o},   {"eror", v.eror_o}, {"f1er", v.f1er_o}};
}

void drive(Vhost_port& v, const HostPortInputs& in) {
  v.hp_sel_i = in.hp_sel;
  v.hp_rd_i = in.hp_rd;
  v.hp_rd_done_i = in.hp_rd_done;
  v.hp_wr_i = in.hp_wr;
  v.hp_addr_i = in.hp_addr;
  v.hp_wdata_i = in.hp_wdata;
  v.hp_reset_i = in.hp_reset;
  v.dsp_sel_i = in.dsp_sel;
  v.dsp_we_i = in.dsp_we;
  v.dsp_rd_i = in.dsp_rd;
  v.dsp_addr_i = in.dsp_addr;
  v.dsp_wdata_i = in.dsp_wdata;
}
Outputs sample(const Vhost_port& v) {
  return {{"hp_rdata", v.hp_rdata_o}, {"dsp_rdata", v.dsp_rdata_o}, {"hreq", v.hreq_o},
          {"irq", v.irq_o},           {"txde", v.txde_o},           {"rxdf", v.rxdf_o}};
}

void drive(Vdpram& v, const DpramInputs& in) {
  v.small_i = in.small;
  v.rd_falls_i = in.rd_falls;
  v.wr_falls_i = in.wr_falls;
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
}
Outputs sample(const Vdpram& v) {
  return {{"cpu_rdata", v.cpu_rdata_o}, {"cpu_wait", v.cpu_wait_o},   {"cpu_busy", v.cpu_busy_o},
          {"mem_rdata", v.mem_rdata_o}, {"host_busy", v.host_busy_o}, {"cpu_drive", v.cpu_drive_o}};
}

void drive(Visa_slave& v, const AnsweredInputs& in) {
  v.isa_la_i = in.isa_la;
  v.isa_sa_i = in.isa_sa;
  v.isa_sd_i = in.isa_sd;
  v.isa_ior_ni = in.isa_ior_n;
  v.isa_iow_ni = in.isa_iow_n;
  v.isa_memr_ni = in.isa_memr_n;
  v.isa_memw_ni = in.isa_memw_n;
  v.isa_aen_i = in.isa_aen;
  v.isa_sbhe_ni = in.isa_sbhe_n;
  v.isa_resetdrv_i = in.isa_resetdrv;
  v.io_base_i = in.io_base;
  v.io_decode16_i = in.io_decode16;
  v.window_i = in.window;
  v.window_flat_i = in.window_flat;
  v.slot8_i = in.slot8;
  v.hp_rdata_i = in.hp_rdata;
  v.pic_rdata_i = in.pic_rdata;
  v.mem_rdata_i = in.mem_rdata;
  v.mem_busy_d_i = in.mem_busy_d;
}
Outputs sample(const Visa_slave& v) {
  return {{"isa_sd", v.isa_sd_o},
          {"isa_iochrdy", v.isa_iochrdy_o},
          {"isa_memcs16_n", v.isa_memcs16_no},
          {"isa_sd_oe", v.isa_sd_oe_o},
          {"host_reset", v.host_reset_o},
          {"pic_rd", v.pic_rd_o},
          {"hp_sel", v.hp_sel_o},
          {"hp_rd", v.hp_rd_o},
          {"hp_rd_done", v.hp_rd_done_o},
          {"hp_wr", v.hp_wr_o},
          {"hp_addr", v.hp_addr_o},
          {"hp_wdata", v.hp_wdata_o},
          {"pic_sel", v.pic_sel_o},
          {"pic_wr", v.pic_wr_o},
          {"pic_addr", v.pic_addr_o},
          {"pic_wdata", v.pic_wdata_o},
          {"mem_sel", v.mem_sel_o},
          {"mem_rd", v.mem_rd_o},
          {"mem_wr", v.mem_wr_o},
          {"mem_addr", v.mem_addr_o},
          {"mem_be", v.mem_be_o},
          {"mem_wdata", v.mem_wdata_o}};
}

}  // namespace

RtlBlock<InterruptControllerInputs, Outputs> make_rtl_interrupt_controller(int seed) {
  return verilated_shell<Vinterrupt_controller, InterruptControllerInputs, Outputs>(drive, sample, seed);
}
RtlBlock<Pic8259Inputs, Outputs> make_rtl_pic_8259(int seed) {
  return verilated_shell<Vpic_8259, Pic8259Inputs, Outputs>(drive, sample, seed);
}
RtlBlock<HostInterruptInputs, Outputs> make_rtl_host_interrupt(int seed) {
  return verilated_shell<Vhost_interrupt, HostInterruptInputs, Outputs>(drive, sample, seed);
}
RtlBlock<HostSignalsInputs, Outputs> make_rtl_host_signals() {
  return verilated_shell<Vhost_signals, HostSignalsInputs, Outputs>(drive, sample);
}
RtlBlock<HostPortInputs, Outputs> make_rtl_host_port() {
  return verilated_shell<Vhost_port, HostPortInputs, Outputs>(drive, sample);
}
RtlBlock<DpramInputs, Outputs> make_rtl_dpram(int seed) {
  return verilated_shell<Vdpram, DpramInputs, Outputs>(drive, sample, seed);
}
RtlBlock<AnsweredInputs, Outputs> make_rtl_isa_slave(bool on_a_board) {
  const auto seen = [](const Visa_slave& v) { return seen_by_a_board(sample(v)); };
  return on_a_board ? verilated_shell<Visa_slave, AnsweredInputs, Outputs>(drive, +seen)
                    : verilated_shell<Visa_slave, AnsweredInputs, Outputs>(drive, sample);
}

Outputs seen_by_a_board(Outputs outputs) {
  const auto of = [&](std::string_view name) -> std::uint32_t& {
    return std::find_if(outputs.begin(), outputs.end(), [=](const auto& o) { return o.first == name; })->second;
  };
  if (of("hp_addr") != 7) of("hp_rd_done") = 0;
  for (const auto& [strobe, data] : {std::pair{"hp_wr", "hp_wdata"}, {"pic_wr", "pic_wdata"}, {"mem_wr", "mem_wdata"}})
    if (of(strobe) == 0) of(data) = 0;
  return outputs;
}

}  // namespace brick
