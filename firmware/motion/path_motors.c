#include "firmware/motion/path_motors.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_turn.h"
#include "firmware/motion/system_motors.h"

enum { PAUSE_MOTORS = 8 };

#define TWO_PI 6.28318530717958647692

#define RADIUS_MOST (INT64_C(1) << 58) /* what is nearly straight in the range of positions is straight beyond this */

/* A move as a motor makes it: where it ends and the way to there from the end before it; of an arc what the larger of
 * its radii is in its two directions, in the first of them twice that: the part that goes with it is halved, from -2 to
 * 0. What they do not make of the way goes evenly, `along`: an arc ends where its end is. */
struct way {
  int64_t end, whole, along, first, second;
  bool turns;
};

/* Of the first move's start, and of the moves by their places in the queue. A motor belongs to one system. Of one that
 * an inverse program moves: what it stands beside that, and comes along with the first move. */
static struct {
  int64_t start;
  struct way ways[PATH_MOVES];
} motors_of_path[MOTORS] __attribute__((section(".noinit")));

/* An arc: its angle, and its radii at the start and what that grows by, of the larger one. */
struct arc {
  int64_t angle, from, growth;
};
static struct arc arcs[COORDINATE_SYSTEMS][PATH_MOVES] __attribute__((section(".noinit")));

/* What it has made of its radius in its two directions. */
struct turned {
  int64_t first, second;
};

/* What is looked at, of the system that is worked for: moves that have begun. */
static struct {
  uint32_t by_program; /* motors that an inverse program moves: it has been executed for the point */
  uint32_t count;
  struct {
    uint32_t place;
    int64_t part;
    struct turned turned;
  } moves[PATH_MOVES];
} at;

static uint32_t place_of(const struct path* p, uint32_t ahead) { return (p->first + ahead) % PATH_MOVES; }

static int64_t magnitude(int64_t value) { return value < 0 ? -value : value; }

/* product of two parts */
static int64_t product(int64_t a, int64_t b) { return fixed_share(a >> 2, b) * 4; }

static struct turned turned_of(const struct arc* arc, int64_t part) {
  const struct fixed_direction to = fixed_direction_of(fixed_share(arc->angle, part));
  slice_pause();
  const int64_t radius = arc->from + product(arc->growth, part);
  return (struct turned){(product(to.cosine, radius) - arc->from) / 2, product(to.sine, radius)};
}

/* What a radius is in a direction of the plane. */
static int64_t radius_in(uint32_t motor, const double direction[CIRCLE_AXES], double radius) {
  double velocity[AXIS_COUNT] = {0};
  for (uint32_t i = 0; i < CIRCLE_AXES; i++) velocity[AXIS_X + i] = direction[i];
  slice_pause();
  double value = system_motor_velocity_at(motor, velocity);
  value *= radius;
  slice_pause();
  return math_to_integer(value + 0.5);
}

static void turn(uint32_t motor, const struct path_move* m, double largest, const struct turned* end, struct way* way) {
  way->first = radius_in(motor, m->circle.first, largest + largest);
  way->second = radius_in(motor, m->circle.second, largest);
  slice_pause();
  const bool is_round = way->first != 0 || way->second != 0;
  way->turns = is_round && magnitude(way->first) < 2 * RADIUS_MOST && magnitude(way->second) < RADIUS_MOST;
  if (way->turns) way->along = way->whole - fixed_share(way->first, end->first) - fixed_share(way->second, end->second);
}

static double set_arc(uint32_t cs, uint32_t place, const struct circle* c) {
  const double end = c->radius + c->growth, largest = end > c->radius ? end : c->radius;
  slice_pause();
  const double angle = c->angle / TWO_PI;
  slice_pause();
  arcs[cs][place].angle = math_to_integer(math_scale(angle, FIXED_TURN_BITS));
  const double growth = c->growth / largest;
  slice_pause();
  arcs[cs][place].growth = math_to_integer(math_scale(growth, 62));
  arcs[cs][place].from = c->growth > 0.0 ? PATH_WHOLE - arcs[cs][place].growth : PATH_WHOLE;
  return largest;
}

/* Those whose definitions are sums of axes; the others are moved by a program. */
static uint32_t defined(uint32_t cs) { return coordinate_systems[cs].motors & ~coordinate_systems[cs].inverse_motors; }

void path_motors_begin(uint32_t cs) {
  const struct path_move* m = path_of(&paths[cs], 0);
  for (uint32_t motor = 0, left = defined(cs); left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    motors_of_path[motor].start = math_nearest(system_motor_from(motor, m->start));
    slice_pause();
  }
  for (uint32_t motor = 0, left = coordinate_systems[cs].inverse_motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    motors_of_path[motor].start = math_nearest(system_motor_aside(motor));
    slice_pause();
  }
  path_motors_join(cs, 0);
}

void path_motors_join(uint32_t cs, uint32_t ahead) {
  const struct path_move* m = path_of(&paths[cs], ahead);
  const uint32_t place = place_of(&paths[cs], ahead);
  const double largest = m->is_arc ? set_arc(cs, place, &m->circle) : 0.0;
  slice_pause();
  const struct turned turned = m->is_arc ? turned_of(&arcs[cs][place], PATH_WHOLE) : (struct turned){0};
  for (uint32_t motor = 0, left = defined(cs); left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct way *ways = motors_of_path[motor].ways, *way = &ways[place];
    const double position = system_motor_at(motor, m->end);
    way->end = math_nearest(position);
    way->whole = way->end - (ahead == 0 ? motors_of_path[motor].start : ways[place_of(&paths[cs], ahead - 1u)].end);
    way->turns = false;
    slice_pause();
    if (m->is_arc && (system_motor_axes(motor) & AXIS_XYZ) != 0) turn(motor, m, largest, &turned, way);
  }
}

void path_motors_pop(uint32_t cs) {
  const uint32_t place = place_of(&paths[cs], 0);
  const uint32_t by_program = coordinate_systems[cs].inverse_motors;
  slice_pause();
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) != 0) motors_of_path[motor].start = motors_of_path[motor].ways[place].end;
    if ((by_program >> motor & 1u) != 0) motors_of_path[motor].start = 0;
    if (motor % PAUSE_MOTORS == PAUSE_MOTORS - 1u) slice_pause();
  }
}

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
    at.moves[n].turned = turned_of(&arcs[cs][place], part);
  }
}

static __attribute__((noinline)) int64_t on_arc(const struct way* way, uint32_t move) {
  slice_pause();
  return fixed_share(way->along, at.moves[move].part) + fixed_share(way->first, at.moves[move].turned.first) +
         fixed_share(way->second, at.moves[move].turned.second);
}

static __attribute__((noinline)) int64_t by_program(uint32_t motor) {
  const int64_t aside = motors_of_path[motor].start;
  const double position = system_motor_solved(motor);
  slice_pause();
  const int64_t nearest = math_nearest(position);
  if (aside == 0) return nearest;
  return nearest + aside - (at.count == 0 ? 0 : fixed_share(aside, at.moves[0].part));
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
