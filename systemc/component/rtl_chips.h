// Makers of the Verilated chips. Free of Verilator, whose headers and SystemC's do not go into one file.
#pragma once

#include <cstdint>
#include <memory>

#include "systemc/component/chip.h"

namespace brick::component {

std::unique_ptr<Chip> rtl_servo_ic(std::uint64_t seed);
std::unique_ptr<Chip> rtl_interrupt_controller(std::uint64_t seed);
std::unique_ptr<Chip> rtl_host_signals(std::uint64_t seed);
std::unique_ptr<Chip> rtl_watchdog(std::uint64_t seed);
std::unique_ptr<Chip> rtl_ssi(std::uint64_t seed);
std::unique_ptr<Chip> rtl_macro_ic(std::uint64_t seed);
std::unique_ptr<Chip> rtl_clock_select(std::uint64_t seed);
std::unique_ptr<Chip> rtl_host_port(std::uint64_t seed);
std::unique_ptr<Chip> rtl_dpram(std::uint64_t seed, std::uint64_t ram_seed);

}  // namespace brick::component
