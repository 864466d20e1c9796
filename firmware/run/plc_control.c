#include "firmware/run/plc_control.h"

#include "firmware/buffers/fixed_programs.h"

static uint32_t enabled, paused;

void plc_control_initialize(void) {
  enabled = paused = 0;
  for (uint32_t i = 0; i < fixed_programs_count(); i++)
    if (fixed_program_at(i)->kind == FIXED_PLC) enabled |= 1u << fixed_program_at(i)->number;
}

void plc_enable(uint32_t plcs) {
  enabled |= plcs;
  paused &= ~plcs;
}

void plc_disable(uint32_t plcs) {
  enabled &= ~plcs;
  paused &= ~plcs;
}

void plc_pause(uint32_t plcs) { paused |= plcs & enabled; }
void plc_resume(uint32_t plcs) { paused &= ~plcs; }
uint32_t plc_enabled(void) { return enabled & ~paused; }
