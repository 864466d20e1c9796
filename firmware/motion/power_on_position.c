#include "firmware/motion/power_on_position.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum {
  FORMAT_REST = 0xFFFF, /* of Ixx95: of formats that are not built */
  FORMAT_BITS_SHIFT = 16,
  FORMAT_BITS_MASK = 0x3F,
  FORMAT_X = 1u << 22,
  FORMAT_SIGNED = 1u << 23,
  FEWEST_BITS = 8,
  MOST_BITS = 48,
  WORD_BITS = 24,
  FLAGS_OVER_RING = 3u << 18, /* Ixx24: not of the IC at Ixx25 */
  SOFTWARE_CAPTURE = 1,       /* Ixx97 */
  COMMUTATED = 1,             /* Ixx01 */
  NOT_AT_POWER_ON = 4,        /* Ixx80 */
  CHANNEL_WORDS = 8
};

#define OFFSET_UNITS 16.0 /* of Ixx26 in a count */

static uint32_t variable(uint32_t motor, enum i_name ixxnn) { return (uint32_t)i_integer(i_motor(motor + 1u, ixxnn)); }

static uint32_t format_bits(uint32_t format) { return (format >> FORMAT_BITS_SHIFT) & FORMAT_BITS_MASK; }

static bool is_built(uint32_t motor) {
  const uint32_t format = variable(motor, IXX95_POWER_ON_POSITION_FORMAT), bits = format_bits(format);
  if (variable(motor, IXX10_POWER_ON_ADDRESS) == 0u) return true;
  return (format & FORMAT_REST) == 0u && bits >= FEWEST_BITS && bits <= MOST_BITS;
}

static int64_t sensor(uint32_t motor) {
  const uint32_t format = variable(motor, IXX95_POWER_ON_POSITION_FORMAT), bits = format_bits(format);
  const uint32_t address = variable(motor, IXX10_POWER_ON_ADDRESS);
  const bool x = (format & FORMAT_X) != 0u;
  uint64_t value = word_read(x, address);
  if (bits > WORD_BITS) value |= (uint64_t)word_read(x, address + 1u) << WORD_BITS;
  const uint32_t unused = 64u - bits;
  return (format & FORMAT_SIGNED) != 0u ? (int64_t)(value << unused) >> unused : (int64_t)(value << unused >> unused);
}

/* The IC of the channel that Ixx25 names, GATE_IC_MACRO: it is none of a servo IC, or one by which the phase of a
 * commutated motor is counted. */
static unsigned counter_ic(uint32_t motor, uint32_t* channel) {
  const uint32_t address = variable(motor, IXX25_FLAG_ADDRESS);
  if ((variable(motor, IXX24_FLAG_MODE) & FLAGS_OVER_RING) != 0u) return GATE_IC_MACRO;
  if ((variable(motor, IXX97_CAPTURE_MODE) & SOFTWARE_CAPTURE) != 0u) return GATE_IC_MACRO;
  if ((variable(motor, IXX01_COMMUTATION_ENABLE) & COMMUTATED) != 0u) return GATE_IC_MACRO;
  for (unsigned ic = 0; ic < GATE_IC_MACRO; ic++) {
    const uint32_t offset = address - gate_ic_base(ic);
    *channel = offset / CHANNEL_WORDS;
    if (gate_ic_present(ic) && *channel < GATE_IC_CHANNELS) return ic;
  }
  return GATE_IC_MACRO;
}

static void set_position(uint32_t motor, int64_t counts) {
  const double offset = i_variable_read(i_motor(motor + 1u, IXX26_HOME_OFFSET)) / OFFSET_UNITS;
  const bool absolute = variable(motor, IXX10_POWER_ON_ADDRESS) != 0u;
  const int64_t position = absolute ? motor_position_of(motor, (double)counts - offset) : 0;
  int64_t corrections;
  const uint32_t state = desired_path_hold(motor, position, &corrections);
  jog_count_from(motor, motors[motor].actual - position, corrections);
  motors[motor].bias = 0;
  motors[motor].status.home_complete = absolute;
  hal_unmask(state);
  position_loop_show(motor);
}

bool power_on_position_read(uint32_t motor) {
  if (!is_built(motor)) return false;
  motor_kill(motor);
  const int64_t counts = variable(motor, IXX10_POWER_ON_ADDRESS) != 0u ? sensor(motor) : 0;
  uint32_t channel = 0;
  const unsigned ic = counter_ic(motor, &channel);
  const uint32_t state = hal_mask_servo();
  if (ic < GATE_IC_MACRO) gate_ic_zero_counter(ic, channel);
  position_loop_forget_movement(motor);
  hal_unmask(state);
  set_position(motor, counts);
  return true;
}

void power_on_positions_read(void) {
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    if (variable(motor, IXX10_POWER_ON_ADDRESS) == 0u || !is_built(motor)) continue;
    if ((variable(motor, IXX80_POWER_UP_MODE) & NOT_AT_POWER_ON) == 0u) set_position(motor, sensor(motor));
  }
}
