// `brick control`: a started controller for a program that holds its clock (docs/control.md).
#pragma once

#include <string>

#include "app/options.h"

namespace brick {

struct ControlOptions {
  RunOptions run;
  std::string place;      // a path, or fd:N
  bool realtime = false;  // between calls simulated time follows the clock on the wall
  int end_with = 0;       // process that it ends with, 0: none
};
int control_command(const ControlOptions& options);

}  // namespace brick
