/* Run control of the coordinate systems (firmware:4.10, firmware:4.11), called by the command interpreter in the
 * background task. What stops (quit, abort, hold) is called by the real-time task too, for control characters. */
#ifndef FIRMWARE_RUN_RUN_CONTROL_H
#define FIRMWARE_RUN_RUN_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/motion/coordinate_system.h"

error_t run_point(uint32_t cs, double program);   /* B{n}: ERR001 while running; 0 is the rotary buffer */
error_t run_start(uint32_t cs, bool single_step); /* R, S: ERR015 no valid program, ERR016 its blocks */
error_t run_match(uint32_t cs);                   /* PMATCH: ERR001 while a move executes or waits, ERR015, ERR016 */
void run_quit(uint32_t cs);                       /* Q: what is calculated is finished, then the program stops */
void run_abort(uint32_t cs);                      /* A: calculated moves are lost, unread lines are kept */
void run_hold(uint32_t cs);                       /* H: the time base goes to 0 at Isx95 */
void run_stop_on_path(uint32_t cs);               /* `\`: as fast as the limits allow; outside of lookahead as H */
void run_by_state(uint32_t cs);                   /* an order by Isx21; any task that writes variables */
error_t run_forward(uint32_t cs);                 /* `>`: outside of lookahead as R */
error_t run_back(uint32_t cs);                    /* `<`: outside of lookahead as H */
void run_end_block(uint32_t cs);                  /* `/`: stop at the end of the executing move */
void run_calculating(uint32_t cs, struct program_trace* trace); /* PC: the line to be calculated next */
void run_executing(uint32_t cs, struct program_trace* trace);   /* PE: that of the move that executes, else as PC */
double run_time_base(uint32_t cs);                              /* %: present value */
error_t run_set_time_base(uint32_t cs, double percent);
bool run_is_running(uint32_t cs);
bool run_any_running(void);
void run_forget_rotary(uint32_t cs); /* the rotary buffer has gone: the pointer is no longer valid */

#endif
