/* Text scanner of the command interpreter. Works on the upper-case, NUL-terminated line in place; nothing is copied.
 * Numbers are gathered as integers and divided once by a power of ten, which is exact to the last bit for up to 15
 * digits and keeps the parsing of a program line well inside the time that the buffer request allows (host-bus:5.7,
 * T_FALL). */
#include "firmware/language/lexer.h"

enum { SHORT_DIGITS = 9, NUMBER_DIGITS = LEXER_DECIMALS };

static const double POWER_OF_TEN[NUMBER_DIGITS + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                       1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static int hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool lexer_keyword(struct lexer* lx, const char* word) {
  if (lexer_peek(lx) == '\0') return false;
  const char* text = lx->at;
  for (; *word != '\0'; word++, text++)
    if (*text != *word) return false;
  lx->at = text;
  return true;
}

bool lexer_is_hexadecimal(struct lexer lx) {
  if (!lexer_accept(&lx, '-')) (void)lexer_accept(&lx, '+');
  return lexer_peek(&lx) == '$';
}

bool lexer_value_starts(struct lexer lx) {
  if (lexer_peek(&lx) == '(') return true;
  if (!lexer_accept(&lx, '-')) (void)lexer_accept(&lx, '+');
  const char c = lexer_peek(&lx);
  return is_digit(c) || (c == '.' && is_digit(lx.at[1])) || (c == '$' && hex_digit(lx.at[1]) >= 0);
}

bool lexer_further(struct lexer* lx) {
  struct lexer after = *lx;
  if (!lexer_accept(&after, ',') || !lexer_value_starts(after)) return false;
  *lx = after;
  return true;
}

static bool hex_number(struct lexer* lx, double* value) {
  const char* text = lx->at + 1;
  uint64_t sum = 0;
  if (hex_digit(*text) < 0) return false;
  for (; hex_digit(*text) >= 0; text++) {
    if ((sum >> 56) != 0) sum = 1ull << 55; /* far outside any limit already: keep it so */
    sum = sum * 16u + (uint64_t)hex_digit(*text);
  }
  lx->at = text;
  *value = (double)sum;
  return true;
}

bool lexer_hexadecimal(struct lexer* lx, unsigned most, uint64_t* value) {
  if (!lexer_accept(lx, '$')) return false;
  unsigned digits = 0;
  for (*value = 0; hex_digit(*lx->at) >= 0; lx->at++, digits++) *value = *value << 4 | (uint64_t)hex_digit(*lx->at);
  return digits != 0 && digits <= most;
}

/* The first digits, nine of them at most that count: they fit into 32 bits. Nothing more follows: it is the number. */
static inline bool short_integer(const char** at, uint32_t* low, unsigned* digits) {
  const char* text = *at;
  *low = 0;
  *digits = 0;
  while (is_digit(*text) && *digits < SHORT_DIGITS) {
    *low = *low * 10u + (uint32_t)(*text++ - '0');
    if (*low != 0) ++*digits;
  }
  *at = text;
  return !is_digit(*text) && *text != '.';
}

double lexer_decimal(uint64_t digits, unsigned decimals) {
  const double value = digits <= UINT32_MAX ? (double)(uint32_t)digits : (double)digits; /* the short one is faster */
  return decimals != 0 ? value / POWER_OF_TEN[decimals] : value;
}

bool lexer_number(struct lexer* lx, double* value) {
  char first = lexer_peek(lx);
  if (first == '$') return hex_number(lx, value);
  if (!is_digit(first) && !(first == '.' && is_digit(lx->at[1]))) return false;
  const char* text = lx->at;
  uint32_t low; /* the usual number needs no 64-bit arithmetic */
  unsigned digits;
  if (short_integer(&text, &low, &digits)) {
    lx->at = text;
    *value = (double)low;
    return true;
  }
  uint64_t sum = low;
  unsigned decimals = 0;
  unsigned zeros = 0; /* digits before the point that were not kept */
  for (; is_digit(*text); text++) {
    if (digits < NUMBER_DIGITS) {
      sum = sum * 10u + (uint64_t)(*text - '0');
      if (sum != 0) digits++;
    } else {
      zeros++;
    }
  }
  if (*text == '.' && text[1] != '.') { /* two points are a range such as I0..99 */
    for (text++; is_digit(*text); text++) {
      if (digits >= NUMBER_DIGITS || decimals >= NUMBER_DIGITS) continue;
      sum = sum * 10u + (uint64_t)(*text - '0');
      if (sum != 0) digits++;
      decimals++;
    }
  }
  lx->at = text;
  *value = lexer_decimal(sum, decimals);
  for (; zeros > 0 && *value <= LEXER_CONSTANT_LIMIT * 1e18; zeros--) *value *= 10.0;
  return true;
}

/* The exponent tells below 2^35 without a floating-point comparison. */
static bool is_too_large(double value) {
  const union {
    double value;
    uint64_t bits;
  } u = {value};
  return (uint32_t)(u.bits >> 52) >= 1023u + 35u && value > LEXER_CONSTANT_LIMIT;
}

error_t lexer_constant(struct lexer* lx, double* value) {
  bool negative = lexer_accept(lx, '-');
  if (!negative) (void)lexer_accept(lx, '+');
  if (!lexer_number(lx, value) || is_too_large(*value)) return ERR_DATA;
  if (negative) *value = -*value;
  return ERR_NONE;
}

/* The usual one, `&5`, needs no floating-point arithmetic, which is slow here: T_CS (host-bus:5.7/9). */
error_t lexer_integer(struct lexer* lx, int32_t* value) {
  if (is_digit(lexer_peek(lx))) {
    const char* text = lx->at;
    if (!is_digit(text[1]) && text[1] != '.') {
      *value = *text - '0';
      ++lx->at;
      return ERR_NONE;
    }
    uint32_t low;
    unsigned digits;
    if (short_integer(&text, &low, &digits)) {
      lx->at = text;
      *value = (int32_t)low;
      return ERR_NONE;
    }
  }
  double constant;
  error_t error = lexer_constant(lx, &constant);
  if (error != ERR_NONE) return error;
  if (constant > 2147483647.0 || constant < -2147483648.0 || (double)(int32_t)constant != constant) return ERR_DATA;
  *value = (int32_t)constant;
  return ERR_NONE;
}
