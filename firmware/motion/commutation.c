#include "firmware/motion/commutation.h"

#include "firmware/motion/phase_task.h"

bool commutation_is_used(uint32_t motor) { return ((phase_task_work >> motor) & 1u) != 0u; }

void commutation_command(uint32_t motor, int32_t output) {
  (void)motor;
  (void)output;
}

void commutation_enable(uint32_t motor, bool enabled) {
  (void)motor;
  (void)enabled;
}

struct motor_current commutation_current(uint32_t motor) {
  (void)motor;
  return (struct motor_current){0, 0};
}

void commutation_motor_changed(uint32_t motor) { phase_task_motor_changed(motor); }
