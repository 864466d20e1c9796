// What `--plant` stands at the motor side: the axes of a TOML file (docs/plant.md). Every mistake is a UsageError of
// one line: file, line, key, what was found, what was expected.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/plant/plant.h"

namespace brick {

// `fitted`: the servo ICs of the board. `seed` is what the file's own replaces.
plant::PlantParameters read_plant_file(const std::string& path, std::uint32_t fitted, std::uint64_t seed);

// A cause of `trip` and a mask of ChannelPin by their names in the file. Throw UsageError.
plant::Amplifier::Fault amplifier_fault(const std::string& cause);
std::uint16_t channel_pins(const std::vector<std::string>& names);

}  // namespace brick
