// Model of rtl/board/board_top.sv: the controller board behind the Board face, event-driven. Time jumps from one event
// to the next (systemc/core/model_block.h). An event concerns the blocks whose time it is: they execute their edge,
// what they show is wired to the inputs of others (board_wires.cpp), and those whose inputs have changed are asked when
// they are next. Nobody else is touched. The ICs keep a time of their own and catch up when somebody looks
// (docs/architecture.md). ICs are built for the bits of `ics`, as the RTL's parameters ServoIcMask and MacroIcMask;
// BoardInputs::fitted selects at run time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>

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
#include "systemc/host/host_interrupt.h"
#include "systemc/host/host_port.h"
#include "systemc/host/host_signals.h"
#include "systemc/host/interrupt_controller.h"
#include "systemc/host/isa_slave.h"
#include "systemc/host/pic_8259.h"
#include "systemc/ssi/ssi.h"

namespace brick {

class BoardTop : public sc_core::sc_module, public Board, private MotorDigest {
 public:
  explicit BoardTop(const sc_core::sc_module_name& name, std::uint32_t ics = 0x3, std::uint64_t seed = 0);

  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs& inputs) override;
  void set_port_a(const BoardInputs& inputs) override;
  const BoardOutputs& outputs() const override { return outputs_; }
  BoardOutputs port_a_at_once() const override;
  Tick run_until(Tick limit, const BoardOutputs& stop_on = {}) override;
  Tick quiet_until(const BoardOutputs& watched) const override;

  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override;
  MotorOutputs motor_outputs(unsigned ic) const override { return gate_ics_.motor_outputs(ic, now_); }
  void watch_motor(unsigned ic, const MotorOutputs& select) override;
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic < kMaxServoIcs) stop_on_motor_[ic] = select;
  }

  MotorDigest* motor_digest() override { return this; }

  // Blocks behind the pins, for SystemC users and tests; the ICs stand at now().
  ServoIc* servo_ic(unsigned index) { return gate_ics_.servo_ic(index, now_); }
  MacroIc* macro_ic(unsigned index) { return gate_ics_.macro_ic(index, now_); }
  Dpram& dpram() { return dpram_; }
  std::optional<std::uint16_t> dpram_word(unsigned index) const override { return dpram_.peek(index); }
  HostPort& host_port() { return host_port_; }

 private:
  friend class BoardWaker;  // testbench/unit/cosim/board_asleep_test.cpp
  friend class BoardProbe;  // testbench/unit/cosim/board_parts_test.cpp

  ConverterWords dac_lines(unsigned ic) override {
    const ServoChannels* channels = gate_ics_.channels(ic, now_);
    return channels != nullptr ? channels->dac_lines() : ConverterWords{};
  }
  AdcStream adc_stream(unsigned ic) override {
    const ServoChannels* channels = gate_ics_.channels(ic, now_);
    return channels != nullptr ? channels->adc_stream() : AdcStream{};
  }
  void send_adc(unsigned ic, const ConverterWords& words) override { gate_ics_.send_adc(ic, words, now_); }
  unsigned adc_lines(unsigned ic, bool b) override {
    const ServoChannels* channels = gate_ics_.channels(ic, now_);
    return channels != nullptr ? channels->adc_lines(b) : 0;
  }

  PwmTimes pwm_times(unsigned ic, unsigned channel) override {
    const ServoChannels* channels = gate_ics_.channels(ic, now_);
    return channels != nullptr ? channels->pwm_times(channel) : PwmTimes{};
  }

  // What may change: the blocks of the buses, which all have a next event, then what else feeds them.
  enum Part : unsigned {
    kBusSync,
    kIsaSlave,
    kHostPort,
    kDpram,
    kBusy,  // those before have events all the time that a bus is used, those from here on seldom
    kClockSelect = kBusy,
    kWatchdog,
    kInterruptController,
    kPic8259,
    kHostInterrupt,
    kHostSignals,
    kPanelPort,
    kSsi,
    kBlocks,
    kIcClocks = kBlocks,
    kPortAPins,
    kIsaPins,
    kConnectorPins,
    kStraps
  };
  using Parts = std::uint32_t;
  template <class... P>
  static constexpr Parts parts(P... p) {
    return ((1u << p) | ...);
  }
  static constexpr Parts kEveryBlock = (1u << kBlocks) - 1, kEverything = ~0u;

  // Those of the blocks in `which`, by their own types: this is the innermost loop of the model.
  template <class F>
  void each_block(Parts which, F f) {
    for (which &= kEveryBlock; which != 0; which &= which - 1) {
      switch (__builtin_ctz(which)) {
        case kBusSync:
          f(kBusSync, bus_sync_);
          break;
        case kClockSelect:
          f(kClockSelect, clock_select_);
          break;
        case kWatchdog:
          f(kWatchdog, watchdog_);
          break;
        case kIsaSlave:
          f(kIsaSlave, isa_slave_);
          break;
        case kHostPort:
          f(kHostPort, host_port_);
          break;
        case kInterruptController:
          f(kInterruptController, interrupt_controller_);
          break;
        case kPic8259:
          f(kPic8259, pic_8259_);
          break;
        case kHostInterrupt:
          f(kHostInterrupt, host_interrupt_);
          break;
        case kHostSignals:
          f(kHostSignals, host_signals_);
          break;
        case kDpram:
          f(kDpram, dpram_);
          break;
        case kPanelPort:
          f(kPanelPort, panel_port_);
          break;
        case kSsi:
          f(kSsi, ssi_);
          break;
      }
    }
  }

  struct IcAccess {  // of the CPU to a register of an IC, or of the serial encoder inputs
    bool read = false, write = false, ssi = false;
    unsigned number = 0;
    BusSync::Where where{};
    std::uint32_t wdata = 0;
  };

  void reset_all(Tick t);
  void drive_port_a();
  void execute(Tick t);
  IcAccess take_strobe(Tick t);
  void take_access(const IcAccess& ic, Tick t, Parts& changed);
  void select();
  Parts due(Tick t) const {  // blocks whose next event has come
    Parts which = 0;
    for (unsigned i = 0; i < (seldom_ <= t ? kBlocks : kBusy); ++i) which |= (next_[i] <= t ? 1u : 0u) << i;
    return which;
  }
  void schedule(Parts which);
  Tick next_event() const;
  Tick next_clock_event() const { return std::min(next_[kClockSelect], gate_ics_.next_clock_event()); }

  // Bytes, not values: what equal groups have between their fields may differ, which costs time only, and no new field
  // is forgotten here. Word by word, because a call of memcmp() costs more than it compares.
  template <class Group>
  static bool same(const Group& a, const Group& b) {
    using Word = std::conditional_t<sizeof(Group) >= 8, std::uint64_t, std::uint32_t>;
    static_assert(sizeof(Group) >= sizeof(Word));
    const auto word = [](const Group& group, std::size_t at) {
      Word w;
      std::memcpy(&w, reinterpret_cast<const unsigned char*>(&group) + at, sizeof w);
      return w;
    };
    constexpr std::size_t kLast = sizeof(Group) - sizeof(Word);  // may overlap the one before
    Word differ = word(a, kLast) ^ word(b, kLast);
    for (std::size_t at = 0; at < kLast; at += sizeof(Word)) differ |= word(a, at) ^ word(b, at);
    return differ == 0;
  }

  // board_wires.cpp. `changed`: what may show other values than before.
  void connect(Parts changed);
  void connect_port_a(Parts& changed);
  void connect_clocks(Parts& changed);
  void connect_host_port(Parts& changed);
  void connect_dpram(Parts& changed);
  void connect_interrupts(Parts& changed);
  void connect_host_interrupt(Parts& changed);
  void connect_isa(Parts& changed);
  void connect_panel(Parts& changed);
  void connect_ssi(Parts& changed);
  template <class Block>
  class Wires;
  BoardOutputs pins(Parts changed) const;
  void set_port_a_pins(BoardOutputs& o) const;
  // A trip turns the control outputs off; the reset that ends it clears the latch.
  std::uint32_t ctrl() const { return watchdog_.trip() ? 0u : host_signals_.ctrl(); }
  std::uint32_t selected_lines() const;  // IR5, IR6, IR7 of the interrupt controller

  bool show_pins();                       // updates outputs_ after an edge; true when a selected pin changed
  bool show_motors();                     // the same for the watched ICs
  std::uint32_t read_data(Tick t) const;  // of the selected register, after the edge t
  void take_straps(const Straps& straps, Tick t);

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
  HostInterrupt host_interrupt_;
  HostSignals host_signals_;
  Dpram dpram_;
  PanelPort panel_port_;
  Ssi ssi_;
  GateIcs gate_ics_;

  BoardInputs inputs_;
  Straps straps_;              // as taken over on clk_ref
  AddressSelect select_;       // of the address in bus_sync, while a strobe is shown
  bool strobe_wired_ = false;  // and the blocks of the buses have it
  // The board is in reset up to reset_end_, kNever while the pin is low: rtl/common/reset_sync.sv. From the first edge
  // of clk_ref that sees the pin high it is one period of clk_ref and two edges of clk_pwm.
  static constexpr Tick kResetRelease = kTicksPerRef + 2;
  bool held() const { return now_ < reset_end_; }
  Tick reset_end_ = kNever;
  bool in_reset_ = true;  // and an edge has been executed in it
  Tick now_ = 0;

  std::array<Tick, kBlocks> next_{};  // event of each block, as long as its inputs stay as they are
  Tick seldom_{}, first_{};           // of those from kBusy on, of all
  Tick next_own_{};                   // the board's: what follows a pin without a clock
  Parts touched_{};                   // blocks that have executed the edges up to now() and must be asked anew
  Parts shown_{};                     // what may have changed at the last edge
  bool straps_differ_{};              // from the pins
  std::uint32_t lines_{};             // of the interrupt controller, but for HREQ
  std::uint32_t equ_{};               // of the ICs, as wired to the interrupt controller
  BoardOutputs outputs_, stop_on_;
  std::array<MotorOutputs, kMaxServoIcs> motor_outputs_, stop_on_motor_, watched_motor_;
};

}  // namespace brick
