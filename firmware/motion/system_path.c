#include "firmware/motion/system_path.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/time_base.h"

/* A hold stops the trajectory, and what is about to leave it stays at its rate, whatever the time base is. */
static int32_t target_of(const struct coordinate_system* s) {
  return s->time_base_source == 0 || s->held || s->settling ? s->increment_target : time_base_external(s);
}

static void slew_time_base(struct coordinate_system* s) {
  int32_t present = s->increment, target = target_of(s), slew = s->increment_slew;
  if (present < target)
    s->increment = target - present > slew ? present + slew : target;
  else if (present > target)
    s->increment = present - target > slew ? present - slew : target;
  if (s->increment == target && !s->held) s->increment_slew = s->increment_usual; /* a hold's end went at another */
  s->increment_before = present;
}

static void go_to(struct motor* m, int64_t position) { m->trajectory = m->of_system = position; }

/* Motors that are not in the piece under way stand where the one before it ends. One that was cut short has all its
 * motors there. */
static void end_pieces(struct coordinate_system* s, uint32_t first) {
  const uint32_t follows = s->active ? piece_ring_at(&s->ring, s->ring.executing)->motors : 0u;
  for (uint32_t number = first; number != s->ring.executing; number++) {
    const struct piece* piece = piece_ring_at(&s->ring, number);
    if (piece->end != piece->time) continue;
    for (uint32_t motor = 0, left = piece->motors & ~follows; left != 0; motor++, left >>= 1)
      if ((left & 1u) != 0 && motors[motor].path == PATH_SYSTEM)
        go_to(&motors[motor], piece_end(piece, piece_ring_cubic(&s->ring, number, motor)));
  }
}

static void follow(struct coordinate_system* s) {
  const uint32_t number = s->ring.executing, fraction = s->ring.fraction;
  const struct cubic* cubic = piece_ring_cubic(&s->ring, number, 0);
  struct motor* m = motors;
  for (uint32_t left = piece_ring_at(&s->ring, number)->motors; left != 0; left >>= 1, m++, cubic++)
    if ((left & 1u) != 0 && m->path == PATH_SYSTEM) go_to(m, cubic_at(cubic, fraction));
}

/* From rest a move begins with the interrupt: what the one before has left of it is lost. */
static void begin_move(struct coordinate_system* s, uint32_t first, uint32_t number) {
  const uint32_t move = piece_ring_at(&s->ring, number)->move;
  if (piece_ring_at(&s->ring, number)->continues) { /* on the way back none starts again */
    if ((int32_t)(move - s->started) > 0) s->started = move;
    return;
  }
  s->executing ^= 1u;
  s->started = move;
  s->next_valid = s->placed = false; /* the real-time task sees room for another move */
  if (!s->moves[s->executing].blended) {
    s->ring.elapsed = 0;
    s->ring.fraction = 0;
  }
  s->elapsed = s->ring.elapsed;
  for (uint32_t i = first; i != number; i++) /* those of it that are over already */
    if (piece_ring_at(&s->ring, i)->move == move) s->elapsed += piece_ring_at(&s->ring, i)->end;
}

/* The first piece of a sequence that has been passed over within this interrupt. */
static void begin_passed(struct coordinate_system* s, uint32_t first, uint32_t number) {
  for (uint32_t i = first; i != number; i++)
    if (!piece_ring_at(&s->ring, i)->continues && piece_ring_at(&s->ring, i)->move != s->started)
      begin_move(s, first, i);
}

static bool goes_alone(const struct move* m) {
  if (m->kind != MOVE_OWN) return false;
  for (uint32_t motor = 0, left = m->own; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && jog_is_moving(motor)) return true;
  return false;
}

static void advance(struct coordinate_system* s) {
  if (goes_alone(&s->moves[s->executing])) return;
  const bool dwells = s->moves[s->executing].kind == MOVE_DWELL; /* real time: the time base does not count */
  const int32_t increment = dwells ? s->increment_full : s->increment;
  const uint32_t first = s->ring.executing;
  s->elapsed += increment;
  s->active = piece_ring_advance(&s->ring, increment);
  if (s->ring.executing != first) end_pieces(s, first);
  const uint32_t number = s->active ? s->ring.executing : s->ring.executing - 1u;
  if (piece_ring_at(&s->ring, number)->continues) begin_passed(s, first, number);
  if (piece_ring_at(&s->ring, number)->move != s->started) begin_move(s, first, number);
  if (s->active) follow(s);
}

static __attribute__((noinline)) void update(struct coordinate_system* s) {
  slew_time_base(s);
  if (s->settling && s->motors == 0) return;
  if (s->active) {
    advance(s);
  } else if (!piece_ring_is_empty(&s->ring)) {
    s->active = true;
    begin_move(s, s->ring.executing, s->ring.executing);
  }
}

void system_path_servo(void) {
  uint32_t left = cs_busy;
  for (uint32_t cs = 0; left != 0; cs++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct coordinate_system* s = &coordinate_systems[cs];
    update(s);
    const bool stands = !s->active && piece_ring_is_empty(&s->ring);
    if (stands && s->time_base_source == 0 && s->increment == s->increment_target) cs_busy &= ~(1u << cs);
  }
}
