/* What a sequence that is looked ahead is told: to stop on its path, and in which direction to go on (motion:7.5). */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_ORDER_H
#define FIRMWARE_MOTION_LOOKAHEAD_ORDER_H

enum lookahead_order {
  LOOKAHEAD_NONE,
  LOOKAHEAD_STOP,
  LOOKAHEAD_FORWARD,
  LOOKAHEAD_BACKWARD,
  LOOKAHEAD_ONE_FORWARD, /* a segment */
  LOOKAHEAD_ONE_BACKWARD
};

#endif
