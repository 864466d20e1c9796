#include "firmware/motion/phase_motor.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/sine_table.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

#define TWO_PI 6.283185307179586

enum { SOURCE_IS_Y = 2 };                 /* Ixx01 */
enum { ALTERNATE_MODE = 1 };              /* Ixx96 */
enum { NO_THIRD_HARMONIC = 1 << 10 };     /* Ixx24 */
enum { REGISTER_CYCLE = 1 << 24 };        /* Ixx71 = 0: the position wraps as its word does */
enum { INDEX_SHIFT = 32 - SINE_BITS };    /* from an index of the sine table to an angle */
enum { PWM_SHIFT = 11, BIAS_SHIFT = 14 }; /* 2^-29 of full voltage to output; a 16-bit bias to 2^-29 */

struct phase_motor phase_motors[MOTORS];

static const volatile uint32_t none; /* where nothing is: reads 0 */
static volatile uint32_t nobody;     /* and swallows */

static const volatile uint32_t* readable(bool x, uint32_t address) {
  if (!word_exists(x, address)) return &none;
  return x ? hal_x(address) : hal_y(address);
}

static volatile uint32_t* writable(uint32_t address) { return word_exists(false, address) ? hal_y(address) : &nobody; }

/* Rounded to the nearest, what is outside to the end of the range. */
static int32_t scaled(double value, double unit, int32_t largest) {
  const double product = value * unit;
  if (product >= (double)largest) return largest;
  if (product <= -(double)largest) return -largest;
  return (int32_t)(product < 0.0 ? product - 0.5 : product + 0.5);
}

static int32_t gain(double value, double factor) {
  const double unit = 1 << CURRENT_GAIN_FRACTION_BITS;
  return scaled(value, factor * unit, 8 << CURRENT_GAIN_FRACTION_BITS);
}

static double real(uint32_t motor, enum i_real_name name) {
  return i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)name);
}

/* 2^(31+k) / cycle, rounded up, with 2^k <= cycle < 2^(k+1): the position, less than half a cycle, fits with k bits. */
static void resolve_cycle(struct phase_settings* s, uint32_t counts) {
  const uint32_t cycle = counts == 0u ? REGISTER_CYCLE : counts;
  const uint32_t k = 31u - (uint32_t)__builtin_clz(cycle);
  const uint64_t reciprocal = ((1ull << (31u + k)) + cycle - 1u) / cycle;
  s->reciprocal = reciprocal > INT32_MAX ? INT32_MAX : (int32_t)reciprocal;
  s->shift = 31u - k;
  s->cycle = (int32_t)counts;
  s->half = (int32_t)(cycle / 2u);
}

static void resolve_current_loop(struct phase_settings* s, uint32_t motor, uint32_t address) {
  s->measured[0] = readable(false, address - 1u);
  s->measured[1] = readable(false, address);
  s->mask = (uint32_t)i_integer(i_motor(motor, IXX84_CURRENT_MASK));
  s->integral = gain(real(motor, IXX61_CURRENT_LOOP_GAINS), 8.0);
  s->proportional = gain(i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)IXX61_CURRENT_LOOP_GAINS + 1u), 4.0);
  s->back = gain(real(motor, IXX76_CURRENT_LOOP_BACK_GAIN), 4.0);
  s->pwm_scale = i_integer(i_motor(motor, IXX66_PWM_SCALE)) << PWM_SHIFT;
}

static void resolve_modes(struct phase_settings* s, uint32_t motor) {
  const uint32_t address = (uint32_t)i_integer(i_motor(motor, IXX81_POWER_ON_PHASE_ADDRESS) + 1u);
  const bool alternate = ((uint32_t)i_integer(i_motor(motor, IXX96_OUTPUT_MODE)) & ALTERNATE_MODE) != 0u;
  s->current_loop = address != 0u;
  s->brush = s->current_loop && alternate;
  s->micro_stepping = !s->current_loop && alternate;
  s->third_harmonic = ((uint32_t)i_integer(i_motor(motor, IXX24_FLAG_MODE)) & NO_THIRD_HARMONIC) == 0u;
  const int shift = s->current_loop ? BIAS_SHIFT : OUTPUT_FRACTION_BITS;
  s->bias[0] = i_integer(i_motor(motor, IXX29_OUTPUT_BIAS)) * (1 << shift);
  s->bias[1] = i_integer(i_motor(motor, IXX79_SECOND_PHASE_BIAS)) * (1 << shift);
  if (s->current_loop) resolve_current_loop(s, motor, address);
}

/* Slip of a rotor whose field decays with the time constant Tr: Iq / (Id Tr) radians a second; Ixx78 is the time of a
 * phase update in units of Tr. */
static void resolve_servo_side(struct phase_settings* s, uint32_t motor) {
  const int32_t magnetisation = i_integer(i_motor(motor, IXX77_MAGNETISATION_CURRENT));
  s->magnetisation = magnetisation * (1 << (CURRENT_FRACTION_BITS - 15));
  s->advance_gain = scaled(real(motor, IXX56_PHASE_ADVANCE), 137438953472.0, INT32_MAX); /* 2^37 */
  const double slip = real(motor, IXX78_SLIP_GAIN);
  s->slip_gain = 0;
  if (slip != 0.0 && magnetisation != 0) {
    const double units = (double)(s->cycle == 0 ? REGISTER_CYCLE : s->cycle) / TWO_PI;
    s->slip_gain = scaled(slip / (double)magnetisation * units, 4294967296.0, INT32_MAX); /* 2^40 / 2^8 of an output */
  }
}

struct phase_settings phase_motor_resolve(uint32_t motor) {
  struct phase_settings s = {.measured = {&none, &none}};
  const bool y = ((uint32_t)i_integer(i_motor(motor, IXX01_COMMUTATION_ENABLE)) & SOURCE_IS_Y) != 0u;
  const uint32_t output = (uint32_t)i_integer(i_motor(motor, IXX02_OUTPUT_ADDRESS));
  s.source = readable(!y, (uint32_t)i_integer(i_motor(motor, IXX83_COMMUTATION_ADDRESS)));
  s.multiplier = i_integer(i_motor(motor, IXX70_COMMUTATION_CYCLES));
  resolve_cycle(&s, (uint32_t)i_integer(i_motor(motor, IXX71_COMMUTATION_COUNTS)));
  s.table = sine_table_address((uint32_t)i_integer(i_motor(motor, IXX55_COMMUTATION_TABLE)));
  s.second = (uint32_t)i_integer(i_motor(motor, IXX72_PHASE_ANGLE)) << INDEX_SHIFT;
  for (uint32_t phase = 0; phase < PHASES; ++phase) s.output[phase] = writable(output + phase);
  resolve_modes(&s, motor);
  resolve_servo_side(&s, motor);
  if (s.micro_stepping) s.source = &none; /* nothing is followed: the output says how fast it turns */
  return s;
}
