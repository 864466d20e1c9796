/* M-variables: pointers to a register, part of one, or a word of their own. The definition of Mn is the 48-bit word at
 * $004000+n: Y = register address, X = form in bits 23..20, first bit in 12..8, width in 4..0, signed in bit 5.
 * `*` (form 0) keeps its value in the Y half of the definition itself. */
#include "firmware/variables/m_variables.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/words.h"

struct m_definition m_variable_definition(uint32_t number) {
  const uint32_t x = *hal_x(MEMORY_M_DEFINITIONS + number) & HAL_WORD_MASK;
  const uint32_t form = x >> 20 <= M_FORM_LAST ? x >> 20 : M_FORM_NONE; /* a host may have written over it */
  const struct m_definition definition = {(m_form_t)form, *hal_y(MEMORY_M_DEFINITIONS + number) & HAL_WORD_MASK,
                                          (uint8_t)((x >> 8) & 0x1Fu), (uint8_t)(x & 0x1Fu), ((x >> 5) & 1u) != 0u};
  return definition;
}

void m_variable_define(uint32_t number, const struct m_definition* definition) {
  if (number >= VARIABLE_COUNT) return;
  const uint32_t state = hal_mask_real_time();
  *hal_x(MEMORY_M_DEFINITIONS + number) = ((uint32_t)definition->form << 20) | ((uint32_t)definition->lsb << 8) |
                                          (definition->is_signed ? 0x20u : 0u) | definition->width;
  *hal_y(MEMORY_M_DEFINITIONS + number) = definition->address;
  hal_unmask(state);
}

static double read_part(uint32_t word, const struct m_definition* definition) {
  uint32_t value = word >> definition->lsb;
  if (definition->width < 24u) value &= (1u << definition->width) - 1u;
  value &= HAL_WORD_MASK;
  if (definition->is_signed && definition->width > 0u && ((value >> (definition->width - 1u)) & 1u) != 0u)
    return (double)(int32_t)(value | ~((1u << definition->width) - 1u));
  return (double)value;
}

static void write_part(bool x, const struct m_definition* definition, double value) {
  const uint32_t mask = definition->width < 24u ? (1u << definition->width) - 1u : HAL_WORD_MASK;
  const uint32_t bits = (uint32_t)(int64_t)(value < 0.0 ? value - 0.5 : value + 0.5) & mask;
  const uint32_t kept = mask == HAL_WORD_MASK ? 0u : word_read(x, definition->address) & ~(mask << definition->lsb);
  word_write(x, definition->address, kept | (bits << definition->lsb));
}

static double read_value(const struct m_definition* definition) {
  const uint32_t address = definition->address;
  if (definition->form == M_FORM_NONE) return (double)hal_signed(address);
  const uint32_t x = definition->form == M_FORM_Y ? 0u : word_read(true, address);
  const uint32_t y = definition->form == M_FORM_X ? 0u : word_read(false, address);
  const struct float48 word = {x, y};
  switch (definition->form) {
    case M_FORM_X:
      return read_part(x, definition);
    case M_FORM_Y:
      return read_part(y, definition);
    case M_FORM_D:
      return (double)(((int64_t)hal_signed(x) * 16777216) + (int64_t)y);
    case M_FORM_DP:
      return (double)(int32_t)(((x & 0xFFFFu) << 16) | (y & 0xFFFFu));
    default:
      return float48_unpack(word);
  }
}

double m_variable_read(uint32_t number) {
  if (number >= VARIABLE_COUNT) return 0.0;
  const uint32_t state = hal_mask_servo(); /* the servo task moves positions of two words */
  const struct m_definition definition = m_variable_definition(number);
  const double value = read_value(&definition);
  hal_unmask(state);
  return value;
}

static void write_long(uint32_t address, uint32_t x, uint32_t y) {
  word_write(true, address, x);
  word_write(false, address, y);
}

void m_variable_write(uint32_t number, double value) {
  if (number >= VARIABLE_COUNT) return;
  if (!(value < 140737488355328.0)) value = 140737488355327.0;
  if (!(value > -140737488355328.0)) value = -140737488355328.0;
  const int64_t whole = (int64_t)(value < 0.0 ? value - 0.5 : value + 0.5);
  const struct float48 word = float48_pack(value);
  const uint32_t state = hal_mask_servo();
  const struct m_definition definition = m_variable_definition(number);
  switch (definition.form) {
    case M_FORM_X:
    case M_FORM_Y:
      write_part(definition.form == M_FORM_X, &definition, value);
      break;
    case M_FORM_D:
      write_long(definition.address, (uint32_t)(whole >> 24), (uint32_t)whole);
      break;
    case M_FORM_L:
      write_long(definition.address, word.x, word.y);
      break;
    case M_FORM_DP:
      write_long(definition.address, (uint32_t)(whole >> 16) & 0xFFFFu, (uint32_t)whole & 0xFFFFu);
      break;
    default:
      *hal_y(MEMORY_M_DEFINITIONS + number) = (uint32_t)whole & HAL_WORD_MASK;
      break;
  }
  hal_unmask(state);
}
