#include "firmware/motion/corner.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/motor.h"

enum { ISX82 = 1, ISX85 = 2 }; /* behind Isx81, behind Isx83 */

/* Cosine of the angle by which the direction of X, Y, Z changes; 1 where there is none. */
static double cosine(const double before[AXIS_COUNT], const double after[AXIS_COUNT]) {
  double product = 0.0, first = 0.0, second = 0.0;
  for (uint32_t axis = AXIS_X; axis <= AXIS_Z; axis++) {
    if (before[axis] == 0.0 && after[axis] == 0.0) continue;
    product += before[axis] * after[axis];
    slice_pause();
    first += before[axis] * before[axis];
    slice_pause();
    second += after[axis] * after[axis];
    slice_pause();
  }
  if (first == 0.0 || second == 0.0) return 1.0;
  const double length = math_square_root(first * second);
  return product / length;
}

bool corner_is_sharp(uint32_t cs, const double before[AXIS_COUNT], const double after[AXIS_COUNT], bool* has_dwell) {
  const double limit = cs_real(cs, ISX83_CORNER_RULES);
  if (limit == 0.0) return false;
  const double turn = cosine(before, after);
  slice_pause();
  if (!(turn < limit)) return false;
  *has_dwell = turn < i_variable_read(i_cs_real(cs, ISX83_CORNER_RULES) + ISX85);
  return true;
}

void corner_plan(uint32_t cs, struct move* m) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->may_join || !corner_is_sharp(cs, s->last_delta, m->delta, &m->has_dwell)) return;
  m->is_sharp = true;
  s->may_join = false;
}

static bool in_position(const struct coordinate_system* s) {
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && !motors[motor].found.in_position) return false;
  return true;
}

static void begin(struct coordinate_system* s, enum corner_stop stop) {
  s->corner = stop;
  s->corner_began = cs_interrupts;
}

bool corner_waits(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* next = &s->moves[s->executing ^ 1u];
  const uint32_t longest = (uint32_t)i_integer(i_cs(cs, ISX81_BLEND_CONTROL));
  const uint32_t dwell = next->has_dwell ? (uint32_t)i_integer(i_cs(cs, ISX81_BLEND_CONTROL) + ISX82) : 0u;
  if (next->joins || s->first || (longest == 0u && dwell == 0u)) return false;
  if (s->active || !piece_ring_is_empty(&s->ring)) return true;
  if (s->corner == CORNER_NONE) begin(s, CORNER_IN_POSITION);
  if (s->corner == CORNER_IN_POSITION) {
    if (longest == 0u || in_position(s))
      begin(s, CORNER_DWELL);
    else if (cs_interrupts - s->corner_began >= longest)
      s->failure = RUN_TIME_IN_POSITION;
  }
  if (s->corner != CORNER_DWELL || cs_interrupts - s->corner_began < dwell) return true;
  s->corner = CORNER_NONE;
  return false;
}
