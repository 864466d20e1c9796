#include "systemc/board/board_top.h"

#include <algorithm>

#include "systemc/board/model_board.h"
#include "systemc/core/start_value.h"

namespace brick {

BoardTop::BoardTop(const sc_core::sc_module_name& name, std::uint32_t ics, std::uint64_t seed)
    : sc_module(name),
      bus_sync_("bus_sync"),
      address_decode_("address_decode"),
      clock_select_("clock_select"),
      watchdog_("watchdog"),
      isa_slave_("isa_slave"),
      host_port_("host_port"),
      interrupt_controller_("interrupt_controller"),
      pic_8259_("pic_8259"),
      host_signals_("host_signals"),
      dpram_("dpram"),
      panel_port_("panel_port"),
      gate_ics_(ics) {
  inputs_.fitted = ics;
  for (unsigned i = 0; i < Dpram::kWords; ++i) dpram_.poke(i, start_word(start_seed(seed), i));
  reset_all(0);
  outputs_ = pins();
}

void BoardTop::set_inputs(const BoardInputs& inputs) {
  if (!in_reset_) advance_all(now_);  // what has passed saw the old inputs
  inputs_ = inputs;
  bus_strobes_.set_pins(inputs_, inputs_.rst_n);
  bus_read_.set_rd_n(inputs_.pa_rd_n);
  connect();
}

void BoardTop::set_motor_inputs(unsigned ic, const MotorInputs& inputs) {
  gate_ics_.set_motor_inputs(ic, inputs, now_);
}

void BoardTop::watch_motors(std::uint32_t ics) {
  gate_ics_.watch(ics, now_);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if ((ics >> ic & 1) != 0) motor_outputs_[ic] = motor_outputs(ic);
}

void BoardTop::reset_all(Tick t) {
  each_block([t](ModelBlock& block) { block.reset(t); });
  gate_ics_.reset(t);
  bus_read_.reset();
  from_dpram_ = false;
  take_straps(kNoStraps, t);
  connect();
}

void BoardTop::advance_all(Tick t) {
  each_block([t](auto& block) { block.advance(t); });
}

// The edge t. Everything that looks at a register of another block does so before any block executes the edge.
void BoardTop::execute(Tick t) {
  const bool ref = is_ref_edge(t), read = ref && bus_sync_.rd(), write = ref && bus_sync_.we();
  const BusSync::Where where = bus_sync_.where();
  const std::uint32_t wdata = bus_sync_.wdata();
  const int ic = select_.ic;
  if (read && select_.any)
    bus_read_.take(read_data(t - 1), select_.internal);
  else if (read)
    bus_read_.take_nothing();

  advance_all(t);
  gate_ics_.advance(t);
  from_dpram_ = dpram_.in.cpu_sel;
  if (next_ref_edge(now_) <= t && straps_ != inputs_) take_straps(inputs_, t);
  if (read && ic >= 0) gate_ics_.read_taken(static_cast<unsigned>(ic), where.x, where.addr, t);
  if (write && ic >= 0) gate_ics_.write(static_cast<unsigned>(ic), where.x, where.addr, wdata, t);
  now_ = t;
  connect();
}

std::uint32_t BoardTop::read_data(Tick t) const {
  if (select_.internal) return host_port_.dsp_rdata();
  if (select_.signals) return host_signals_.rdata();
  if (select_.ctrl) return host_signals_.ctrl();
  if (select_.panel) return panel_port_.rdata();
  if (select_.ic < 0) return 0;
  return gate_ics_.read(static_cast<unsigned>(select_.ic), bus_sync_.where().x, bus_sync_.where().addr, t);
}

void BoardTop::connect() {
  bus_sync_.set_pins(inputs_, bus_strobes_);
  select_ = AddressDecode::decode(bus_sync_.where(), straps_.fitted & gate_ics_.built(), straps_.jpan_fitted);
  connect_clocks();
  connect_host();
}

void BoardTop::connect_clocks() {
  gate_ics_.set_macro_gates(straps_.macro_gate & gate_ics_.built() >> kMaxServoIcs, now_);
  clock_select_.in = {gate_ics_.drivers().phase & straps_.fitted, gate_ics_.drivers().servo & straps_.fitted,
                      straps_.ext_clock};
  clock_select_.phase_level = gate_ics_.phase_levels();
  clock_select_.servo_level = gate_ics_.servo_levels();
  clock_select_.ext_phase = inputs_.ext_phase;
  clock_select_.ext_servo = inputs_.ext_servo;

  gate_ics_.set_clocks(clock_select_.phase(), clock_select_.servo(), now_);
  gate_ics_.set_trip(watchdog_.trip(), now_);
  watchdog_.servo = clock_select_.servo();
  watchdog_.pwr_good = inputs_.pwr_good;
  watchdog_.strobe = bus_sync_.we() && select_.strobe;
}

void BoardTop::connect_host() {
  // Port A side
  HostPort::Inputs& hp = host_port_.in;
  hp.dsp_sel = select_.internal;
  hp.dsp_we = bus_sync_.we();
  hp.dsp_rd = bus_sync_.rd();
  hp.dsp_addr = bus_sync_.where().addr & 0x3F;
  hp.dsp_wdata = bus_sync_.wdata();
  panel_port_.jpan = inputs_.jpan;
  panel_port_.fitted = straps_.jpan_fitted;
  panel_port_.breq = host_signals_.breq();
  panel_port_.eror = host_signals_.eror();
  panel_port_.f1er = host_signals_.f1er();
  panel_port_.ipos = host_signals_.ipos();
  host_signals_.in.wr = bus_sync_.we() && select_.signals;
  host_signals_.in.ctrl_wr = bus_sync_.we() && select_.ctrl;
  host_signals_.in.wdata = bus_sync_.wdata() & 0xF;
  Dpram::Inputs& ram = dpram_.in;
  ram.small = straps_.dpram_small;
  ram.rd_toggle = bus_strobes_.rd_toggle();
  ram.wr_toggle = bus_strobes_.wr_toggle();
  ram.cpu_sel = (inputs_.pa_aa & 4) != 0 && !inputs_.pa_int;
  ram.cpu_x = inputs_.pa_x;
  ram.cpu_addr = inputs_.pa_addr & 0x3FFF;
  ram.cpu_rd_n = inputs_.pa_rd_n;
  ram.cpu_wr_n = inputs_.pa_wr_n;
  ram.cpu_wdata = inputs_.pa_wdata & 0xFFFF;

  // ISA side
  IsaSlave::Inputs& isa = isa_slave_.in;
  static_cast<IsaPins&>(isa) = inputs_;
  static_cast<IsaStraps&>(isa) = inputs_;
  isa.mem_rdata = dpram_.mem_rdata();
  isa.mem_busy = dpram_.mem_busy();
  hp.hp_sel = isa_slave_.hp_sel();
  hp.hp_rd_done = isa_slave_.hp_rd_done();
  hp.hp_wr = isa_slave_.hp_wr();
  hp.hp_addr = isa_slave_.hp_addr();
  hp.hp_wdata = isa_slave_.hp_wdata();
  hp.hp_reset = isa_slave_.host_reset();
  ram.mem_sel = isa_slave_.mem_sel();
  ram.mem_rd = isa_slave_.mem_rd();
  ram.mem_wr = isa_slave_.mem_wr();
  ram.mem_addr = isa_slave_.mem_addr();
  ram.mem_be = isa_slave_.mem_be();
  ram.mem_wdata = isa_slave_.mem_wdata();
  isa.hp_rdata = host_port_.hp_rdata();
  connect_interrupts();
}

// One of the two controllers is fitted; the other is neither read nor written.
void BoardTop::connect_interrupts() {
  // IPOS, BREQ, EROR, F1ER, HREQ from bit 0 up, then three that the board chooses.
  const auto line =
      static_cast<std::uint8_t>((host_signals_.rdata() & 0xF) | host_port_.hreq() << 4 | selected_lines() << 5);
  const bool old = straps_.pic_8259, write = isa_slave_.pic_sel() && isa_slave_.pic_wr();
  interrupt_controller_.in = {isa_slave_.host_reset(), line, write && !old, isa_slave_.pic_addr(),
                              isa_slave_.pic_wdata()};
  pic_8259_.in = {line, isa_slave_.pic_rd() && old, write && old, isa_slave_.pic_addr(), isa_slave_.pic_wdata()};
  isa_slave_.in.pic_rdata = old ? pic_8259_.rdata() : interrupt_controller_.rdata();
}

void BoardTop::take_straps(const Straps& straps, Tick t) {
  straps_ = straps;
  std::uint32_t interrupting = 0;
  for (unsigned line = 0; line < 3; ++line) interrupting |= 1u << (straps_.line_select >> 4 * line & 0xF);
  gate_ics_.set_interrupting(interrupting >> 1 & 0xFF, t);
}

std::uint32_t BoardTop::selected_lines() const {
  const std::uint32_t fitted_equ = ((straps_.fitted & 1) != 0 ? 0x0Fu : 0u) | ((straps_.fitted & 2) != 0 ? 0xF0u : 0u);
  const auto at = [](bool level, unsigned source) { return (level ? 1u : 0u) << source; };
  const std::uint32_t sources =  // by the digits of line_select
      (gate_ics_.equ() & fitted_equ) << 1 | at(watchdog_.trip(), 9) | std::uint32_t{host_signals_.ctrl()} << 10 |
      at(inputs_.mi1, 12) | at(inputs_.mi2, 13) | at(inputs_.axexp0, 14) | at(inputs_.axexp1, 15);
  std::uint32_t lines = 0;
  for (unsigned line = 0; line < 3; ++line) lines |= (sources >> (straps_.line_select >> 4 * line & 0xF) & 1) << line;
  return lines;
}

// The packed words of systemc/core/board_pins.h.
BoardOutputs BoardTop::pins() const {
  const auto at = [](const PinField& f, std::uint32_t value) { return value << f.lsb; };
  BoardOutputs o;
  o.w[0] = at(pin::kPaData, from_dpram_ ? dpram_.cpu_rdata() : bus_read_.data()) | at(pin::kPaTaN, dpram_.cpu_wait()) |
           at(pin::kIrqHost, host_port_.irq()) | at(pin::kPhase, clock_select_.phase()) |
           at(pin::kServo, clock_select_.servo()) | at(pin::kBreq, host_signals_.breq()) |
           at(pin::kIpos, host_signals_.ipos()) | at(pin::kEror, host_signals_.eror()) |
           at(pin::kF1er, host_signals_.f1er());
  o.w[1] = at(pin::kIsaSd, isa_slave_.isa_sd()) | at(pin::kIsaIochrdy, isa_slave_.isa_iochrdy()) |
           at(pin::kIsaMemcs16N, isa_slave_.isa_memcs16_n()) |
           at(pin::kIsaIrq, straps_.pic_8259 ? pic_8259_.irq() : interrupt_controller_.irq()) |
           at(pin::kHreq, host_port_.hreq()) | at(pin::kWdo, watchdog_.trip()) | at(pin::kWdTripped, watchdog_.trip()) |
           at(pin::kBusyHost, dpram_.host_busy()) | at(pin::kBusyCpu, dpram_.cpu_busy()) |
           at(pin::kPhaseSource, clock_select_.phase_source()) | at(pin::kSourceConflict, clock_select_.conflict());
  o.w[2] = at(pin::kPicSig, interrupt_controller_.sig());
  if (straps_.pic_8259) {
    const auto enabled = static_cast<std::uint8_t>(~pic_8259_.imr());
    o.w[2] |= at(pin::kPicIst, pic_8259_.irr() & enabled) | at(pin::kPicMsk, enabled) |
              at(pin::kPicElr, pic_8259_.level() ? 0xFF : 0);
  } else {
    o.w[2] |= at(pin::kPicIst, interrupt_controller_.ist()) | at(pin::kPicMsk, interrupt_controller_.msk()) |
              at(pin::kPicElr, interrupt_controller_.elr());
  }
  o.w[3] = at(pin::kPaDataOe, data_oe()) | at(pin::kBrldN, panel_port_.brld_n()) |
           at(pin::kErldN, panel_port_.erld_n()) | at(pin::kF1ldN, panel_port_.f1ld_n()) |
           at(pin::kIpldN, panel_port_.ipld_n()) | std::uint32_t{host_signals_.ctrl()} << pin::kCtrl0.lsb |
           at(pin::kIsaSdOe, isa_slave_.isa_sd_oe()) | at(pin::kTxde, host_port_.txde()) |
           at(pin::kRxdf, host_port_.rxdf()) | at(pin::kWdRelay, watchdog_.relay()) | at(pin::kWdLed, watchdog_.trip());
  return o;
}

bool BoardTop::show_pins() {
  const BoardOutputs after = pins();
  if (after == outputs_) return false;
  const BoardOutputs before = outputs_;
  outputs_ = after;
  if (on_change) on_change(now_, before, after);
  return before.differs(after, stop_on_);
}

bool BoardTop::show_motors() {
  bool stop = false;
  for (std::uint32_t ics = gate_ics_.take_changes(); ics != 0; ics &= ics - 1) {
    const auto ic = static_cast<unsigned>(__builtin_ctz(ics));
    const MotorOutputs before = motor_outputs_[ic], after = motor_outputs(ic);
    if (after == before) continue;
    motor_outputs_[ic] = after;
    if (on_motor_change) on_motor_change(now_, ic, before, after);
    stop = stop || before.differs(after, stop_on_motor_[ic]);
  }
  return stop;
}

Tick BoardTop::next_event() const {
  Tick next = gate_ics_.next_event();
  each_block([&next](const auto& block) { next = std::min(next, block.next_event()); });
  if (from_dpram_ != dpram_.in.cpu_sel || data_oe() != (outputs_.get(pin::kPaDataOe) != 0)) next = now_ + 1;
  if (straps_ != inputs_) next = std::min(next, next_ref_edge(now_));
  return next;
}

Tick BoardTop::run_until(Tick limit, const BoardOutputs& stop_on) {
  stop_on_ = stop_on;
  while (now_ < limit) {
    if (!inputs_.rst_n) {
      now_ = in_reset_ ? limit : now_ + 1;
      in_reset_ = true;
      reset_all(now_);
    } else {
      in_reset_ = false;
      const Tick event = next_event();
      if (event > limit) {
        now_ = limit;
        break;
      }
      execute(event);
    }
    const bool pin = show_pins(), motor = show_motors();
    if (pin || motor) break;
  }
  return now_;
}

Tick BoardTop::quiet_until(const BoardOutputs& watched) const {
  if (!inputs_.rst_n) return in_reset_ ? kNever : now_;
  const Tick any_pin = next_event() - 1;
  if (bus_sync_.write_pending() || straps_ != inputs_) return any_pin;

  // With no write under way each group of pins has its own cause; only those that interrupt the CPU are told apart.
  constexpr BoardOutputs kClocks = select_pins(pin::kPhase, pin::kServo, pin::kPhaseSource, pin::kSourceConflict);
  constexpr BoardOutputs kTripped = select_pins(pin::kWdTripped, pin::kWdo);
  constexpr BoardOutputs kHost = select_pins(pin::kIrqHost);
  Tick quiet = kNever;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) {
    const std::uint32_t w = watched.w[i];
    if ((w & kClocks.w[i]) != 0) quiet = std::min(quiet, next_clock_event() - 1);
    if ((w & kTripped.w[i]) != 0) quiet = std::min(quiet, watchdog_.next_event() - 1);
    if ((w & kHost.w[i]) != 0) {
      const bool busy = isa_slave_.next_event() != kNever || bus_sync_.internal_pending();
      quiet = std::min(quiet, busy ? any_pin : host_port_.next_event() - 1);
    }
    if ((w & ~(kClocks.w[i] | kTripped.w[i] | kHost.w[i])) != 0) return any_pin;
  }
  return quiet;
}

std::unique_ptr<Board> make_model_board(std::uint32_t fitted, std::uint64_t seed) {
  return std::make_unique<BoardTop>(sc_core::sc_gen_unique_name("board_top"), fitted, seed);
}

}  // namespace brick
