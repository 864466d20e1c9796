/* Definitions read and reported:
 *   X:$78200,8   X:$78001,24,S   Y:$C0,4,8   D:$88   L:$D7   DP:$60010   F:$60011   *
 *   TWB:3,4,4   TWD:4,0,8.3,S   TWR:2,1   TWS:17                                     */
#include "firmware/command/m_definition.h"

#include "firmware/command/reply.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

enum { WHOLE_WORD = 24 };

static const struct {
  const char* name;
  m_form_t form;
} forms[] = {/* longer names first */
             {"TWB", M_FORM_TWB}, {"TWD", M_FORM_TWD}, {"TWR", M_FORM_TWR}, {"TWS", M_FORM_TWS},
             {"DP", M_FORM_DP},   {"X", M_FORM_X},     {"Y", M_FORM_Y},     {"D", M_FORM_D},
             {"L", M_FORM_L},     {"F", M_FORM_F},     {"*", M_FORM_NONE}};
enum { FORMS = sizeof forms / sizeof forms[0] };

static const char FORMAT_LETTERS[] = "USDC"; /* in the order of m_format_t */

/* Reading ---------------------------------------------------------------------------------------------------------- */

static error_t read_number(struct lexer* lx, uint32_t limit, uint32_t* number) {
  int32_t value;
  const error_t error = lexer_integer(lx, &value);
  if (error != ERR_NONE) return error;
  if (value < 0 || (uint32_t)value > limit) return ERR_DATA;
  *number = (uint32_t)value;
  return ERR_NONE;
}

static error_t read_small(struct lexer* lx, uint8_t* number) {
  uint32_t value;
  const error_t error = read_number(lx, UINT8_MAX, &value);
  if (error == ERR_NONE) *number = (uint8_t)value;
  return error;
}

static bool read_format(struct lexer* lx, struct m_definition* d) {
  for (unsigned i = 0; FORMAT_LETTERS[i] != '\0'; ++i) {
    if (!lexer_accept(lx, FORMAT_LETTERS[i])) continue;
    d->format = (m_format_t)i;
    return true;
  }
  return false;
}

/* `,8` is one bit, which a width, a format or both may follow; `,24` the whole word, which only a format may. */
static error_t read_part(struct lexer* lx, struct m_definition* d) {
  d->width = WHOLE_WORD;
  if (!lexer_accept(lx, ',')) return ERR_NONE;
  error_t error = read_small(lx, &d->lsb);
  if (error != ERR_NONE) return error;
  const bool whole = d->lsb == WHOLE_WORD;
  if (whole) d->lsb = 0;
  if (!whole) d->width = 1;
  if (!lexer_accept(lx, ',')) return ERR_NONE;
  if (read_format(lx, d)) return ERR_NONE;
  if (whole) return ERR_DATA;
  error = read_small(lx, &d->width);
  if (error != ERR_NONE || !lexer_accept(lx, ',')) return error;
  return read_format(lx, d) ? ERR_NONE : ERR_DATA;
}

/* `8.3` is eight digits, three of them decimals; the lexer takes it for one number. */
static error_t read_digits(struct lexer* lx, struct m_definition* d) {
  uint32_t digits = 0;
  (void)lexer_peek(lx);
  for (; *lx->at >= '0' && *lx->at <= '9' && digits < UINT8_MAX; ++lx->at)
    digits = digits * 10u + (uint32_t)(*lx->at - '0');
  if (digits == 0u || digits > UINT8_MAX) return ERR_DATA;
  d->width = (uint8_t)digits;
  return lexer_accept(lx, '.') ? read_small(lx, &d->decimals) : ERR_NONE;
}

/* On the multiplexer: TWS an address; TWR offset behind it; TWB, TWD size and format too. */
static error_t read_multiplexed(struct lexer* lx, struct m_definition* d) {
  if (d->form == M_FORM_TWS) return ERR_NONE;
  if (!lexer_accept(lx, ',')) return ERR_DATA;
  error_t error = read_small(lx, &d->lsb);
  if (error != ERR_NONE || d->form == M_FORM_TWR) return error;
  if (!lexer_accept(lx, ',')) return ERR_DATA;
  error = d->form == M_FORM_TWD ? read_digits(lx, d) : read_small(lx, &d->width);
  if (error != ERR_NONE || !lexer_accept(lx, ',')) return error;
  return read_format(lx, d) ? ERR_NONE : ERR_DATA;
}

/* `F` alone is a command: a definition goes on with its address. */
static bool read_form(struct lexer* lx, m_form_t* form) {
  for (unsigned i = 0; i < FORMS; ++i) {
    struct lexer after = *lx;
    if (!lexer_keyword(&after, forms[i].name)) continue;
    *form = forms[i].form;
    const char next = lexer_peek(&after);
    if (*form == M_FORM_F && next != ':' && next != '$' && (next < '0' || next > '9')) continue;
    *lx = after;
    return true;
  }
  return false;
}

error_t m_definition_read(struct lexer* lx, struct m_definition* definition, bool* defines) {
  struct m_definition d = {M_FORM_NONE, 0, 0, 0, M_UNSIGNED, 0};
  *defines = read_form(lx, &d.form);
  if (!*defines) return ERR_NONE;
  if (d.form != M_FORM_NONE) {
    (void)lexer_accept(lx, ':');
    error_t error = read_number(lx, HAL_WORD_MASK, &d.address);
    if (error == ERR_NONE && (d.form == M_FORM_X || d.form == M_FORM_Y)) error = read_part(lx, &d);
    if (error == ERR_NONE && d.form > M_FORM_F) error = read_multiplexed(lx, &d);
    if (error != ERR_NONE) return error;
  }
  if (!m_definition_is_valid(&d)) return ERR_DATA;
  *definition = d;
  return ERR_NONE;
}

/* Reporting -------------------------------------------------------------------------------------------------------- */

static void report_number(uint32_t number) {
  reply_char(',');
  reply_integer((int64_t)number);
}

static void report_part(const struct m_definition* d) {
  if (d->width == WHOLE_WORD) {
    report_number(WHOLE_WORD);
    return;
  }
  report_number(d->lsb);
  if (d->width != 1u || d->format != M_UNSIGNED) report_number(d->width);
}

static void report_multiplexed(const struct m_definition* d) {
  if (d->form == M_FORM_TWS) return;
  report_number(d->lsb);
  if (d->form == M_FORM_TWR) return;
  report_number(d->width);
  if (d->form != M_FORM_TWD || d->decimals == 0u) return; /* a host may have left bits there in a TWB */
  reply_char('.');
  reply_integer(d->decimals);
}

static const char* form_name(m_form_t form) {
  unsigned i = 0;
  while (i + 1u < FORMS && forms[i].form != form) ++i;
  return forms[i].name;
}

void m_definition_report(uint32_t number) {
  const struct m_definition d = m_variable_definition(number);
  if ((i_integer(I9_LISTING_FORM) & 1) != 0) {
    reply_char('M');
    reply_integer((int64_t)number);
    reply_text("->");
  }
  reply_text(form_name(d.form));
  if (d.form > M_FORM_F) {
    reply_char(':');
    reply_integer((int64_t)d.address);
    report_multiplexed(&d);
  } else if (d.form != M_FORM_NONE) {
    reply_text(":$");
    reply_hex(d.address, 0);
  }
  if (d.form == M_FORM_X || d.form == M_FORM_Y) report_part(&d);
  const bool has_format = d.form == M_FORM_X || d.form == M_FORM_Y || d.form == M_FORM_TWB || d.form == M_FORM_TWD;
  if (has_format && d.format != M_UNSIGNED) {
    reply_char(',');
    reply_char(FORMAT_LETTERS[d.format]);
  }
  reply_end_line();
}
