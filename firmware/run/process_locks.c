#include "firmware/run/process_locks.h"

#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

bool process_lock(uint32_t number) {
  const uint32_t state = hal_mask_real_time();
  const uint32_t before = i_variable_locks();
  i_variable_set_locks(before | 1u << number);
  hal_unmask(state);
  return (before >> number & 1u) != 0;
}

void process_unlock(uint32_t number) {
  const uint32_t state = hal_mask_real_time();
  i_variable_set_locks(i_variable_locks() & ~(1u << number));
  hal_unmask(state);
}
