/* 48-bit floating-point words (X = high mantissa, Y = low mantissa and exponent), as the user sees them with RL. */
#ifndef FIRMWARE_BASE_FLOAT48_H
#define FIRMWARE_BASE_FLOAT48_H

#include <stdint.h>

struct float48 {
  uint32_t x, y;
};
struct float48 float48_pack(double value);
double float48_unpack(struct float48 word);
double float48_round(double value); /* to what the word holds of it */

#endif
