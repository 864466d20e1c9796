// The controller board: clock selection, servo and MACRO ICs, watchdog, host port, interrupt controller, host signals,
// dual-ported RAM behind the pins of Port A (the CPU's bus), of ISA and of the connectors. The CPU is the user's: he
// drives Port A. docs/architecture.md, data sheets host-bus and servo-ic.
//
// Each of the two buses is driven by the pins or by its sockets, whose accesses are cycles with real edges on those
// pins inside: docs/port-a.md, host-bus:3.4. A bus of which a socket and an input pin is bound is an error
// /brick/two_masters at the end of the elaboration; its output pins show its cycles either way.
//  - The annotated delay is waited for, then the bus: its first clock after the call, the end of its cycle, as long as
//    /TA or IOCHRDY stretch that. An access returns with the delay 0 as the cycle's address is let go; its time and its
//    result depend on neither quantum nor engine. Accesses to one bus queue as those to a register socket do. No DMI.
//  - A process that is killed in its access leaves the cycle to go on to its end.
//  - Debug transport reads the dual-ported RAM (not through a window with pages), BCR and PCTL, and moves 0 bytes of
//    anything else; it writes nothing.
//   TLM_GENERIC_ERROR_RESPONSE  rst_n broke the cycle off or is low (Port A); IOCHRDY stayed low for more than 15.6 us
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <tlm_utils/simple_target_socket.h>

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

  In<> rst_n;  // reset, idle 1, asynchronous; let go of, the board works 6 to 8 ticks later (host-bus:2.6)

  // Port A, the CPU's external bus (host-bus:2).
  // The socket: PMAC word X:a is 4 bytes at 8 a + 4, Y:a at 8 a, 24 bits in the low ones. Here too are the on-chip
  // registers of the bus: BCR, X:$FFFFFB, wait states, and PCTL, X:$FFFFFD, the CPU clock. They start as after a reset
  // (rst_n), with the longest cycles.
  //   TLM_ADDRESS_ERROR_RESPONSE  nothing on the bus there (docs/architecture.md), or not a multiple of 4
  //   TLM_BURST_ERROR_RESPONSE, TLM_BYTE_ENABLE_ERROR_RESPONSE  not one whole word
  tlm_utils::simple_target_socket_optional<Board> port_a{"port_a"};
  In<19> pa_addr;         // A18..A0
  In<4> pa_aa;            // AA3..AA0, 1 = region selected (host-bus:2.1)
  In<> pa_x, pa_int;      // 1 = X space, 0 = Y; 1 = on-chip page: the CPU's side of the host port (host-bus:2.6)
  In<> pa_rd_n, pa_wr_n;  // strobes, idle 1
  In<24> pa_data_i;       // D as the CPU drives it
  Out<24> pa_data_o;      // D as the board drives it
  Out<> pa_data_oe;       // the board drives D
  Out<> pa_ta_n;          // 0 = transfer acknowledged; 1 stretches the cycle
  Out<> irq_host;         // interrupt of the host port to the CPU (host-bus:3.2)

  // ISA / PC104 (host-bus:3.4).
  // The sockets: bytes of I/O, $0 to $FFFF, and of memory, $0 to $FFFFFF. An access of any length is split into cycles:
  // of a byte for I/O, of an aligned word or a byte for memory; in a slot of 8 bits, or where MEMCS16# does not answer,
  // of bytes. Bytes that are not enabled are not accessed. A lane that nobody drives reads $FF.
  //   TLM_ADDRESS_ERROR_RESPONSE  beyond the last byte
  //   TLM_BURST_ERROR_RESPONSE    no byte, or no streaming width
  tlm_utils::simple_target_socket_optional<Board> isa_io{"isa_io"}, isa_memory{"isa_memory"};
  In<7> isa_la;                  // LA23..LA17
  In<20> isa_sa;                 // SA19..SA0
  In<16> isa_sd_i;               // SD as the host drives it
  In<> isa_ior_n, isa_iow_n;     // commands of I/O, idle 1
  In<> isa_memr_n, isa_memw_n;   // commands of memory, idle 1
  In<> isa_aen, isa_sbhe_n;      // 1 = no I/O cycle of the host; 0 = upper byte lane used, idle 1
  In<> isa_resetdrv;             // RESETDRV (host-bus:3.8)
  Out<16> isa_sd_o;              // SD as the board drives it
  Out<2> isa_sd_oe;              // the board drives SD15..SD8 (bit 1), SD7..SD0 (bit 0)
  Out<> isa_iochrdy;             // 0 stretches the cycle
  Out<> isa_memcs16_n, isa_irq;  // 0 = memory of 16 bits at this address; interrupt to the host (host-bus:3.5)

  // Switches and straps (host-bus:3.1, host-bus:3.7).
  In<8> io_base;                  // A11..A4 of the I/O block, idle $21
  In<10> window;                  // A23..A14 of the memory window, idle $34
  In<> io_decode16;               // compare SA15..SA12 too, idle 1
  In<> window_flat;               // 64 KiB, not 16 KiB with a page register, idle 1
  In<> slot8;                     // the slot has no LA
  In<22> fitted;                  // a part of BoardOptions::fitted, idle all of it (servo-ic:1.2)
  In<4> macro_gate;               // bit i: MACRO IC i is a MACROGATE (servo-ic:1.3)
  In<> dpram_small, jpan_fitted;  // RAM of 8192 words (host-bus:6.1); there is a control panel port (servo-ic:11.8)
  In<> ext_clock;                 // jumper E1: PHASE and SERVO come from outside (servo-ic:7.3)
  In<> pic_8259;                  // the interrupt controller is an 8259 (host-bus:4.5)
  In<12> line_select;             // sources of IR5, IR6, IR7, 4 bits each, idle $951 (host-bus:4.2)

  // Connectors.
  In<16> jpan;                           // inputs of the control panel port, low-true, idle $FFFF (servo-ic:11.8)
  In<> ext_phase, ext_servo;             // the clocks from outside, idle 1
  In<> mi1, mi2, axexp0, axexp1;         // machine inputs, lines of axis expansion boards (host-bus:4.2)
  In<> pwr_good;                         // 5 V is good, to the watchdog, idle 1 (servo-ic:10)
  Out<> phase, servo;                    // the nets (servo-ic:5.1)
  Out<> breq, ipos, eror, f1er;          // buffer request (host-bus:5); in position, following errors (host-bus:4.3)
  Out<> hreq;                            // host port request (host-bus:3.2)
  Out<> wdo, wd_tripped;                 // watchdog, to the interrupt controller; it has tripped (servo-ic:10)
  Out<> wd_relay, wd_led;                // 1 = energised; 1 = the red lamp is on
  Out<> brld_n, erld_n, f1ld_n, ipld_n;  // lamps of BREQ, EROR, F1ER, IPOS, 0 = lit (host-bus:5.6)
  Out<> ctrl0, ctrl1;                    // control outputs (host-bus:4.2)

  // What the board does inside.
  Out<5> phase_source;        // IC that drives PHASE; 30 from outside, 31 none (servo-ic:7.1)
  Out<> source_conflict;      // drivers of a net disagree (servo-ic:7.2)
  Out<> busy_host, busy_cpu;  // who waits for the other at the dual-ported RAM (host-bus:6.9)
  Out<> txde, rxdf;           // host port: TX is empty, RX holds a word (host-bus:3.2)

  std::vector<std::unique_ptr<BoardServoIc>> servo_ic;  // the fitted ones, lowest first

  static const std::vector<PinInfo>& pin_table(std::uint32_t fitted);

 private:
  class IsaBus;
  void end_of_elaboration() override;
  void transport_port_a(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_io(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_memory(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_isa(bool memory, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned debug_port_a(tlm::tlm_generic_payload& payload);
  unsigned debug_memory(tlm::tlm_generic_payload& payload);
};

}  // namespace brick::component
