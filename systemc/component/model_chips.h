// Makers of the chips of the SystemC model.
#pragma once

#include <memory>

#include "systemc/component/chip.h"

namespace brick::component {

std::unique_ptr<Chip> model_servo_ic();
std::unique_ptr<Chip> model_interrupt_controller();

std::unique_ptr<Chip> model_host_signals();
std::unique_ptr<Chip> model_watchdog();
std::unique_ptr<Chip> model_ssi();
std::unique_ptr<Chip> model_macro_ic();
std::unique_ptr<Chip> model_clock_select();
std::unique_ptr<Chip> model_host_port();
std::unique_ptr<Chip> model_dpram(std::uint64_t seed);
std::unique_ptr<Chip> model_board(std::uint32_t fitted, std::uint64_t seed);

class ModelFactory : public ChipFactory {
 public:
  std::unique_ptr<Chip> servo_ic() const override { return model_servo_ic(); }
  std::unique_ptr<Chip> interrupt_controller() const override { return model_interrupt_controller(); }
  std::unique_ptr<Chip> host_signals() const override { return model_host_signals(); }
  std::unique_ptr<Chip> watchdog() const override { return model_watchdog(); }
  std::unique_ptr<Chip> ssi() const override { return model_ssi(); }
  std::unique_ptr<Chip> macro_ic() const override { return model_macro_ic(); }
  std::unique_ptr<Chip> clock_select() const override { return model_clock_select(); }
  std::unique_ptr<Chip> host_port() const override { return model_host_port(); }
  std::unique_ptr<Chip> dpram(std::uint64_t ram_seed) const override { return model_dpram(ram_seed); }
  std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const override {
    return model_board(fitted, seed);
  }
};

}  // namespace brick::component
