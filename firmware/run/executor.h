/* Execution of stored statements: assignments and logic, which all programs share. Motion programs, rotary buffers,
 * PLCs and kinematic programs each have an executor, and do themselves what is theirs alone:
 *
 *   struct instruction in;
 *   switch (executor_step(&x, &in)) {      one word; between two steps another program may be executed
 *     case EXECUTED_WORD:                  more of the line is to come
 *     case EXECUTED_LINE:                  a line has ended; x.jumps_back: how often execution has gone back so far
 *     case EXECUTED_STATEMENT:             not a shared one, not consumed yet: `in` with its value, popped or not.
 *                                          Do it, then executor_pass(&x) gives EXECUTED_WORD or EXECUTED_LINE
 *     case EXECUTED_LATER:                 nothing can be read now: again at the next interrupt or pass
 *     case EXECUTED_END:                   RETURN or the end of a fixed program. Not consumed: it comes again
 *     case EXECUTED_ERROR:                 no such word, or the program's structure is damaged: x.error
 *
 * Used in the real-time task within a slice (pauses between the words it skips), or in the background. */
#ifndef FIRMWARE_RUN_EXECUTOR_H
#define FIRMWARE_RUN_EXECUTOR_H

#include "firmware/language/evaluator.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/program_reader.h"

enum { ONE_LINE_LOOPS = 8 }; /* WHILEs in one line, each governing the rest of it */

enum executed { EXECUTED_WORD, EXECUTED_LINE, EXECUTED_STATEMENT, EXECUTED_LATER, EXECUTED_END, EXECUTED_ERROR };

/* Where a program stands. All that a call has to keep. */
struct program_position {
  struct program_reader reader;
  uint32_t line;      /* offset of the line under way */
  uint32_t statement; /* and of the statement */
  bool begun;         /* its first word has been executed */
  bool in_line;       /* words of the line have been executed, and others follow */
  uint16_t loops[ONE_LINE_LOOPS];
  uint8_t loop_count;
};

struct executor {
  struct program_position at;
  uint32_t cs; /* whose Q-variables */
  uint32_t jumps_back;
  uint32_t prefix; /* OP_PREFIX: added to the number of the next command */
  struct evaluator evaluator;
  struct {
    uint32_t kind; /* CONDITION_IF, CONDITION_WHILE */
    bool open;     /* AND(..) or OR(..) may follow */
    bool inner_any, inner_all, any, all;
  } condition;
  enum run_time_error error; /* with EXECUTED_ERROR: the cause, where it is not the statement itself */
};

static inline enum executed executor_fail(struct executor* x, enum run_time_error error) {
  x->error = error;
  return EXECUTED_ERROR;
}

void executor_begin(struct executor* x, uint32_t cs); /* at.reader is the caller's */
enum executed executor_step(struct executor* x, struct instruction* in);
enum executed executor_pass(struct executor* x);
enum executed executor_jump(struct executor* x, uint32_t offset); /* EXECUTED_LINE */
enum executed executor_end_line(struct executor* x); /* a line's end that was reached by other means than a step */
void executor_back(struct executor* x); /* fixed program: to the begin of the statement, which has not been executed;
                                           the loops of its line go on */
void executor_skip_line(struct executor* x);                                 /* what is left of a begun line is lost */
bool executor_text_word(struct executor* x, uint32_t index, word48_t* word); /* raw word behind OP_TEXT */
bool executor_next(struct executor* x, struct instruction* in); /* what the next value is for, without executing it */

#endif
