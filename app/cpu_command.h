// `brick cpu FILE.elf`: runs a bare RV32IMC program on the CPU model alone, without board and firmware.
#pragma once

#include <cstdint>
#include <string>

namespace brick {

// Runs `file` until it stores a value other than zero to its symbol `tohost` (1 = passed, 2n+1 = failed with code n),
// or until `max_instructions` have retired. Prints instructions, cycles, simulated time and rate. Returns 0 if the
// program passed, otherwise 1. Throws std::runtime_error for a file that cannot be run.
int cpu_command(const std::string& file, std::uint64_t max_instructions);

}  // namespace brick
