#include "systemc/machine/motor_side.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace brick {

MotorSide::MotorSide(Board& board, Signals& signals, std::uint32_t fitted, std::uint16_t idle_pins)
    : board_(board), signals_(signals), fitted_(fitted & ((1u << kMaxServoIcs) - 1)), idle_(idle_pins) {
  place_.fill(-1);
  MotorInputs idle;
  idle.pins.fill(idle_);
  inputs_.fill(idle);
  applied_ = inputs_;
  for (unsigned i = 0; i < kMaxServoIcs; ++i) {
    if ((fitted_ >> i & 1) == 0) continue;
    place_[i] = static_cast<int>(ics_.size());
    Ic ic{};
    ic.index = i;
    for (unsigned n = 0; n < kChannels; ++n) {
      const std::string scope = servo_ic_scope(i) + ".ch" + std::to_string(n + 1) + ".";
      for (unsigned p = 0; p < kChannelPins; ++p)
        ic.pin[n][p] = signals.add(scope + std::string(kChannelPinNames[p]), 1, Radix::kBinary, idle.pins[n] >> p & 1);
      ic.adc[n] = {signals.add(scope + "adc_a", 1, Radix::kBinary), signals.add(scope + "adc_b", 1, Radix::kBinary)};
      for (const bool b : {false, true})
        signals.ask(ic.adc[n][b ? 1 : 0], [this, i, n, b] {
          const unsigned lines = digest_ != nullptr ? digest_->adc_lines(i, b)
                                 : b                ? inputs_[i].adc_b
                                                    : inputs_[i].adc_a;
          return lines >> n & 1;
        });
      for (std::size_t f = 0; f < motor_pin::kAll.size(); ++f) {
        const MotorField& field = motor_pin::kAll[f];
        if (field.shared && n > 0) {
          ic.output[n][f] = ic.output[0][f];
          signals.add_alias(scope + std::string(field.name), ic.output[0][f]);
          continue;
        }
        ic.output[n][f] = signals.add(scope + std::string(field.name), field.width,
                                      field.width > 1 ? Radix::kSigned : Radix::kBinary);
        signals.ask(ic.output[n][f], [this, i, n, &field] { return board_.motor_outputs(i).get(field, n); });
      }
    }
    ics_.push_back(ic);
    board.set_motor_inputs(i, idle);
  }
  board.on_motor_change = [this](Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    changed(tick, ic, before, after);
  };
}

void MotorSide::apply() {
  const TimeFs time = tick_to_fs(board_.now());
  for (const Ic& ic : ics_) {
    const MotorInputs& in = inputs_[ic.index];
    const MotorInputs before = applied_[ic.index];
    if (in == before) continue;
    applied_[ic.index] = in;
    board_.set_motor_inputs(ic.index, in);
    for (unsigned n = 0; n < kChannels; ++n) {
      if (in.pins[n] == before.pins[n] && in.adc_a == before.adc_a && in.adc_b == before.adc_b) continue;
      for (unsigned p = 0; p < kChannelPins; ++p) signals_.set(ic.pin[n][p], time, in.pins[n] >> p & 1);
      signals_.set(ic.adc[n][0], time, in.adc_a >> n & 1);
      signals_.set(ic.adc[n][1], time, in.adc_b >> n & 1);
    }
  }
}

void MotorSide::attach(MotorPeer& peer) {
  peers_.push_back({&peer, {}, false});
  digest_ = digest();
  peer.begin(digest_);
  watch();
  show_present(peer);
}

void MotorSide::show_present(MotorPeer& peer) {
  for (const Ic& ic : ics_) {
    if ((peer.ics() >> ic.index & 1) == 0) continue;
    const MotorOutputs present = board_.motor_outputs(ic.index);
    peer.changed(board_.now(), ic.index, present, present);
  }
}

void MotorSide::detach(MotorPeer& peer) {
  peers_.erase(std::remove_if(peers_.begin(), peers_.end(), [&](const Peer& p) { return p.peer == &peer; }),
               peers_.end());
  watch();
}

void MotorSide::stop_on(unsigned ic, const MotorOutputs& select) {
  select_.at(ic) = select;
  watch();
}

// Who is watched, and which edges end a run: what the user, the peers and the waveform want.
void MotorSide::watch() {
  for (const Ic& ic : ics_) {
    MotorOutputs stops = select_[ic.index], watched = traced_[ic.index];
    for (Peer& p : peers_) {
      p.stops[ic.index] = p.peer->stops(ic.index);
      stops |= p.stops[ic.index];
      if ((p.peer->ics() >> ic.index & 1) != 0) watched |= p.peer->watched(ic.index);
    }
    watched |= stops;
    board_.watch_motor(ic.index, watched);
    board_.stop_on_motor(ic.index, stops);
  }
}

// The waveform wants other outputs than before: from here on it has them.
void MotorSide::take_groups() {
  attachments_ = signals_.attachments();
  const bool other = digest_ != digest();
  if (other) {
    digest_ = digest();
    for (Peer& p : peers_) p.peer->begin(digest_);
  }
  for (Ic& ic : ics_) {
    MotorOutputs& traced = traced_[ic.index];
    traced = {};
    ic.shown.clear();
    for (unsigned n = 0; n < kChannels; ++n) {
      for (std::size_t f = 0; f < motor_pin::kAll.size(); ++f) {
        const MotorField& field = motor_pin::kAll[f];
        if (!signals_.traced(ic.output[n][f]) || (field.shared && n > 0)) continue;
        MotorOutputs place;
        place.set(field, n, ~0u);
        traced |= place;
        for (unsigned word = 0; word < kMotorOutputWords; ++word)
          if (const std::uint32_t mask = place.w[word]; mask != 0)
            ic.shown.push_back({word, mask, static_cast<unsigned>(__builtin_ctz(mask)), ic.output[n][f]});
      }
    }
  }
  watch();
  for (const Ic& ic : ics_) {
    const MotorOutputs present = board_.motor_outputs(ic.index);
    MotorOutputs inverse = present;
    for (std::uint32_t& word : inverse.w) word = ~word;
    show(tick_to_fs(board_.now()), ic.index, inverse, present);
  }
  for (Peer& p : peers_)
    if (other) show_present(*p.peer);
}

void MotorSide::step_peers() {
  const Tick now = board_.now();
  bool edited = false;
  for (Peer& p : peers_) {
    if (!p.stopped && p.peer->next_event() > now) continue;
    p.stopped = false;
    edited = p.peer->step(now, inputs_) || edited;
    if (const std::uint8_t ssi = p.peer->ssi_channels(); ssi != 0)
      ssi_data_ = static_cast<std::uint8_t>((ssi_data_ & ~ssi) | (p.peer->ssi_data(now) & ssi));
    if (p.peer->next_event() <= now) throw std::logic_error("a motor peer asks for a time that has passed");
  }
  if (edited) apply();
}

void MotorSide::ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after) {
  for (Peer& p : peers_) {
    const std::uint8_t ssi = p.peer->ssi_channels();
    if (((before ^ after) & ssi) == 0) continue;
    p.peer->ssi_clocked(tick, before, after);
    p.stopped = true;
  }
}

void MotorSide::changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
  if (before.differs(after, traced_[ic])) show(tick_to_fs(tick), ic, before, after);
  for (Peer& p : peers_) {
    if ((p.peer->ics() >> ic & 1) == 0) continue;
    p.peer->changed(tick, ic, before, after);
    p.stopped = p.stopped || before.differs(after, p.stops[ic]);
  }
  stopped_ = stopped_ || before.differs(after, select_[ic]);
}

void MotorSide::show(TimeFs time, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
  if (place_[ic] < 0) return;
  for (const Shown& s : ics_[static_cast<std::size_t>(place_[ic])].shown)
    if (((before.w[s.word] ^ after.w[s.word]) & s.mask) != 0)
      signals_.set(s.id, time, (after.w[s.word] & s.mask) >> s.lsb);
}

}  // namespace brick
