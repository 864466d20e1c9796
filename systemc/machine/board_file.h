// Reads boards/*.toml: what is fitted on a product. Every problem is a UsageError with one line: file, line, key,
// what was found, what was expected (docs/boards.md).
#pragma once

#include <string>

#include "systemc/machine/board_family.h"
#include "systemc/machine/machine.h"

namespace brick {

BoardConfig read_board_file(const std::string& path);

}  // namespace brick
