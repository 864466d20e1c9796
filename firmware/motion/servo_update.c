/* clang-format off */
/* Servo task of the coordinate systems: advances trajectory time and goes from move to move. Integer arithmetic only.
 *
 *   velocity   _____________              A move changes velocity during its first `blend_in` units, its corner lies in
 *            /:             \:            the middle of that; the next corner is Tm later. The next move, if it is
 *           / :              :\______     there in time, begins half its own acceleration time before that corner,
 *    ______/  :              :            else the velocity falls to zero during Ta around the corner. From rest to
 *          |<>|blend_in/2    corner + Tm  rest a move so takes Tm + Ta. */
/* clang-format on */
#include "firmware/motion/servo_update.h"

#include "firmware/motion/coordinate_system.h"

static void slew_time_base(struct coordinate_system* s) {
  int32_t present = s->increment, target = s->increment_target, slew = s->increment_slew;
  if (present < target)
    s->increment = target - present > slew ? present + slew : target;
  else if (present > target)
    s->increment = present - target > slew ? present - slew : target;
}

static void begin(struct coordinate_system* s, int64_t elapsed, int64_t blend_in, bool blended) {
  s->executing ^= 1u;
  struct move* m = &s->moves[s->executing];
  m->blend_in = blend_in;
  m->blended = blended;
  s->elapsed = elapsed;
  s->active = true;
  s->blend_decided = false;
  s->stop_length = m->acceleration;
  s->started++;
  s->next_valid = false; /* the real-time task sees room for another move */
}

static void begin_from_rest(struct coordinate_system* s) {
  if (s->next_valid && !s->end_block) begin(s, 0, s->moves[s->executing ^ 1u].acceleration, false);
}

/* The next move joins if it was there before this one began to stop, and R has taken back a `/` by then; a blend that
 * should have begun earlier is shortened. A `/` that comes behind that, while a shorter blend is still to begin, stops
 * the move in what is left of it: at its corner as ever, and never within less than that blend. */
static bool try_blend(struct coordinate_system* s, int64_t corner) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  const bool possible = s->next_valid && !s->end_block && next->joins;
  if (s->elapsed - s->increment < corner - s->stop_length / 2) {
    s->blend_decided = possible;
  } else if (s->blend_decided && !possible) {
    s->blend_decided = false;
    s->stop_length = s->elapsed < corner ? 2 * (corner - s->elapsed) : 0;
  }
  if (!s->blend_decided) return false;
  int64_t half = next->acceleration / 2;
  int64_t longest = m->time - m->blend_in / 2; /* a blend cannot begin before this move's own has ended */
  if (half > longest) half = longest;
  int64_t into = s->elapsed - (corner - half);
  if (into < 0) return true;
  if (into > s->increment) {
    half = s->elapsed < corner ? corner - s->elapsed : 0;
    into = 0;
  }
  begin(s, into, 2 * half, true);
  return true;
}

static void update_linear(struct coordinate_system* s) {
  const struct move* m = &s->moves[s->executing];
  int64_t corner = m->blend_in / 2 + m->time;
  if (try_blend(s, corner)) return;
  if (s->elapsed < corner + s->stop_length / 2) return;
  s->active = false;
  begin_from_rest(s);
}

static void update_dwell(struct coordinate_system* s) {
  if (s->elapsed < s->moves[s->executing].time) return;
  s->active = false;
  begin_from_rest(s);
}

static __attribute__((noinline)) void update(struct coordinate_system* s) {
  slew_time_base(s);
  if (s->settling) return;
  if (!s->active) {
    begin_from_rest(s);
    return;
  }
  if (s->moves[s->executing].kind == MOVE_DWELL) {
    s->elapsed += s->increment_full; /* real time: the time base does not count */
    update_dwell(s);
  } else {
    s->elapsed += s->increment;
    update_linear(s);
  }
}

void servo_update(void) {
  uint32_t left = cs_busy;
  for (uint32_t cs = 0; left != 0; cs++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct coordinate_system* s = &coordinate_systems[cs];
    update(s);
    if (!s->active && !s->next_valid && s->increment == s->increment_target) cs_busy &= ~(1u << cs);
  }
}
