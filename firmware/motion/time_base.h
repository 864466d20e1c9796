/* The time base of a coordinate system: what its trajectory time grows by at each servo cycle, 100 % being I10. `%`, a
 * host or program that writes its word of memory, and the hold of H command it; the servo task slews it there. */
#ifndef FIRMWARE_MOTION_TIME_BASE_H
#define FIRMWARE_MOTION_TIME_BASE_H

#include <stdint.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/variables/i_variables.h"

void time_base_slew(uint32_t cs, int32_t target, enum i_name rate); /* servo and real-time tasks held off */
/* From the next servo cycle on, at Isx94; while H holds the system, or motors are about to leave the path, it is kept
 * for the end of that. */
void time_base_command(uint32_t cs, int32_t command);
void time_base_stay(uint32_t cs);  /* as it is: motors are about to leave the path, which must not quicken for that */
void time_base_go_on(uint32_t cs); /* to what is commanded, behind that or a hold, which ends; the latter at Isx95 */
int32_t time_base_external(const struct coordinate_system* s); /* of Isx93: one that runs backwards stops */
void time_base_initialize(void);                               /* start-up: Isx93 of all */
void time_base_source_changed(uint32_t cs);                    /* Isx93 has been written */
void time_base_slew_changed(uint32_t cs); /* Isx94 has been written: it acts at once, but for a hold */

#endif
