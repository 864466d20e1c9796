// Reads boards/*.toml: what is fitted on a product. Every problem is a BoardFileError with one line: file, line, what is
// wrong, what was expected.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"

namespace brick {

class BoardFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

BoardConfig read_board_file(const std::string& path);

// Names of the fitted ICs, e.g. "servo IC 0", "servo IC 2*", "MACRO IC 0", in the order of BoardInputs::fitted.
std::vector<std::string> fitted_ic_names(std::uint32_t fitted);

}  // namespace brick
