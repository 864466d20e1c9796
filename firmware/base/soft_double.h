/* Products and quotients of doubles, which the CPU does not have. The compiler calls them by the names of its own
 * library, which takes two to three times as long for them; results are the same to the last bit. */
#ifndef FIRMWARE_BASE_SOFT_DOUBLE_H
#define FIRMWARE_BASE_SOFT_DOUBLE_H

#ifdef BRICK_NATIVE
#define SOFT_DOUBLE_NAME(name)
#else
#define SOFT_DOUBLE_NAME(name) __asm__(name)
#endif

double soft_double_product(double a, double b) SOFT_DOUBLE_NAME("__muldf3");
double soft_double_quotient(double a, double b) SOFT_DOUBLE_NAME("__divdf3");

#endif
