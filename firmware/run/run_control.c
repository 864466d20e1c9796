/* Run control, in the background and, for control characters, in the real-time task. Requests are flags that the
 * real-time and servo tasks act on; an abort stops the trajectory at once and leaves the rest to the calculation. */
#include "firmware/run/run_control.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/calculate.h"
#include "firmware/variables/i_variables.h"

#define LARGEST_PERCENT 225.0
#define LARGEST_PROGRAM 32767.99999

/* The executing and the calculated move are dropped where the axes are now. That takes long to find out: the trajectory
 * stops here, the calculation does the rest before anything else for this system. Servo and real-time tasks held off.
 */
static void drop_moves(uint32_t cs) {
  coordinate_systems[cs].settling = true;
  calculate_forget(cs);
}

/* The time base goes to `target` at `rate` a servo cycle. Servo and real-time tasks held off. */
static void slew_to(uint32_t cs, int32_t target, enum i_name rate) {
  struct coordinate_system* s = &coordinate_systems[cs];
  s->increment_slew = i_integer(i_cs(cs, rate));
  s->increment_target = target;
  cs_busy |= 1u << cs;
}

static void release_hold(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->held) return;
  uint32_t state = hal_mask_servo();
  s->held = false;
  slew_to(cs, s->increment_command, ISX95_FEED_HOLD_SLEW);
  hal_unmask(state);
}

error_t run_point(uint32_t cs, double program) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->running) return ERR_PROGRAM_RUNNING;
  if (program < 0.0 || program > LARGEST_PROGRAM) return ERR_DATA;
  uint32_t state = hal_mask_servo();
  if (s->next_valid) drop_moves(cs);
  s->end_block = false;
  hal_unmask(state);
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
  drop_moves(cs);
  s->running = s->quit = s->end_block = s->stepping = s->continuous = false;
  hal_unmask(state);
  release_hold(cs);
}

void run_hold(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t state = hal_mask_servo();
  if (!s->held && (s->running || s->active)) {
    s->held = true;
    slew_to(cs, 0, ISX95_FEED_HOLD_SLEW);
  }
  hal_unmask(state);
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
  const int32_t full = i_integer(I10_SERVO_PERIOD);
  const int32_t command = (int32_t)((double)full * percent / 100.0 + 0.5);
  uint32_t state = hal_mask_servo();
  s->increment_full = full;
  s->increment_command = command;
  if (!s->held) slew_to(cs, command, ISX94_TIME_BASE_SLEW);
  hal_unmask(state);
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
