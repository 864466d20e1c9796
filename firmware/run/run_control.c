/* Run control, in the background and, for control characters, in the real-time task. Requests are flags that the
 * real-time and servo tasks act on; an abort stops the trajectory at once and leaves the rest to the calculation. */
#include "firmware/run/run_control.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/path.h"
#include "firmware/motion/place.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/segment_ring.h"
#include "firmware/motion/system_motors.h"
#include "firmware/motion/time_base.h"
#include "firmware/run/calculate.h"
#include "firmware/run/calls.h"
#include "firmware/run/kinematic_program.h"
#include "firmware/run/motion_program.h"
#include "firmware/variables/i_variables.h"

#define LARGEST_INCREMENT 8388607.0 /* the word of the commanded time base */

/* The executing and the calculated move are dropped where the axes are now. That takes long to find out: the trajectory
 * stops here, the calculation does the rest before anything else for this system. Servo and real-time tasks held off.
 */
static void drop_moves(uint32_t cs) {
  coordinate_systems[cs].settling = true;
  cs_awake |= 1u << cs;
  calculate_forget(cs);
}

/* What is still to be settled after an abort is begun anew: it is about the new program then. A line of the rotary
 * buffer that was begun is lost, whatever was pointed to meanwhile. */
static void point(uint32_t cs, uint32_t number, struct program_entry entry) {
  const uint32_t state = hal_mask_real_time();
  calculate_forget(cs);
  if (number == 0) rotary_skip_line_rest(cs);
  motion_program_point(cs, number == 0, number, entry);
  hal_unmask(state);
}

/* Nothing is held off: a system that stands has a calculated move only behind `/`, or one that is being dropped. So the
 * servo task does not start it before end_block falls, nor then, and settling twice finds the same. */
error_t run_point(uint32_t cs, double program) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->running) return ERR_PROGRAM_RUNNING;
  uint32_t number, label;
  struct program_entry entry = program_top;
  if (!calls_split(program, &number, &label)) return ERR_DATA;
  if (s->next_valid || paths[cs].count != 0) {
    s->settling = true;
    cs_awake |= 1u << cs;
  }
  s->quit_at_block = s->own_stop = false;
  s->end_block = s->must_return = s->must_have_returned = s->restarts = false;
  s->pointer = POINTER_NONE;
  if (program == 0.0) {
    s->pointer = POINTER_ROTARY;
    point(cs, 0, program_top);
    return ERR_NONE;
  }
  s->fixed_program = number;
  if (fixed_program_find(FIXED_PROG, number) == 0) return ERR_NONE; /* R is ERR015 */
  if (label != 0 && calls_find(number, label, &entry) != READER_WORD) return ERR_NONE;
  s->pointer = POINTER_FIXED;
  point(cs, number, entry);
  return ERR_NONE;
}

/* ERR013, ERR012, ERR010, ERR011 and ERR017 of the motors; a system without any runs with virtual axes. */
static error_t check_motors(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  bool inactive = false, open = false, limits = false, moving = false;
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    const struct axis_definition* d = &axis_definitions[motor];
    if (!d->assigned || d->cs != cs) continue;
    inactive |= i_integer(i_motor(motor + 1u, IXX00_ACTIVATED)) == 0;
    open |= motors[motor].loop != LOOP_CLOSED;
    limits |= motors[motor].found.positive_limit && motors[motor].found.negative_limit;
    moving |= jog_is_moving(motor) && !(s->running && jog_is_of_program(motor));
  }
  if (inactive) return ERR_NOT_ACTIVATED;
  if (open) return ERR_OPEN_LOOP;
  if (limits) return ERR_BOTH_LIMITS;
  if (s->running && !s->held && !segment_stands(cs)) return ERR_NONE; /* what moves is the program's */
  if (moving) return ERR_MOVE_IN_PROGRESS;
  return (s->must_return || segment_stands(cs)) && system_motors_are_away(cs) ? ERR_MOVED : ERR_NONE;
}

/* A start or an order that goes on, and what is told of one that was refused for it. */
static error_t check_return(uint32_t cs) {
  const error_t error = check_motors(cs);
  coordinate_systems[cs].must_have_returned = error == ERR_MOVED;
  return error;
}

/* None runs while an open buffer may change it; a PLC changes none. */
static bool motion_buffer_open(void) { return open_buffer_kind() == OPEN_FIXED && !open_buffer_is_fixed(FIXED_PLC); }

/* ERR015, ERR016. The structure of a fixed program is looked at here, not when it is already running. */
static error_t check_program(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (motion_buffer_open() || s->pointer == POINTER_NONE) return ERR_NO_PROGRAM;
  if (s->pointer == POINTER_ROTARY) return rotary_buffers[cs].size != 0 ? ERR_NONE : ERR_NO_PROGRAM;
  return s->running || reader_check(FIXED_PROG, s->fixed_program) != READER_BAD ? ERR_NONE : ERR_BAD_PROGRAM;
}

/* A PMATCH that stands in a slice: what it finds is of motors as they were resolved for it. */
static void forget_match(uint32_t cs) {
  const uint32_t state = hal_mask_real_time();
  calculate_forget(cs);
  coordinate_systems[cs].matching = false;
  hal_unmask(state);
}

/* Calculated moves that a stop has left out; those that are being dropped are none. */
static bool moves_wait(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return !s->settling && (s->next_valid || segment_is_left(cs));
}

/* In a hold the program has come to a stop of its own: a start ends the hold, another one goes on behind the stop. */
static bool ends_hold_alone(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return s->held && !s->running && s->own_stop && !moves_wait(cs);
}

/* A program that has failed meanwhile, or that a limit has stopped, ramps its motors down: that is not taken from them,
 * nor does time go on before they have left the path. Real-time task held off. */
static void go_on(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->running && (s->held || segment_stands(cs))) system_motors_take(cs);
  s->must_return = false;
  if (!s->settling) time_base_go_on(cs);
}

/* Servo and real-time tasks held off. */
static void set_run(uint32_t cs, bool begins, bool single_step) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const bool waits = begins && moves_wait(cs);
  if (begins) {
    s->matching = s->starting = s->motors != 0;
    s->waited = true;
    s->unblended = cs_variable(cs, ISX92_BLEND_DISABLE) != 0.0;
    s->first = true;
    s->corner = CORNER_NONE;
    s->slots_short = false;
    s->own_stop = s->own_stop && waits; /* behind the moves that are still to be made */
    s->ended = s->ended && waits;
    s->failure = RUN_TIME_NONE;
    s->match_failed = false;
    protection_begin(cs);
    if (!waits) s->may_join = false;
  }
  s->end_block = s->quit_at_block = false;
  s->quit = s->own_stop || (single_step && waits); /* what comes behind it is for another start; one of those alone */
  if (single_step && waits) motion_programs[cs].under_way = false; /* so is the rest of a line that has begun */
  segment_go_on(cs, single_step && waits);
  s->stepping = single_step;
  s->continuous = !single_step;
  if (!s->own_stop) s->error = RUN_TIME_NONE;
  s->running = true;
  cs_awake |= 1u << cs;
  cs_busy |= 1u << cs;
}

/* One may have tripped since check_motors, which no axis need move. Servo task held off. */
static bool any_open(uint32_t of) {
  for (uint32_t left = of; left != 0; left &= left - 1u)
    if (motors[__builtin_ctz(left)].loop != LOOP_CLOSED) return true;
  return false;
}

/* A program that ends or fails while this looks at it has had its start: it is not begun anew. */
error_t run_start(uint32_t cs, bool single_step) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const bool begins = !s->running;
  error_t error = check_return(cs);
  if (error == ERR_NONE) error = check_program(cs);
  if (error == ERR_NONE && begins) error = kinematic_program_check(cs);
  if (error != ERR_NONE) return error;
  uint32_t state = hal_mask_real_time();
  const bool alone = ends_hold_alone(cs);
  go_on(cs);
  hal_unmask(state);
  if (alone) return ERR_NONE;
  if (!begins) segment_order(cs, LOOKAHEAD_FORWARD);
  if (!begins && single_step) {
    if (s->continuous) run_quit(cs); /* while a step waits for its move, one more changes nothing */
    s->continuous = false;
    return ERR_NONE;
  }
  if (begins) {
    forget_match(cs);
    system_motors_resolve(cs);
  }
  state = hal_mask_servo();
  if (begins ? (jogs_busy & axis_motors[cs]) != 0 : !s->running) {
    hal_unmask(state);
    return begins ? ERR_MOVE_IN_PROGRESS : ERR_NONE;
  }
  if (begins && any_open(axis_motors[cs])) {
    hal_unmask(state);
    return ERR_OPEN_LOOP;
  }
  set_run(cs, begins, single_step);
  hal_unmask(state);
  if (s->motors == 0) (void)move_place(cs); /* what `/` has kept out */
  return ERR_NONE;
}

static bool any_jogs(uint32_t cs) {
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && jog_is_moving(motor) && !jog_is_of_program(motor)) return true;
  return false;
}

/* A DWELL may execute or wait: nothing is calculated behind it. What is being calculated meanwhile is executed first.
 */
error_t run_match(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (motion_buffer_open()) return ERR_NO_PROGRAM;
  const error_t error = kinematic_program_check(cs);
  if (error != ERR_NONE) return error;
  if (s->settling || cs_moves(s) || segment_is_busy(cs)) return ERR_PROGRAM_RUNNING;
  if (s->running && any_jogs(cs)) return ERR_MOVE_IN_PROGRESS; /* in a held program, which would take it */
  if (!s->running) {
    forget_match(cs);
    system_motors_resolve(cs);
  }
  const uint32_t state = hal_mask_real_time();
  s->matching = s->matching_anew = s->motors != 0;
  cs_awake |= 1u << cs;
  hal_unmask(state);
  return ERR_NONE;
}

/* Stops hold the real-time task off: a program that ends or fails between the look and what is asked of it would be
 * asked to come back where none has stopped it. */
void run_quit(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_real_time();
  if (s->running) {
    segment_stop(cs);
    s->quit = s->must_return = true;
  }
  hal_unmask(state);
}

/* Motors that the real-time task has begun to move since their ramps were asked for are asked once more. */
void run_abort(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  system_motors_ramp(cs);
  const uint32_t state = hal_mask_servo(), alone = system_motors_alone(cs);
  drop_moves(cs);
  s->running = s->quit = s->end_block = s->stepping = s->continuous = s->matching = s->must_return = false;
  s->quit_at_block = false;
  s->must_have_returned = s->restarts = false;
  hal_unmask(state);
  system_motors_ramp_rest(cs, alone);
}

/* What leaves its path after an abort is not held: its ramps are planned for the rate that there is. */
void run_hold(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t state = hal_mask_servo();
  if (!s->held && !s->settling && (s->running || s->active)) {
    s->held = s->must_return = true;
    time_base_slew(cs, 0, ISX95_FEED_HOLD_SLEW);
  }
  hal_unmask(state);
}

void run_stop_on_path(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_real_time();
  if (!s->running || s->held || !segment_looks(cs)) {
    run_hold(cs);
  } else if (!segment_stands(cs)) { /* there its motors may be on their way: it goes on standing */
    segment_order(cs, LOOKAHEAD_STOP);
    s->must_return = true;
  }
  hal_unmask(state);
}

/* In the direction of an order: motors are back on the path. */
static error_t go(uint32_t cs, enum lookahead_order order) {
  const error_t error = check_return(cs);
  if (error != ERR_NONE) return error;
  const uint32_t state = hal_mask_real_time();
  go_on(cs);
  hal_unmask(state);
  segment_order(cs, order);
  return ERR_NONE;
}

error_t run_forward(uint32_t cs) {
  if (coordinate_systems[cs].running && segment_looks(cs)) return go(cs, LOOKAHEAD_FORWARD);
  return run_start(cs, false);
}

error_t run_back(uint32_t cs) {
  if (coordinate_systems[cs].running && segment_looks(cs)) return go(cs, LOOKAHEAD_BACKWARD);
  run_hold(cs);
  return ERR_NONE;
}

/* 4 `\\`, 6 `>`, 7 `<`, 14 and 15 a segment forwards and backwards. */
void run_by_state(uint32_t cs) {
  switch (i_integer(i_cs(cs, ISX21_LOOKAHEAD_STATE))) {
    case 4:
      run_stop_on_path(cs);
      break;
    case 6:
      (void)run_forward(cs);
      break;
    case 7:
      (void)run_back(cs);
      break;
    case 14:
      if (segment_looks(cs)) (void)go(cs, LOOKAHEAD_ONE_FORWARD);
      break;
    case 15:
      if (segment_looks(cs)) (void)go(cs, LOOKAHEAD_ONE_BACKWARD);
      break;
    default:
      break;
  }
}

/* With motors and without segmentation it is Q (motion:5.6). */
void run_end_block(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = s->motors != 0 ? hal_mask_real_time() : hal_mask_servo();
  if (s->running && s->motors != 0) {
    run_quit(cs);
    s->quit_at_block = true;
  } else if (s->running) {
    s->end_block = true;
    move_take_back(cs);
  }
  hal_unmask(state);
}

void run_calculating(uint32_t cs, struct program_trace* trace) { motion_program_next(cs, trace); }

void run_executing(uint32_t cs, struct program_trace* trace) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  const bool active = s->active;
  if (active && s->moves[s->executing].kind == MOVE_SEGMENTS)
    segment_ring_line(cs, trace);
  else if (active)
    *trace = s->moves[s->executing].line;
  hal_unmask(state);
  if (!active) motion_program_next(cs, trace);
}

double run_time_base(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return s->increment_full == 0 ? 0.0 : (double)s->increment * 100.0 / (double)s->increment_full;
}

error_t run_set_time_base(uint32_t cs, double percent) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const int32_t full = i_integer(I10_SERVO_PERIOD);
  if (percent < 0.0 || (double)full * percent > LARGEST_INCREMENT * 100.0) return ERR_DATA;
  const int32_t command = (int32_t)((double)full * percent / 100.0 + 0.5);
  s->increment_full = full; /* a word: DWELL takes it at once, the time base with the command */
  time_base_command(cs, command);
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
