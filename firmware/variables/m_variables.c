/* M-variables: pointers to a register, part of one, or a word of their own. The definition of Mn is the 48-bit word at $004000+n:
 * Y = register address, X = form in bits 23..20, first bit in 12..8, width in 4..0, signed in bit 5.
 * `*` (form 0) keeps its value in the Y half of the definition itself. */
#include "firmware/variables/m_variables.h"

#include "firmware/hal/hal.h"
#include "firmware/variables/variables.h"

#define M_MEMORY 0x004000u

struct m_definition m_variable_definition(uint32_t number) {
  const uint32_t x = *hal_x(M_MEMORY + number) & HAL_WORD_MASK;
  const struct m_definition definition = {(m_form_t)(x >> 20), *hal_y(M_MEMORY + number) & HAL_WORD_MASK, (uint8_t)((x >> 8) & 0x1Fu),
                                          (uint8_t)(x & 0x1Fu), ((x >> 5) & 1u) != 0u};
  return definition;
}

void m_variable_define(uint32_t number, const struct m_definition* definition) {
  const uint32_t state = hal_mask_real_time();
  *hal_x(M_MEMORY + number) =
      ((uint32_t)definition->form << 20) | ((uint32_t)definition->lsb << 8) | (definition->is_signed ? 0x20u : 0u) | definition->width;
  *hal_y(M_MEMORY + number) = definition->address;
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

static void write_part(volatile uint32_t* word, const struct m_definition* definition, double value) {
  const uint32_t mask = definition->width < 24u ? (1u << definition->width) - 1u : HAL_WORD_MASK;
  const uint32_t bits = (uint32_t)(int64_t)(value < 0.0 ? value - 0.5 : value + 0.5) & mask;
  if (mask == HAL_WORD_MASK) {
    *word = bits;
    return;
  }
  const uint32_t state = hal_mask_servo();
  *word = ((*word & ~(mask << definition->lsb)) | (bits << definition->lsb)) & HAL_WORD_MASK;
  hal_unmask(state);
}

double m_variable_read(uint32_t number) {
  if (number >= VARIABLE_COUNT) return 0.0;
  const struct m_definition definition = m_variable_definition(number);
  const uint32_t address = definition.address;
  switch (definition.form) {
    case M_FORM_X:
      return read_part(*hal_x(address) & HAL_WORD_MASK, &definition);
    case M_FORM_Y:
      return read_part(*hal_y(address) & HAL_WORD_MASK, &definition);
    case M_FORM_D:
      return (double)(((int64_t)hal_signed(*hal_x(address)) * 16777216) + (int64_t)(*hal_y(address) & HAL_WORD_MASK));
    case M_FORM_L: {
      const struct float48 word = {*hal_x(address) & HAL_WORD_MASK, *hal_y(address) & HAL_WORD_MASK};
      return float48_unpack(word);
    }
    case M_FORM_DP:
      return (double)(int32_t)(((*hal_x(address) & 0xFFFFu) << 16) | (*hal_y(address) & 0xFFFFu));
    default:
      return (double)hal_signed(address);
  }
}

void m_variable_write(uint32_t number, double value) {
  if (number >= VARIABLE_COUNT) return;
  if (!(value < 140737488355328.0)) value = 140737488355327.0;
  if (!(value > -140737488355328.0)) value = -140737488355328.0;
  const struct m_definition definition = m_variable_definition(number);
  const uint32_t address = definition.address;
  const int64_t whole = (int64_t)(value < 0.0 ? value - 0.5 : value + 0.5);
  const uint32_t state = hal_mask_real_time();
  switch (definition.form) {
    case M_FORM_X:
      write_part(hal_x(address), &definition, value);
      break;
    case M_FORM_Y:
      write_part(hal_y(address), &definition, value);
      break;
    case M_FORM_D:
      *hal_x(address) = (uint32_t)(whole >> 24) & HAL_WORD_MASK;
      *hal_y(address) = (uint32_t)whole & HAL_WORD_MASK;
      break;
    case M_FORM_L: {
      const struct float48 word = float48_pack(value);
      *hal_x(address) = word.x;
      *hal_y(address) = word.y;
      break;
    }
    case M_FORM_DP:
      *hal_y(address) = (uint32_t)whole & 0xFFFFu;
      *hal_x(address) = (uint32_t)(whole >> 16) & 0xFFFFu;
      break;
    default:
      *hal_y(M_MEMORY + number) = (uint32_t)whole & HAL_WORD_MASK;
      break;
  }
  hal_unmask(state);
}
