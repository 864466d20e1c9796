/* Run control. Requests are flags that the real-time and servo tasks act on; only an abort reaches into the moves, with
 * both tasks held off. */
#include "firmware/run/run_control.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/position.h"
#include "firmware/variables/i_variables.h"

#define LARGEST_PERCENT 225.0
#define LARGEST_PROGRAM 32767.99999

/* The executing and the calculated move are dropped where the axes are now. */
static void drop_moves(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  double position[AXIS_COUNT];
  uint32_t state = hal_mask_servo();
  cs_present_position(s, position);
  s->active = s->next_valid = s->blend_decided = s->may_join = false;
  s->pending_axes = 0;
  s->evaluator.depth = 0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    s->position[axis] = position[axis];
    s->velocity[axis] = 0.0;
  }
  hal_unmask(state);
}

/* The time base goes to `target` at `rate` a servo cycle. */
static void slew_to(uint32_t cs, int32_t target, enum i_name rate) {
  struct coordinate_system* s = &coordinate_systems[cs];
  int32_t slew = (int32_t)cs_variable(cs, rate);
  uint32_t state = hal_mask_servo();
  s->increment_slew = slew;
  s->increment_target = target;
  cs_busy |= 1u << cs;
  hal_unmask(state);
}

static void release_hold(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->held) return;
  s->held = false;
  slew_to(cs, s->increment_command, ISX95_FEED_HOLD_SLEW);
}

error_t run_point(uint32_t cs, double program) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->running) return ERR_PROGRAM_RUNNING;
  if (program < 0.0 || program > LARGEST_PROGRAM) return ERR_DATA;
  if (s->next_valid) drop_moves(cs);
  s->end_block = false;
  s->pointer = program == 0.0 ? POINTER_ROTARY : POINTER_FIXED;
  s->fixed_program = (uint32_t)program;
  return ERR_NONE;
}

static bool has_program(uint32_t cs) {
  return coordinate_systems[cs].pointer == POINTER_ROTARY && rotary_buffers[cs].size != 0;
}

error_t run_start(uint32_t cs, bool single_step) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!VIRTUAL_AXES) return ERR_NO_MOTORS;
  if (!has_program(cs)) return ERR_NO_PROGRAM;
  release_hold(cs);
  if (s->running && single_step) {     /* a step request ends continuous running behind the calculated moves */
    if (s->continuous) s->quit = true; /* while a step waits for its move, one more changes nothing */
    s->continuous = false;
    return ERR_NONE;
  }
  uint32_t state = hal_mask_servo();
  s->end_block = s->quit = false;
  s->stepping = single_step;
  s->continuous = !single_step;
  s->run_time_error = false;
  s->running = true;
  cs_busy |= 1u << cs;
  hal_unmask(state);
  return ERR_NONE;
}

void run_quit(uint32_t cs) {
  if (coordinate_systems[cs].running) coordinate_systems[cs].quit = true;
}

void run_abort(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t state = hal_mask_servo();
  if (s->active || s->running || s->next_valid) drop_moves(cs);
  rotary_skip_line_rest(cs);
  s->running = s->quit = s->end_block = s->stepping = s->continuous = false;
  hal_unmask(state);
  release_hold(cs);
}

void run_hold(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->held || !(s->running || s->active)) return;
  s->held = true;
  slew_to(cs, 0, ISX95_FEED_HOLD_SLEW);
}

void run_end_block(uint32_t cs) {
  if (coordinate_systems[cs].running) coordinate_systems[cs].end_block = true;
}

double run_time_base(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return s->increment_full == 0 ? 0.0 : (double)s->increment * 100.0 / (double)s->increment_full;
}

error_t run_set_time_base(uint32_t cs, double percent) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (percent < 0.0 || percent > LARGEST_PERCENT) return ERR_DATA;
  s->increment_full = i_integer(I10_SERVO_PERIOD);
  s->increment_command = (int32_t)((double)s->increment_full * percent / 100.0 + 0.5);
  if (!s->held) slew_to(cs, s->increment_command, ISX94_TIME_BASE_SLEW);
  return ERR_NONE;
}

bool run_is_running(uint32_t cs) { return coordinate_systems[cs].running; }

bool run_any_running(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (coordinate_systems[cs].running) return true;
  return false;
}

void run_forget_rotary(uint32_t cs) {
  if (coordinate_systems[cs].pointer == POINTER_ROTARY) coordinate_systems[cs].pointer = POINTER_NONE;
}
