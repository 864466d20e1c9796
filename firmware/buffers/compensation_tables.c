#include "firmware/buffers/compensation_tables.h"

#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/watchdog.h"

enum { WORDS_BETWEEN_RELOADS = 256 };

static struct compensation_table tables[COMPENSATION_KINDS][MOTORS];

static struct {
  bool active;
  enum region_kind kind;
  uint32_t motor, next;
} fill;

void compensation_tables_initialize(void) { fill.active = false; }

error_t compensation_table_define(enum region_kind kind, uint32_t motor, uint32_t entries,
                                  const struct compensation_table* table) {
  const error_t error = region_define(kind, motor, entries);
  if (error != ERR_NONE) return error;
  tables[kind][motor] = *table;
  tables[kind][motor].base = region_base(kind, motor);
  for (uint32_t i = 0; i < entries; i++) {
    compensation_set_entry(kind, motor, i, 0);
    if (i % WORDS_BETWEEN_RELOADS == 0) watchdog_reload();
  }
  return ERR_NONE;
}

error_t compensation_table_delete(enum region_kind kind, uint32_t motor) {
  const error_t error = region_delete(kind, motor);
  if (error == ERR_NONE && fill.kind == kind && fill.motor == motor) fill.active = false;
  return error;
}

void compensation_tables_delete_all(void) {
  regions_delete_from(REGION_COMP);
  fill.active = false;
}

const struct compensation_table* compensation_table(enum region_kind kind, uint32_t motor) {
  return region_words(kind, motor) != 0 ? &tables[kind][motor] : 0;
}

int32_t compensation_entry(enum region_kind kind, uint32_t motor, uint32_t index) {
  const uint32_t word = (uint32_t)user_memory_read(tables[kind][motor].base + index) & HAL_WORD_MASK;
  return (int32_t)(word << 8) >> 8;
}

void compensation_set_entry(enum region_kind kind, uint32_t motor, uint32_t index, int32_t entry) {
  user_memory_write(tables[kind][motor].base + index, (uint32_t)entry & HAL_WORD_MASK);
}

void compensation_fill(enum region_kind kind, uint32_t motor) {
  fill.active = true;
  fill.kind = kind;
  fill.motor = motor;
  fill.next = 0;
}

bool compensation_is_filling(void) { return fill.active; }

error_t compensation_take(double value) {
  const double most = COMPENSATION_ENTRY_MOST;
  if (!(value >= -most - 1.0 && value <= most) || value != (double)(int32_t)value) return ERR_DATA;
  compensation_set_entry(fill.kind, fill.motor, fill.next++, (int32_t)value);
  fill.active = fill.next < region_words(fill.kind, fill.motor);
  return ERR_NONE;
}
