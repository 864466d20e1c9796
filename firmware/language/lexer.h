/* Text scanner shared by on-line commands and program lines (firmware:1.1): case-insensitive, spaces skipped, `;` ends
 * the line. */
#ifndef FIRMWARE_LANGUAGE_LEXER_H
#define FIRMWARE_LANGUAGE_LEXER_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"

#define LEXER_CONSTANT_LIMIT 34359738368.0 /* 2^35, firmware:1.1 */

enum {
  LEXER_DECIMALS = 18,   /* digits of a number that count; 10^18 fits 63 bits */
  LEXER_LINE_LIMIT = 255 /* characters of a line, firmware:6.1 */
};

struct lexer {
  const char* at; /* next character not consumed; text is upper case already, NUL-terminated */
};

/* Next character after spaces, 0 at the end of the line. Inline like lexer_accept: most of the time to BREQ goes into
 * these. */
static inline char lexer_peek(struct lexer* lx) {
  while (*lx->at == ' ' || *lx->at == '\t') lx->at++;
  return *lx->at == ';' ? '\0' : *lx->at;
}

/* Consumes c if it is next. */
static inline bool lexer_accept(struct lexer* lx, char c) {
  if (c == '\0' || lexer_peek(lx) != c) return false;
  lx->at++;
  return true;
}

bool lexer_keyword(struct lexer* lx, const char* word);   /* consumes `word` (upper case) if it is next */
bool lexer_is_hexadecimal(struct lexer lx);               /* `$` behind an optional sign */
bool lexer_value_starts(struct lexer lx);                 /* a constant with or without sign, or a bracket */
bool lexer_further(struct lexer* lx);                     /* consumes a comma that a value follows (firmware:1.1/7) */
double lexer_decimal(uint64_t digits, unsigned decimals); /* what these digits, `decimals` of them behind the point,
                                                              are read as; up to LEXER_DECIMALS */
bool lexer_number(struct lexer* lx, double* value);       /* unsigned decimal or $hex constant; false: not a number */
/* `$` and one to `most` hexadecimal digits, up to 16. */
bool lexer_hexadecimal(struct lexer* lx, unsigned most, uint64_t* value);
error_t lexer_constant(struct lexer* lx, double* value); /* optional sign and number; ERR_DATA outside +-2^35 */
error_t lexer_integer(struct lexer* lx, int32_t* value); /* constant without fraction */

#endif
