/* The shortest decimal text that the lexer and the word turn into this constant again: the number of decimals grows
 * until one does. A constant that no text can have come from, in a damaged buffer, is shown with all decimals. */
#include "firmware/language/constant_text.h"

#include "firmware/base/float48.h"
#include "firmware/language/lexer.h"

static const double MOST = 1e18, EXACT = 9007199254740992.0; /* 2^53: from here on doubles are further apart than 1 */

static bool reads_as(const struct instruction* in, double value, uint64_t digits, unsigned decimals) {
  const double read = lexer_decimal(digits, decimals);
  if (in->operation != OP_AXIS && in->operation != OP_RATE) return float48_round(read) == value;
  const struct instruction wanted = {OP_AXIS, 0, 0, value}, found = {OP_AXIS, 0, 0, read};
  return word_encode(&wanted) == word_encode(&found);
}

/* Digits near `scaled` that are read as the value. Rounding may have moved it by one or two steps. */
static bool find(const struct instruction* in, double value, double scaled, unsigned decimals, uint64_t* digits) {
  const uint64_t near = (uint64_t)(scaled + 0.5);
  const uint64_t step = scaled < EXACT ? 1 : 128; /* 10^18 is below 2^60 */
  const unsigned steps = scaled < EXACT ? 2 : 3;
  for (unsigned i = 0; i < steps; i++)
    for (unsigned below = 0; below < 2; below++) {
      const uint64_t distance = i * step;
      if (below != 0 && distance > near) continue;
      *digits = below != 0 ? near - distance : near + distance;
      if (*digits < (uint64_t)MOST && reads_as(in, value, *digits, decimals)) return true;
    }
  *digits = near;
  return false;
}

void integer_text(uint64_t value, void (*put)(char c)) {
  char digits[20];
  unsigned count = 0;
  for (; count == 0 || value != 0; value /= 10u) digits[count++] = (char)('0' + value % 10u);
  while (count != 0) put(digits[--count]);
}

static void decimal_text(uint64_t digits, unsigned decimals, void (*put)(char c)) {
  uint64_t scale = 1;
  for (unsigned i = 0; i < decimals; i++) scale *= 10u;
  integer_text(digits / scale, put);
  if (decimals == 0) return;
  put('.');
  for (digits %= scale; scale > 1; digits %= scale) {
    scale /= 10u;
    put((char)('0' + digits / scale));
  }
}

static void hexadecimal_text(uint64_t value, void (*put)(char c)) {
  unsigned shift = 0;
  while ((value >> shift) > 0xFu) shift += 4;
  put('$');
  for (;; shift -= 4) {
    put("0123456789ABCDEF"[(value >> shift) & 0xFu]);
    if (shift == 0) break;
  }
}

void constant_text(const struct instruction* in, double value, void (*put)(char c)) {
  if (value < 0.0) {
    put('-');
    value = -value;
  }
  if (!(value < MOST)) {
    put('?');
    return;
  }
  if (in->group == 1 && in->operation != OP_ASSIGN && (double)(uint64_t)value == value) {
    hexadecimal_text((uint64_t)value, put);
    return;
  }
  uint64_t digits = 0, power = 1;
  unsigned decimals = 0, tried = 0;
  for (; tried <= LEXER_DECIMALS && value * (double)power < MOST; tried++, power *= 10u) {
    decimals = tried;
    if (find(in, value, value * (double)power, decimals, &digits)) break;
  }
  decimal_text(digits, decimals, put);
}
