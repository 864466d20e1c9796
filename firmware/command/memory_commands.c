/* Direct access to PMAC words (firmware:1.9): RX RY RL RD, RHX ..., WX WY WL WD, with address, count or values. A
 * hexadecimal constant for L or D is the word itself, not its value: what RHL shows can be written back. */
#include "firmware/command/memory_commands.h"

#include "firmware/base/float48.h"
#include "firmware/base/mathematics.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/hal/hal.h"
#include "firmware/language/expression.h"
#include "firmware/variables/words.h"

typedef enum { FORM_X, FORM_Y, FORM_L, FORM_D } form_t;

enum { COUNT_LIMIT = 64, LONG_DIGITS = 12 };

static void report_word(form_t form, bool hex, uint32_t address) {
  if (form == FORM_X || form == FORM_Y) {
    const uint32_t value = word_read(form == FORM_X, address);
    if (hex)
      reply_hex(value, 0);
    else
      reply_integer(hal_signed(value));
    return;
  }
  struct float48 word;
  word_read_long(address, &word.x, &word.y);
  if (hex) {
    reply_hex(word.x, 6);
    reply_hex(word.y, 6);
  } else if (form == FORM_D) {
    reply_integer(((int64_t)hal_signed(word.x) * 16777216) + (int64_t)word.y);
  } else {
    reply_number(float48_unpack(word));
  }
}

static void write_word(form_t form, uint32_t address, double value) {
  const int64_t whole = math_nearest(value);
  const struct float48 word = float48_pack(value);
  switch (form) {
    case FORM_X:
    case FORM_Y:
      word_write(form == FORM_X, address, (uint32_t)whole);
      break;
    case FORM_D:
      word_write_long(address, (uint32_t)(whole >> 24), (uint32_t)whole);
      break;
    default:
      word_write_long(address, word.x, word.y);
      break;
  }
}

static error_t read_address(struct lexer* lx, uint32_t* address) {
  int32_t number;
  (void)lexer_accept(lx, ':');
  const error_t error = lexer_integer(lx, &number);
  if (error == ERR_NONE) *address = (uint32_t)number; /* one below 0 is beyond the last */
  return error;
}

static error_t read_words(struct lexer* lx, form_t form, bool hex) {
  uint32_t address;
  int32_t count = 1;
  error_t error = read_address(lx, &address);
  if (error == ERR_NONE && lexer_further(lx)) error = lexer_integer(lx, &count);
  if (error != ERR_NONE) return error;
  if (count < 1 || count > COUNT_LIMIT || address > HAL_WORD_MASK + 1u - (uint32_t)count) return ERR_DATA;
  for (uint32_t i = 0; i < (uint32_t)count; ++i) {
    if (i != 0u) reply_char(' ');
    report_word(form, hex, address + i);
  }
  reply_end_line();
  return ERR_NONE;
}

/* In an expression the constant is a number as anywhere. */
static bool goes_on(struct lexer lx) {
  static const char operators[] = "+-|^*/%&";
  const char next = lexer_peek(&lx);
  for (const char* c = operators; *c != '\0'; ++c)
    if (*c == next) return true;
  return false;
}

static error_t write_one(struct lexer* lx, form_t form, uint32_t address) {
  double value;
  uint64_t word;
  if (lexer_peek(lx) == '$' && (form == FORM_L || form == FORM_D)) {
    struct lexer after = *lx;
    if (!lexer_hexadecimal(&after, LONG_DIGITS, &word)) return ERR_DATA;
    if (!goes_on(after)) {
      *lx = after;
      word_write_long(address, (uint32_t)(word >> 24), (uint32_t)word & HAL_WORD_MASK);
      return ERR_NONE;
    }
  }
  const error_t error = expression_evaluate(lx, session.cs, &value);
  if (error == ERR_NONE) write_word(form, address, value);
  return error;
}

static error_t write_words(struct lexer* lx, form_t form) {
  uint32_t address;
  error_t error = read_address(lx, &address);
  if (error != ERR_NONE) return error;
  if (lexer_peek(lx) != ',') return ERR_DATA;
  while (lexer_accept(lx, ',')) {
    if (address > HAL_WORD_MASK) return ERR_DATA;
    error = write_one(lx, form, address++);
    if (error != ERR_NONE) return error;
  }
  return ERR_NONE;
}

static error_t rx(struct lexer* lx) { return read_words(lx, FORM_X, false); }
static error_t ry(struct lexer* lx) { return read_words(lx, FORM_Y, false); }
static error_t rl(struct lexer* lx) { return read_words(lx, FORM_L, false); }
static error_t rd(struct lexer* lx) { return read_words(lx, FORM_D, false); }
static error_t rhx(struct lexer* lx) { return read_words(lx, FORM_X, true); }
static error_t rhy(struct lexer* lx) { return read_words(lx, FORM_Y, true); }
static error_t rhl(struct lexer* lx) { return read_words(lx, FORM_L, true); }
static error_t rhd(struct lexer* lx) { return read_words(lx, FORM_D, true); }
static error_t wx(struct lexer* lx) { return write_words(lx, FORM_X); }
static error_t wy(struct lexer* lx) { return write_words(lx, FORM_Y); }
static error_t wl(struct lexer* lx) { return write_words(lx, FORM_L); }
static error_t wd(struct lexer* lx) { return write_words(lx, FORM_D); }

const struct command_entry memory_commands[] = {
    {"RHX", rhx}, {"RHY", rhy}, {"RHL", rhl}, {"RHD", rhd}, {"RX", rx}, {"RY", ry}, {"RL", rl},
    {"RD", rd},   {"WX", wx},   {"WY", wy},   {"WL", wl},   {"WD", wd}, {0, 0},
};
