/* Execution of motion programs, real-time task: statements in sequence until a move is calculated. LINEAR moves are
 * calculated one ahead, a DWELL lets nothing be calculated until it is over (firmware:7.9). Running out of lines is no
 * error in a rotary program: the coordinate system keeps running and waits. The systems take turns, a word each, so
 * that none waits for another's lines; it goes on in slices of the real-time task, left between words, inside functions
 * and inside the planning of a move. */
#include "firmware/run/calculate.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/tasks.h"
#include "firmware/language/statement_key.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog_plan.h"
#include "firmware/motion/jog_state.h"
#include "firmware/motion/path.h"
#include "firmware/motion/place.h"
#include "firmware/motion/position.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/system_motors.h"
#include "firmware/motion/time_base.h"
#include "firmware/run/calls.h"
#include "firmware/run/motion_program.h"
#include "firmware/run/motion_statement.h"
#include "firmware/run/synchronous.h"

enum { JUMPS_BACK_LIMIT = 2 }; /* without a move, at one real-time interrupt (firmware:7.9) */

/* The system that is at its turn; none: COORDINATE_SYSTEMS. R, and B with R held off. */
static uint32_t calculated = COORDINATE_SYSTEMS;

/* While programs are being moved in memory, what executes one of them stands still. */
static bool stands(uint32_t cs) {
  return cs < COORDINATE_SYSTEMS && !motion_programs[cs].x.at.reader.rotary && (fixed_programs_generation() & 1u) != 0;
}

/* The line of a rotary buffer goes, as far as it has not yet; a fixed program stays at the statement. */
static void stop_with_error(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  const bool called = p->depth != 0;
  /* Taken before the first pause: an abort there must not leave it to the next error. */
  const enum run_time_error cause = p->x.error != RUN_TIME_NONE ? p->x.error : RUN_TIME_STATEMENT;
  p->x.error = RUN_TIME_NONE;
  if (called && p->callers[0].reader.rotary) {
    p->x.at = p->callers[0];
    p->depth = 0;
  } else if (p->x.at.reader.rotary && p->x.at.begun) {
    (void)rotary_consume(cs, 1);
  }
  s->pending_axes = 0;
  if (p->x.at.reader.rotary) {
    motion_program_forget_line(cs);
    motion_program_drop_line(p);
  } else {
    executor_back(&p->x); /* R goes on in the line: what else has been collected of it counts then */
  }
  p->under_way = false;
  /* Behind the last pause: R there would forget both. */
  s->error = cause;
  s->quit = s->own_stop = true;
}

/* The program has ended: it stands at its top again, and stops when its moves are over. */
static void end(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  motion_program_restart(cs);
  s->quit = s->own_stop = s->ended = true;
}

static void planned(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  p->under_way = false;
  p->jumps_begin = p->x.jumps_back;
  if (p->asks_time && synchronous_is_move(cs)) {
    synchronous_move_time(cs);
    p->asks_time = false;
  }
  if (s->stepping && !p->in_block) s->quit = true;
}

/* Isx53 bit 0: a step ends behind each line, a block is one. */
static void line_ends(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  motion_programs[cs].lines++;
  if (!s->stepping || motion_programs[cs].in_block) return;
  if (((uint32_t)i_integer(i_cs(cs, ISX53_STEP_MODE)) & 1u) != 0u) s->quit = true;
}

static bool waits_for(enum move_kind kind) { return kind == MOVE_DWELL || kind == MOVE_OWN; }

/* The last calculated move is a PVT that does not end at rest: it needs one behind it. */
static bool needs_next(const struct coordinate_system* s) {
  const struct move* next = cs_next_move(s);
  const struct move* m = next != 0 ? next : &s->moves[s->executing];
  return (next != 0 || s->active) && m->kind == MOVE_PVT && m->overruns;
}

/* What has to wait for a later interrupt: a move to be started, or the limits of this one. */
static bool is_ahead(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (s->next_valid || (s->active && waits_for(s->moves[s->executing].kind))) return true;
  if (s->matching && s->pending_axes == 0 && !needs_next(s)) return true;
  if (path_is_full(cs) || (paths[cs].count != 0 && !segment_is_under_way(cs))) return true;
  if (p->interrupt != cs_interrupts) {
    p->interrupt = cs_interrupts;
    p->lines = 0;
    p->jumps_begin = p->x.jumps_back;
  }
  if (p->x.jumps_back - p->jumps_begin >= JUMPS_BACK_LIMIT) {
    s->may_join = false;
    return true;
  }
  return p->lines >= CALCULATED_LINES_LIMIT;
}

/* Behind STOP, and BLOCKSTOP in a step, the rest of their line is for another start. */
static bool stops_behind(const struct coordinate_system* s, const struct instruction* in) {
  const bool block = in->operation == OP_STATEMENT && in->number == KEY_BLOCKSTOP;
  return s->own_stop || (block && s->quit && s->stepping);
}

/* One word. False: nothing more at this interrupt. */
static bool calculate_word(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  const uint32_t moves = s->planned;
  struct instruction in;
  if (calls_prelude_is_due(p)) {
    const enum executed called = calls_prelude_call(p);
    if (called == EXECUTED_ERROR) stop_with_error(cs);
    return called == EXECUTED_LINE;
  }
  enum executed executed = executor_step(&p->x, &in);
  calls_note_label(p, executed, &in);
  const bool of_motion = executed == EXECUTED_STATEMENT;
  if (of_motion) executed = motion_statement(cs, &in);
  if (executed == EXECUTED_LATER) {
    if (of_motion && s->pending_axes == 0) p->under_way = false; /* it may wait for ever: a stop does not */
    s->waited = true;
    return false;
  }
  if (executed == EXECUTED_LINE) line_ends(cs);
  p->under_way = executed == EXECUTED_WORD && !(of_motion && stops_behind(s, &in));
  if (executed == EXECUTED_LINE || executed == EXECUTED_END) {
    const bool ends = executed == EXECUTED_END && s->pending_axes == 0; /* else it comes again */
    if (s->pending_axes != 0 && motion_plan_line(cs) == EXECUTED_ERROR) executed = EXECUTED_ERROR;
    motion_program_forget_line(cs); /* PSET, I, J and K without axes too */
    if (ends && !calls_return(p)) end(cs);
  }
  if (s->planned != moves) {
    planned(cs);
    if (s->motors == 0) (void)move_place(cs); /* that of motors takes its time: it is the next turn */
  }
  if (executed == EXECUTED_ERROR) stop_with_error(cs);
  return executed != EXECUTED_ERROR;
}

/* After an abort: the axes are where the stopped trajectory has them, what is left of a begun line is lost. Motors have
 * left the path by then, each on a ramp of its own, so time goes on. The servo task looks at nothing else while
 * `settling`, so it falls last. */
static bool settle(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  double position[AXIS_COUNT];
  if (system_motors_leave(cs)) return false;
  cs_present_position(s, position);
  segment_start_of(cs, position);
  motion_program_drop_line(&motion_programs[cs]);
  synchronous_forget(cs);
  motion_program_forget_line(cs);
  s->may_join = false;
  s->corner = CORNER_NONE;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    s->position[axis] = position[axis];
    s->last_delta[axis] = 0.0;
  }
  const uint32_t state = hal_mask_servo();
  piece_ring_clear(&s->ring);
  segment_forget(cs);
  s->active = s->next_valid = s->placed = s->moves[s->executing].overruns = false;
  s->planned = s->started;
  s->must_return = s->must_have_returned = false; /* there is no place on a path to come back to */
  s->settling = false;
  hal_unmask(state);
  time_base_go_on(cs);
  return true;
}

/* What is calculated is dropped, motors ramp to rest. Without a cause the error is what the program has met ahead. */
static void fail(uint32_t cs, enum run_time_error cause) {
  struct coordinate_system* s = &coordinate_systems[cs];
  system_motors_ramp(cs);
  if (cause != RUN_TIME_NONE) s->error = cause;
  s->running = s->quit = s->stepping = s->matching = false;
  s->settling = true;
}

/* A PVT move that ends in motion runs on. Behind the last one of a program that is no error, it ends so. */
static bool runs_on(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (move_ends(cs)) return false;
  const bool ends = s->quit && !s->next_valid && !segment_is_left(cs);
  fail(cs, ends ? RUN_TIME_NONE : RUN_TIME_LATE);
  return true;
}

/* PMATCH while no program runs: it leaves the motors alone, and the error of a program to its next start. */
static void match(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  s->failure = RUN_TIME_NONE;
  const bool found = system_motors_match(cs);
  if (s->error == RUN_TIME_NONE || s->match_failed) {
    s->error = s->failure;
    s->match_failed = !found;
  }
  s->matching = false;
}

/* Behind moves on which motors went for themselves the axes are where those are. */
static bool has_gone_alone(const struct coordinate_system* s) {
  return s->moves[s->executing].kind == MOVE_OWN && !s->active && s->started == s->planned && !s->was_matched;
}

/* PMATCH and HOMEZ in a program: behind the moves of what had been begun by then. */
static bool may_match(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return s->starting || (s->pending_axes == 0 && !cs_moves(s) && !segment_is_busy(cs));
}

/* Axes are where the motors are, and motors the program's. Moves that a stop has left waiting are still to be made:
 * they begin there, the program goes on where they end. */
static void begin(uint32_t cs) {
  double* position = coordinate_systems[cs].position;
  segment_start_of(cs, position);
  system_motors_begin(cs);
  segment_begin_at(cs, position);
}

/* A stop waits for the rest of a line that has begun, unless that waits for moves which the stop has left out. */
static bool may_stop(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->quit && !s->end_block) return false;
  return !motion_programs[cs].under_way || (segment_is_left(cs) && !segment_is_busy(cs));
}

/* False: there is nothing to do for it at this interrupt. */
static bool turn(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (stands(cs)) return false;
  if (s->settling) return settle(cs);
  if (!s->running && !s->matching) return false;
  if (!s->running) {
    match(cs);
    return true;
  }
  if (s->failure != RUN_TIME_NONE) {
    fail(cs, s->failure);
    return true;
  }
  if ((s->matching && may_match(cs)) || has_gone_alone(s)) {
    begin(cs);
    return true;
  }
  if (runs_on(cs)) return true;
  if (move_place(cs) || segment_work(cs, false)) return true;
  if (may_stop(cs)) {
    if (segment_is_busy(cs)) return segment_work(cs, true);
    if (s->active || (s->next_valid && !s->end_block)) return false; /* what is calculated is still to be executed */
    s->running = s->quit = s->stepping = false; /* end_block keeps a calculated move from starting until R */
    return false;
  }
  return (!is_ahead(cs) && calculate_word(cs)) || segment_work(cs, true);
}

static bool is_awake(const struct coordinate_system* s) { return s->running || s->settling || s->matching; }

static uint32_t systems(void) {
  for (uint32_t cs = 0, left = cs_awake; left != 0; cs++, left >>= 1)
    if ((left & 1u) != 0 && !is_awake(&coordinate_systems[cs])) cs_awake &= ~(1u << cs);
  return cs_awake;
}

static void calculate_round(void) {
  uint32_t looked = cs_interrupts, mask = systems();
  for (bool any = true; any;) {
    synchronous_assign();
    any = jog_plan();
    for (uint32_t cs = 0, left = mask; left != 0; cs++, left >>= 1) {
      if ((left & 1u) == 0) continue;
      calculated = cs;
      const bool done = turn(cs);
      calculated = COORDINATE_SYSTEMS;
      if (done) {
        slice_pause();
        synchronous_assign(); /* of moves that have started since: they wait for one word at most */
      }
      any |= done;
    }
    if (looked == cs_interrupts) continue;
    looked = cs_interrupts; /* the background has run */
    mask = systems();
  }
}

void calculate_initialize(void) {
  calculated = COORDINATE_SYSTEMS;
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) {
    motion_program_point(cs, true, 0, program_top);
    segment_forget(cs);
  }
  synchronous_initialize();
  slice_initialize(calculate_round);
}

void calculate_forget(uint32_t cs) {
  if (calculated != cs) return;
  calculated = COORDINATE_SYSTEMS;
  slice_restart();
}

void calculate_programs(void) {
  cs_interrupts++;
  if (stands(calculated)) return;
  if (!slice_is_under_way() && systems() == 0 && jogs_asked == 0 && !synchronous_waits()) {
    slice_skip();
    return;
  }
  slice_run(tasks_real_time_left()); /* what checks of motors and the like have left */
}
