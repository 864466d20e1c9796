/* I-, P-, Q- and M-variables on line (firmware:1.4, firmware:1.5):
 *   I19   I0..99   I16,4   I5213,15,100=10   I(P1*100+20)=10   I100..199=*   M1->Y:$78C02,8,1   M0..99->
 * The right side is evaluated once; without `=` every variable is reported on a line of its own. */
#include "firmware/command/variable_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/language/expression.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"
#include "firmware/variables/pq_variables.h"

struct range {
  uint32_t first, count, step;
};

static error_t read_number(struct lexer* lx, uint32_t* number) {
  double value;
  if (lexer_peek(lx) == '(') {
    (void)lexer_accept(lx, '(');
    const error_t error = expression_evaluate(lx, session.cs, &value);
    if (error != ERR_NONE) return error;
    if (!lexer_accept(lx, ')')) return ERR_DATA;
  } else if (!lexer_number(lx, &value) || value > VARIABLE_COUNT || (double)(uint32_t)value != value) {
    return ERR_DATA; /* `P1.5` is no variable; a computed number loses its fraction */
  }
  if (!(value >= 0.0 && value < (double)VARIABLE_COUNT)) return ERR_DATA;
  *number = (uint32_t)value;
  return ERR_NONE;
}

static error_t read_range(struct lexer* lx, struct range* range) {
  error_t error = read_number(lx, &range->first);
  range->count = 1;
  range->step = 1;
  if (error != ERR_NONE) return error;
  if (lexer_keyword(lx, "..")) {
    uint32_t last;
    error = read_number(lx, &last);
    if (error != ERR_NONE) return error;
    if (last < range->first) return ERR_DATA;
    range->count = last - range->first + 1u;
  } else if (lexer_accept(lx, ',')) {
    error = read_number(lx, &range->count);
    if (error == ERR_NONE && lexer_accept(lx, ',')) error = read_number(lx, &range->step);
    if (error != ERR_NONE) return error;
    if (range->count == 0u || range->first + (range->count - 1u) * range->step >= VARIABLE_COUNT) return ERR_DATA;
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

/* `*` on the right side: the factory default, of I-variables only. */
static error_t assign_range(struct lexer* lx, char letter, const struct range* range) {
  double value = 0.0;
  const bool defaults = letter == 'I' && lexer_accept(lx, '*');
  if (!defaults) {
    const error_t error = expression_evaluate(lx, session.cs, &value);
    if (error != ERR_NONE) return error;
  }
  for (uint32_t i = 0; i < range->count; ++i) {
    const uint32_t number = range->first + i * range->step;
    assign(letter, number, defaults ? i_variable_default(number) : value);
  }
  return ERR_NONE;
}

/* M-variable definitions ------------------------------------------------------------------------------------------- */

static error_t read_part(struct lexer* lx, struct m_definition* definition) {
  int32_t number;
  definition->width = 24;
  if (!lexer_accept(lx, ',')) return ERR_NONE;
  error_t error = lexer_integer(lx, &number);
  if (error != ERR_NONE) return error;
  if (number < 0 || number > 24) return ERR_DATA;
  if (number == 24) return ERR_NONE; /* `Y:address,24`: the whole word */
  definition->lsb = (uint8_t)number;
  definition->width = 1;
  if (!lexer_accept(lx, ',')) return ERR_NONE;
  if (lexer_peek(lx) != 'S' && lexer_peek(lx) != 'U') {
    error = lexer_integer(lx, &number);
    if (error != ERR_NONE) return error;
    if (number < 1 || number + definition->lsb > 24) return ERR_DATA;
    definition->width = (uint8_t)number;
    if (!lexer_accept(lx, ',')) return ERR_NONE;
  }
  definition->is_signed = lexer_accept(lx, 'S');
  return definition->is_signed || lexer_accept(lx, 'U') ? ERR_NONE : ERR_DATA;
}

static error_t read_definition(struct lexer* lx, struct m_definition* definition) {
  static const struct {
    const char* name;
    m_form_t form;
  } forms[] = {{"DP", M_FORM_DP}, {"X", M_FORM_X}, {"Y", M_FORM_Y}, {"D", M_FORM_D}, {"L", M_FORM_L}};
  *definition = (struct m_definition){M_FORM_NONE, 0, 0, 0, false};
  if (lexer_accept(lx, '*')) return ERR_NONE;
  for (unsigned i = 0; i < sizeof forms / sizeof forms[0] && definition->form == M_FORM_NONE; ++i)
    if (lexer_keyword(lx, forms[i].name)) definition->form = forms[i].form;
  if (definition->form == M_FORM_NONE) return ERR_DATA;
  (void)lexer_accept(lx, ':');
  int32_t place;
  error_t error = lexer_integer(lx, &place);
  if (error != ERR_NONE) return error;
  if (place < 0 || place > 0xFFFFFF) return ERR_DATA;
  definition->address = (uint32_t)place;
  const bool has_part = definition->form == M_FORM_X || definition->form == M_FORM_Y;
  return has_part ? read_part(lx, definition) : ERR_NONE;
}

static void report_definition(uint32_t number) {
  static const char* const names[] = {"*", "X:$", "Y:$", "D:$", "L:$", "DP:$"};
  const struct m_definition definition = m_variable_definition(number);
  if ((i_integer(I9_LISTING_FORM) & 1) != 0) {
    reply_char('M');
    reply_integer((int64_t)number);
    reply_text("->");
  }
  reply_text(names[definition.form]);
  if (definition.form != M_FORM_NONE) reply_hex(definition.address, 0);
  if (definition.form == M_FORM_X || definition.form == M_FORM_Y) {
    reply_char(',');
    reply_integer(definition.lsb);
    reply_char(',');
    reply_integer(definition.width);
    if (definition.is_signed) reply_text(",S");
  }
  reply_end_line();
}

static error_t definition_command(struct lexer* lx, const struct range* range) {
  static const char starts[] = "XYDL*";
  struct m_definition definition;
  bool defines = false;
  const char next = lexer_peek(lx);
  for (const char* start = starts; *start != '\0'; ++start) defines = defines || *start == next;
  if (defines) {
    const error_t error = read_definition(lx, &definition);
    if (error != ERR_NONE) return error;
  }
  for (uint32_t i = 0; i < range->count; ++i) {
    const uint32_t number = range->first + i * range->step;
    if (defines)
      m_variable_define(number, &definition);
    else
      report_definition(number);
  }
  return ERR_NONE;
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
