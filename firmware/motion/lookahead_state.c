#include "firmware/motion/lookahead_state.h"

struct look looks[COORDINATE_SYSTEMS];
