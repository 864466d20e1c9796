/* Measured:  Id = Ib sin(th) - Ia sin(th+phi),  Iq = Ib cos(th) - Ia cos(th+phi),  both times -sin(phi): positive for
 *            Ixx72 above 1024 and currents counted into the motor. With the other half of Ixx72, or currents counted
 *            out of it, feedback is positive and the loop runs away.
 * Loop:      Vx = 8 Ixx61 sum(Icmd - Iact) + 4 Ixx62 (Icmd - Iact) - 4 Ixx76 Iact, at most the full voltage. The sum
 *            does not grow further while Vx is at its end.
 * Put out:   A = Vd cos(th) - Vq sin(th), B the same at th+phi, C = -A - B; the middle one of them, halved, is added
 *            to all three (it has three times their frequency, and 15 % more voltage between phases is to be had);
 *            clipped, times Ixx66. */
#include "firmware/motion/current_loop.h"

#include "firmware/motion/fixed_point.h"
#include "firmware/motion/phase_table.h"

enum { CURRENTS = 0x39, INTEGRATORS = 0x3C };                              /* registers: X q, Y d */
enum { FULL_VOLTAGE = 1 << VOLTAGE_FRACTION_BITS };                        /* of d and q */
enum { FULL_PHASE = 1 << 29, TO_SINE = 7 };                                /* of a phase: 2^-30 times a sine */
enum { SHOWN_CURRENT = CURRENT_FRACTION_BITS - 23, SHOWN_INTEGRATOR = 3 }; /* shifts: 2^-23, 2^-20 */

static inline int32_t measured(const struct phase_settings* s, uint32_t phase) { /* 2^-29 of full scale */
  return ((int32_t)((*s->measured[phase] & s->mask) << 8) >> 2) + s->bias[phase];
}

/* Iact of one axis by sine or cosine of both phases. */
static inline int32_t seen(int32_t a, int32_t b, int32_t at_a, int32_t at_b) {
  return fixed_high(b, at_a) - fixed_high(a, at_b);
}

static inline int32_t control(struct phase_axis* x, const struct phase_settings* s) {
  const int32_t error = x->command - x->actual;
  const int32_t growth = fixed_high(error, s->integral), sum = x->integrator + growth;
  const int32_t voltage = sum + fixed_high(error, s->proportional) - fixed_high(x->actual, s->back);
  if (voltage > FULL_VOLTAGE) {
    if (growth < 0) x->integrator = sum;
    return FULL_VOLTAGE;
  }
  if (voltage < -FULL_VOLTAGE) {
    if (growth > 0) x->integrator = sum;
    return -FULL_VOLTAGE;
  }
  x->integrator = sum;
  return voltage;
}

/* Of three with the sum 0, half of the middle one. */
static inline int32_t half_of_middle(int32_t a, int32_t b, int32_t c) {
  int32_t highest = a > b ? a : b, lowest = a > b ? b : a;
  if (c > highest) highest = c;
  if (c < lowest) lowest = c;
  return -(highest + lowest) / 2;
}

static inline uint32_t word(int32_t phase, int32_t scale) {
  return (uint32_t)fixed_high(fixed_within(phase, FULL_PHASE), scale) & HAL_WORD_MASK;
}

static inline void show(uint32_t address, int32_t q, int32_t d, unsigned shift) {
  *hal_x(address) = (uint32_t)(q >> shift) & HAL_WORD_MASK;
  *hal_y(address) = (uint32_t)(d >> shift) & HAL_WORD_MASK;
}

void current_loop(struct phase_motor* m, uint32_t angle, uint32_t words) {
  const struct phase_settings* s = &m->settings;
  const struct phase_sines a = phase_sines(s, angle), b = phase_sines(s, angle + s->second);
  const int32_t current_a = measured(s, 0), current_b = measured(s, 1);
  m->q.actual = seen(current_a, current_b, a.cosine, b.cosine);
  m->d.actual = s->brush ? 0 : seen(current_a, current_b, a.sine, b.sine);
  show(words + CURRENTS, m->q.actual, m->d.actual, SHOWN_CURRENT);
  int32_t vq = 0, vd = 0;
  if (m->enabled) {
    vq = control(&m->q, s) * (1 << TO_SINE);
    if (!s->brush) vd = control(&m->d, s) * (1 << TO_SINE);
  }
  show(words + INTEGRATORS, m->q.integrator, m->d.integrator, SHOWN_INTEGRATOR);
  int32_t phase_a = fixed_high(vd, a.cosine) - fixed_high(vq, a.sine);
  int32_t phase_b = fixed_high(vd, b.cosine) - fixed_high(vq, b.sine);
  int32_t phase_c = -phase_a - phase_b;
  if (s->third_harmonic) {
    const int32_t added = half_of_middle(phase_a, phase_b, phase_c);
    phase_a += added;
    phase_b += added;
    phase_c += added;
  }
  *s->output[0] = word(phase_a, s->pwm_scale);
  *s->output[1] = word(phase_b, s->pwm_scale);
  *s->output[2] = word(phase_c, s->pwm_scale);
}
