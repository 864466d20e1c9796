// The motor side of the machine: input pins, the peers that are wired to them, and the signals `servo_ic0.ch1.enc_a`
// ... (docs/signals.md). Outputs are followed edge by edge only while somebody needs them: a waveform, a peer, a wait.
#pragma once

#include <array>
#include <vector>

#include "systemc/core/board.h"
#include "systemc/core/signals.h"
#include "systemc/machine/motor_peer.h"

namespace brick {

class MotorSide {
 public:
  MotorSide(Board& board, Signals& signals, std::uint32_t fitted);

  MotorInputPins& inputs() { return inputs_; }
  void apply();

  void attach(MotorPeer& peer);
  void detach(MotorPeer& peer);
  void stop_on(unsigned ic,
               const MotorOutputs& select);  // take_stop() tells of such an edge; an empty selection ends it

  void begin_run();         // once a run, before the others
  void step();              // peers whose time has come
  Tick next_event() const;  // of the peers, after now
  bool take_stop();         // a selected edge has come since the last call

 private:
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after);
  void show(TimeFs time, unsigned ic, const MotorOutputs& before, const MotorOutputs& after);
  void watch();

  struct Ic {
    unsigned index;
    std::array<std::array<Signals::Id, kChannelPins>, kChannels> pin;
    std::array<std::array<Signals::Id, 2>, kChannels> adc;
    std::array<std::array<Signals::Id, motor_pin::kAll.size()>, kChannels> output;
  };
  struct Peer {
    MotorPeer* peer;
    bool stopped;
  };

  Board& board_;
  Signals& signals_;
  std::uint32_t fitted_;
  std::vector<Ic> ics_;
  std::array<int, kMaxServoIcs> place_;  // in ics_, -1: not fitted
  std::vector<Peer> peers_;
  MotorInputPins inputs_, applied_;
  std::array<MotorOutputs, kMaxServoIcs> select_{};  // of the user
  bool traced_ = false, stopped_ = false;
};

}  // namespace brick
