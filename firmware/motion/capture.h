/* Where a motor was when its trigger came: from the capture registers of its servo channel (I7mn2 and I7mn3 choose the
 * edge), or where it is when the trigger is seen (Ixx97 bit 0). The trigger is the capture flag of Ixx25, or a warning
 * following error (Ixx97 bit 1). */
#ifndef FIRMWARE_MOTION_CAPTURE_H
#define FIRMWARE_MOTION_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

struct capture {
  volatile uint32_t *status, *position, *fraction; /* of the channel; null: there is none */
  bool on_error, in_software, with_fraction;
  uint32_t count_bits; /* of the table result below a count of the hardware */
};

/* Registers and modes of a motor (0..31) as its variables have them. Background and real-time task. */
struct capture capture_make(uint32_t motor);
void capture_arm(const struct capture* capture); /* S: what was captured before does not count */
/* S: whether the trigger came, and the actual position then. */
bool capture_servo(uint32_t motor, const struct capture* capture, int64_t* position);

#endif
