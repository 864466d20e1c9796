// The pins of the controller board, as every engine shows them: the Verilated RTL (rtl/board/board_sim.sv packs the
// same words), the SystemC model, and lock-step, which compares the packed words tick by tick. All outputs are
// registered: they change only at a clock edge, or without one when a strobe ends. All inputs are sampled by the first
// clock edge after they were applied. Active-low pins end in _n.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace brick {

// Inputs, in groups by who drives them. Whoever drives or samples a group takes it as a whole.

// Port A, the CPU's external bus (host-bus:2).
struct PortAPins {
  std::uint32_t pa_addr = 0;  // A[18:0]; A[5:0] of the on-chip peripheral when pa_int is 1
  bool pa_x = false;          // 1 = X space, 0 = Y space
  std::uint8_t pa_aa = 0;     // AA3..AA0, 1 = region selected
  bool pa_int = false;        // 1 = on-chip peripheral page X:$FFFF80..$FFFFFF (HI08), not a pin of the real part
  bool pa_rd_n = true;
  bool pa_wr_n = true;
  std::uint32_t pa_wdata = 0;  // D[23:0] as the CPU drives it
};

// ISA / PC104 host bus (host-bus:3.4).
struct IsaPins {
  std::uint8_t isa_la = 0;   // LA[23:17]
  std::uint32_t isa_sa = 0;  // SA[19:0]
  std::uint16_t isa_sd = 0;  // SD[15:0] as the host drives it
  bool isa_ior_n = true;
  bool isa_iow_n = true;
  bool isa_memr_n = true;
  bool isa_memw_n = true;
  bool isa_aen = false;
  bool isa_sbhe_n = true;  // 0 = upper byte lane used
  bool isa_resetdrv = false;

  bool operator==(const IsaPins& o) const {
    return isa_la == o.isa_la && isa_sa == o.isa_sa && isa_sd == o.isa_sd && isa_ior_n == o.isa_ior_n &&
           isa_iow_n == o.isa_iow_n && isa_memr_n == o.isa_memr_n && isa_memw_n == o.isa_memw_n &&
           isa_aen == o.isa_aen && isa_sbhe_n == o.isa_sbhe_n && isa_resetdrv == o.isa_resetdrv;
  }
  void set_address(std::uint32_t address) {  // of 24 bits; I/O has 16
    isa_la = static_cast<std::uint8_t>(address >> 17 & 0x7F);
    isa_sa = address & 0xFFFFF;
  }
};

// Switches and set-up of the host bus (host-bus:3.1, host-bus:3.7).
struct IsaStraps {
  std::uint8_t io_base = 0x21;  // A11..A4 of the I/O block
  bool io_decode16 = true;      // false: SA[15:10] are not compared
  std::uint16_t window = 0x34;  // A23..A14 of the memory window
  bool window_flat = true;      // 64 KiB, not 16 KiB with a page register
  bool slot8 = false;           // the slot has no LA: A23..A20 are not compared, A19..A17 come from SA

  static constexpr IsaStraps none() { return {0, false, 0, false, false}; }                   // as a reset leaves them
  bool operator!=(const IsaStraps& o) const { return std::memcmp(this, &o, sizeof o) != 0; }  // no byte between them
};

static_assert(std::has_unique_object_representations_v<IsaStraps>);

// What is fitted and how the jumpers stand; taken over on clk_ref.
struct Straps {
  std::uint32_t fitted = 0x3;  // bit i = IC i fitted: 0..9 servo IC 0..9, 10..17 servo IC 2*..9*, 18..21 MACRO IC 0..3
  std::uint32_t macro_gate = 0;  // bit i: MACRO IC i is a MACROGATE, not a DSPGATE2
  bool dpram_small = false;      // dual-ported RAM of 8192 words, not 32768
  bool jpan_fitted = false;      // control panel port of Turbo PMAC boards
  // Sources of IR5 (low digit), IR6, IR7: 0 none, 1..8 EQU1..EQU8, 9 WDO, then CTRL0, CTRL1, MI1, MI2, AXEXP0, AXEXP1.
  std::uint16_t line_select = 0x951;
  bool ext_clock = false;  // jumper E1: phase and servo come from outside
  bool pic_8259 = false;   // the interrupt controller is an 8259

  bool operator!=(const Straps& o) const {
    return fitted != o.fitted || macro_gate != o.macro_gate || dpram_small != o.dpram_small ||
           jpan_fitted != o.jpan_fitted || line_select != o.line_select || ext_clock != o.ext_clock ||
           pic_8259 != o.pic_8259;
  }
};

// What else comes in at a connector.
struct ConnectorPins {
  std::uint16_t jpan = 0xFFFF;  // control panel inputs, low-true, bits as Y:$078800 (rtl/regs/board.rdl)
  bool ext_phase = true;
  bool ext_servo = true;
  bool mi1 = false, mi2 = false;        // machine inputs of JOPTO, to the interrupt controller
  bool axexp0 = false, axexp1 = false;  // interrupt lines of an axis expansion board
  bool pwr_good = true;                 // 5 V is good, to the watchdog
};

struct HostInputs : IsaPins, IsaStraps, Straps, ConnectorPins {  // all but what the CPU drives
  bool jpan_init_n = true;  // INIT/ of the control panel: goes to the card's reset circuit, not to the board's logic
};

struct BoardInputs : PortAPins, HostInputs {
  bool rst_n = false;
};

constexpr std::uint32_t pin_mask(unsigned width) { return width >= 32 ? ~0u : (1u << width) - 1; }

// One field of the packed output words. `name` is the trace and script name (docs/signals.md), scope `brick` left out.
struct PinField {
  std::string_view name;
  unsigned word;
  unsigned lsb;
  unsigned width;
  bool hex;
};

constexpr unsigned kBoardOutputWords = 4;

namespace pin {
constexpr PinField kPaData{"bus.rdata", 0, 0, 24, true};  // D[23:0] as the board drives it
constexpr PinField kPaTaN{"bus.ta_n", 0, 24, 1, false};   // 0 = transfer acknowledged; 1 stretches the cycle
constexpr PinField kIrqHost{"cpu.irq_host", 0, 25, 1,
                            false};  // HI08 to CPU: (HRIE & HRDF) | (HTIE & HTDE) | (HCIE & HCP)
constexpr PinField kPhase{"clock.phase", 0, 26, 1, false};
constexpr PinField kServo{"clock.servo", 0, 27, 1, false};
constexpr PinField kBreq{"host.breq", 0, 28, 1, false};
constexpr PinField kIpos{"host.ipos", 0, 29, 1, false};
constexpr PinField kEror{"host.eror", 0, 30, 1, false};
constexpr PinField kF1er{"host.f1er", 0, 31, 1, false};
constexpr PinField kIsaSd{"host.isa.rdata", 1, 0, 16, true};  // SD[15:0] as the board drives it
constexpr PinField kIsaIochrdy{"host.isa.iochrdy", 1, 16, 1, false};
constexpr PinField kIsaMemcs16N{"host.isa.memcs16_n", 1, 17, 1, false};
constexpr PinField kIsaIrq{"host.irq", 1, 18, 1, false};
constexpr PinField kHreq{"host.hreq", 1, 19, 1, false};
constexpr PinField kWdo{"host.wdo", 1, 20, 1, false};  // 1 = tripped, to the interrupt controller
constexpr PinField kWdTripped{"watchdog.tripped", 1, 21, 1, false};
constexpr PinField kBusyHost{"dpram.busy_host", 1, 22, 1, false};
constexpr PinField kBusyCpu{"dpram.busy_cpu", 1, 23, 1, false};
constexpr PinField kPhaseSource{"clock.source_ic", 1, 24, 5,
                                false};  // index as in BoardInputs::fitted; 30 external, 31 none
constexpr PinField kSourceConflict{"clock.conflict", 1, 29, 1,
                                   false};  // drivers of a net disagreed for more than 2 clk
constexpr PinField kPicIst{"host.pic.ist", 2, 0, 8, true};
constexpr PinField kPicSig{"host.pic.sig", 2, 8, 8, true};
constexpr PinField kPicMsk{"host.pic.msk", 2, 16, 8, true};
constexpr PinField kPicElr{"host.pic.elr", 2, 24, 8, true};
constexpr PinField kPaDataOe{"bus.rdata_oe", 3, 0, 1, false};  // 1 = the board drives D: /RD is low and the word stands
constexpr PinField kIsaSdOe{"host.isa.sd_oe", 3, 8, 2, true};  // the board drives SD[15:8] (2), SD[7:0] (1)
constexpr PinField kTxde{"host.port.txde", 3, 10, 1, false};   // host port: TX is empty
constexpr PinField kRxdf{"host.port.rxdf", 3, 11, 1, false};   // RX holds a word
constexpr PinField kBrldN{"host.brld_n", 3, 16, 1, false};     // lamps of the control panel, 0 = lit
constexpr PinField kErldN{"host.erld_n", 3, 17, 1, false};
constexpr PinField kF1ldN{"host.f1ld_n", 3, 18, 1, false};
constexpr PinField kIpldN{"host.ipld_n", 3, 19, 1, false};
constexpr PinField kCtrl0{"host.ctrl0", 3, 20, 1, false};  // outputs of the Ultralite, written by user programs
constexpr PinField kCtrl1{"host.ctrl1", 3, 21, 1, false};
constexpr PinField kWdRelay{"watchdog.relay", 3, 24, 1, false};  // 1 = energised
constexpr PinField kWdLed{"watchdog.led", 3, 25, 1, false};      // 1 = the red lamp is on
inline constexpr std::array kAll{
    kPaData,      kPaTaN,          kIrqHost,     kPhase,  kServo,  kBreq,   kIpos,      kEror,     kF1er,
    kIsaSd,       kIsaIochrdy,     kIsaMemcs16N, kIsaIrq, kHreq,   kWdo,    kWdTripped, kBusyHost, kBusyCpu,
    kPhaseSource, kSourceConflict, kPicIst,      kPicSig, kPicMsk, kPicElr, kIsaSdOe,   kTxde,     kRxdf,
    kPaDataOe,    kBrldN,          kErldN,       kF1ldN,  kIpldN,  kCtrl0,  kCtrl1,     kWdRelay,  kWdLed};
}  // namespace pin

struct BoardOutputs {
  std::array<std::uint32_t, kBoardOutputWords> w{};

  constexpr std::uint32_t get(const PinField& f) const { return (w[f.word] >> f.lsb) & pin_mask(f.width); }
  constexpr void set(const PinField& f, std::uint32_t value) {
    w[f.word] = (w[f.word] & ~(pin_mask(f.width) << f.lsb)) | ((value & pin_mask(f.width)) << f.lsb);
  }
  bool operator==(const BoardOutputs& o) const { return w == o.w; }
  bool operator!=(const BoardOutputs& o) const { return w != o.w; }
  // True when any bit selected by `select` differs.
  bool differs(const BoardOutputs& o, const BoardOutputs& select) const {
    std::uint32_t bits = 0;  // without branches
    for (unsigned i = 0; i < kBoardOutputWords; ++i) bits |= (w[i] ^ o.w[i]) & select.w[i];
    return bits != 0;
  }
};

// A selection of output pins, to stop a run at their next change.
template <class... Fields>
constexpr BoardOutputs select_pins(const Fields&... fields) {
  BoardOutputs s;
  (s.set(fields, ~0u), ...);
  return s;
}

}  // namespace brick
