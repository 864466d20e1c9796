/* The encoder conversion table, I8000 to I8191 (motion:2): what motors follow is its results, X of each entry's last
 * line. First thing of each servo interrupt. */
#ifndef FIRMWARE_MOTION_CONVERSION_TABLE_H
#define FIRMWARE_MOTION_CONVERSION_TABLE_H

#include <stdbool.h>
#include <stdint.h>

void conversion_table_initialize(void);               /* start-up, after the I-variables */
void conversion_table_changed(uint32_t instance);     /* a line was written. Background, real-time task */
void conversion_table_servo(void);                    /* servo task: every entry once */
void conversion_table_pass(void);                     /* background: lines that the servo task changed */
bool conversion_table_is_not_built(uint32_t address); /* X:address is the result of a method $F, which stays 0 */

#endif
