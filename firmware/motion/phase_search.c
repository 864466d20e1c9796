/* Two guesses (Ixx80 bit 1 = 0): torque Ixx73 for Ixx74 servo interrupts and the opposite one for as many, which leaves
 * the motor at rest, as if the phase position were 0; then the same as if it were a quarter of a cycle more. A rotor at
 * the angle x moves by cos(x) and by sin(x) of what it would with the right guess: x is the arc tangent of the two. The
 * phase position follows meanwhile, so it is x plus what has moved.
 *
 *   torque   __    __          guess 0: 0 degrees, guess 1: 90 degrees
 *           |  |  |  |
 *           | 0|  | 1|         a part is Ixx74 servo interrupts
 *              |__|  |__
 *
 * Stepper (Ixx80 bit 1 = 1): current Ixx73 into the second phase, then into the first, 256 Ixx74 servo interrupts each.
 * The rotor goes to where they pull it, at last to phase position 0. It must have moved on the way from one to the
 * other. Users of sine outputs (Ixx82 = 0) with Ixx72 above 1024 give Ixx73 with the other sign.
 *
 * The background begins (search zeroed, then `kind`), the servo task goes from part to part and says how it ended, the
 * background finishes. */
#include "firmware/motion/phase_search.h"

#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/phase_absolute.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phase_task.h"
#include "firmware/motion/phasing.h"
#include "firmware/variables/i_variables.h"

enum { PHASE_POSITION = 0x34, READING = 0x32 };          /* registers */
enum { AT_POWER_ON = 1, STEPPER = 2, NOT_ABSOLUTE = 4 }; /* Ixx80 */
enum { GUESSES = 2, PARTS_OF_GUESS = 2, STEPPER_PARTS = 2, STEPPER_UNIT = 256 };
enum { LEAST_COUNTS = 3 };                        /* that a guess must have moved */
enum { LEAST_OF_STEP = 4 };                       /* a quarter of the way between the phases */
enum { TO_CURRENT = CURRENT_FRACTION_BITS - 15 }; /* of 16-bit outputs */
enum { LARGEST_WORD = (1 << 23) - 1 };
enum { ANGLE_SHIFT = 21, HALF_CYCLE_INDEX = 1024 }; /* of Ixx72 */
enum kind { SEARCH_NONE, SEARCH_GUESSES, SEARCH_STEPPER };
enum result { RESULT_NONE, RESULT_FOUND, RESULT_FAILED };

static struct search {
  volatile enum kind kind; /* background sets; S clears with the result */
  volatile enum result result;
  bool guesses;
  uint32_t length, left;  /* servo interrupts of a part */
  uint32_t part;          /* 0, 1, ... */
  int32_t current, cycle; /* Ixx73; Ixx71 */
  uint32_t reading;       /* of the encoder, where the part or guess began */
  int32_t moved[GUESSES]; /* counts */
} searches[MOTORS];

static int32_t variable(uint32_t motor, enum i_name name) { return i_integer(i_motor(motor + 1u, name)); }
static volatile uint32_t* position_word(uint32_t motor) {
  return hal_x(MEMORY_MOTOR_WORDS * (motor + 1u) + PHASE_POSITION);
}
static uint32_t reading_now(uint32_t motor) { return *hal_y(MEMORY_MOTOR_WORDS * (motor + 1u) + READING); }

/* Between -cycle and cycle: the phase task brings it to the half around 0, what the word cannot hold is brought here.
 */
static void set_position(uint32_t motor, int32_t position) {
  if (position > LARGEST_WORD) position -= variable(motor, IXX71_COMMUTATION_COUNTS);
  *position_word(motor) = (uint32_t)position & HAL_WORD_MASK;
}

static void drive(struct phase_motor* p, int32_t q, int32_t d) {
  p->q.command = q;
  p->d.command = d;
}

/* Servo task. ------------------------------------------------------------------------------------------------------ */

static void end(struct search* s, struct phase_motor* p, bool found) {
  drive(p, 0, 0);
  p->held = false;
  p->advance = 0;
  s->result = found ? RESULT_FOUND : RESULT_FAILED;
  s->kind = SEARCH_NONE;
}

static int32_t counts_since(const struct search* s, uint32_t motor) {
  return hal_signed(reading_now(motor) - s->reading);
}

static int32_t magnitude(int32_t value) { return value < 0 ? -value : value; }

static void begin_guess_part(struct search* s, struct phase_motor* p, uint32_t motor) {
  const uint32_t guess = s->part / PARTS_OF_GUESS;
  const bool brakes = s->part % PARTS_OF_GUESS != 0u;
  if (!brakes) {
    set_position(motor, guess == 0u ? 0 : hal_signed(*position_word(motor)) + s->cycle / 4);
    s->reading = reading_now(motor);
  }
  drive(p, brakes ? -s->current : s->current, 0);
}

static void end_guess_part(struct search* s, struct phase_motor* p, uint32_t motor) {
  if (s->part % PARTS_OF_GUESS != 0u) s->moved[s->part / PARTS_OF_GUESS] = counts_since(s, motor);
  if (++s->part < GUESSES * PARTS_OF_GUESS)
    begin_guess_part(s, p, motor);
  else
    end(s, p, magnitude(s->moved[0]) >= LEAST_COUNTS || magnitude(s->moved[1]) >= LEAST_COUNTS);
}

/* Part 0: into the second phase. Its current is greatest at the angle -Ixx72. */
static void begin_step(struct search* s, struct phase_motor* p, uint32_t motor) {
  s->reading = reading_now(motor);
  p->advance = s->part == 0u ? 0u - p->settings.second : 0u;
  p->held = true;
  drive(p, 0, s->current);
}

static void end_step(struct search* s, struct phase_motor* p, uint32_t motor) {
  s->moved[s->part] = counts_since(s, motor);
  if (++s->part < STEPPER_PARTS) {
    begin_step(s, p, motor);
    return;
  }
  const uint32_t index = p->settings.second >> ANGLE_SHIFT;
  const int64_t between = index > HALF_CYCLE_INDEX ? 2 * HALF_CYCLE_INDEX - index : index;
  const int64_t moved = (int64_t)magnitude(s->moved[1]) * p->settings.multiplier;
  const bool found = between != 0 && moved * LEAST_OF_STEP * 2 * HALF_CYCLE_INDEX >= between * s->cycle;
  if (found) set_position(motor, 0);
  end(s, p, found);
}

static void search_servo(uint32_t motor) {
  struct search* s = &searches[motor];
  struct phase_motor* p = &phase_motors[motor];
  const enum kind kind = s->kind;
  if (kind == SEARCH_NONE || !p->searched) return;
  if (s->left == 0u) { /* the first part */
    if (kind == SEARCH_GUESSES)
      begin_guess_part(s, p, motor);
    else
      begin_step(s, p, motor);
    s->left = s->length;
  } else if (--s->left == 0u) {
    s->left = s->length;
    if (kind == SEARCH_GUESSES)
      end_guess_part(s, p, motor);
    else
      end_step(s, p, motor);
  }
}

void phasing_servo(void) {
  for (uint32_t motor = 0, left = phasing_searched; left != 0u; ++motor, left >>= 1)
    if ((left & 1u) != 0u) search_servo(motor);
}

/* Background. ------------------------------------------------------------------------------------------------------ */

void phasing_search_initialize(void) { __builtin_memset(searches, 0, sizeof searches); }

/* What the second guess has left in the register is a quarter of a cycle too much, if x were 0. */
static void take_guesses(uint32_t motor, const struct search* s) {
  const double sign = s->current < 0 ? -1.0 : 1.0, cycle = (double)s->cycle;
  const double degrees = math_arc_tangent2(sign * (double)s->moved[1], sign * (double)s->moved[0], 1);
  const int32_t change = (int32_t)math_nearest(degrees / 360.0 * cycle) - s->cycle / 4;
  const uint32_t state = hal_mask_all(); /* the phase task moves the position */
  set_position(motor, hal_signed(*position_word(motor)) + change);
  hal_unmask(state);
}

/* Who changes the state of the loop ends a search (commutation_enable) and has left the loop as it shall be. */
static bool is_taken_over(uint32_t motor) {
  if (phase_motors[motor].searched) return false;
  phasing_set_searched(motor, false);
  return true;
}

/* A kill by the real-time task comes before it or behind it. */
static void finish(uint32_t motor, const struct search* s) {
  const bool found = s->result == RESULT_FOUND;
  if (found && s->guesses) take_guesses(motor, s);
  const uint32_t state = hal_mask_real_time();
  if (!is_taken_over(motor)) {
    phase_motors[motor].searched = false;
    phasing_set_searched(motor, false);
    if (found) phasing_set_missing(motor, false);
    if (!found || !motor_close(motor)) motor_kill(motor);
  }
  hal_unmask(state);
}

/* A limit, or nobody commutates the motor any more. */
static void look_for_an_end(uint32_t motor, struct search* s) {
  const struct motor_findings* found = &motors[motor].found;
  const bool ends = found->positive_limit || found->negative_limit || !commutation_is_used(motor);
  const uint32_t state = hal_mask_servo();
  if (s->kind != SEARCH_NONE && ends) {
    s->kind = SEARCH_NONE;
    s->result = RESULT_FAILED;
  }
  hal_unmask(state);
}

void phasing_pass(void) {
  for (uint32_t left = phasing_searched; left != 0u; left &= left - 1u) {
    const uint32_t motor = (uint32_t)__builtin_ctz(left);
    if (is_taken_over(motor)) continue;
    look_for_an_end(motor, &searches[motor]);
    if (searches[motor].result != RESULT_NONE) finish(motor, &searches[motor]);
  }
}

/* A sensor that cannot be read leaves no reference, whatever there was. */
static bool begin_absolute(uint32_t motor) {
  int32_t position;
  if (!phase_absolute_read(motor, &position)) {
    motor_kill(motor);
    phasing_set_missing(motor, true);
    return false;
  }
  set_position(motor, position);
  phasing_set_missing(motor, false);
  return motor_close(motor);
}

/* The size of the current, with the sign that turns a rotor the way of the phase position. */
static int32_t search_current(uint32_t motor, bool stepper) {
  const int32_t current = variable(motor, IXX73_PHASE_SEARCH_OUTPUT) * (1 << TO_CURRENT);
  const bool other =
      stepper && !phase_motors[motor].settings.current_loop && variable(motor, IXX72_PHASE_ANGLE) > HALF_CYCLE_INDEX;
  return other ? -current : current;
}

static bool begin_search(uint32_t motor) {
  const bool stepper = ((uint32_t)variable(motor, IXX80_POWER_UP_MODE) & STEPPER) != 0u;
  const uint32_t time = (uint32_t)variable(motor, IXX74_PHASE_SEARCH_TIME);
  const struct search s = {.guesses = !stepper,
                           .length = stepper ? time * STEPPER_UNIT : time,
                           .current = search_current(motor, stepper),
                           .cycle = variable(motor, IXX71_COMMUTATION_COUNTS)};
  if (s.length == 0u || s.cycle == 0) return false;
  motor_kill(motor);
  phasing_set_missing(motor, true);
  motor_open(motor, 0);
  const uint32_t state = hal_mask_servo(); /* nor does a kill come between */
  const bool begins = motors[motor].loop == LOOP_OPEN;
  if (begins) {
    phasing_set_searched(motor, true);
    phase_motors[motor].searched = true;
    searches[motor] = s;
    searches[motor].kind = stepper ? SEARCH_STEPPER : SEARCH_GUESSES;
  }
  hal_unmask(state);
  return begins;
}

bool phasing_begin(uint32_t motor) {
  if (!phasing_is_needed(motor)) return motor_close(motor);
  if (phasing_is_searched(motor) && !is_taken_over(motor)) return true;
  if (phase_absolute_is_set(motor)) return begin_absolute(motor);
  return begin_search(motor);
}

/* Ixx80 bit 2: an absolute sensor is not read by itself. */
void phasing_power_on(void) {
  for (uint32_t motor = 0; motor < MOTORS; ++motor) {
    const uint32_t mode = (uint32_t)variable(motor, IXX80_POWER_UP_MODE);
    if ((mode & AT_POWER_ON) == 0u || variable(motor, IXX00_ACTIVATED) == 0) continue;
    if ((mode & NOT_ABSOLUTE) == 0u || !phase_absolute_is_set(motor)) (void)phasing_begin(motor);
  }
}

void phasing_set_here(uint32_t of) {
  for (uint32_t motor = 0; of != 0u; ++motor, of >>= 1)
    if ((of & 1u) != 0u) set_position(motor, variable(motor, IXX75_PHASE_OFFSET));
}
