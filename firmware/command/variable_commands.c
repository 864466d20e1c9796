/* I-, P-, Q- and M-variables on line (firmware:1.4, firmware:1.5):
 *   I19   I0..99   I16,4   I5213,15,100=10   I(P1*100+20)=10   I100..199=*   I103=@I8000   M1->Y:$78C02,8,1   M0..99->
 * The right side is evaluated once; without `=` every variable is reported on a line of its own. */
#include "firmware/command/variable_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/memory_map.h"
#include "firmware/command/m_definition.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/language/expression.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"
#include "firmware/variables/pq_variables.h"

struct range {
  uint32_t first, count, step;
};

/* A number or a computed one, below `end`. */
static error_t read_number(struct lexer* lx, uint32_t end, uint32_t* number) {
  double value;
  if (lexer_peek(lx) == '(') {
    (void)lexer_accept(lx, '(');
    const error_t error = expression_evaluate(lx, session.cs, &value);
    if (error != ERR_NONE) return error;
    if (!lexer_accept(lx, ')')) return ERR_DATA;
  } else if (!lexer_number(lx, &value) || value > VARIABLE_COUNT || (double)(uint32_t)value != value) {
    return ERR_DATA; /* `P1.5` is no variable; a computed number loses its fraction */
  }
  if (!(value >= 0.0 && value < (double)end)) return ERR_DATA; /* an expression may be no number at all */
  *number = (uint32_t)value;
  return ERR_NONE;
}

static error_t read_range(struct lexer* lx, struct range* range) {
  error_t error = read_number(lx, VARIABLE_COUNT, &range->first);
  range->count = 1;
  range->step = 1;
  if (error != ERR_NONE) return error;
  if (lexer_keyword(lx, "..")) {
    uint32_t last;
    error = read_number(lx, VARIABLE_COUNT, &last);
    if (error != ERR_NONE) return error;
    if (last < range->first) return ERR_DATA;
    range->count = last - range->first + 1u;
  } else if (lexer_further(lx)) {
    error = read_number(lx, VARIABLE_COUNT + 1u, &range->count);
    if (error == ERR_NONE && lexer_further(lx)) error = read_number(lx, VARIABLE_COUNT, &range->step);
    if (error != ERR_NONE) return error;
    if (range->count == 0u || range->step == 0u || range->first + (range->count - 1u) * range->step >= VARIABLE_COUNT)
      return ERR_DATA;
  }
  return ERR_NONE;
}

static void report_i(uint32_t number) {
  const int32_t style = i_integer(I9_LISTING_FORM);
  if ((style & 1) != 0) {
    reply_char('I');
    reply_integer((int64_t)number);
    reply_char('=');
  }
  const double value = i_variable_read(number);
  if ((style & 2) != 0 && i_variable_format(number) == I_FORMAT_HEX) {
    reply_char('$');
    reply_hex((uint32_t)value, 0);
  } else {
    reply_number(value);
  }
}

static void report(char letter, uint32_t number) {
  switch (letter) {
    case 'I':
      report_i(number);
      break;
    case 'P':
      reply_number(p_variable_read(number));
      break;
    case 'Q':
      reply_number(q_variable_read(session.cs, number));
      break;
    default:
      reply_number(m_variable_read(number));
      break;
  }
  reply_end_line();
}

static void assign(char letter, uint32_t number, double value) {
  switch (letter) {
    case 'I':
      i_variable_write(number, value);
      break;
    case 'P':
      p_variable_write(number, value);
      break;
    case 'Q':
      q_variable_write(session.cs, number, value);
      break;
    default:
      m_variable_write(number, value);
      break;
  }
}

/* `@I8000`: where a line of the conversion table and its result stand. No page tells where other variables do. */
static error_t read_address(struct lexer* lx, double* address) {
  uint32_t number;
  if (!lexer_accept(lx, 'I')) return ERR_DATA;
  const error_t error = read_number(lx, VARIABLE_COUNT, &number);
  if (error != ERR_NONE || number < I_BASE_TABLE) return ERR_DATA;
  *address = (double)(MEMORY_CONVERSION + number - I_BASE_TABLE);
  return ERR_NONE;
}

/* Of I-variables alone the right side may be `*`, the factory default, or an address. */
static error_t assign_range(struct lexer* lx, char letter, const struct range* range) {
  double value = 0.0;
  const bool defaults = letter == 'I' && lexer_accept(lx, '*');
  if (!defaults) {
    const error_t error =
        letter == 'I' && lexer_accept(lx, '@') ? read_address(lx, &value) : expression_evaluate(lx, session.cs, &value);
    if (error != ERR_NONE) return error;
  }
  for (uint32_t i = 0; i < range->count; ++i) {
    const uint32_t number = range->first + i * range->step;
    assign(letter, number, defaults ? i_variable_default(number) : value);
    reply_between_lines();
  }
  return ERR_NONE;
}

static error_t definition_command(struct lexer* lx, const struct range* range) {
  struct m_definition definition;
  bool defines;
  const error_t error = m_definition_read(lx, &definition, &defines);
  for (uint32_t i = 0; error == ERR_NONE && i < range->count; ++i) {
    const uint32_t number = range->first + i * range->step;
    if (!defines) {
      m_definition_report(number);
      continue;
    }
    m_variable_define(number, &definition);
    reply_between_lines();
  }
  return error;
}

error_t variable_command(struct lexer* lx, char letter) {
  struct range range;
  const error_t error = read_range(lx, &range);
  if (error != ERR_NONE) return error;
  if (letter == 'M' && lexer_keyword(lx, "->")) return definition_command(lx, &range);
  if (lexer_accept(lx, '=')) return assign_range(lx, letter, &range);
  for (uint32_t i = 0; i < range.count; ++i) report(letter, range.first + i * range.step);
  return ERR_NONE;
}
