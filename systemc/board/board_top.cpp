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
      host_interrupt_("host_interrupt"),
      host_signals_("host_signals"),
      dpram_("dpram"),
      panel_port_("panel_port"),
      ssi_("ssi"),
      gate_ics_(ics) {
  isa_slave_.leave_ends_out();
  for (unsigned i = 0; i < Dpram::kWords; ++i) dpram_.poke(i, start_word(start_seed(seed), i));
  reset_all(0);
  outputs_ = pins(kEverything);
}

void BoardTop::set_inputs(const BoardInputs& inputs) {
  Parts changed = 0;
  if (!same<PortAPins>(inputs, inputs_) || inputs.rst_n != inputs_.rst_n) changed |= parts(kPortAPins);
  if (!same<IsaPins>(inputs, inputs_) || !same<IsaStraps>(inputs, inputs_)) changed |= parts(kIsaPins);
  if (!same<ConnectorPins>(inputs, inputs_)) changed |= parts(kConnectorPins);
  if (!same<Straps>(inputs, inputs_)) straps_differ_ = straps_ != inputs;
  inputs_ = inputs;
  if (!inputs_.rst_n)
    reset_end_ = kNever;
  else if (reset_end_ == kNever)
    reset_end_ = next_ref_edge(now_) + kResetRelease;
  touched_ = 0;
  if ((changed & parts(kPortAPins)) != 0) drive_port_a();
  connect(changed & ~parts(kPortAPins));
  schedule(touched_);
}

void BoardTop::set_port_a(const BoardInputs& inputs) {
  static_cast<PortAPins&>(inputs_) = inputs;
  touched_ = 0;
  drive_port_a();
  if (touched_ != 0) schedule(touched_);
}

// The CPU's bus alone has pins that follow others without a clock. What hangs on its inputs shows nothing else before
// the next edge, so there is nothing to wire on; while no strobe moves or is on its way nobody takes notice of the
// rest.
void BoardTop::drive_port_a() {
  const bool strobe = bus_strobes_.moves(inputs_) || held();
  if (strobe) {
    bus_strobes_.set_pins(inputs_, !held());
    bus_read_.set_rd(inputs_.pa_rd_n, bus_strobes_.rd_falls());
  }
  if (strobe || bus_sync_.under_way()) {
    bus_sync_.advance(now_);
    touched_ |= parts(kBusSync);
  }
  bus_sync_.set_pins(inputs_, bus_strobes_);
  const bool selected = Dpram::Inputs::selected(inputs_);
  if (strobe || selected || dpram_.in.cpu_sel) {
    dpram_.advance(now_);
    touched_ |= parts(kDpram);
  }
  dpram_.in.set_cpu_pins(inputs_, bus_strobes_.rd_falls(), bus_strobes_.wr_falls());
  dpram_.rd_moved();
  const bool oe = bus_read_.oe() || dpram_.cpu_drive();
  if (oe != (outputs_.get(pin::kPaDataOe) != 0) || dpram_.cpu_wait() != (outputs_.get(pin::kPaTaN) != 0))
    next_own_ = now_ + 1;
}

BoardOutputs BoardTop::port_a_at_once() const {
  BoardOutputs o = outputs_;
  set_port_a_pins(o);
  return o;
}

void BoardTop::set_motor_inputs(unsigned ic, const MotorInputs& inputs) {
  gate_ics_.set_motor_inputs(ic, inputs, now_);
}

void BoardTop::watch_motor(unsigned ic, const MotorOutputs& select) {
  if (ic >= kMaxServoIcs) return;
  gate_ics_.watch(ic, select, now_);
  watched_motor_[ic] = select;
  motor_outputs_[ic] = motor_outputs(ic) & select;
}

void BoardTop::reset_all(Tick t) {
  each_block(kEveryBlock, [t](Part, ModelBlock& block) { block.reset(t); });
  gate_ics_.reset(t);
  bus_read_.reset();
  take_straps(Straps::none(), t);
  touched_ = kEveryBlock;
  connect(kEverything);
  schedule(kEveryBlock);
  shown_ = kEverything;
  next_own_ = kNever;
}

void BoardTop::schedule(Parts which) {
  each_block(which, [this](Part part, const auto& block) { next_[part] = block.next_event(); });
  const auto first = [this](unsigned from, unsigned to,
                            Tick earliest) {  // without branches, which nobody could foresee
    for (unsigned i = from; i < to; ++i) earliest = std::min(earliest, next_[i]);
    return earliest;
  };
  if ((which >> kBusy) != 0) seldom_ = first(kBusy, kBlocks, kNever);
  first_ = first(0, kBusy, seldom_);
}

// The edge t. What looks at a register of another block does so before any block executes the edge.
void BoardTop::execute(Tick t) {
  Parts changed = first_ <= t ? due(t) : 0;
  touched_ = changed;
  const IcAccess ic = (changed & parts(kBusSync)) != 0 ? take_strobe(t) : IcAccess{};
  each_block(changed, [t](Part, auto& block) { block.advance(t); });
  if (gate_ics_.next_event() <= t && gate_ics_.advance(t)) changed |= parts(kIcClocks);
  Parts own = 0;
  if (next_own_ <= t) {
    next_own_ = kNever;
    own = parts(kPortAPins);
  }
  if (straps_differ_ && is_ref_edge(t)) {
    take_straps(inputs_, t);
    changed |= parts(kStraps);
  }
  take_access(ic, t, changed);
  now_ = t;
  connect(changed);
  schedule(touched_);
  shown_ = changed | touched_ | own;
}

// What an access that the edge t saw does to the registers, which have executed it.
void BoardTop::take_access(const IcAccess& ic, Tick t, Parts& changed) {
  if (ic.ssi) {
    if (!ic.write) return;
    ssi_.advance(t);
    ssi_.write(ic.where.x, ic.where.addr & Ssi::kPage, ic.wdata);
    touched_ |= parts(kSsi);
    changed |= parts(kSsi);
    return;
  }
  if (ic.read) gate_ics_.read_taken(ic.number, ic.where.x, ic.where.addr, t);
  if (ic.write) {
    gate_ics_.write(ic.number, ic.where.x, ic.where.addr, ic.wdata, t);
    changed |= parts(kIcClocks);
  }
}

// The strobe of a Port A access that the edge t sees: of a read it takes the sample; an access of an IC is returned.
BoardTop::IcAccess BoardTop::take_strobe(Tick t) {
  bus_sync_.advance(t - 1);
  const bool read = bus_sync_.rd(), write = bus_sync_.we();
  if (!read && !write) return {};
  select();
  if (select_.ssi) ssi_.advance(t - 1);
  if (read && select_.any) bus_read_.take(read_data(t - 1), bus_sync_.rd_falls(), select_.internal);
  if (select_.ssi) {
    if (read) ssi_.read_taken(bus_sync_.where().x, bus_sync_.where().addr & Ssi::kPage);
    return {read, write, true, 0, bus_sync_.where(), bus_sync_.wdata()};
  }
  if (select_.ic < 0) return {};
  return {read, write, false, static_cast<unsigned>(select_.ic), bus_sync_.where(), bus_sync_.wdata()};
}

void BoardTop::select() {
  select_ = AddressDecode::decode(bus_sync_.where(), straps_.fitted & gate_ics_.built(), straps_.jpan_fitted,
                                  straps_.ssi_kind);
}

std::uint32_t BoardTop::read_data(Tick t) const {
  if (select_.internal) return select_.port ? host_port_.dsp_rdata() : 0;
  if (select_.signals) return host_signals_.rdata();
  if (select_.ctrl) return ctrl();
  if (select_.panel) return panel_port_.rdata();
  if (select_.ssi) return ssi_.read(bus_sync_.where().x, bus_sync_.where().addr & Ssi::kPage);
  if (select_.ic < 0) return 0;
  return gate_ics_.read(static_cast<unsigned>(select_.ic), bus_sync_.where().x, bus_sync_.where().addr, t);
}

void BoardTop::take_straps(const Straps& straps, Tick t) {
  straps_ = straps;
  straps_differ_ = straps_ != inputs_;
  std::uint32_t interrupting = 0;
  for (unsigned line = 0; line < 3; ++line) interrupting |= 1u << (straps_.line_select >> 4 * line & 0xF);
  gate_ics_.set_interrupting(interrupting >> 1 & 0xFF, t);
}

bool BoardTop::show_pins() {
  const BoardOutputs after = pins(shown_);
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
    const MotorOutputs before = motor_outputs_[ic];
    const MotorOutputs after = gate_ics_.motor_outputs(ic, now_, watched_motor_[ic]) & watched_motor_[ic];
    if (after == before) continue;
    motor_outputs_[ic] = after;
    if (on_motor_change) on_motor_change(now_, ic, before, after);
    stop = stop || before.differs(after, stop_on_motor_[ic]);
  }
  return stop;
}

Tick BoardTop::next_event() const {
  const Tick next = std::min({gate_ics_.next_event(), next_own_, first_});
  return straps_differ_ ? std::min(next, next_ref_edge(now_)) : next;
}

Tick BoardTop::run_until(Tick limit, const BoardOutputs& stop_on) {
  stop_on_ = stop_on;
  while (now_ < limit) {
    if (held()) {
      if (!in_reset_) gate_ics_.end(now_);
      now_ = in_reset_ ? std::min(limit, reset_end_) : now_ + 1;
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
  if (held()) return in_reset_ ? reset_end_ : now_;
  const Tick any_pin = next_event() - 1;
  if (bus_sync_.write_pending() || straps_differ_) return any_pin;

  // With no write under way each group of pins has its own cause; only those that interrupt the CPU are told apart.
  constexpr BoardOutputs kClocks = select_pins(pin::kPhase, pin::kServo, pin::kPhaseSource, pin::kSourceConflict);
  constexpr BoardOutputs kTripped = select_pins(pin::kWdTripped, pin::kWdo);
  constexpr BoardOutputs kHost = select_pins(pin::kIrqHost);
  Tick quiet = kNever;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) {
    const std::uint32_t w = watched.w[i];
    if ((w & kClocks.w[i]) != 0) quiet = std::min(quiet, next_clock_event() - 1);
    if ((w & kTripped.w[i]) != 0) quiet = std::min(quiet, next_[kWatchdog] - 1);
    if ((w & kHost.w[i]) != 0) {
      const bool busy = next_[kIsaSlave] != kNever || bus_sync_.internal_pending();
      quiet = std::min(quiet, busy ? any_pin : next_[kHostPort] - 1);
    }
    if ((w & ~(kClocks.w[i] | kTripped.w[i] | kHost.w[i])) != 0) return any_pin;
  }
  return quiet;
}

std::unique_ptr<Board> make_model_board(std::uint32_t fitted, std::uint64_t seed) {
  return std::make_unique<BoardTop>(sc_core::sc_gen_unique_name("board_top"), fitted, seed);
}

}  // namespace brick
