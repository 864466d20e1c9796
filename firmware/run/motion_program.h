/* The program of each coordinate system, rotary or fixed: its executor and the calls it is in. Real-time task; the
 * background changes it while the system does not run and is not being calculated. */
#ifndef FIRMWARE_RUN_MOTION_PROGRAM_H
#define FIRMWARE_RUN_MOTION_PROGRAM_H

#include "firmware/base/dimensions.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/executor.h"

/* Where a fixed program is entered: a word of it, its top or a label, and the line in which that stands. */
struct program_entry {
  uint32_t offset, line;
};

struct motion_program {
  struct executor x;
  struct program_position callers[CALL_DEPTH];
  uint32_t depth; /* calls under way */
  bool reading;   /* READ stands at its caller's values; its own place is kept in: */
  struct program_position reader;
  uint32_t move;      /* offset of the statement with which the move being collected begins */
  uint8_t move_loops; /* x.at.loop_count there: the line's end has left one */
  bool in_block;      /* between BLOCKSTART and BLOCKSTOP */
  bool asks_time;     /* MOVETIME: of the next move */
  bool labelled;      /* nothing but labels of the line has been executed */
  struct {
    bool on;
    struct instruction call; /* before each line that begins with a move */
  } prelude;
  bool under_way;       /* a stop waits for the end of the line */
  uint32_t interrupt;   /* real-time interrupt that these belong to: */
  uint32_t lines;       /* worked off in it */
  uint32_t jumps_begin; /* x.jumps_back at its begin, or at the last move */
};

static const struct program_entry program_top = {0, 0};

extern struct motion_program motion_programs[COORDINATE_SYSTEMS];

/* Nothing of it is begun. `entry`: of a fixed program. */
void motion_program_point(uint32_t cs, bool rotary, uint32_t number, struct program_entry entry);
void motion_program_restart(uint32_t cs);                            /* the same once more */
void motion_program_forget_line(uint32_t cs);                        /* what has been collected of one */
void motion_program_end_read(struct motion_program* p);              /* back from the caller's values, if it is there */
void motion_program_drop_line(struct motion_program* p);             /* what is left of a begun line is lost */
void motion_program_trace(uint32_t cs, struct program_trace* trace); /* the line under way */
void motion_program_next(uint32_t cs, struct program_trace* trace);  /* background: the line to be calculated next */

#endif
