// Model of rtl/board/board_top.sv: the controller board behind the Board face, event-driven. Time jumps from one event
// to the next; at an event the blocks of the buses execute their edges, then the wires between them are copied
// (systemc/core/model_block.h). The ICs keep a time of their own and catch up when somebody looks
// (docs/architecture.md). ICs are built for the bits of `ics`, as the RTL's parameters ServoIcMask and MacroIcMask;
// BoardInputs::fitted selects at run time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include <systemc>

#include "systemc/board/address_decode.h"
#include "systemc/board/bus_read.h"
#include "systemc/board/bus_strobes.h"
#include "systemc/board/bus_sync.h"
#include "systemc/board/clock_select.h"
#include "systemc/board/gate_ics.h"
#include "systemc/board/panel_port.h"
#include "systemc/board/watchdog.h"
#include "systemc/core/board.h"
#include "systemc/host/dpram.h"
#include "systemc/host/host_port.h"
#include "systemc/host/host_signals.h"
#include "systemc/host/interrupt_controller.h"
#include "systemc/host/isa_slave.h"
#include "systemc/host/pic_8259.h"

namespace brick {

class BoardTop : public sc_core::sc_module, public Board {
 public:
  explicit BoardTop(const sc_core::sc_module_name& name, std::uint32_t ics = 0x3, std::uint64_t seed = 0);

  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs& inputs) override;
  const BoardOutputs& outputs() const override { return outputs_; }
  Tick run_until(Tick limit, const BoardOutputs& stop_on = {}) override;
  Tick quiet_until(const BoardOutputs& watched) const override;

  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override;
  MotorOutputs motor_outputs(unsigned ic) const override { return gate_ics_.motor_outputs(ic, now_); }
  void watch_motors(std::uint32_t ics) override;
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic < kMaxServoIcs) stop_on_motor_[ic] = select;
  }

  // Blocks behind the pins, for SystemC users and tests; the ICs stand at now().
  ServoIc* servo_ic(unsigned index) { return gate_ics_.servo_ic(index, now_); }
  MacroIc* macro_ic(unsigned index) { return gate_ics_.macro_ic(index, now_); }
  Dpram& dpram() { return dpram_; }
  HostPort& host_port() { return host_port_; }

 private:
  // The blocks of the buses, by their own types: this is the innermost loop of the model.
  template <class F>
  void each_block(F f) {
    f(bus_sync_), f(clock_select_), f(watchdog_), f(isa_slave_), f(host_port_), f(interrupt_controller_), f(pic_8259_),
        f(host_signals_), f(dpram_), f(panel_port_);
  }
  template <class F>
  void each_block(F f) const {
    f(bus_sync_), f(clock_select_), f(watchdog_), f(isa_slave_), f(host_port_), f(interrupt_controller_), f(pic_8259_),
        f(host_signals_), f(dpram_), f(panel_port_);
  }
  void reset_all(Tick t);
  void advance_all(Tick t);
  void execute(Tick t);
  void connect();  // copies wires: outputs of the blocks to inputs of the others
  void connect_clocks();
  void connect_host();
  void connect_interrupts();
  BoardOutputs pins() const;
  bool show_pins();                       // updates outputs_ after an edge; true when a selected pin changed
  bool show_motors();                     // the same for the watched ICs
  std::uint32_t read_data(Tick t) const;  // of the selected register, after the edge t
  bool data_oe() const { return bus_read_.oe() || (from_dpram_ && dpram_.cpu_valid() && !inputs_.pa_rd_n); }
  void take_straps(const Straps& straps, Tick t);
  std::uint32_t selected_lines() const;  // IR5, IR6, IR7 of the interrupt controller
  Tick next_event() const;
  Tick next_clock_event() const { return std::min(clock_select_.next_event(), gate_ics_.next_clock_event()); }

  BusStrobes bus_strobes_;
  BusSync bus_sync_;
  BusRead bus_read_;
  AddressDecode address_decode_;
  ClockSelect clock_select_;
  Watchdog watchdog_;
  IsaSlave isa_slave_;
  HostPort host_port_;
  InterruptController interrupt_controller_;
  Pic8259 pic_8259_;
  HostSignals host_signals_;
  Dpram dpram_;
  PanelPort panel_port_;
  GateIcs gate_ics_;

  BoardInputs inputs_;
  static constexpr Straps kNoStraps{0, 0, false, false, 0, false, false};
  Straps straps_ = kNoStraps;  // as taken over on clk_ref
  AddressSelect select_;       // of the address in bus_sync
  bool from_dpram_ = false;    // read data pins show the dual-ported RAM
  bool in_reset_ = true;
  Tick now_ = 0;
  BoardOutputs outputs_, stop_on_;
  std::array<MotorOutputs, kMaxServoIcs> motor_outputs_, stop_on_motor_;
};

}  // namespace brick
