#include <brick/board.h>

#include <map>
#include <stdexcept>
#include <string_view>

#include "systemc/component/board_buses.h"
#include "systemc/component/board_words.h"
#include "systemc/component/chip.h"
#include "systemc/component/error.h"
#include "systemc/component/servo_ic_pins.h"

namespace brick::component {
namespace {

struct Meaning {
  std::string_view pin, port;  // as in core/board_pins.h or cosim/drive.h; of the component
  const char* section;
  const char* text;
};

constexpr Meaning kInputs[] = {
    {"pa_addr", "", "host-bus:2.1", "address A18..A0"},
    {"pa_aa", "", "host-bus:2.1", "AA3..AA0, 1 = region selected"},
    {"pa_x", "", "host-bus:2.1", "1 = X space, 0 = Y space"},
    {"pa_int", "", "host-bus:2.6", "1 = on-chip peripheral page: the CPU's side of the host port"},
    {"pa_rd_n", "", "host-bus:2.1", "read strobe"},
    {"pa_wr_n", "", "host-bus:2.1", "write strobe"},
    {"pa_wdata", "pa_data_i", "host-bus:2.1", "D23..D0 as the CPU drives them"},
    {"isa_sa", "", "host-bus:3.4", "address SA19..SA0"},
    {"isa_la", "", "host-bus:3.4", "address LA23..LA17"},
    {"isa_ior_n", "", "host-bus:3.4", "read of I/O"},
    {"isa_iow_n", "", "host-bus:3.4", "write of I/O"},
    {"isa_memr_n", "", "host-bus:3.4", "read of memory"},
    {"isa_memw_n", "", "host-bus:3.4", "write of memory"},
    {"isa_aen", "", "host-bus:3.4", "1 = no I/O cycle of the host"},
    {"isa_sbhe_n", "", "host-bus:3.4", "0 = upper byte lane used"},
    {"isa_sd", "isa_sd_i", "host-bus:3.4", "SD15..SD0 as the host drives them"},
    {"isa_resetdrv", "", "host-bus:3.8", "reset of the host bus"},
    {"jpan", "", "servo-ic:11.8", "inputs of the control panel port, low-true"},
    {"fitted", "", "servo-ic:1.2", "ICs present, of those that are built"},
    {"macro_gate", "", "servo-ic:1.3", "bit i: MACRO IC i is a MACROGATE"},
    {"dpram_small", "", "host-bus:6.1", "dual-ported RAM of 8192 words"},
    {"jpan_fitted", "", "servo-ic:11.8", "control panel port is there"},
    {"ext_clock", "", "servo-ic:7.3", "jumper E1: PHASE and SERVO come from outside"},
    {"ext_phase", "", "servo-ic:7.3", "PHASE from outside"},
    {"ext_servo", "", "servo-ic:7.3", "SERVO from outside"},
    {"line_select", "", "host-bus:4.2", "sources of IR5, IR6, IR7"},
    {"io_base", "", "host-bus:3.1", "A11..A4 of the I/O block"},
    {"io_decode16", "", "host-bus:3.1", "compare SA15..SA12 too"},
    {"window", "", "host-bus:3.7", "A23..A14 of the memory window"},
    {"window_flat", "", "host-bus:3.7", "64 KiB, not 16 KiB with a page register"},
    {"slot8", "", "host-bus:3.7", "the slot has no LA"},
    {"mi1", "", "host-bus:4.2", "machine input 1 of JOPTO"},
    {"mi2", "", "host-bus:4.2", "machine input 2 of JOPTO"},
    {"axexp0", "", "host-bus:4.2", "interrupt line of an axis expansion board"},
    {"axexp1", "", "host-bus:4.2", "interrupt line of an axis expansion board"},
    {"pic_8259", "", "host-bus:4.5", "the interrupt controller is an 8259"},
    {"pwr_good", "", "servo-ic:10", "5 V is good, to the watchdog"}};

constexpr Meaning kOutputs[] = {
    {"bus.rdata", "pa_data_o", "host-bus:2.1", "D23..D0 as the board drives them"},
    {"bus.rdata_oe", "pa_data_oe", "host-bus:2.6", "the board drives D"},
    {"bus.ta_n", "pa_ta_n", "host-bus:2.1", "0 = transfer acknowledged; 1 stretches the cycle"},
    {"cpu.irq_host", "irq_host", "host-bus:3.2", "interrupt of the host port to the CPU"},
    {"clock.phase", "phase", "servo-ic:5.1", "PHASE net"},
    {"clock.servo", "servo", "servo-ic:5.1", "SERVO net"},
    {"host.breq", "breq", "host-bus:5", "buffer request"},
    {"host.ipos", "ipos", "host-bus:4.3", "in position"},
    {"host.eror", "eror", "host-bus:4.3", "fatal following error"},
    {"host.f1er", "f1er", "host-bus:4.3", "warning following error"},
    {"host.isa.rdata", "isa_sd_o", "host-bus:3.8", "SD15..SD0 as the board drives them"},
    {"host.isa.sd_oe", "isa_sd_oe", "host-bus:3.8", "the board drives SD15..SD8 (2), SD7..SD0 (1)"},
    {"host.isa.iochrdy", "isa_iochrdy", "host-bus:3.4", "0 stretches the cycle"},
    {"host.isa.memcs16_n", "isa_memcs16_n", "host-bus:3.4", "0 = memory of 16 bits at this address"},
    {"host.irq", "isa_irq", "host-bus:3.5", "interrupt to the host"},
    {"host.hreq", "hreq", "host-bus:3.2", "host port request"},
    {"host.wdo", "wdo", "servo-ic:10", "watchdog, to the interrupt controller"},
    {"watchdog.tripped", "wd_tripped", "servo-ic:10", "the watchdog has tripped"},
    {"watchdog.relay", "wd_relay", "servo-ic:10", "1 = energised"},
    {"watchdog.led", "wd_led", "servo-ic:10", "1 = the red lamp is on"},
    {"host.brld_n", "brld_n", "host-bus:5.6", "lamp of BREQ, 0 = lit"},
    {"host.erld_n", "erld_n", "host-bus:5.6", "lamp of EROR, 0 = lit"},
    {"host.f1ld_n", "f1ld_n", "host-bus:5.6", "lamp of F1ER, 0 = lit"},
    {"host.ipld_n", "ipld_n", "host-bus:5.6", "lamp of IPOS, 0 = lit"},
    {"host.ctrl0", "ctrl0", "host-bus:4.2", "control output"},
    {"host.ctrl1", "ctrl1", "host-bus:4.2", "control output"},
    {"dpram.busy_host", "busy_host", "host-bus:6.9", "the host waits for the CPU"},
    {"dpram.busy_cpu", "busy_cpu", "host-bus:6.9", "the CPU waits for the host"},
    {"clock.source_ic", "phase_source", "servo-ic:7.1", "IC that drives PHASE; 30 from outside, 31 none"},
    {"clock.conflict", "source_conflict", "servo-ic:7.2", "drivers of a net disagree"},
    {"host.port.txde", "txde", "host-bus:3.2", "host port: TX is empty"},
    {"host.port.rxdf", "rxdf", "host-bus:3.2", "host port: RX holds a word"},
    {"host.pic.ist", "", "host-bus:4.1", "interrupt status"},
    {"host.pic.sig", "", "host-bus:4.1", "levels of the lines"},
    {"host.pic.msk", "", "host-bus:4.1", "mask"},
    {"host.pic.elr", "", "host-bus:4.1", "edge or level"}};

template <std::size_t kSize>
const Meaning& meaning(const Meaning (&rows)[kSize], std::string_view pin) {
  for (const Meaning& row : rows)
    if (row.pin == pin) return row;
  throw std::logic_error("no meaning for the board's pin " + std::string(pin));
}

std::vector<PinInfo> make_table(std::uint32_t fitted) {
  using namespace board_words;
  BoardInputs idle;
  idle.fitted = fitted;
  std::vector<PinInfo> table{
      {"rst_n", PinDirection::kIn, kReset, 0, 1, 1, "host-bus:2.6", "reset, asynchronous, active low"}};
  std::apply(
      [&](const auto&... f) {
        (
            [&] {
              const Meaning& m = meaning(kInputs, f.name);
              table.push_back({std::string(m.port.empty() ? m.pin : m.port), PinDirection::kIn, f.word, f.lsb, f.width,
                               static_cast<std::uint32_t>(idle.*f.pin), m.section, m.text});
            }(),
            ...);
      },
      kInputFields);
  for (const PinField& f : pin::kAll) {
    const Meaning& m = meaning(kOutputs, f.name);
    const bool inner = m.port.empty();
    table.push_back({std::string(inner ? f.name : m.port), inner ? PinDirection::kInner : PinDirection::kOut, f.word,
                     f.lsb, f.width, 0, m.section, m.text});
  }
  for (unsigned ic = 0, k = 0; ic < kMaxServoIcs; ++ic)
    if ((fitted >> ic & 1) != 0) {
      add_motor_pins(table, servo_ic_scope(ic) + "_", motor_input(k), motor_output(k));
      ++k;
    }
  return table;
}

}  // namespace

const std::vector<PinInfo>& Board::pin_table(std::uint32_t fitted) {
  static std::map<std::uint32_t, std::vector<PinInfo>> tables;
  const auto [place, fresh] = tables.try_emplace(fitted);
  if (fresh) place->second = make_table(fitted);
  return place->second;
}

BoardServoIc::BoardServoIc(Component& board, const std::string& ic)
    : ch{ServoIcChannel{board, 1, ic}, ServoIcChannel{board, 2, ic}, ServoIcChannel{board, 3, ic},
         ServoIcChannel{board, 4, ic}},
      dac_clk(board, ic + "dac_clk"),
      dac_strobe(board, ic + "dac_strobe"),
      adc_clk(board, ic + "adc_clk"),
      adc_strobe(board, ic + "adc_strobe") {}

namespace {
std::uint32_t checked(std::uint32_t fitted) {
  constexpr unsigned kIcs = 22;  // as many as BoardInputs::fitted has bits
  if (fitted >> kIcs != 0) raise_error("/brick/fitted", "BoardOptions::fitted has bits beyond 21, the last MACRO IC");
  return fitted;
}
}  // namespace

constexpr std::uint64_t kPortABytes = std::uint64_t{8} << 24;  // X and Y of 2^24 words

#define BRICK_PIN(name) name(*this, #name)
Board::Board(const sc_core::sc_module_name& name, TimeBase& time, const BoardOptions& options, const Engine& engine)
    : Component(name, time, pin_table(checked(options.fitted)), {{4, kPortABytes}, {1, 0}}),
      BRICK_PIN(rst_n),
      BRICK_PIN(pa_addr),
      BRICK_PIN(pa_aa),
      BRICK_PIN(pa_x),
      BRICK_PIN(pa_int),
      BRICK_PIN(pa_rd_n),
      BRICK_PIN(pa_wr_n),
      BRICK_PIN(pa_data_i),
      BRICK_PIN(pa_data_o),
      BRICK_PIN(pa_data_oe),
      BRICK_PIN(pa_ta_n),
      BRICK_PIN(irq_host),
      BRICK_PIN(isa_la),
      BRICK_PIN(isa_sa),
      BRICK_PIN(isa_sd_i),
      BRICK_PIN(isa_ior_n),
      BRICK_PIN(isa_iow_n),
      BRICK_PIN(isa_memr_n),
      BRICK_PIN(isa_memw_n),
      BRICK_PIN(isa_aen),
      BRICK_PIN(isa_sbhe_n),
      BRICK_PIN(isa_resetdrv),
      BRICK_PIN(isa_sd_o),
      BRICK_PIN(isa_sd_oe),
      BRICK_PIN(isa_iochrdy),
      BRICK_PIN(isa_memcs16_n),
      BRICK_PIN(isa_irq),
      BRICK_PIN(io_base),
      BRICK_PIN(window),
      BRICK_PIN(io_decode16),
      BRICK_PIN(window_flat),
      BRICK_PIN(slot8),
      BRICK_PIN(fitted),
      BRICK_PIN(macro_gate),
      BRICK_PIN(dpram_small),
      BRICK_PIN(jpan_fitted),
      BRICK_PIN(ext_clock),
      BRICK_PIN(pic_8259),
      BRICK_PIN(line_select),
      BRICK_PIN(jpan),
      BRICK_PIN(ext_phase),
      BRICK_PIN(ext_servo),
      BRICK_PIN(mi1),
      BRICK_PIN(mi2),
      BRICK_PIN(axexp0),
      BRICK_PIN(axexp1),
      BRICK_PIN(pwr_good),
      BRICK_PIN(phase),
      BRICK_PIN(servo),
      BRICK_PIN(breq),
      BRICK_PIN(ipos),
      BRICK_PIN(eror),
      BRICK_PIN(f1er),
      BRICK_PIN(hreq),
      BRICK_PIN(wdo),
      BRICK_PIN(wd_tripped),
      BRICK_PIN(wd_relay),
      BRICK_PIN(wd_led),
      BRICK_PIN(brld_n),
      BRICK_PIN(erld_n),
      BRICK_PIN(f1ld_n),
      BRICK_PIN(ipld_n),
      BRICK_PIN(ctrl0),
      BRICK_PIN(ctrl1),
      BRICK_PIN(phase_source),
      BRICK_PIN(source_conflict),
      BRICK_PIN(busy_host),
      BRICK_PIN(busy_cpu),
      BRICK_PIN(txde),
      BRICK_PIN(rxdf) {
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if ((options.fitted >> ic & 1) != 0)
      servo_ic.push_back(std::make_unique<BoardServoIc>(*this, servo_ic_scope(ic) + "_"));
  set_chip(engine.factory().board(options.fitted, options.seed));
  port_a.register_b_transport(this, &Board::transport_port_a);
  port_a.register_transport_dbg(this, &Board::debug_port_a);
  isa_io.register_b_transport(this, &Board::transport_io);
  isa_memory.register_b_transport(this, &Board::transport_memory);
  isa_memory.register_transport_dbg(this, &Board::debug_memory);
}
#undef BRICK_PIN

}  // namespace brick::component
