/* Names of the I-variables, from the table. Those of motors (Ixx08), coordinate systems (Isx89) and ICs (I7m00) are
 * numbers inside their block of 100 or 50: i_motor and i_cs make variable numbers of them. */
#ifndef FIRMWARE_VARIABLES_I_NAMES_H
#define FIRMWARE_VARIABLES_I_NAMES_H

#include <stdint.h>

enum {
  I_BASE_GLOBAL = 0,
  I_BASE_SYSTEM = 4900,
  I_BASE_GATHER = 5000,
  I_BASE_TABLE = 8000,
  I_BASE_MACRO = 6800, /* MACRO IC 0 */
  I_BASE_SUPPLEMENTARY = 0,
  I_BASE_SERVO = 0,
  I_BASE_CHANNEL = 0,
  I_BASE_MOTOR = 0,
  I_BASE_ESA = 0,
  I_BASE_CS = 0
};

enum i_name {
#define I_ENTRY(name, group, first, count, kind, bits, format, value, field) name = I_BASE_##group + (first),
#include "firmware/variables/i_variables.def"
#undef I_ENTRY
  I_MOTOR_BLOCK = 100,
  I_CS_FIRST = 5100,
  I_CS_BLOCK = 100
};

static inline uint32_t i_motor(uint32_t motor, enum i_name name) { /* motor 1..32 */
  return I_MOTOR_BLOCK * motor + (uint32_t)name;
}

static inline uint32_t i_cs(uint32_t cs, enum i_name name) { /* coordinate system 0..15 */
  return I_CS_FIRST + I_CS_BLOCK * cs + (uint32_t)name;
}

#endif
