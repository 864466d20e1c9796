#include "systemc/servo_ic/servo_channels.h"

#include <algorithm>

namespace brick {

void ServoChannels::reset(Tick t) {
  now_ = phase_rise_ = pwm_now_ = t;
  pwm_line_ = {};
  pwm_deadtime_ = kDeadtimeReset;
  turned_ = false;
  started_ = true;
  for (ServoChannel& channel : channel_) channel.reset(t);
  sclk_.reset(t);
  pfm_.reset(t);
  dac_.reset(t);
  adc_.reset(t);
  if (in.trip) dac_.ask(next_ref_edge(t) + kTicksPerRef);
  phase_rises_ = phase_falls_ = servo_falls_ = in.phase_rises = in.phase_falls = in.servo_falls = false;
}

void ServoChannels::write(bool x, unsigned offset, std::uint32_t value) {
  ServoChannel& channel = channel_[offset >> 3];
  const bool control = x && (offset & 7) == regs::servo_channel::kControl.address;
  if (control) settle_pwm_times();
  const bool fine = channel.fine(), other = channel.uses_channel1();
  channel.write(now_, sclk_.start() == now_, x, offset & 7, value, in.trip);
  if (!control) return;
  channel.change_dac_lines(dac_.unclocked(now_));
  if (channel.uses_channel1() != other) channel.forget_position();
  for (ServoChannel& c : channel_) {
    const ServoChannel& source = compared_by(c);
    const bool turns = channel.fine() != fine && (&c == &channel || &source == &channel);
    if (turns || source.still()) c.forget_position();
  }
}

void ServoChannels::advance(Tick t) {
  if (t <= now_) return;
  if (pwm_inputs_move()) {  // the next edge still sees what the flip-flops of the channels have
    catch_up_pwm(now_ + 1);
    if (turned_)
      for (ServoChannel& channel : channel_) channel.load_pwm();
    turned_ = started_ = false;
    pwm_line_ = in.line;
    pwm_deadtime_ = in.deadtime;
  }
  in.line = line_ = in.line.after(t - now_);

  // An edge of PHASE or SERVO acts at the next edge of clk_ref; all latches take what was there before it.
  const Tick edge = next_ref_edge(now_);
  const bool phase_rise = in.phase_rises != phase_rises_;
  if (edge <= t && !phase_rise && in.phase_falls == phase_falls_ && in.servo_falls == servo_falls_) {
    run_ref(t, false);
  } else if (edge <= t) {
    if (in.phase_falls != phase_falls_)
      for (ServoChannel& channel : channel_) channel.latch_phase();
    if (in.servo_falls != servo_falls_)
      for (ServoChannel& channel : channel_) channel.latch_servo(edge);
    phase_rises_ = in.phase_rises;
    phase_falls_ = in.phase_falls;
    servo_falls_ = in.servo_falls;
    if (phase_rise) phase_rise_ = edge;
    run_ref(edge, phase_rise);
    if (edge != t) run_ref(t, false);
  }
  now_ = t;
}

void ServoChannels::catch_up_pwm(Tick t) const {
  if (pwm_now_ == t) return;
  for (const ServoChannel& channel : channel_) channel.run_pwm(pwm_now_, t, pwm_line_, pwm_deadtime_);
  pwm_line_ = pwm_line_.after(t - pwm_now_);
  pwm_now_ = t;
}

void ServoChannels::run_dac(Tick t, bool phase_rise) {
  dac_.advance(
      t, phase_rise, divider(kDac), in.dac_strobe,
      [this](unsigned cut) {
        for (ServoChannel& channel : channel_) channel.load_dac(in.trip, cut);
      },
      [](unsigned, unsigned) {});
}

// Edges of clk_ref up to t. PHASE rises at t or not at all. After a trip it cuts no word of the DACs.
void ServoChannels::run_ref(Tick t, bool phase_rise) {
  if (phase_rise && in.trip) {
    run_dac(t - 1, false);
    run_dac(t, dac_.left() == 0);
  } else {
    run_dac(t, phase_rise);
  }
  adc_.advance(
      t, phase_rise, divider(kAdc), in.adc_strobe,
      [this](unsigned cut) {
        adc_bits_ += kSerialBits - cut;
        sent_from_ = std::max(sent_from_ - static_cast<int>(kSerialBits - cut), -static_cast<int>(kSerialBits));
      },
      [this](unsigned bit, unsigned count) {
        if (sends_) {
          for (unsigned i = 0; i < kChannels; ++i)
            channel_[i].sample_adc_stream(bit, count, sent_in_stream(i), sent_in_stream(kChannels + i));
          return;
        }
        for (unsigned i = 0; i < kChannels; ++i)
          channel_[i].sample_adc(bit, count, (in.adc_a >> i & 1) != 0, (in.adc_b >> i & 1) != 0);
      });

  bool pfm = false;
  for (ServoChannel& channel : channel_) {
    if (channel.hold()) channel.hold_counter();
    const bool run = channel.runs_pfm(in.trip);
    if (!run) channel.stop_pfm();
    pfm = pfm || run;
  }
  while (pfm) {
    Tick stop = t;  // where a PFM pulse begins: the next SCLK may count it
    for (const ServoChannel& channel : channel_) {
      const std::int64_t periods = channel.pfm().periods_to_pulse(channel.pfm_inputs(in.trip, in.deadtime));
      if (periods != kNever) stop = std::min(stop, pfm_.after(periods, divider(kPfm)));
    }
    run_sclk(stop);
    const std::int64_t periods = pfm_.take(stop, divider(kPfm));
    for (ServoChannel& channel : channel_) channel.advance_pfm(periods, in.trip, in.deadtime);
    if (stop == t) return;
  }
  run_sclk(t);
  pfm_.take(t, divider(kPfm));
}

void ServoChannels::run_sclk(Tick t) {
  while (sclk_.next() <= t) {
    const bool source_moves = !channel_[0].settled();
    const auto settled = [&](const ServoChannel& c) { return c.settled() && !(source_moves && c.uses_channel1()); };
    const Tick edge = sclk_.next();
    if (std::all_of(channel_.begin(), channel_.end(), settled)) {
      const std::int64_t periods = sclk_.take(t, divider(kSclk));
      for (ServoChannel& channel : channel_) channel.skip_sclk(periods);
      return;
    }
    ChannelPosition channel1 = channel_[0].position();
    for (unsigned i = 0; i < kChannels; ++i) {
      if (settled(channel_[i]))
        channel_[i].skip_sclk(1);
      else if (i == 0)
        channel1 = channel_[0].sclk(edge, nullptr);
      else
        channel_[i].sclk(edge, &channel1);
    }
    sclk_.take(edge, divider(kSclk));
  }
}

ConverterWords ServoChannels::dac_lines() const {
  ConverterWords lines;
  const unsigned unclocked = dac_.unclocked(now_);
  for (unsigned i = 0; i < lines.size(); ++i) lines[i] = channel_[i % kChannels].dac_line(i / kChannels, unclocked);
  return lines;
}

MotorDigest::AdcStream ServoChannels::adc_stream() const {
  return {adc_bits_ - adc_.left(), adc_.word(), adc_.left() == kSerialBits, adc_.end(divider(kAdc))};
}

void ServoChannels::send_adc(const ConverterWords& words) {
  sends_ = true;
  sent_ = words;
  sent_from_ = static_cast<int>(kSerialBits - adc_.left());
}

// Where it stands in the present stream, of which bit 23 is the first.
std::uint32_t ServoChannels::sent_in_stream(unsigned line) const {
  return sent_from_ >= 0 ? sent_[line] >> sent_from_ : sent_[line] << -sent_from_;
}

unsigned ServoChannels::adc_lines(bool b) const {
  if (!sends_) return b ? in.adc_b : in.adc_a;
  unsigned lines = 0;
  for (unsigned i = 0; i < kChannels && adc_.left() != 0; ++i)
    lines |= (sent_in_stream((b ? kChannels : 0) + i) >> (adc_.left() - 1) & 1) << i;
  return lines;
}

Tick ServoChannels::next_event(const MotorOutputs& select) const {
  const Tick ref = next_ref_edge(now_);
  Tick next = kNever;
  if (has_pwm(select)) {
    catch_up_pwm();
    if (pwm_inputs_move()) next = now_ + 1;
  }
  const bool dac = has_dac(select), adc = has_adc(select);
  if (dac)
    next = std::min(next, dac_.next_event(now_, divider(kDac), (select.w[1] & kDacClk) != 0, has_dac_data(select)));
  if (adc) next = std::min(next, adc_.next_event(now_, divider(kAdc), (select.w[1] & kAdcClk) != 0, false));
  if ((dac || adc) && phase_rises_ != in.phase_rises) next = std::min(next, ref);
  const bool position = has_position(select), pfm_pins = has_pfm(select);
  for (const ServoChannel& channel : channel_) {
    if (position && !channel.quiet(now_)) next = std::min(next, ref);
    if (position && !channel.settled()) next = std::min(next, sclk_.next());
    if (!in.trip && has_pwm(select)) next = std::min(next, channel.next_pwm_event(now_, pwm_line_));
    if (!position && !pfm_pins) continue;
    const ChannelPfm::Inputs pfm = channel.pfm_inputs(in.trip, in.deadtime);
    const std::int64_t periods = channel.pfm().periods_to_change(pfm);
    if (periods != kNever) next = std::min(next, pfm_.after(periods, divider(kPfm)));
    if (!pfm.run && channel.pfm().pulse()) next = std::min(next, ref);
  }
  return next;
}

Tick ServoChannels::next_equ_event(unsigned channels) const {
  Tick next = kNever;
  for (unsigned i = 0; i < kChannels; ++i)
    if ((channels >> i & 1) != 0) next = std::min(next, next_equ_of(channel_[i]));
  return next;
}

Tick ServoChannels::next_equ_of(const ServoChannel& channel) const {
  if (&compared_by(channel) != &channel) return channel_[0].compares(in.trip) ? sclk_.next() : kNever;
  if (!channel.compares(in.trip)) return kNever;
  Tick next = sclk_.after(channel.edges_to_equ() + 1, divider(kSclk));
  if (channel.settled()) {  // until the next pulse
    const std::int64_t periods = channel.pfm().periods_to_pulse(channel.pfm_inputs(in.trip, in.deadtime));
    next = periods == kNever ? kNever : std::max(next, pfm_.after(periods, divider(kPfm)));
  }
  return next;
}

void ServoChannels::mark() {
  catch_up_pwm();
  marked_ = now_;
  marked_adc_bits_ = adc_bits_;
  for (ServoChannel& channel : channel_) channel.mark(now_);
}

// Dividers, timers, encoders and PFM take no notice of the clocks: a jump executes them. The clocks latch and start
// streams, which the period after the jump does again, provided that none is under way at either end, however PHASE
// falls into the bit clock, and that none takes a word that was sent.
bool ServoChannels::repeats() const {
  catch_up_pwm();
  const unsigned slow = std::max(divider(kDac), divider(kAdc));
  const bool sent = sends_ && sent_from_ > -static_cast<int>(kSerialBits);
  const bool calm = dac_.idle() && adc_.idle() && !sent &&
                    (phase_rise_ < marked_ || now_ - phase_rise_ > 26 * (kTicksPerRef << slow));
  return calm && std::all_of(channel_.begin(), channel_.end(),
                             [this](const ServoChannel& c) { return c.repeats(now_ - marked_); });
}

void ServoChannels::jump(Tick by) {
  catch_up_pwm();
  pwm_now_ += by;
  const Tick periods = by / (now_ - marked_);
  for (ServoChannel& channel : channel_) channel.jump(now_, by, periods);
  adc_bits_ += periods * (adc_bits_ - marked_adc_bits_);
  run_ref(now_ + by, false);
  now_ += by;
}

MotorOutputs ServoChannels::motor_outputs(const MotorOutputs& select) const {
  MotorOutputs o;
  o.w[0] = dir() << 28 | pulse() << 24 | (has_pwm(select) ? pwm() : 0);
  o.w[1] = dac_a() | dac_b() << 4 | aena() << 8 | equ() << 12 | (dac_clk() ? 1u : 0u) << 16 |
           (dac_strobe() ? 1u : 0u) << 17 | (adc_clk() ? 1u : 0u) << 18 | (adc_strobe() ? 1u : 0u) << 19;
  for (unsigned i = 0; i < kChannels; ++i) o.w[2 + i] = channel_[i].counter();
  return o;
}

std::uint32_t ServoChannels::pwm() const {
  catch_up_pwm();
  std::uint32_t pins = 0;
  for (unsigned i = 0; i < kChannels; ++i) pins |= channel_[i].pwm(in.trip) << (6 * i);
  return pins;
}

}  // namespace brick
