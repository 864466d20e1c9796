#include "firmware/motion/rollover.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/variables/i_variables.h"

#define BAND_UNITS 16.0 /* of Ixx28 in a count */

/* Up to half a turn either way. */
static double shortest(double way, double turn) {
  slice_pause();
  const double part = math_modulo(way, turn);
  slice_pause();
  const double shorter = part > turn * 0.5 ? part - turn : part;
  slice_pause();
  return shorter;
}

double rollover_target(uint32_t motor, double from, double to, bool negative) {
  const double turn = i_variable_read(I_MOTOR_BLOCK * (motor + 1u) + (uint32_t)IXX27_ROLLOVER);
  if (turn == 0.0) return to;
  if (turn > 0.0) return from + shortest(to - from, turn);
  const double near = math_absolute(shortest(to - from, -turn));
  if (near * BAND_UNITS < i_variable_read(i_motor(motor + 1u, IXX28_IN_POSITION_BAND))) return from;
  return negative ? from - math_modulo(from - to, -turn) : from + math_modulo(to - from, -turn);
}
