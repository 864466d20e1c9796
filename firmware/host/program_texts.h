/* Texts of programs (firmware:6.7, firmware:7.2): those that are sent go to the port while it has room, commands to the
 * command interpreter. Background task. */
#ifndef FIRMWARE_HOST_PROGRAM_TEXTS_H
#define FIRMWARE_HOST_PROGRAM_TEXTS_H

void program_texts_initialize(void);
void program_texts_pass(void); /* what has room is sent; one command a task that executes programs */

#endif
