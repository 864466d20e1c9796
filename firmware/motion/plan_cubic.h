/* PVT and SPLINE moves (motion:5.4): one cubic from way point to way point. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PLAN_CUBIC_H
#define FIRMWARE_MOTION_PLAN_CUBIC_H

#include <stdint.h>

void plan_pvt(uint32_t cs);
void plan_spline(uint32_t cs);
void plan_spline_anew(uint32_t cs); /* the calculated one does not go on with the sequence before it: from rest */

#endif
