/* Ixx29 is added on the word, after every limit (motion:1.1). A killed motor's word is written when it changes only:
 * until the motor is enabled the register is the user's. */
#include "firmware/motion/motor_output.h"

#include <stdbool.h>

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { COMMUTATED = 1, DESTINATION_IS_X = 2, WORD_MOST = 0x7FFFFF }; /* Ixx01 */

static struct output {
  /* V */
  volatile uint32_t* word; /* 0: there is none */
  int32_t bias;            /* output */
  /* S */
  int32_t written;
} outputs[MOTORS];

uint32_t motor_output_commutated;

static int32_t variable(uint32_t motor, enum i_name ixxnn) { return i_integer(i_motor(motor, ixxnn)); }

static volatile uint32_t* word_of(bool x, uint32_t address) {
  if (address == 0u || !word_exists(x, address)) return 0;
  return x ? hal_x(address) : hal_y(address);
}

/* What the registers hold is not known: each is written once. */
void motor_output_initialize(void) {
  motor_output_commutated = 0;
  for (uint32_t motor = 0; motor < MOTORS; ++motor) outputs[motor] = (struct output){.written = INT32_MIN};
}

void motor_output_motor_changed(uint32_t motor) {
  struct output* o = &outputs[motor - 1u];
  const uint32_t mode = (uint32_t)variable(motor, IXX01_COMMUTATION_ENABLE);
  const uint32_t bit = 1u << (motor - 1u), state = hal_mask_servo();
  o->word = word_of((mode & DESTINATION_IS_X) != 0u, (uint32_t)variable(motor, IXX02_OUTPUT_ADDRESS));
  motor_output_commutated = (mode & COMMUTATED) != 0u ? motor_output_commutated | bit : motor_output_commutated & ~bit;
  o->bias = variable(motor, IXX29_OUTPUT_BIAS) * (1 << OUTPUT_FRACTION_BITS);
  hal_unmask(state);
}

void motor_output_write(uint32_t motor) {
  const struct motor* m = &motors[motor];
  struct output* o = &outputs[motor];
  FIXED_IN_REGISTER(m);
  FIXED_IN_REGISTER(o);
  const int32_t word = fixed_within(m->output + o->bias, WORD_MOST);
  if (o->word == 0 || (m->loop == LOOP_KILLED && word == o->written)) return;
  *o->word = (uint32_t)word & HAL_WORD_MASK;
  o->written = word;
}
