/* A = Id cos(th) - Iq sin(th) + Ixx29, B = Id cos(th + phi) - Iq sin(th + phi) + Ixx79, phi = Ixx72. */
#include "firmware/motion/sine_output.h"

#include "firmware/motion/fixed_point.h"
#include "firmware/motion/phase_table.h"

enum { LARGEST = (1 << 23) - 1, ROUND_BITS = CURRENT_FRACTION_BITS - 1 - 23 };

static uint32_t clipped(int32_t output) { return (uint32_t)fixed_within(output, LARGEST) & HAL_WORD_MASK; }

static uint32_t word(int32_t q, int32_t d, struct phase_sines at, int32_t bias) {
  const int32_t sum = fixed_high(d, at.cosine) - fixed_high(q, at.sine); /* 2^-27 */
  return clipped(((sum + (1 << (ROUND_BITS - 1))) >> ROUND_BITS) + bias);
}

void sine_output(struct phase_motor* m, uint32_t angle) {
  const struct phase_settings* s = &m->settings;
  const int32_t q = m->q.command, d = m->d.command;
  if ((q | d) == 0) { /* as of a killed motor, and there are 32 */
    *s->output[0] = clipped(s->bias[0]);
    *s->output[1] = clipped(s->bias[1]);
    return;
  }
  *s->output[0] = word(q, d, phase_sines(s, angle), s->bias[0]);
  *s->output[1] = word(q, d, phase_sines(s, angle + s->second), s->bias[1]);
}
