// What `--plant` stands at the motor side: the axes of a TOML file (docs/plant.md). Every mistake is a UsageError of
// one line: file, line, key, what was found, what was expected.
#pragma once

#include <cstdint>
#include <string>

#include "testbench/plant/plant.h"

namespace brick {

// `fitted`: the servo ICs of the board. `seed` is what the file's own replaces.
plant::PlantParameters read_plant_file(const std::string& path, std::uint32_t fitted, std::uint64_t seed);

}  // namespace brick
