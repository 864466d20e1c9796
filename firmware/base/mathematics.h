/* Elementary functions in double precision, good to about 1e-15 relative for moderate arguments; there is no C library
 * in the image. Domain errors follow firmware:10/9: 0 or the largest magnitude, never an error. */
#ifndef FIRMWARE_BASE_MATHEMATICS_H
#define FIRMWARE_BASE_MATHEMATICS_H

#include <stdbool.h>
#include <stdint.h>

#define MATH_LARGEST \
  140737488355328.0 /* 2^47: what a division by zero saturates to, the report limit of firmware:1.6 */

/* Called between the steps of long functions, so that a task that has little time can go on later: image/tables.c. */
extern void (*const mathematics_pause)(void);

double math_floor(double x);
double math_absolute(double x);
double math_square_root(double x);
double math_sine(double x, int degrees);
double math_cosine(double x, int degrees);
double math_tangent(double x, int degrees);
double math_arc_sine(double x, int degrees);
double math_arc_cosine(double x, int degrees);
double math_arc_tangent(double x, int degrees);
double math_arc_tangent2(double y, double x, int degrees);
double math_logarithm(double x);
double math_exponential(double x);
double math_divide(double a, double b);
double math_modulo(double a, double b); /* [0, b), or [-n, n) for b = -n */
int64_t math_to_integer(double x);      /* floor, saturating at +-2^62 */
int64_t math_nearest(double x);         /* halves away from 0, saturating at +-2^47; what is no number too */

/* Of two's complements with their fractions, 61 bits below the larger operand. */
enum math_bits { MATH_AND, MATH_OR, MATH_XOR };
double math_bitwise(enum math_bits operation, double a, double b);

bool math_is_finite(double x);
double math_scale(double m, int exponent); /* m * 2^exponent, 0 on underflow */

/* Without floating-point arithmetic: x as mantissa * 2^(exponent - bits), 2^(bits-1) <= |mantissa| < 2^bits, rounded to
 * nearest; true when exact. And back, mantissa * 2^exponent for |mantissa| up to 2^53. */
bool math_to_fixed(double x, unsigned bits, int64_t* mantissa, int* exponent);
double math_from_fixed(int64_t mantissa, int exponent);

#endif
