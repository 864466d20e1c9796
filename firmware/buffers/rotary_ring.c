/* Cleared by rotary_initialize; changed by the rotary buffers and the buffer request alone. */
#include "firmware/buffers/rotary_ring.h"

#include "firmware/base/dimensions.h"

struct rotary rotary_buffers[COORDINATE_SYSTEMS];
