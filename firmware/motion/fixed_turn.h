/* Cosine and sine in integers, as parts of motion/fixed_point.h. */
#ifndef FIRMWARE_MOTION_FIXED_TURN_H
#define FIRMWARE_MOTION_FIXED_TURN_H

#include <stdint.h>

enum { FIXED_TURN_BITS = 58 }; /* an angle: 2^58 is a turn */

struct fixed_direction {
  int64_t cosine, sine;
};
struct fixed_direction fixed_direction_of(int64_t angle); /* good to 2^-39 */

#endif
