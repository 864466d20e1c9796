// The host's side of the bus: ISA / PC104 cycles with real edges (host-bus:3.4), the host port by polling or by
// interrupt, the interrupt controller and the dual-ported RAM window. Every call advances the machine; a host reads and
// drives pins only while the board stands at that time, so the result is the same on every engine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/machine/machine.h"
#include "testbench/host/isa_timing.h"

namespace brick {

// The board broke a rule of the bus cycle, e.g. held IOCHRDY low for longer than t10.
class HostBusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class HostBus {
 public:
  static constexpr std::uint32_t kIoBase = regs::host_io::kBase;
  static constexpr std::uint32_t kDpramWindow = regs::kDpramWindowBase;
  static constexpr std::uint32_t kDpramBytes = regs::kDpramWindowSize;
  static constexpr std::uint8_t kRxdf = regs::host_io::isr::kRxdf.mask();  // a character waits to be read
  static constexpr std::uint8_t kTxde = regs::host_io::isr::kTxde.mask();  // the next character may be written

  static constexpr std::uint32_t kCommand8259 = 8, kMask8259 = 9, kAcknowledge8259 = 10;

  explicit HostBus(Machine& machine) : machine_(machine) {}

  // Bus cycles --------------------------------------------------------------------------------------------------------
  std::uint8_t io_read(std::uint32_t offset);  // offset 0..15 from kIoBase
  void io_write(std::uint32_t offset, std::uint8_t value);
  std::uint8_t io_read(const regs::Register& byte) { return io_read(byte.address - kIoBase); }
  void io_write(const regs::Register& byte, std::uint8_t value) { io_write(byte.address - kIoBase, value); }
  std::uint16_t dpram_read(std::uint32_t byte_offset);  // even offsets
  void dpram_write(std::uint32_t byte_offset, std::uint16_t value);

  // Host port, host-bus:3.1 "polling recipe" -------------------------------------------------------------------------
  std::uint8_t port_status() { return io_read(regs::host_io::kIsr); }
  void pause_polling() { free_at_ += isa::kPollPause; }  // after a look at the status that found nothing
  bool tripped() const { return machine_.outputs().get(pin::kWdo) != 0; }  // line WDO: nobody will answer until a reset
  void open_port();                                                        // once: high and middle byte zero
  bool put_char(std::uint8_t c, Tick timeout);                             // spins on TXDE; false at the time-out
  std::optional<std::uint8_t> get_char(Tick timeout);                      // spins on RXDF

  // Interrupt controller, host-bus:4.1 -------------------------------------------------------------------------------
  struct Pic {
    std::uint8_t ist, sig, msk, elr;
  };
  Pic read_pic();
  std::uint8_t read_pic_status() { return io_read(regs::host_io::kPicStatus); }
  std::uint8_t read_pic_signals() { return io_read(regs::host_io::kPicSignal); }
  void write_pic_mask(std::uint8_t v);
  void write_pic_edge_level(std::uint8_t v);
  void clear_pic();

  // The 8259 in its place, host-bus:4.5.
  struct Pic8259 {
    std::uint8_t irr, isr, imr;
  };
  Pic8259 read_8259();
  std::uint8_t acknowledge_8259() { return io_read(kAcknowledge8259); }  // the vector
  void command_8259(std::uint8_t v) { io_write(kCommand8259, v); }       // ICW1, OCW2, OCW3
  void mask_8259(std::uint8_t v) { io_write(kMask8259, v); }             // OCW1; ICW2, ICW4 after ICW1

  // Time --------------------------------------------------------------------------------------------------------------
  Tick now() const { return machine_.now(); }
  void advance_to(Tick tick);
  void advance_to_stop(Tick limit);  // or to the end of the run that an edge ends (Machine::stop_on_motor)
  void wait(Tick ticks) { advance_to(now() + ticks); }
  void wait_change(const PinField& pin, Tick limit);  // to the pin's next change, or to tick `limit`
  bool wait_pin(const PinField& pin, std::uint32_t value, Tick timeout);  // stops at the edge; false at the time-out

  // Hooks -------------------------------------------------------------------------------------------------------------
  // `on_edge` is called at each change of a pin selected by `pins`, whatever the host does meanwhile.
  using EdgeHook = std::function<void(Tick, const BoardOutputs& before, const BoardOutputs& after)>;
  void watch(const BoardOutputs& pins, EdgeHook on_edge);
  void set_pace(std::function<unsigned()> idle_bclk) { pace_ = std::move(idle_bclk); }  // idle BCLKs before each cycle
  void set_heartbeat(std::function<void()> heartbeat) {
    heartbeat_ = std::move(heartbeat);
  }  // called often, for progress

  Machine& machine() { return machine_; }

 private:
  enum class Command { kIoRead, kIoWrite, kMemoryRead, kMemoryWrite };
  std::uint16_t cycle(Command command, std::uint32_t address, std::uint16_t data);
  void drive_at(TimeFs time, const std::function<void(HostInputs&)>& edit);
  TimeFs cycle_start();
  void step_to(Tick limit, const BoardOutputs& stop_on);

  Machine& machine_;
  TimeFs free_at_ = 0;  // the bus is free for the next cycle
  BoardOutputs watched_{};
  EdgeHook on_edge_;
  std::function<unsigned()> pace_;
  std::function<void()> heartbeat_;
};

}  // namespace brick
