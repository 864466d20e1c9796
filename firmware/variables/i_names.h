/* Names of the I-variables, from the table, and how many stand in their row. Integers and reals are enumerations of
 * their own: the compiler refuses a real where only an integer can be read (i_integer). Those of motors (Ixx08),
 * coordinate systems (Isx89) and ICs (I7m00) are numbers inside their block of 100 or 50: i_motor and i_cs make
 * variable numbers of them. */
#ifndef FIRMWARE_VARIABLES_I_NAMES_H
#define FIRMWARE_VARIABLES_I_NAMES_H

#include <stdint.h>

enum {
  I_BASE_GLOBAL = 0,
  I_BASE_SYSTEM = 4900,
  I_BASE_GATHER = 5000,
  I_BASE_TABLE = 8000,
  I_BASE_MACRO = 6800, /* MACRO IC 0 */
  I_BASE_SSI = 1015,
  I_BASE_ONLY = 0,
  I_BASE_SUPPLEMENTARY = 0,
  I_BASE_SERVO = 0,
  I_BASE_CHANNEL = 0,
  I_BASE_MOTOR = 0,
  I_BASE_ESA = 0,
  I_BASE_CS = 0
};

enum {
  I_MOTOR_BLOCK = 100,
  I_ESA_FIRST = 3300,
  I_ESA_BLOCK = 50,
  I_CS_FIRST = 5100,
  I_CS_BLOCK = 100,
  I_SERVO_FIRST = 7000,
  I_IC_BLOCK = 50,
  I_SSI_BLOCK = 5,
  I_ONLY_SEGMENTATION_TIME = 13, /* of a Geo PMAC */
  I_ONLY_LOOKAHEAD_LENGTH = 1020
};

#define I_NAMES_OF(name, group, first, count) name = I_BASE_##group + (first), name##_COUNT = (count),
#define I_ENTRY(name, group, first, count, kind, bits, format, value, field) I_NAMES_##kind(name, group, first, count)

enum i_name {
#define I_NAMES_U I_NAMES_OF
#define I_NAMES_S I_NAMES_OF
#define I_NAMES_R I_NAMES_OF
#define I_NAMES_F(name, group, first, count)
#include "firmware/variables/i_variables.def"
#undef I_NAMES_U
#undef I_NAMES_S
#undef I_NAMES_R
#undef I_NAMES_F
};

enum i_real_name {
#define I_NAMES_U(name, group, first, count)
#define I_NAMES_S(name, group, first, count)
#define I_NAMES_R(name, group, first, count)
#define I_NAMES_F I_NAMES_OF
#include "firmware/variables/i_variables.def"
#undef I_NAMES_U
#undef I_NAMES_S
#undef I_NAMES_R
#undef I_NAMES_F
};
#undef I_ENTRY
#undef I_NAMES_OF

static inline uint32_t i_motor(uint32_t motor, enum i_name name) { /* motor 1..32 */
  return I_MOTOR_BLOCK * motor + (uint32_t)name;
}

static inline uint32_t i_motor_real(uint32_t motor, enum i_real_name name) { /* motor 1..32 */
  return I_MOTOR_BLOCK * motor + (uint32_t)name;
}

static inline uint32_t i_esa(uint32_t motor, enum i_name name) { /* Iyy00: motor 1..32 */
  return I_ESA_FIRST + I_ESA_BLOCK * (motor - 1u) + (uint32_t)name;
}

static inline uint32_t i_cs(uint32_t cs, enum i_name name) { /* coordinate system 0..15 */
  return I_CS_FIRST + I_CS_BLOCK * cs + (uint32_t)name;
}

static inline uint32_t i_cs_real(uint32_t cs, enum i_real_name name) {
  return I_CS_FIRST + I_CS_BLOCK * cs + (uint32_t)name;
}

#endif
