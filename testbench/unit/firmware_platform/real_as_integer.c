/* Must not compile: the whole part of Ixx17, 0.015625, is 0. The test lint.real_as_integer sees that it does not.
 * With BRICK_INTEGER it must: what is refused is the real alone. */
#include "firmware/variables/i_variables.h"

int32_t limit(void);
#ifdef BRICK_INTEGER
int32_t limit(void) { return i_integer(i_motor(1, IXX00_ACTIVATED)); }
#else
int32_t limit(void) { return i_integer(i_motor(1, IXX17_ACCELERATION_LIMIT)); }
#endif
