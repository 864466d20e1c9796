#include "firmware/motion/path_motors.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_turn.h"
#include "firmware/motion/system_motors.h"

#define TWO_PI 6.28318530717958647692

/* A move as a motor makes it: from its start to its end; of an arc what goes evenly, and what the larger of its radii
 * is in its two directions, in the first of them twice that: the part that goes with it is halved, from -2 to 0. */
struct way {
  int64_t whole, along, first, second;
  bool turns;
};

/* Of the first move's start and of the last one's end, and of the moves by their places in the queue. A motor belongs
 * to one system. */
static struct {
  int64_t start, end;
  struct way ways[PATH_MOVES];
} motors_of_path[MOTORS] __attribute__((section(".noinit")));

/* An arc: its angle, and its radii at the start and what that grows by, of the larger one. */
static struct { int64_t angle, from, growth; } arcs[COORDINATE_SYSTEMS][PATH_MOVES] __attribute__((section(".noinit")));

/* What is looked at, of the system that is worked for: moves that have begun. */
static struct {
  uint32_t by_program; /* motors that an inverse program moves: it has been executed for the point */
  uint32_t count;
  struct {
    uint32_t place;
    int64_t part, first, second;
  } moves[PATH_MOVES];
} at;

static uint32_t place_of(const struct path* p, uint32_t ahead) { return (p->first + ahead) % PATH_MOVES; }

/* What goes evenly of an arc are the other axes, and its way out of the plane. */
static void turn(uint32_t motor, const struct path_move* m, double largest, struct way* way) {
  double along[AXIS_COUNT], first[AXIS_COUNT] = {0}, second[AXIS_COUNT] = {0};
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) along[axis] = m->delta[axis];
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) {
    along[AXIS_X + i] = m->circle.along[i];
    first[AXIS_X + i] = m->circle.first[i];
    second[AXIS_X + i] = m->circle.second[i];
  }
  slice_pause();
  double value = system_motor_velocity_at(motor, along);
  slice_pause();
  way->along = math_nearest(value);
  slice_pause();
  value = system_motor_velocity_at(motor, first);
  slice_pause();
  value *= largest + largest;
  slice_pause();
  way->first = math_nearest(value);
  slice_pause();
  value = system_motor_velocity_at(motor, second);
  slice_pause();
  value *= largest;
  slice_pause();
  way->second = math_nearest(value);
  slice_pause();
  way->turns = way->first != 0 || way->second != 0;
}

static double set_arc(uint32_t cs, uint32_t place, const struct circle* c) {
  const double end = c->radius + c->growth, largest = end > c->radius ? end : c->radius;
  slice_pause();
  const double angle = c->angle / TWO_PI;
  slice_pause();
  arcs[cs][place].angle = math_to_integer(math_scale(angle, FIXED_TURN_BITS));
  slice_pause();
  const double growth = c->growth / largest;
  slice_pause();
  arcs[cs][place].growth = math_to_integer(math_scale(growth, 62));
  arcs[cs][place].from = c->growth > 0.0 ? PATH_WHOLE - arcs[cs][place].growth : PATH_WHOLE;
  slice_pause();
  return largest;
}

/* Those whose definitions are sums of axes. */
static uint32_t defined(uint32_t cs) { return coordinate_systems[cs].motors & ~coordinate_systems[cs].inverse_motors; }

void path_motors_begin(uint32_t cs) {
  const struct path_move* m = path_of(&paths[cs], 0);
  for (uint32_t motor = 0, left = defined(cs); left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    motors_of_path[motor].start = motors_of_path[motor].end = math_nearest(system_motor_from(motor, m->start));
    slice_pause();
  }
  path_motors_join(cs, 0);
}

void path_motors_join(uint32_t cs, uint32_t ahead) {
  const struct path_move* m = path_of(&paths[cs], ahead);
  const uint32_t place = place_of(&paths[cs], ahead);
  const double largest = m->is_arc ? set_arc(cs, place, &m->circle) : 0.0;
  slice_pause();
  for (uint32_t motor = 0, left = defined(cs); left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct way* way = &motors_of_path[motor].ways[place];
    const double position = system_motor_at(motor, m->end);
    slice_pause();
    const int64_t end = math_nearest(position);
    way->whole = end - motors_of_path[motor].end;
    way->turns = false;
    motors_of_path[motor].end = end;
    slice_pause();
    if (m->is_arc && (system_motor_axes(motor) & AXIS_XYZ) != 0) turn(motor, m, largest, way);
  }
}

void path_motors_pop(uint32_t cs) {
  const uint32_t place = place_of(&paths[cs], 0);
  for (uint32_t motor = 0, left = defined(cs); left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) motors_of_path[motor].start += motors_of_path[motor].ways[place].whole;
  slice_pause();
}

/* product of two parts */
static int64_t product(int64_t a, int64_t b) { return fixed_share(a >> 2, b) * 4; }

static void look_by_program(uint32_t cs, const struct path_point* point) {
  double position[AXIS_COUNT];
  at.by_program = coordinate_systems[cs].inverse_motors;
  if (at.by_program == 0) return;
  path_axes_at(&paths[cs], point, position);
  slice_pause();
  system_motors_solve(cs, position);
  slice_pause();
}

void path_motors_look(uint32_t cs, const struct path_point* point) {
  look_by_program(cs, point);
  at.count = 0;
  for (uint32_t i = 0; i < point->count; i++) {
    const int64_t part = point->parts[i];
    if (part == 0) continue;
    const uint32_t n = at.count++, place = place_of(&paths[cs], i);
    at.moves[n].place = place;
    at.moves[n].part = part;
    if (part == PATH_WHOLE || !path_of(&paths[cs], i)->is_arc) continue;
    slice_pause();
    const struct fixed_direction to = fixed_direction_of(fixed_share(arcs[cs][place].angle, part));
    const int64_t radius = arcs[cs][place].from + product(arcs[cs][place].growth, part);
    at.moves[n].first = (product(to.cosine, radius) - arcs[cs][place].from) / 2;
    at.moves[n].second = product(to.sine, radius);
    slice_pause();
  }
}

static __attribute__((noinline)) int64_t on_arc(const struct way* way, uint32_t move) {
  slice_pause();
  return fixed_share(way->along, at.moves[move].part) + fixed_share(way->first, at.moves[move].first) +
         fixed_share(way->second, at.moves[move].second);
}

static __attribute__((noinline)) int64_t by_program(uint32_t motor) {
  slice_pause();
  const double position = system_motor_solved(motor);
  slice_pause();
  const int64_t nearest = math_nearest(position);
  slice_pause();
  return nearest;
}

int64_t path_motor_at(uint32_t motor) {
  if ((at.by_program >> motor & 1u) != 0) return by_program(motor);
  const struct way* ways = motors_of_path[motor].ways;
  int64_t position = motors_of_path[motor].start;
  for (uint32_t i = 0; i < at.count; i++) {
    const struct way* way = &ways[at.moves[i].place];
    const int64_t part = at.moves[i].part;
    if (part == PATH_WHOLE || !way->turns)
      position += part == PATH_WHOLE ? way->whole : fixed_share(way->whole, part);
    else
      position += on_arc(way, i);
  }
  return position;
}
