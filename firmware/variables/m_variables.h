/* M-variables and their definitions (firmware:1.8). Safe from every task except phase and servo. */
#ifndef FIRMWARE_VARIABLES_M_VARIABLES_H
#define FIRMWARE_VARIABLES_M_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"

typedef enum { M_FORM_NONE, M_FORM_X, M_FORM_Y, M_FORM_D, M_FORM_L, M_FORM_DP, M_FORM_LAST = M_FORM_DP } m_form_t;

struct m_definition {
  m_form_t form;
  uint32_t address;
  uint8_t lsb, width; /* X and Y forms: bits lsb .. lsb+width-1 */
  bool is_signed;
};

double m_variable_read(uint32_t number);
void m_variable_write(uint32_t number, double value);
struct m_definition m_variable_definition(uint32_t number);
void m_variable_define(uint32_t number, const struct m_definition* definition);

#endif
