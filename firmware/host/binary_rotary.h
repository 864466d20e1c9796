/* Binary rotary transfer: program lines that the host writes into the dual-ported RAM go to the rotary buffers as they
 * are (host-bus:7). */
#ifndef FIRMWARE_HOST_BINARY_ROTARY_H
#define FIRMWARE_HOST_BINARY_ROTARY_H

void binary_rotary_initialize(void); /* no header is enabled */
void binary_rotary_pass(void);       /* background: I45 = 0 */
void binary_rotary_real_time(void);  /* real-time task: I45 = 1 */

#endif
