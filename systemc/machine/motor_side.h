// The motor side of the machine: input pins, the peers that are wired to them, and the signals `servo_ic0.ch1.enc_a`
// ... (docs/signals.md). Outputs are followed edge by edge only while somebody needs them: a waveform, a peer, a wait.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "systemc/core/board.h"
#include "systemc/core/signals.h"
#include "systemc/machine/motor_peer.h"

namespace brick {

class MotorSide {
 public:
  // `idle`: the input pins of a channel where nothing is connected, bits as ChannelPin
  MotorSide(Board& board, Signals& signals, std::uint32_t fitted, std::uint16_t idle);

  MotorInputPins& inputs() { return inputs_; }
  std::uint16_t idle_pins() const { return idle_; }
  void apply();

  void attach(MotorPeer& peer);
  void detach(MotorPeer& peer);
  std::uint16_t driven(unsigned ic, unsigned channel) const {  // input pins that peers drive, bits as ChannelPin
    unsigned pins = 0;
    for (const Peer& p : peers_) pins |= p.peer->drives(ic, channel);
    return static_cast<std::uint16_t>(pins);
  }
  void stop_on(unsigned ic,
               const MotorOutputs& select);  // take_stop() tells of such an edge; an empty selection ends it

  void begin_run() {  // once a run, before the others
    stopped_ = false;
    if (attachments_ != signals_.attachments()) take_groups();
  }
  void step() {  // peers whose time has come
    if (!peers_.empty()) step_peers();
  }
  Tick next_event() const {  // of the peers, after now
    Tick next = kNever;
    for (const Peer& p : peers_) next = std::min(next, p.peer->next_event());
    return next;
  }
  // Absolute encoders: whether a run must stop at the edges of their clocks, an edge, the data pins as the peers drive
  // them.
  bool has_ssi() const {
    return std::any_of(peers_.begin(), peers_.end(), [](const Peer& p) { return p.peer->ssi_channels() != 0; });
  }
  void ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after);
  std::uint8_t ssi_data() const { return ssi_data_; }
  bool take_stop() { return std::exchange(stopped_, false); }  // a selected edge has come since the last call

 private:
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after);
  void show(TimeFs time, unsigned ic, const MotorOutputs& before, const MotorOutputs& after);
  void step_peers();
  void watch();
  void take_groups();
  void show_present(MotorPeer& peer);
  MotorDigest* digest() const { return signals_.traced() ? nullptr : board_.motor_digest(); }  // a waveform has pins

  struct Shown {  // an output in the waveform
    unsigned word;
    std::uint32_t mask;
    unsigned lsb;
    Signals::Id id;
  };
  struct Ic {
    unsigned index;
    std::array<std::array<Signals::Id, kChannelPins>, kChannels> pin;
    std::array<std::array<Signals::Id, 2>, kChannels> adc;
    std::array<std::array<Signals::Id, motor_pin::kAll.size()>, kChannels> output;
    std::vector<Shown> shown;
  };
  struct Peer {
    MotorPeer* peer;
    std::array<MotorOutputs, kMaxServoIcs> stops;
    bool stopped;
  };

  Board& board_;
  Signals& signals_;
  std::uint32_t fitted_;
  std::uint16_t idle_;
  std::vector<Ic> ics_;
  std::array<int, kMaxServoIcs> place_;  // in ics_, -1: not fitted
  std::vector<Peer> peers_;
  MotorInputPins inputs_, applied_;
  std::array<MotorOutputs, kMaxServoIcs> select_{};  // of the user
  std::array<MotorOutputs, kMaxServoIcs> traced_{};  // of the waveform
  MotorDigest* digest_ = nullptr;                    // that the peers have
  std::uint8_t ssi_data_ = 0xFF;
  unsigned attachments_ = 0;  // as traced_ knows them
  bool stopped_ = false;
};

}  // namespace brick
