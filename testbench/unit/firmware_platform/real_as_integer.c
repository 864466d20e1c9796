/* Must not compile: the whole part of Ixx17, 0.015625, is 0. The test lint.real_as_integer sees that it does not. */
#include "firmware/variables/i_variables.h"

int32_t limit(void);
int32_t limit(void) { return i_integer(i_motor(1, IXX17_ACCELERATION_LIMIT)); }
