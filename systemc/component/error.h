// An error of a component. It throws even where SC_ERROR is set not to: nothing sensible could follow.
#pragma once

#include <stdexcept>
#include <string>

#include <systemc>

namespace brick::component {

[[noreturn]] inline void raise_error(const char* type, const std::string& text) {
  SC_REPORT_ERROR(type, text.c_str());
  throw std::runtime_error(std::string(type) + ": " + text);
}

}  // namespace brick::component
