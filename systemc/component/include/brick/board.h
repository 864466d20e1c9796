// The controller board: clock selection, servo and MACRO ICs, watchdog, host port, interrupt controller, host signals,
// dual-ported RAM behind the pins of Port A (the CPU's bus), of ISA and of the connectors. The CPU is the user's: he
// drives Port A. docs/architecture.md, data sheets host-bus and servo-ic.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <brick/component.h>
#include <brick/servo_ic.h>

namespace brick::component {

struct BoardOptions {
  std::uint32_t fitted = 0x3;  // ICs: bit i = servo IC 0..9, 2*..9* (10..17), MACRO IC 0..3 (18..21)
  std::uint64_t seed = 0;      // of what the dual-ported RAM holds at power-on; 0: zero
};

// Motor side of one servo IC of the board; the names of its ports begin with those of the IC, servo_ic0_ch1_enc_a.
struct BoardServoIc {
  BoardServoIc(Component& board, const std::string& ic);
  std::array<ServoIcChannel, 4> ch;
  Out<> dac_clk, dac_strobe, adc_clk, adc_strobe;
};

class Board final : public Component {
 public:
  // An error /brick/fitted when BoardOptions::fitted has other bits than 0..21.
  Board(const sc_core::sc_module_name& name, TimeBase& time, const BoardOptions& options = {},
        const Engine& engine = model_engine());

  In<> rst_n;  // let go of, the board works 6 to 8 ticks later

  // Port A, the CPU's external bus (host-bus:2).
  In<19> pa_addr;
  In<4> pa_aa;
  In<> pa_x, pa_int, pa_rd_n, pa_wr_n;
  In<24> pa_data_i;
  Out<24> pa_data_o;
  Out<> pa_data_oe, pa_ta_n, irq_host;

  // ISA / PC104 (host-bus:3.4).
  In<7> isa_la;
  In<20> isa_sa;
  In<16> isa_sd_i;
  In<> isa_ior_n, isa_iow_n, isa_memr_n, isa_memw_n, isa_aen, isa_sbhe_n, isa_resetdrv;
  Out<16> isa_sd_o;
  Out<2> isa_sd_oe;
  Out<> isa_iochrdy, isa_memcs16_n, isa_irq;

  // Switches and straps (host-bus:3.1, host-bus:3.7).
  In<8> io_base;
  In<10> window;
  In<> io_decode16, window_flat, slot8;
  In<22> fitted;  // a part of BoardOptions::fitted
  In<4> macro_gate;
  In<> dpram_small, jpan_fitted, ext_clock, pic_8259;
  In<12> line_select;

  // Connectors.
  In<16> jpan;
  In<> ext_phase, ext_servo, mi1, mi2, axexp0, axexp1, pwr_good;
  Out<> phase, servo, breq, ipos, eror, f1er, hreq, wdo, wd_tripped, wd_relay, wd_led;
  Out<> brld_n, erld_n, f1ld_n, ipld_n, ctrl0, ctrl1;

  // What the board does inside.
  Out<5> phase_source;
  Out<> source_conflict, busy_host, busy_cpu, txde, rxdf;

  std::vector<std::unique_ptr<BoardServoIc>> servo_ic;  // the fitted ones, lowest first

  static const std::vector<PinInfo>& pin_table(std::uint32_t fitted);
};

}  // namespace brick::component
