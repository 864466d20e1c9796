/* Divisions and roots of the planner in integers: some 150 cycles where soft floating point takes 1000. Parts are those
 * of motion/fixed_point.h. */
#ifndef FIRMWARE_MOTION_FIXED_RATIO_H
#define FIRMWARE_MOTION_FIXED_RATIO_H

#include <stdint.h>

/* What divides by `by` << `shift`, which has bit 63 set: 2^126 / that, good to 2^-58 of it. */
struct fixed_divisor {
  uint64_t inverse;
  uint32_t shift;
};
struct fixed_divisor fixed_divide_by(uint64_t by); /* above 0 */

/* value / by as a part, for 0 <= value <= by. */
int64_t fixed_part_of(const struct fixed_divisor* by, int64_t value);
int64_t fixed_ratio(int64_t value, int64_t by);

/* 2^32 value / by, for value < by / 2: too small by 2^-28 of it and 2 at most, too large by 2^-30 of it. */
uint32_t fixed_fraction(uint32_t value, uint32_t by);

/* Root of 0..2^30, where 2^30 is 1; good to 2^-26 of it. */
uint32_t fixed_root(uint32_t square);

#endif
