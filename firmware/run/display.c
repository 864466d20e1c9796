#include "firmware/run/display.h"

#include <stdbool.h>

#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/language/statement_argument.h"

enum { WIDEST = 16, MOST_DECIMALS = 9 };

static void put(uint32_t column, char c) {
  if (column < DISPLAY_COLUMNS) *hal_y(MEMORY_DISPLAY + column) = (uint8_t)c;
}

void display_initialize(void) {
  for (uint32_t column = 0; column < DISPLAY_COLUMNS; column++) put(column, ' ');
  *hal_x(MEMORY_DISPLAY_POINTER) = MEMORY_DISPLAY;
}

void display_text(uint32_t column, const char* text, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) put(column + i, text[i]);
}

/* A number is written from its last character on. */
struct field {
  char text[WIDEST];
  uint32_t at; /* the first character so far */
  bool fits;
};

static void prepend(struct field* field, char c) {
  field->fits = field->fits && field->at != 0;
  if (field->fits) field->text[--field->at] = c;
}

void display_value(uint32_t column, uint32_t width, uint32_t decimals, double value) {
  const uint32_t end = width < WIDEST ? width : WIDEST, places = decimals < MOST_DECIMALS ? decimals : MOST_DECIMALS;
  double scaled = math_absolute(value);
  for (uint32_t i = 0; i < places; i++) scaled *= 10.0;
  struct field field = {{0}, end, scaled < 1e16}; /* what has more digits is wider than any field */
  uint64_t digits = field.fits ? (uint64_t)(scaled + 0.5) : 0;
  const bool negative = value < 0.0 && digits != 0;
  for (uint32_t i = 0; digits != 0 || i <= places; i++, digits /= 10u) {
    if (i == places && places != 0) prepend(&field, '.');
    prepend(&field, (char)('0' + digits % 10u));
  }
  if (negative) prepend(&field, '-');
  for (uint32_t i = 0; i < end; i++) put(column + i, !field.fits ? '*' : i < field.at ? ' ' : field.text[i]);
}
