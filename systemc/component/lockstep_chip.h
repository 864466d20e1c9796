// Two chips of different engines as one, compared at each edge that the model says may change anything, and wherever
// the RTL changes something. The first difference of a pin or of what a read takes is the error /brick/lockstep.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "systemc/component/chip.h"
#include "systemc/component/include/brick/pins.h"

namespace brick::component {

// `name`: of the block, for messages.
std::unique_ptr<Chip> lockstep_chip(std::string name, std::unique_ptr<Chip> rtl, std::unique_ptr<Chip> model,
                                    const std::vector<PinInfo>& table);

}  // namespace brick::component
