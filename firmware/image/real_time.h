/* The real-time task. */
#ifndef FIRMWARE_IMAGE_REAL_TIME_H
#define FIRMWARE_IMAGE_REAL_TIME_H

void real_time(void); /* one real-time interrupt */

#endif
