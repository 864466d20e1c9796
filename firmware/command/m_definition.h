/* The text of M-variable definitions (firmware:1.8). */
#ifndef FIRMWARE_COMMAND_M_DEFINITION_H
#define FIRMWARE_COMMAND_M_DEFINITION_H

#include "firmware/language/lexer.h"
#include "firmware/variables/m_variables.h"

/* What stands behind `->`: a definition, or nothing of the kind and *defines is false. */
error_t m_definition_read(struct lexer* lx, struct m_definition* definition, bool* defines);
void m_definition_report(uint32_t number); /* a data line, as I9 says */

#endif
