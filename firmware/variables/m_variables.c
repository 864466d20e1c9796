/* M-variables: pointers to a register, part of one, or a word of their own. The definition of Mn is the 48-bit word at
 * $004000+n: Y = register address, X = form in bits 23..20, decimals in 19..16, first bit in 12..8, format in 6..5,
 * width in 4..0 (0 is 32). `*` (form 0) keeps its value in the Y half of the definition itself. Users write these words
 * too. */
#include "firmware/variables/m_variables.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/words.h"

enum { WORD_BITS = 24, TWB_BITS = 32, TWD_DIGITS = 12, TWD_DECIMALS = 8, MULTIPLEXER_END = 256, DIGIT_BITS = 4 };

/* Definitions ------------------------------------------------------------------------------------------------------ */

static bool part_is_valid(const struct m_definition* d) {
  const bool digits = d->format == M_BCD || d->format == M_COMPLEMENT_BCD;
  return d->width >= 1u && d->lsb + d->width <= WORD_BITS && !(digits && d->width % DIGIT_BITS != 0u);
}

bool m_definition_is_valid(const struct m_definition* d) {
  if (d->form > M_FORM_F && d->address >= MULTIPLEXER_END) return false;
  switch (d->form) {
    case M_FORM_X:
    case M_FORM_Y:
      return part_is_valid(d);
    case M_FORM_TWB:
      return d->lsb < 8u && d->width >= 1u && d->width <= TWB_BITS && d->format <= M_SIGNED;
    case M_FORM_TWD:
      return d->lsb % 4u == 0u && d->lsb < 8u && d->width >= 1u && d->width <= TWD_DIGITS &&
             d->decimals <= TWD_DECIMALS && d->format <= M_SIGNED;
    case M_FORM_TWR:
      return d->address % 2u == 0u && d->lsb < 8u;
    default:
      return d->form < M_FORM_COUNT;
  }
}

struct m_definition m_variable_definition(uint32_t number) {
  uint32_t x, y;
  word_read_long(MEMORY_M_DEFINITIONS + number, &x, &y);
  struct m_definition d = {(m_form_t)(x >> 20),         y,
                           (uint8_t)((x >> 8) & 0x1Fu), (uint8_t)(x & 0x1Fu),
                           (m_format_t)((x >> 5) & 3u), (uint8_t)((x >> 16) & 0xFu)};
  if (d.form == M_FORM_TWB && d.width == 0u) d.width = TWB_BITS;
  if (!m_definition_is_valid(&d)) d.form = M_FORM_NONE;
  return d;
}

void m_variable_define(uint32_t number, const struct m_definition* d) {
  if (number >= VARIABLE_COUNT) return;
  word_write_long(MEMORY_M_DEFINITIONS + number,
                  ((uint32_t)d->form << 20) | ((uint32_t)d->decimals << 16) | ((uint32_t)d->lsb << 8) |
                      ((uint32_t)d->format << 5) | (d->width & 0x1Fu),
                  d->address);
}

/* Parts of a word -------------------------------------------------------------------------------------------------- */

static uint32_t width_mask(uint32_t width) { return (1u << width) - 1u; } /* 1 to 24 */

static uint32_t from_digits(uint32_t bits) {
  uint32_t value = 0;
  for (unsigned shift = WORD_BITS; shift != 0u; shift -= DIGIT_BITS)
    value = value * 10u + ((bits >> (shift - DIGIT_BITS)) & 0xFu);
  return value;
}

static uint32_t to_digits(uint32_t value) {
  uint32_t bits = 0;
  for (unsigned shift = 0; shift < WORD_BITS; shift += DIGIT_BITS, value /= 10u) bits |= (value % 10u) << shift;
  return bits;
}

static double read_part(uint32_t word, const struct m_definition* d) {
  const uint32_t mask = width_mask(d->width), bits = (word >> d->lsb) & mask;
  if (d->format == M_BCD) return (double)from_digits(bits);
  if (d->format == M_COMPLEMENT_BCD) return (double)from_digits(~bits & mask);
  if (d->format == M_SIGNED && (bits >> (d->width - 1u)) != 0u) return (double)(int32_t)(bits | ~mask);
  return (double)bits;
}

/* The nearest integer, as many digits or bits of it as there are. */
static void write_part(bool x, const struct m_definition* d, int64_t whole) {
  uint32_t bits = (uint32_t)whole;
  if (d->format >= M_BCD) bits = to_digits((uint32_t)((whole < 0 ? -whole : whole) % 1000000));
  if (d->format == M_COMPLEMENT_BCD) bits = ~bits;
  word_write_part(x, d->address, width_mask(d->width) << d->lsb, bits << d->lsb);
}

/* 32 bits in the low halves of X and Y ----------------------------------------------------------------------------- */

static uint32_t join_halves(uint32_t x, uint32_t y) { return ((x & 0xFFFFu) << 16) | (y & 0xFFFFu); }

/* IEEE single precision. What a host leaves there may be infinite or no number: the largest value, 0. */
static double from_single(uint32_t bits) {
  const union {
    uint32_t bits;
    float value;
  } u = {bits};
  if (((bits >> 23) & 0xFFu) != 0xFFu) return (double)u.value;
  if ((bits & 0x7FFFFFu) != 0u) return 0.0;
  return (bits >> 31) != 0u ? -MATH_LARGEST : MATH_LARGEST;
}

static uint32_t to_single(double value) {
  const union {
    float value;
    uint32_t bits;
  } u = {(float)value};
  return u.bits;
}

/* Values ----------------------------------------------------------------------------------------------------------- */

static double read_value(const struct m_definition* d) {
  if (d->form == M_FORM_NONE) return (double)hal_signed(d->address);
  if (d->form > M_FORM_F) return 0.0;
  if (d->form == M_FORM_X || d->form == M_FORM_Y) return read_part(word_read(d->form == M_FORM_X, d->address), d);
  struct float48 word;
  word_read_long(d->address, &word.x, &word.y);
  switch (d->form) {
    case M_FORM_D:
      return (double)(((int64_t)hal_signed(word.x) * 16777216) + (int64_t)word.y);
    case M_FORM_DP:
      return (double)(int32_t)join_halves(word.x, word.y);
    case M_FORM_F:
      return from_single(join_halves(word.x, word.y));
    default:
      return float48_unpack(word);
  }
}

double m_variable_read(uint32_t number) {
  if (number >= VARIABLE_COUNT) return 0.0;
  const struct m_definition definition = m_variable_definition(number);
  return read_value(&definition);
}

static void write_halves(uint32_t address, uint32_t bits) { word_write_long(address, bits >> 16, bits & 0xFFFFu); }

void m_variable_write(uint32_t number, double value) {
  if (number >= VARIABLE_COUNT) return;
  const int64_t whole = math_nearest(value);
  const struct float48 word = float48_pack(value);
  const struct m_definition d = m_variable_definition(number);
  switch (d.form) {
    case M_FORM_NONE:
      word_write_long(MEMORY_M_DEFINITIONS + number, 0, (uint32_t)whole);
      break;
    case M_FORM_X:
    case M_FORM_Y:
      write_part(d.form == M_FORM_X, &d, whole);
      break;
    case M_FORM_D:
      word_write_long(d.address, (uint32_t)(whole >> 24), (uint32_t)whole);
      break;
    case M_FORM_L:
      word_write_long(d.address, word.x, word.y);
      break;
    case M_FORM_DP:
      write_halves(d.address, (uint32_t)whole);
      break;
    case M_FORM_F:
      write_halves(d.address, to_single(value));
      break;
    default:
      break; /* on the multiplexer, where nothing is */
  }
}
