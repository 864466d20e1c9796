/* P- and Q-variables: 48-bit words in user memory, L:$006000 and L:$008000, where RL and M-variables see them too. */
#include "firmware/variables/pq_variables.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

static double read_long(uint32_t address) {
  const uint32_t state = hal_mask_real_time();
  const struct float48 word = {*hal_x(address) & HAL_WORD_MASK, *hal_y(address) & HAL_WORD_MASK};
  hal_unmask(state);
  return float48_unpack(word);
}

static void write_long(uint32_t address, double value) {
  const struct float48 word = float48_pack(value);
  const uint32_t state = hal_mask_real_time();
  *hal_x(address) = word.x;
  *hal_y(address) = word.y;
  hal_unmask(state);
}

double p_variable_read(uint32_t number) {
  return number < VARIABLE_COUNT ? read_long(MEMORY_P_VARIABLES + number) : 0.0;
}

void p_variable_write(uint32_t number, double value) {
  if (number < VARIABLE_COUNT) write_long(MEMORY_P_VARIABLES + number, value);
}

/* I68+1 active coordinate systems share the pool: 8192, 4096, 2048, 1024 or 512 each. */
static uint32_t q_count(void) {
  uint32_t systems = (uint32_t)i_integer(I68_ACTIVE_COORDINATE_SYSTEMS) + 1u;
  uint32_t count = VARIABLE_COUNT;
  for (; systems > 1u; systems = (systems + 1u) / 2u) count /= 2u;
  return count;
}

double q_variable_read(uint32_t cs, uint32_t number) {
  const uint32_t count = q_count();
  return number < count && cs * count < VARIABLE_COUNT ? read_long(MEMORY_Q_VARIABLES + cs * count + number) : 0.0;
}

void q_variable_write(uint32_t cs, uint32_t number, double value) {
  const uint32_t count = q_count();
  if (number < count && cs * count < VARIABLE_COUNT) write_long(MEMORY_Q_VARIABLES + cs * count + number, value);
}
