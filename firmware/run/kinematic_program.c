#include "firmware/run/kinematic_program.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/jog_plan.h"
#include "firmware/motion/jog_state.h"
#include "firmware/variables/i_variables.h"

/* Of one run: what takes more is taken to go on for ever (motion:8.1/7). Others wait for it, so it is time that counts,
 * of slices: half of all time, 2,100 cycles a word. In all it is less than what paths of others have ahead
 * (motion/segment_sequence.h). The words are for a clock that stands. */
enum { LIMIT_MS = 10, WORDS_LIMIT = 5000 };

static struct executor x;

static enum run_time_error end_of(enum executed executed) {
  if (executed == EXECUTED_END) return RUN_TIME_NONE;
  return x.error != RUN_TIME_NONE ? x.error : RUN_TIME_STATEMENT;
}

enum run_time_error kinematic_program_execute(uint32_t cs, enum fixed_kind kind) {
  reader_fixed(&x.at.reader, kind, cs, 0);
  executor_begin(&x, cs);
  const uint32_t began = slice_spent(), limit = LIMIT_MS * hal_cycles_per_ms();
  for (uint32_t words = 0; words < WORDS_LIMIT && slice_spent() - began < limit;) {
    struct instruction in;
    if (jogs_asked != 0) (void)jog_plan(); /* ramps of an abort do not wait for it */
    const enum executed executed = executor_step(&x, &in);
    if (executed == EXECUTED_WORD || executed == EXECUTED_LINE)
      words++;
    else if (executed != EXECUTED_LATER) /* programs have just been moved: soon */
      return end_of(executed);
    slice_pause();
  }
  return RUN_TIME_KINEMATIC;
}

static error_t check(uint32_t cs, enum fixed_kind kind) {
  if (fixed_program_find(kind, cs) == 0) return ERR_NO_PROGRAM;
  return reader_check(kind, cs) != READER_BAD ? ERR_NONE : ERR_BAD_PROGRAM;
}

static bool needs_inverse(uint32_t cs) {
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (axis_definitions[motor].assigned && axis_definitions[motor].cs == cs && axis_definitions[motor].kinematic)
      return true;
  return false;
}

error_t kinematic_program_check(uint32_t cs) {
  if (i_integer(i_cs(cs, ISX50_KINEMATICS)) == 0) return ERR_NONE;
  const error_t error = check(cs, FIXED_FORWARD);
  return error != ERR_NONE || !needs_inverse(cs) ? error : check(cs, FIXED_INVERSE);
}
