// The wires of the board: outputs of the blocks to inputs of the others, and to the pins. Each group of wires names its
// sources and is copied when one of them may have changed. A block whose inputs change has executed all edges up to
// now() with the old ones first. What follows an input without a clock (a read multiplexer, the nets of PHASE and
// SERVO) makes its block a source at once, so the order below is from the registers to what hangs on them.
#include "systemc/board/board_top.h"

namespace brick {

// Wires to one block: the first that differs makes the block execute what has passed.
template <class Block>
class BoardTop::Wires {
 public:
  Wires(BoardTop& board, Part part, Block& block, Parts& changed)
      : board_(board), part_(part), block_(block), changed_(changed) {}

  template <class Pin, class Value>
  void operator()(Pin& pin, const Value& value) {
    if (pin == static_cast<Pin>(value)) return;
    touch();
    pin = static_cast<Pin>(value);
  }
  void touch() {
    if ((board_.touched_ >> part_ & 1) == 0) block_.advance(board_.now_);
    board_.touched_ |= parts(part_);
    changed_ |= parts(part_);
  }

 private:
  BoardTop& board_;
  const Part part_;
  Block& block_;
  Parts& changed_;
};

// Each with all its sources.
void BoardTop::connect(Parts changed) {
  const auto from = [&changed](auto... part) { return (changed & parts(part...)) != 0; };
  if (from(kBusSync, kStraps)) connect_port_a(changed);
  if (from(kIcClocks, kClockSelect, kWatchdog, kConnectorPins, kStraps)) connect_clocks(changed);
  if (from(kBusSync, kIsaSlave, kStraps)) connect_host_port(changed);
  if (from(kIsaSlave, kStraps)) connect_dpram(changed);
  if (from(kIsaSlave, kHostPort, kHostSignals, kWatchdog, kConnectorPins, kStraps) || equ_ != gate_ics_.equ())
    connect_interrupts(changed);
  if (from(kInterruptController, kPic8259, kStraps)) connect_host_interrupt(changed);
  if (from(kIsaPins, kHostPort, kInterruptController, kPic8259, kDpram, kStraps)) connect_isa(changed);
  if (from(kConnectorPins, kHostSignals, kStraps)) connect_panel(changed);
  if (from(kClockSelect, kConnectorPins, kStraps)) connect_ssi(changed);
}

void BoardTop::connect_port_a(Parts& changed) {
  const bool write = bus_sync_.we(), strobe = write || bus_sync_.rd();
  if (!strobe && !strobe_wired_) {
    changed &= ~parts(kBusSync);  // nor is there anything for the host port
    return;
  }
  strobe_wired_ = strobe;
  select();

  Wires latch(*this, kHostSignals, host_signals_, changed);
  latch(host_signals_.in.wr, write && select_.signals);
  latch(host_signals_.in.ctrl_wr, write && select_.ctrl);
  latch(host_signals_.in.wdata, bus_sync_.wdata() & 0xF);
  Wires watchdog(*this, kWatchdog, watchdog_, changed);
  watchdog(watchdog_.strobe, write && select_.strobe);
}

void BoardTop::connect_clocks(Parts& changed) {
  if ((changed & parts(kStraps)) != 0) {
    gate_ics_.set_macro_gates(straps_.macro_gate & gate_ics_.built() >> kMaxServoIcs, now_);
    changed |= parts(kIcClocks);
  }
  if ((changed & parts(kIcClocks, kConnectorPins)) != 0) {
    Wires select(*this, kClockSelect, clock_select_, changed);
    select(clock_select_.in.phase, gate_ics_.drivers().phase & straps_.fitted);
    select(clock_select_.in.servo, gate_ics_.drivers().servo & straps_.fitted);
    select(clock_select_.in.ext, straps_.ext_clock);
    select(clock_select_.phase_level, gate_ics_.phase_levels());
    select(clock_select_.servo_level, gate_ics_.servo_levels());
    select(clock_select_.ext_phase, inputs_.ext_phase);
    select(clock_select_.ext_servo, inputs_.ext_servo);
  }
  if ((changed & parts(kClockSelect)) != 0) {
    gate_ics_.set_clocks(clock_select_.phase(), clock_select_.servo(), now_);
    Wires watchdog(*this, kWatchdog, watchdog_, changed);
    watchdog(watchdog_.servo, clock_select_.servo());
  }
  if ((changed & parts(kConnectorPins)) != 0) {
    Wires watchdog(*this, kWatchdog, watchdog_, changed);
    watchdog(watchdog_.pwr_good, inputs_.pwr_good);
  }
  if ((changed & parts(kWatchdog)) != 0) {
    gate_ics_.set_trip(watchdog_.trip(), now_);
    Wires latch(*this, kHostSignals, host_signals_, changed);
    latch(host_signals_.in.trip, watchdog_.trip());
  }
}

void BoardTop::connect_host_port(Parts& changed) {
  HostPort::Inputs& in = host_port_.in;
  Wires to(*this, kHostPort, host_port_, changed);
  if ((changed & parts(kBusSync, kStraps)) != 0) {
    to(in.dsp_sel, select_.port);
    to(in.dsp_we, bus_sync_.we());
    to(in.dsp_rd, bus_sync_.rd());
    to(in.dsp_addr, bus_sync_.where().addr & 0x3F);
    to(in.dsp_wdata, bus_sync_.wdata());
  }
  if ((changed & parts(kIsaSlave)) != 0) {
    to(in.hp_sel, isa_slave_.hp_sel());
    to(in.hp_rd, isa_slave_.hp_rd());
    to(in.hp_rd_done, isa_slave_.hp_rd_done());
    to(in.hp_wr, isa_slave_.hp_wr());
    to(in.hp_addr, isa_slave_.hp_addr());
    to(in.hp_wdata, isa_slave_.hp_wdata());
    to(in.hp_reset, isa_slave_.host_reset());
  }
}

void BoardTop::connect_dpram(Parts& changed) {
  Dpram::Inputs& in = dpram_.in;
  Wires to(*this, kDpram, dpram_, changed);
  if ((changed & parts(kStraps)) != 0) to(in.small, straps_.dpram_small);
  if ((changed & parts(kIsaSlave)) != 0 && (isa_slave_.mem_target() || in.mem_sel || in.mem_wr)) {
    to(in.mem_sel, isa_slave_.mem_sel());
    to(in.mem_rd, isa_slave_.mem_rd());
    to(in.mem_wr, isa_slave_.mem_wr());
    to(in.mem_addr, isa_slave_.mem_addr());
    to(in.mem_be, isa_slave_.mem_be());
    to(in.mem_wdata, isa_slave_.mem_wdata());
  }
}

// One of the two controllers is fitted; the other is neither read nor written.
void BoardTop::connect_interrupts(Parts& changed) {
  InterruptController::Inputs& in = interrupt_controller_.in;
  Pic8259::Inputs& old = pic_8259_.in;
  Wires to(*this, kInterruptController, interrupt_controller_, changed);
  Wires to_old(*this, kPic8259, pic_8259_, changed);
  const bool concerned = isa_slave_.pic_target() || in.wr || old.rd || old.wr || in.reset != isa_slave_.host_reset();
  if (((changed & parts(kIsaSlave)) != 0 && concerned) || (changed & parts(kStraps)) != 0) {
    const bool write = isa_slave_.pic_sel() && isa_slave_.pic_wr();
    to(in.wr, write && !straps_.pic_8259);
    to(in.addr, isa_slave_.pic_addr());
    to(in.wdata, isa_slave_.pic_wdata());
    to(in.reset, isa_slave_.host_reset());
    to_old(old.rd, isa_slave_.pic_rd() && straps_.pic_8259);
    to_old(old.wr, write && straps_.pic_8259);
    to_old(old.addr, isa_slave_.pic_addr());
    to_old(old.wdata, isa_slave_.pic_wdata());
  }
  // IPOS, BREQ, EROR, F1ER, HREQ from bit 0 up, then three that the board chooses.
  if ((changed & parts(kHostSignals, kWatchdog, kConnectorPins, kStraps)) != 0 || equ_ != gate_ics_.equ()) {
    equ_ = gate_ics_.equ();
    lines_ = (host_signals_.rdata() & 0xF) | selected_lines() << 5;
  }
  const std::uint32_t line = lines_ | host_port_.hreq() << 4;
  to(in.line, line);
  to_old(old.line, line);
}

void BoardTop::connect_host_interrupt(Parts& changed) {
  Wires to(*this, kHostInterrupt, host_interrupt_, changed);
  to(host_interrupt_.in.request, straps_.pic_8259 ? pic_8259_.request() : interrupt_controller_.request());
  to(host_interrupt_.in.served, straps_.pic_8259 ? pic_8259_.served() : interrupt_controller_.served());
}

void BoardTop::connect_isa(Parts& changed) {
  IsaSlave::Inputs& in = isa_slave_.in;
  Wires to(*this, kIsaSlave, isa_slave_, changed);
  if ((changed & parts(kIsaPins)) != 0) {
    to.touch();
    static_cast<IsaPins&>(in) = inputs_;
    static_cast<IsaStraps&>(in) = inputs_;
  }
  if ((changed & parts(kHostPort)) != 0) to(in.hp_rdata, host_port_.hp_rdata());
  if ((changed & parts(kInterruptController, kPic8259, kStraps)) != 0)
    to(in.pic_rdata, straps_.pic_8259 ? pic_8259_.rdata() : interrupt_controller_.rdata());
  if ((changed & parts(kDpram)) != 0) {
    to(in.mem_rdata, dpram_.mem_rdata());
    to(in.mem_busy, dpram_.mem_busy());
  }
}

void BoardTop::connect_panel(Parts& changed) {
  Wires to(*this, kPanelPort, panel_port_, changed);
  to(panel_port_.jpan, inputs_.jpan);
  to(panel_port_.fitted, straps_.jpan_fitted);
  to(panel_port_.breq, host_signals_.breq());
  to(panel_port_.eror, host_signals_.eror());
  to(panel_port_.f1er, host_signals_.f1er());
  to(panel_port_.ipos, host_signals_.ipos());
}

// A board without them leaves them asleep.
void BoardTop::connect_ssi(Parts& changed) {
  if (straps_.ssi_kind == 0) return;
  Wires to(*this, kSsi, ssi_, changed);
  to(ssi_.geo, (straps_.ssi_kind & AddressDecode::kSsiGeo) != 0);
  to(ssi_.phase, clock_select_.phase());
  to(ssi_.servo, clock_select_.servo());
  to(ssi_.data, inputs_.ssi_data);
}

std::uint32_t BoardTop::selected_lines() const {
  const std::uint32_t fitted_equ = ((straps_.fitted & 1) != 0 ? 0x0Fu : 0u) | ((straps_.fitted & 2) != 0 ? 0xF0u : 0u);
  const auto at = [](bool level, unsigned source) { return (level ? 1u : 0u) << source; };
  const std::uint32_t sources =  // by the digits of line_select
      (gate_ics_.equ() & fitted_equ) << 1 | at(watchdog_.trip(), 9) | ctrl() << 10 | at(inputs_.mi1, 12) |
      at(inputs_.mi2, 13) | at(inputs_.axexp0, 14) | at(inputs_.axexp1, 15);
  std::uint32_t lines = 0;
  for (unsigned line = 0; line < 3; ++line) lines |= (sources >> (straps_.line_select >> 4 * line & 0xF) & 1) << line;
  return lines;
}

// The packed words of systemc/core/board_pins.h: what each part shows.
void BoardTop::set_port_a_pins(BoardOutputs& o) const {
  o.set(pin::kPaData, dpram_.cpu_drive() ? dpram_.cpu_rdata() : bus_read_.data());
  o.set(pin::kPaDataOe, bus_read_.oe() || dpram_.cpu_drive());
  o.set(pin::kPaTaN, dpram_.cpu_wait());
}

BoardOutputs BoardTop::pins(Parts changed) const {
  BoardOutputs o = outputs_;
  const auto from = [changed](auto... part) { return (changed & parts(part...)) != 0; };
  if (from(kPortAPins, kBusSync, kDpram)) {
    set_port_a_pins(o);
    o.set(pin::kBusyHost, dpram_.host_busy());
    o.set(pin::kBusyCpu, dpram_.cpu_busy());
  }
  if (from(kIsaSlave)) {
    o.set(pin::kIsaSd, isa_slave_.isa_sd());
    o.set(pin::kIsaSdOe, isa_slave_.isa_sd_oe());
    o.set(pin::kIsaIochrdy, isa_slave_.isa_iochrdy());
    o.set(pin::kIsaMemcs16N, isa_slave_.isa_memcs16_n());
  }
  if (from(kHostPort) && (host_port_.stepped() || changed == kEverything)) {
    o.set(pin::kIrqHost, host_port_.irq());
    o.set(pin::kHreq, host_port_.hreq());
    o.set(pin::kTxde, host_port_.txde());
    o.set(pin::kRxdf, host_port_.rxdf());
  }
  if (from(kClockSelect)) {
    o.set(pin::kPhase, clock_select_.phase());
    o.set(pin::kServo, clock_select_.servo());
    o.set(pin::kPhaseSource, clock_select_.phase_source());
    o.set(pin::kSourceConflict, clock_select_.conflict());
  }
  if (from(kHostSignals)) {
    o.set(pin::kBreq, host_signals_.breq());
    o.set(pin::kIpos, host_signals_.ipos());
    o.set(pin::kEror, host_signals_.eror());
    o.set(pin::kF1er, host_signals_.f1er());
  }
  if (from(kHostSignals, kWatchdog)) {
    o.set(pin::kCtrl0, ctrl() & 1);
    o.set(pin::kCtrl1, ctrl() >> 1);
  }
  if (from(kWatchdog)) {
    o.set(pin::kWdo, watchdog_.trip());
    o.set(pin::kWdTripped, watchdog_.trip());
    o.set(pin::kWdRelay, watchdog_.relay());
    o.set(pin::kWdLed, watchdog_.trip());
  }
  if (from(kSsi)) o.set(pin::kSsiClk, ssi_.clk());
  if (from(kPanelPort)) {
    o.set(pin::kBrldN, panel_port_.brld_n());
    o.set(pin::kErldN, panel_port_.erld_n());
    o.set(pin::kF1ldN, panel_port_.f1ld_n());
    o.set(pin::kIpldN, panel_port_.ipld_n());
  }
  if (from(kInterruptController, kPic8259, kStraps)) {
    const InterruptController& own = interrupt_controller_;
    const bool old = straps_.pic_8259;
    const auto enabled = static_cast<std::uint8_t>(~pic_8259_.imr());
    o.set(pin::kPicIst, old ? pic_8259_.irr() & enabled : own.ist());
    o.set(pin::kPicSig, own.sig());
    o.set(pin::kPicMsk, old ? enabled : own.msk());
    o.set(pin::kPicElr, !old ? own.elr() : pic_8259_.level() ? 0xFF : 0);
  }
  if (from(kHostInterrupt)) o.set(pin::kIsaIrq, host_interrupt_.irq());
  return o;
}

}  // namespace brick
