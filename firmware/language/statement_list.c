#include "firmware/language/statement_list.h"

#include "firmware/language/word.h"

static bool accept_axis(struct lexer* lx, uint32_t* axis) {
  static const char letters[] = "ABCUVWXYZ"; /* in the order of enum axis */
  for (*axis = 0; *axis < AXIS_COUNT; ++*axis)
    if (lexer_accept(lx, letters[*axis])) return true;
  return false;
}

error_t statement_axis_list(struct lexer* lx, uint32_t bare, uint32_t* mask) {
  uint32_t axis;
  *mask = bare;
  if (!lexer_accept(lx, '(')) return ERR_NONE;
  *mask = 0;
  do {
    if (lexer_accept(lx, 'R'))
      *mask |= AXIS_VECTOR;
    else if (accept_axis(lx, &axis))
      *mask |= 1u << axis;
    else
      return ERR_DATA;
  } while (lexer_accept(lx, ','));
  return lexer_accept(lx, ')') ? ERR_NONE : ERR_DATA;
}

/* No space may stand before the bracket of FRAX(. */
error_t statement_frax_list(struct lexer* lx, uint32_t* mask) {
  *mask = 0;
  if (*lx->at == ' ' && lexer_peek(lx) == '(') return ERR_DATA;
  return statement_axis_list(lx, AXIS_XYZ, mask);
}

error_t statement_number_list(struct lexer* lx, int32_t first, int32_t last, uint32_t* mask) {
  *mask = 0;
  do {
    int32_t from, to;
    error_t error = lexer_integer(lx, &from);
    if (error != ERR_NONE) return error;
    to = from;
    if (lexer_keyword(lx, "..")) error = lexer_integer(lx, &to);
    if (error != ERR_NONE || from < first || to > last || to < from) return ERR_DATA;
    for (; from <= to; from++) *mask |= 1u << (from - first);
  } while (lexer_accept(lx, ','));
  return ERR_NONE;
}
