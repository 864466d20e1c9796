// The engines as tests that have them as a parameter name them.
#pragma once

#include <string>

#include <brick/rtl.h>

namespace brick::component {

inline Engine engine_named(const std::string& name) {
  return name == "model" ? model_engine() : name == "rtl" ? rtl_engine() : lockstep_engine();
}
inline Engine model_or_rtl(bool rtl) { return rtl ? rtl_engine() : model_engine(); }

}  // namespace brick::component
