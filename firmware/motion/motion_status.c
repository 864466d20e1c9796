/* Status words of the coordinate systems (firmware:5.4 to firmware:5.6, firmware:5.8). */
#include "firmware/motion/motion_status.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/rotary_ring.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/system_findings.h"
#include "firmware/variables/i_variables.h"

enum {
  S1_VECTOR_INCREMENTAL = 5,
  S1_CONTINUOUS = 4,
  S1_TIME_MODE = 3,
  S1_BLENDING = 2,
  S1_STEP = 1,
  S1_RUNNING = 0,
  S1_AXIS_A = 6,
  S2_LOOKAHEAD = 23,
  S2_RUN_TIME_ERROR = 22,
  S2_AMPLIFIER_FAULT = 20,
  S2_FATAL_ERROR = 19,
  S2_WARNING_ERROR = 18,
  S2_IN_POSITION = 17,
  S2_ROTARY_FULL = 16,
  S2_END_BLOCK = 14,
  S2_DWELL = 12,
  S2_SEGMENTS = 7,
  S3_SHARP_CORNER = 6,
  S3_CORNER_DWELL = 5,
  S3_RADIUS_ERROR = 3,
  S3_RESUME_ERROR = 2,
  S3_WRAPPED = 23,
  S3_BACKWARD = 22,
  S3_OLDEST = 21,
  S3_ASSIGNMENTS = 20,
  S3_ASSIGNMENTS_LOST = 19,
  S3_LOOKAHEAD_STATE = 8,
  S3_DESIRED_LIMIT = 1,
  S3_MATCHING = 0,
  G2_ULTRALITE = 23,
  G2_BINARY_ROTARY_OPEN = 20,
  G2_MOTION_OPEN = 19,
  G2_ROTARY_OPEN = 18,
  G2_PLC_OPEN = 17,
  G2_UMAC = 16,
  G2_FORWARD_OPEN = 15,
  G2_INVERSE_OPEN = 14,
  G2_FIXED_FULL = 11
};

/* Bits 4, 1, 0 of word 2, by mode. */
static const uint8_t MODES[] = {0x00, 0x02, 0x01, 0x03, 0x11, 0x11, 0x12};

static uint32_t bit(bool value, unsigned position) { return value ? 1u << position : 0u; }

static uint32_t status1(const struct coordinate_system* s) {
  const bool steps = s->running && (s->stepping || (s->quit && !s->ended)); /* behind `Q`, too */
  uint32_t word = bit(!s->vector_absolute, S1_VECTOR_INCREMENTAL) |
                  bit(s->running && s->continuous && !s->unblended, S1_CONTINUOUS) | bit(s->time_mode, S1_TIME_MODE) |
                  bit(s->active && s->moves[s->executing].blended, S1_BLENDING) | bit(steps, S1_STEP) |
                  bit(s->running && !s->ended, S1_RUNNING); /* until its last move is calculated */
  for (uint32_t axis = 0; axis < AXIS_COUNT;
       axis++) { /* A lowest, Z highest: incremental, then feedrate axis above it */
    word |= bit((s->incremental >> axis) & 1u, S1_AXIS_A + 2 * axis);
    word |= bit((s->feedrate_axes >> axis) & 1u, S1_AXIS_A + 1 + 2 * axis);
  }
  return word;
}

static bool has_dwell(const struct coordinate_system* s) {
  const struct move* next = cs_next_move(s);
  return (next != 0 && next->kind == MOVE_DWELL) || (s->active && s->moves[s->executing].kind == MOVE_DWELL);
}

/* Nothing of a program is under way or waits, and motors, if there are any, are where they shall be. */
static bool is_in_position(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (s->active || s->next_valid) return false;
  return axis_definition_motors(cs) == 0u || system_in_position(cs);
}

static uint32_t faults(uint32_t cs) {
  uint32_t word = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    const struct axis_definition* d = &axis_definitions[motor];
    const struct motor_findings* found = &motors[motor].found;
    if (d->assigned && d->cs == cs)
      word |= bit(found->amplifier_fault, S2_AMPLIFIER_FAULT) | bit(found->fatal_error, S2_FATAL_ERROR) |
              bit(found->warning_error, S2_WARNING_ERROR);
  }
  return word;
}

static bool is_on_desired_limit(uint32_t cs) {
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (axis_definitions[motor].assigned && axis_definitions[motor].cs == cs && motors[motor].found.on_desired_limit)
      return true;
  return false;
}

/* A stop at a corner that is too sharp to blend, and its pause, and one at the limit of a desired position; Isx21
 * (motion:7.5). */
static uint32_t status3(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const bool stops = s->corner != CORNER_NONE && s->moves[s->executing ^ 1u].is_sharp;
  const uint32_t state = (uint32_t)i_integer(i_cs(cs, ISX21_LOOKAHEAD_STATE)) << S3_LOOKAHEAD_STATE;
  const bool looks = segment_looks(cs);
  const uint32_t buffer = bit(looks && lookahead_is_wrapped(cs), S3_WRAPPED) |
                          bit(looks && lookahead_is_backward(cs), S3_BACKWARD) |
                          bit(segment_stands(cs) && lookahead_is_at_oldest(cs), S3_OLDEST) |
                          bit(s->slots_wait, S3_ASSIGNMENTS) | bit(s->slots_short, S3_ASSIGNMENTS_LOST);
  return state | buffer | bit(s->error == RUN_TIME_RADIUS, S3_RADIUS_ERROR) |
         bit(s->must_have_returned, S3_RESUME_ERROR) | bit(stops, S3_SHARP_CORNER) |
         bit(s->corner == CORNER_DWELL, S3_CORNER_DWELL) |
         bit(is_on_desired_limit(cs) || (segment_stands(cs) && lookahead_is_at_limit(cs)), S3_DESIRED_LIMIT) |
         bit(s->running && s->matching, S3_MATCHING);
}

uint32_t motion_cs_status(uint32_t cs, unsigned word) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (word == 0) return status1(s);
  if (word == 2) return status3(cs);
  const bool segments = s->active && s->moves[s->executing].kind == MOVE_SEGMENTS;
  return bit(segments && segment_looks(cs), S2_LOOKAHEAD) | bit(segments, S2_SEGMENTS) |
         bit(s->error != RUN_TIME_NONE, S2_RUN_TIME_ERROR) | bit(is_in_position(cs), S2_IN_POSITION) |
         bit(rotary_buffers[cs].full, S2_ROTARY_FULL) | bit(s->end_block || s->quit_at_block, S2_END_BLOCK) |
         bit(has_dwell(s), S2_DWELL) | faults(cs) | MODES[s->mode];
}

uint32_t motion_global_status2(void) {
  enum open_buffer open = open_buffer_kind();
  bool rotary = open == OPEN_ROTARY;
  const uint32_t product = hal_strap(HAL_STRAP_PRODUCT);
  return bit((product & HAL_PRODUCT_ULTRALITE) != 0u, G2_ULTRALITE) | bit((product & HAL_PRODUCT_UMAC) != 0u, G2_UMAC) |
         bit(open == OPEN_BINARY_ROTARY, G2_BINARY_ROTARY_OPEN) |
         bit(rotary || open_buffer_is_fixed(FIXED_PROG), G2_MOTION_OPEN) | bit(rotary, G2_ROTARY_OPEN) |
         bit(open_buffer_is_fixed(FIXED_PLC), G2_PLC_OPEN) | bit(open_buffer_is_fixed(FIXED_FORWARD), G2_FORWARD_OPEN) |
         bit(open_buffer_is_fixed(FIXED_INVERSE), G2_INVERSE_OPEN) | bit(buffer_request_fixed_full(), G2_FIXED_FULL);
}
