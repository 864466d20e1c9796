#include "firmware/motion/segment_sequence.h"

struct sequence sequences[COORDINATE_SYSTEMS];
int64_t segment_control[MOTORS][SPLINE_POINTS];
