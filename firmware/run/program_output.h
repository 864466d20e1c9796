/* SEND, COMMAND and DISPLAY of programs (firmware:7.2): texts are queued, and the background sends them or gives them
 * to the command interpreter (host/program_texts.h). */
#ifndef FIRMWARE_RUN_PROGRAM_OUTPUT_H
#define FIRMWARE_RUN_PROGRAM_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/language/word.h"
#include "firmware/run/text_queue.h"

enum program_port { PORT_ACTIVE, PORT_SERIAL, PORT_PARALLEL, PORT_DPRAM, PORT_AUXILIARY }; /* SEND, S, P, R, A */

/* The task that executes the program: each fills queues of its own. */
enum program_task { PROGRAM_BACKGROUND, PROGRAM_REAL_TIME, PROGRAM_TASKS };

enum program_output {
  OUTPUT_DONE,
  OUTPUT_LATER,  /* no room: the statement is to be executed again; nothing has happened */
  OUTPUT_ILLEGAL /* no such statement: a damaged program */
};

struct program_caller {
  enum program_task task;
  uint32_t cs, motor; /* addressed, from 0 */
};

void program_output_initialize(void);

/* An OP_TEXT statement. `raw`: the words behind it, word_raw_count(in) of them. */
enum program_output program_output_text(const struct instruction* in, const word48_t* raw,
                                        const struct program_caller* caller);

/* OP_LIST with the key DISPLAY_VALUE, its value popped. */
void program_output_value(const struct instruction* in, double value);

/* Background. */
extern struct text_queue send_queues[PROGRAM_TASKS], command_queues[PROGRAM_TASKS];

#endif
