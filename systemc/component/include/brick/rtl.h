// The engines with the Verilated RTL, of the library brick::rtl. In lock-step the first difference of any pin or
// register value is the error /brick/lockstep, which names tick, pin and both values.
#pragma once

#include <cstdint>

#include <brick/engine.h>

namespace brick::component {

// `seed`: what flip-flops hold before their reset; 0 all zero. No pin depends on it.
Engine rtl_engine(std::uint64_t seed = 1);
Engine lockstep_engine(std::uint64_t seed = 1);

}  // namespace brick::component
