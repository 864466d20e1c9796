// Times as people write them: 10ms, 2.5us, 400ns, 1s.
#pragma once

#include <string>

#include "systemc/core/ticks.h"

namespace brick {

// Femtoseconds, exact. Throws UsageError that says what was expected.
TimeFs parse_time(const std::string& text);

}  // namespace brick
