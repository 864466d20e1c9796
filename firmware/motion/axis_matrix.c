#include "firmware/motion/axis_matrix.h"

#include "firmware/base/float48.h"
#include "firmware/base/mathematics.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/slice.h"
#include "firmware/variables/pq_variables.h"

enum { N = 3, ROTATION = N * N, WORDS = ROTATION + N, Q_NUMBERS = 8192 };

/* Rows of R, then D, as in TBUF. */
struct matrix {
  double r[ROTATION], d[N];
};

static struct selection {
  uint32_t number; /* 0: none */
  struct matrix now;
  double back[ROTATION]; /* the inverse of R */
  bool mirrors;          /* its determinant is below 0 */
} selections[COORDINATE_SYSTEMS];

static const struct matrix UNIT = {{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};

static uint32_t count(void) { return region_words(REGION_TBUF, 0) / WORDS; }

static double* element(struct matrix* m, uint32_t i) { return i < ROTATION ? &m->r[i] : &m->d[i - ROTATION]; }

static void store(uint32_t number, struct matrix m) {
  const uint32_t base = region_base(REGION_TBUF, 0) + (number - 1u) * WORDS;
  for (uint32_t i = 0; i < WORDS; i++) {
    const struct float48 word = float48_pack(*element(&m, i));
    user_memory_write(base + i, (word48_t)word.x << 24 | word.y);
    slice_pause();
  }
}

static struct matrix load(uint32_t number) {
  const uint32_t base = region_base(REGION_TBUF, 0) + (number - 1u) * WORDS;
  struct matrix m;
  for (uint32_t i = 0; i < WORDS; i++) {
    const word48_t word = user_memory_read(base + i);
    *element(&m, i) = float48_unpack((struct float48){(uint32_t)(word >> 24), (uint32_t)word & HAL_WORD_MASK});
    slice_pause();
  }
  return m;
}

void axis_matrix_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) selections[cs].number = 0;
}

void axis_matrix_clear(void) {
  axis_matrix_initialize();
  for (uint32_t number = 1; number <= count(); number++) store(number, UNIT);
}

/* One whose TBUF has gone is none. */
bool axis_matrix_is_selected(uint32_t cs) { return selections[cs].number - 1u < count(); }

static double multiply(double a, double b) {
  if (a == 0.0 || b == 0.0) return 0.0;
  slice_pause();
  return a * b;
}

/* The minor of row i and column k with its sign. */
static double cofactor(const double r[ROTATION], uint32_t i, uint32_t k) {
  const uint32_t i1 = (i + 1u) % N, i2 = (i + 2u) % N, k1 = (k + 1u) % N, k2 = (k + 2u) % N;
  return multiply(r[i1 * N + k1], r[i2 * N + k2]) - multiply(r[i1 * N + k2], r[i2 * N + k1]);
}

/* False: there is no inverse. */
static bool adopt(struct selection* s, const struct matrix* m) {
  double cofactors[ROTATION], determinant = 0.0;
  for (uint32_t i = 0; i < ROTATION; i++) cofactors[i] = cofactor(m->r, i / N, i % N);
  for (uint32_t k = 0; k < N; k++) determinant += multiply(m->r[k], cofactors[k]);
  if (determinant == 0.0) return false;
  for (uint32_t i = 0; i < ROTATION; i++) {
    s->back[(i % N) * N + i / N] = cofactors[i] == 0.0 ? 0.0 : cofactors[i] / determinant;
    slice_pause();
  }
  s->now = *m;
  s->mirrors = determinant < 0.0;
  return true;
}

bool axis_matrix_select(uint32_t cs, double number) {
  struct selection* s = &selections[cs];
  const int64_t wanted = math_to_integer(number);
  if (wanted < 0 || wanted > (int64_t)count()) return false;
  if (wanted != 0) {
    const struct matrix m = load((uint32_t)wanted);
    if (!adopt(s, &m)) return false;
  }
  s->number = (uint32_t)wanted;
  return true;
}

static double variable(uint32_t cs, int64_t number) {
  slice_pause();
  return q_variable_read(cs, (uint32_t)number);
}

static void turn(uint32_t cs, struct matrix* m, int64_t q, bool more) {
  const struct matrix old = *m;
  for (uint32_t i = 0; i < ROTATION; i++) {
    if (!more) m->r[i] = variable(cs, q + i);
    if (!more) continue;
    m->r[i] = 0.0;
    for (uint32_t k = 0; k < N; k++) m->r[i] += multiply(variable(cs, q + (i / N) * N + k), old.r[k * N + i % N]);
  }
}

static void displace(uint32_t cs, struct matrix* m, int64_t q, bool more) {
  for (uint32_t i = 0; i < N; i++) m->d[i] = variable(cs, q + i) + (more ? m->d[i] : 0.0);
}

bool axis_matrix_change(uint32_t cs, enum matrix_change change, double q) {
  struct selection* s = &selections[cs];
  struct matrix m = change == MATRIX_TINIT ? UNIT : s->now;
  const int64_t first = math_to_integer(q);
  if (!axis_matrix_is_selected(cs) || first < 0 || first >= Q_NUMBERS) return false;
  if (change == MATRIX_AROT || change == MATRIX_IROT) turn(cs, &m, first, change == MATRIX_IROT);
  if (change == MATRIX_ADIS || change == MATRIX_IDIS) displace(cs, &m, first, change == MATRIX_IDIS);
  if (!adopt(s, &m)) return false;
  store(s->number, m);
  return true;
}

static double row(const double matrix[ROTATION], uint32_t i, const double vector[N]) {
  double sum = 0.0;
  for (uint32_t k = 0; k < N; k++) sum += multiply(matrix[i * N + k], vector[k]);
  return sum;
}

double axis_matrix_programmed(uint32_t cs, uint32_t axis) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct selection* m = &selections[cs];
  if (axis < AXIS_X || axis > AXIS_Z || !axis_matrix_is_selected(cs)) return s->position[axis];
  return row(m->now.r, axis - AXIS_X, &s->position[AXIS_X]) + m->now.d[axis - AXIS_X];
}

static void lead_back(const struct selection* m, double vector[N]) {
  const double programmed[N] = {vector[0], vector[1], vector[2]};
  for (uint32_t i = 0; i < N; i++) vector[i] = row(m->back, i, programmed);
}

static void lead_back_point(const struct selection* m, double point[N]) {
  for (uint32_t i = 0; i < N; i++) point[i] -= m->now.d[i];
  lead_back(m, point);
}

static void set_targets(uint32_t cs, const struct selection* m) {
  struct coordinate_system* s = &coordinate_systems[cs];
  for (uint32_t axis = AXIS_X; axis <= AXIS_Z; axis++)
    if ((s->pending_axes >> axis & 1u) == 0) s->pending[axis] = axis_matrix_programmed(cs, axis);
  lead_back_point(m, &s->pending[AXIS_X]);
  const bool absolute = (s->pending_axes & AXIS_XYZ & ~s->pending_absolute) == 0;
  s->pending_absolute = absolute ? s->pending_absolute | AXIS_XYZ : s->pending_absolute & ~(uint32_t)AXIS_XYZ;
  s->pending_axes |= AXIS_XYZ;
}

/* What is not given is 0; of the centre of an arc, as at its start. */
static void set_vector(uint32_t cs, const struct selection* m) {
  struct coordinate_system* s = &coordinate_systems[cs];
  for (uint32_t i = 0; i < N; i++)
    if ((s->pending_vectors >> i & 1u) == 0)
      s->pending_vector[i] = s->vector_absolute ? axis_matrix_programmed(cs, AXIS_X + i) : 0.0;
  if (s->vector_absolute)
    lead_back_point(m, s->pending_vector);
  else
    lead_back(m, s->pending_vector);
  s->pending_vectors |= (1u << N) - 1u;
}

void axis_matrix_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const struct selection* m = &selections[cs];
  if (!axis_matrix_is_selected(cs)) return;
  if ((s->pending_vectors & ((1u << N) - 1u)) != 0) set_vector(cs, m);
  if ((s->pending_axes & AXIS_XYZ) != 0) set_targets(cs, m);
  if ((s->pending_velocities & AXIS_XYZ) == 0) return;
  for (uint32_t axis = AXIS_X; axis <= AXIS_Z; axis++)
    if ((s->pending_velocities >> axis & 1u) == 0) s->pending_velocity[axis] = 0.0;
  lead_back(m, &s->pending_velocity[AXIS_X]);
  s->pending_velocities |= AXIS_XYZ;
}

/* By the transpose of R, which is how planes go over; a mirror turns the sense. */
void axis_matrix_normal(uint32_t cs, double normal[3]) {
  const struct selection* m = &selections[cs];
  if (!axis_matrix_is_selected(cs)) return;
  const double programmed[N] = {normal[0], normal[1], normal[2]};
  for (uint32_t i = 0; i < N; i++) {
    normal[i] = 0.0;
    for (uint32_t k = 0; k < N; k++) normal[i] += multiply(m->now.r[k * N + i], programmed[k]);
    if (m->mirrors) normal[i] = -normal[i];
  }
}
