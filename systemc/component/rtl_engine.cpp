#include <brick/clock_select.h>
#include <brick/dpram.h>
#include <brick/host_port.h>
#include <brick/host_signals.h>
#include <brick/interrupt_controller.h>
#include <brick/macro_ic.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>
#include <brick/ssi.h>
#include <brick/watchdog.h>

#include "systemc/board/model_board.h"
#include "systemc/component/board/board_chip.h"
#include "systemc/component/board/board_options.h"
#include "systemc/component/lockstep_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/rtl_chips.h"

namespace brick::component {
namespace {

class RtlFactory final : public ChipFactory {
 public:
  explicit RtlFactory(std::uint64_t seed) : seed_(seed) {}
  std::unique_ptr<Chip> servo_ic() const override { return rtl_servo_ic(seed_); }
  std::unique_ptr<Chip> interrupt_controller() const override { return rtl_interrupt_controller(seed_); }
  std::unique_ptr<Chip> host_signals() const override { return rtl_host_signals(seed_); }
  std::unique_ptr<Chip> watchdog() const override { return rtl_watchdog(seed_); }
  std::unique_ptr<Chip> ssi() const override { return rtl_ssi(seed_); }
  std::unique_ptr<Chip> macro_ic() const override { return rtl_macro_ic(seed_); }
  std::unique_ptr<Chip> clock_select() const override { return rtl_clock_select(seed_); }
  std::unique_ptr<Chip> host_port() const override { return rtl_host_port(seed_); }
  std::unique_ptr<Chip> dpram(std::uint64_t ram_seed) const override { return rtl_dpram(seed_, ram_seed); }
  std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const override {
    return board_chip(make_rtl_board(fitted, board_options(seed_, seed)), fitted, false);
  }

 private:
  std::uint64_t seed_;
};

class LockstepFactory final : public ChipFactory {
 public:
  explicit LockstepFactory(std::uint64_t seed) : seed_(seed), rtl_(seed) {}
  std::unique_ptr<Chip> servo_ic() const override {
    return lockstep_chip("servo_ic", rtl_.servo_ic(), model_.servo_ic(), ServoIc::pin_table());
  }
  std::unique_ptr<Chip> interrupt_controller() const override {
    return lockstep_chip("interrupt_controller", rtl_.interrupt_controller(), model_.interrupt_controller(),
                         InterruptController::pin_table());
  }
  std::unique_ptr<Chip> host_signals() const override {
    return lockstep_chip("host_signals", rtl_.host_signals(), model_.host_signals(), HostSignals::pin_table());
  }
  std::unique_ptr<Chip> watchdog() const override {
    return lockstep_chip("watchdog", rtl_.watchdog(), model_.watchdog(), Watchdog::pin_table());
  }
  std::unique_ptr<Chip> ssi() const override {
    return lockstep_chip("ssi", rtl_.ssi(), model_.ssi(), Ssi::pin_table());
  }
  std::unique_ptr<Chip> macro_ic() const override {
    return lockstep_chip("macro_ic", rtl_.macro_ic(), model_.macro_ic(), MacroIc::pin_table());
  }
  std::unique_ptr<Chip> clock_select() const override {
    return lockstep_chip("clock_select", rtl_.clock_select(), model_.clock_select(), ClockSelect::pin_table());
  }
  std::unique_ptr<Chip> host_port() const override {
    return lockstep_chip("host_port", rtl_.host_port(), model_.host_port(), HostPort::pin_table());
  }
  std::unique_ptr<Chip> dpram(std::uint64_t ram_seed) const override {
    return lockstep_chip("dpram", rtl_.dpram(ram_seed), model_.dpram(ram_seed), Dpram::pin_table());
  }
  std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const override {
    return board_chip(
        make_lockstep_board(make_rtl_board(fitted, board_options(seed_, seed)), make_model_board(fitted, seed)), fitted,
        false);
  }

 private:
  std::uint64_t seed_;
  RtlFactory rtl_;
  ModelFactory model_;
};

}  // namespace

Engine rtl_engine(std::uint64_t seed) { return Engine(std::make_shared<RtlFactory>(seed)); }
Engine lockstep_engine(std::uint64_t seed) { return Engine(std::make_shared<LockstepFactory>(seed)); }

}  // namespace brick::component
