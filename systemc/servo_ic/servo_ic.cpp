#include "systemc/servo_ic/servo_ic.h"

namespace brick {

ServoIc::ServoIc(const sc_core::sc_module_name& name)
    : sc_module(name), regs_("regs"), clock_gen_("clock_gen"), channels_("channels") {}

void ServoIc::reset(Tick t) {
  regs_.reset();
  clock_gen_.reset(t);
  channels_.reset(t);
  now_ = chain_edge_ = t;
  apply_registers();
}

void ServoIc::write(bool x, unsigned offset, std::uint32_t value) {
  regs_.write(x, offset, value, channels_.in.trip);
  channels_.write(x, offset, value);
  apply_registers();
}

void ServoIc::apply_registers() {
  clock_gen_.in.max_count = regs_.max_count();
  clock_gen_.in.phase_div = regs_.phase_div();
  clock_gen_.in.servo_div = regs_.servo_div();
  clock_gen_.in.phase_ext = regs_.phase_ext();
  clock_gen_.in.servo_ext = regs_.servo_ext();
  channels_.in.clock_control = regs_.clock_word();
  channels_.in.dac_strobe = regs_.dac_strobe();
  channels_.in.adc_strobe = regs_.adc_strobe();
  channels_.in.deadtime = regs_.deadtime();
  follow_clock();
}

void ServoIc::follow_clock() { channels_.in.line = {clock_gen_.cnt(), clock_gen_.up() ? 1 : -1}; }

// The triangle is a straight line up to each special edge of the clock chain; the channels run along it.
void ServoIc::advance(Tick t) {
  while (now_ < t) {
    now_ = std::min(t, clock_gen_.next_special_edge());
    channels_.advance(now_);
    const bool up = clock_gen_.up(), phase = clock_gen_.phase_clock(), servo = clock_gen_.servo_clock();
    clock_gen_.advance(now_);
    if (clock_gen_.up() != up) channels_.turn();
    if (clock_gen_.phase_clock() != phase) {
      bool& edges = phase ? channels_.in.phase_falls : channels_.in.phase_rises;
      edges = !edges;
      chain_edge_ = now_;
    }
    if (servo && !clock_gen_.servo_clock()) {
      channels_.in.servo_falls = !channels_.in.servo_falls;
      chain_edge_ = now_;
    }
    follow_clock();
  }
}

// A turn of the triangle loads the PWM commands, an edge of PHASE starts the serial streams.
Tick ServoIc::next_motor_event(const MotorOutputs& select) const {
  const Tick next = channels_.next_event(select);
  return channels_.follow_clocks(select) ? std::min(clock_gen_.next_special_edge(), next) : next;
}

void ServoIc::mark() {
  clock_gen_.mark();
  channels_.mark();
}

// clk_ref has taken the last edge of the chain, wherever it fell.
bool ServoIc::repeats() const {
  return now_ - chain_edge_ > kTicksPerRef && clock_gen_.repeats() && channels_.repeats();
}

void ServoIc::jump(Tick by) {
  clock_gen_.jump(by);
  channels_.jump(by);
  now_ += by;
  chain_edge_ += by;
}

}  // namespace brick
