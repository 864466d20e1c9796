/* M-variables and their definitions (firmware:1.8). Safe from every task except phase and servo. */
#ifndef FIRMWARE_VARIABLES_M_VARIABLES_H
#define FIRMWARE_VARIABLES_M_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"

/* TWB, TWD, TWR and TWS are accessories on the thumbwheel multiplexer: none is modelled, they read 0. */
typedef enum {
  M_FORM_NONE,
  M_FORM_X,
  M_FORM_Y,
  M_FORM_D,
  M_FORM_L,
  M_FORM_DP,
  M_FORM_F,
  M_FORM_TWB,
  M_FORM_TWD,
  M_FORM_TWR,
  M_FORM_TWS,
  M_FORM_COUNT
} m_form_t;

typedef enum { M_UNSIGNED, M_SIGNED, M_BCD, M_COMPLEMENT_BCD } m_format_t;

struct m_definition {
  m_form_t form;
  uint32_t address;   /* of a word, or on the multiplexer */
  uint8_t lsb, width; /* X, Y: bits lsb .. lsb+width-1; TWB: the same, up to 32; TWD: width digits; TWR: lsb only */
  m_format_t format;
  uint8_t decimals; /* TWD */
};

bool m_definition_is_valid(const struct m_definition* definition);

double m_variable_read(uint32_t number);
void m_variable_write(uint32_t number, double value);
struct m_definition m_variable_definition(uint32_t number); /* valid: words that no definition makes count as `*` */
void m_variable_define(uint32_t number, const struct m_definition* definition);

#endif
