/* What protection (motion/protection.h) has found of the motors of a coordinate system, for status words and the lines
 * of the interrupt controller: in position, tripped, warned (motion:6.5). */
#ifndef FIRMWARE_MOTION_SYSTEM_FINDINGS_H
#define FIRMWARE_MOTION_SYSTEM_FINDINGS_H

#include <stdbool.h>
#include <stdint.h>

void system_findings_initialize(void);
/* As found, and not jogged since: who asks at once behind a command would take it for done. */
bool motor_in_position(uint32_t motor); /* 0..31 */
bool system_in_position(uint32_t cs);   /* all motors of a coordinate system; false: it has none */
/* Real-time task: IPOS, EROR, F1ER of the system that the host or the panel has selected. */
void system_findings_show(void);

#endif
