#include <brick/host_signals.h>
#include <brick/interrupt_controller.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>
#include <brick/watchdog.h>

#include "systemc/board/model_board.h"
#include "systemc/component/board_chip.h"
#include "systemc/component/lockstep_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/cosim/engines.h"

namespace brick::component {
namespace {

// An Engine's seed is for flip-flops, a board's for its memory; a Verilated board takes one for both.
std::unique_ptr<brick::Board> rtl_board(std::uint32_t fitted, std::uint64_t seed) {
  RtlOptions options;
  options.seed = seed;
  try {
    return make_rtl_board(fitted, options);
  } catch (const std::runtime_error& error) {
    SC_REPORT_ERROR("/brick/fitted", error.what());
    return nullptr;
  }
}

class RtlFactory final : public ChipFactory {
 public:
  explicit RtlFactory(std::uint64_t seed) : seed_(seed) {}
  std::unique_ptr<Chip> servo_ic() const override { return rtl_servo_ic(seed_); }
  std::unique_ptr<Chip> interrupt_controller() const override { return rtl_interrupt_controller(seed_); }
  std::unique_ptr<Chip> host_signals() const override { return rtl_host_signals(seed_); }
  std::unique_ptr<Chip> watchdog() const override { return rtl_watchdog(seed_); }
  std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const override {
    return board_chip(rtl_board(fitted, seed), fitted, false);
  }

 private:
  std::uint64_t seed_;
};

class LockstepFactory final : public ChipFactory {
 public:
  explicit LockstepFactory(std::uint64_t seed) : rtl_(seed) {}
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
  std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const override {
    return board_chip(make_lockstep_board(rtl_board(fitted, seed), make_model_board(fitted, seed)), fitted, false);
  }

 private:
  RtlFactory rtl_;
  ModelFactory model_;
};

}  // namespace

Engine rtl_engine(std::uint64_t seed) { return Engine(std::make_shared<RtlFactory>(seed)); }
Engine lockstep_engine(std::uint64_t seed) { return Engine(std::make_shared<LockstepFactory>(seed)); }

}  // namespace brick::component
