/* From lines to entries. A line may be written while the servo task works on the table, so a second table is made and
 * the two change places while it is held off; entries whose lines are as before go on with what they remember. */
#include "firmware/motion/conversion_table.h"

#include "firmware/base/memory_map.h"
#include "firmware/base/rework.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/conversion_encoder.h"
#include "firmware/motion/conversion_entry.h"
#include "firmware/motion/conversion_filter.h"
#include "firmware/motion/conversion_word.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"
#include "rtl/regs/brick_regs.h"

enum { FLAG = 1 << 19, ADDRESS = FLAG - 1, METHOD_SHIFT = 20, METHOD = 0xF << METHOD_SHIFT };
enum { METHOD_FROZEN = 0x9, METHOD_RUNNING = 0xA, METHOD_ARMED = 0xB, METHOD_EXTENDED = 0xF };
enum { PARALLEL_MOST_BITS = 24, PARALLEL_LEAST = 0x2F, SHIFTED = 5 };

struct table {
  uint32_t count;
  bool armed; /* an entry waits for its trigger */
  struct conversion_entry entries[CONVERSION_LINES];
};

static struct table tables[2];
static struct rework rework;
static struct table* volatile present;                   /* the servo task's */
static struct conversion_state states[CONVERSION_LINES]; /* by first line. S */
static const volatile uint32_t zero;                     /* where there is no word */

static uint32_t line_word(uint32_t line) { return (uint32_t)i_integer(I8000_CONVERSION_TABLE + line) & HAL_WORD_MASK; }
static volatile uint32_t* result_word(uint32_t line) { return hal_x(MEMORY_CONVERSION + line); }

static const volatile uint32_t* source_word(bool x, uint32_t address) {
  if (!word_exists(x, address)) return &zero;
  return x ? hal_x(address) : hal_y(address);
}

static uint32_t lines_of(uint32_t line) {
  static const uint8_t LINES[16] = {1, 1, 2, 3, 2, 2, 2, 3, 1, 2, 2, 2, 1, 3, 1, 2};
  static const uint8_t EXTENDED[16] = {3, 5, 2, 3, 4, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2};
  const uint32_t setup = line_word(line), method = setup >> METHOD_SHIFT;
  if (method == 0xD && (setup & FLAG) != 0u) return 5;
  if (method != METHOD_EXTENDED || line + 1u >= CONVERSION_LINES) return LINES[method];
  return EXTENDED[line_word(line + 1u) >> METHOD_SHIFT];
}

static void make_encoder(struct conversion_entry* e, uint32_t channel) {
  e->source[0] = source_word(true, channel + SERVO_CHANNEL_X_SERVO_POSITION);
  e->source[1] = source_word(false, channel + SERVO_CHANNEL_Y_TIMER1);
  e->source[2] = source_word(false, channel + SERVO_CHANNEL_Y_TIMER2);
  e->source[3] = source_word(true, channel + SERVO_CHANNEL_X_STATUS);
  e->source[4] = source_word(true, channel + SERVO_CHANNEL_X_FLAG_POSITION);
}

/* Bits that do not exist, in the word or in the number, are none: the result stays. */
static void make_parallel(struct conversion_entry* e, uint32_t address) {
  const uint32_t width = (uint32_t)e->parameter[1] >> 12 & 0xFFFu, least = (uint32_t)e->parameter[1] & 0xFFFu;
  const bool x_follows = e->method == 0x6 || e->method == 0x7;
  e->source[0] = source_word(false, address);
  e->source[1] = x_follows ? source_word(true, address) : source_word(false, address + 1u);
  e->shift = e->flag ? 0 : SHIFTED;
  e->width = (uint8_t)(width >= 1u && width <= PARALLEL_MOST_BITS ? width : 1u);
  e->least = (uint8_t)(least <= PARALLEL_LEAST ? least : PARALLEL_LEAST);
  if (e->width != width || e->least != least) e->source[0] = e->source[1] = &zero;
}

static void make_sources(struct conversion_entry* e) {
  const uint32_t address = e->setup & ADDRESS;
  switch (e->method) {
    case 0x1:
    case 0x5:
      e->source[0] = source_word(false, address);
      break;
    case 0x2:
    case 0x3:
    case 0x6:
    case 0x7:
      make_parallel(e, address);
      break;
    case 0x4:
    case 0xD:
      e->source[0] = source_word(true, address);
      break;
    case 0xE:
      for (uint32_t i = 0; i < 2u; ++i) {
        const uint32_t line = e->setup >> 8u * i & 0xFFu;
        e->source[i] = line < CONVERSION_LINES ? result_word(line) : &zero;
      }
      break;
    default:
      make_encoder(e, address);
  }
}

static void make_entry(struct conversion_entry* e, uint32_t line, uint32_t lines) {
  typedef void (*convert_t)(const struct conversion_entry* entry);
  static const convert_t CONVERT[16] = {0, /* conversion_software_1t */
                                        convert_analog,
                                        convert_parallel,
                                        convert_parallel_limited,
                                        convert_time_base,
                                        convert_analog_integrated,
                                        convert_parallel,
                                        convert_parallel_limited,
                                        convert_sub_count,
                                        convert_frozen,
                                        convert_armed,
                                        convert_armed,
                                        convert_counter,
                                        convert_exponential,
                                        convert_sum,
                                        convert_nothing};
  e->line = (uint8_t)line;
  e->setup = line_word(line);
  e->method = (uint8_t)(e->setup >> METHOD_SHIFT);
  e->flag = (e->setup & FLAG) != 0u;
  for (uint32_t i = 1; i < CONVERSION_LONGEST; ++i) e->parameter[i] = i < lines ? hal_signed(line_word(line + i)) : 0;
  e->convert = CONVERT[e->method];
  if (e->flag && e->method == 0xC) e->convert = convert_hardware_1t;
  if (e->flag && e->method == 0xD) e->convert = convert_tracking;
  e->state = &states[line];
  e->first_result = result_word(line);
  e->result = result_word(line + lines - 1u);
  make_sources(e);
}

/* Whether `e`, of the same line as `b`, goes on with what that remembers: the digit that the servo task changes does
 * not count. */
static bool is_as_before(const struct conversion_entry* e, const struct conversion_entry* b) {
  const bool triggered = b->method == METHOD_ARMED && e->method == METHOD_RUNNING && b->state->runs;
  if (b->setup != e->setup && !(triggered && ((b->setup ^ e->setup) & ~(uint32_t)METHOD) == 0u)) return false;
  for (uint32_t k = 1; k < CONVERSION_LONGEST; ++k)
    if (b->parameter[k] != e->parameter[k]) return false;
  return true;
}

static void make(struct table* table) {
  table->count = 0;
  table->armed = false;
  for (uint32_t line = 0; line < CONVERSION_LINES && line_word(line) != 0u;) {
    const uint32_t lines = lines_of(line);
    if (line + lines > CONVERSION_LINES) break;
    struct conversion_entry* entry = &table->entries[table->count++];
    make_entry(entry, line, lines);
    if (entry->method == METHOD_ARMED) table->armed = true;
    line += lines;
  }
}

/* A time base that is told to run begins where its source is. */
static void begin(struct conversion_entry* e) {
  *e->state = (struct conversion_state){.fresh = true, .runs = e->method == METHOD_RUNNING};
  if (e->state->runs) e->state->previous = *e->source[0] >> 1 << 8;
}

static void change(void) {
  static bool new_entry[CONVERSION_LINES];
  struct table *before = present, *table = before == &tables[0] ? &tables[1] : &tables[0];
  make(table);
  const struct conversion_entry *b = before->entries, *end = b + before->count; /* both by line */
  for (uint32_t i = 0; i < table->count; ++i) {
    const struct conversion_entry* e = &table->entries[i];
    while (b != end && b->line < e->line) ++b;
    new_entry[i] = b == end || b->line != e->line || !is_as_before(e, b);
  }
  const uint32_t state = hal_mask_servo();
  for (uint32_t i = 0; i < table->count; ++i)
    if (new_entry[i]) begin(&table->entries[i]);
  present = table;
  hal_unmask(state);
}

void conversion_table_changed(uint32_t instance) {
  (void)instance;
  if (!rework_begin(&rework, 1)) return;
  do change();
  while (rework_end(&rework) != 0u);
}

void conversion_table_initialize(void) {
  rework = (struct rework){.under_way = false};
  tables[0].count = tables[1].count = 0;
  present = &tables[0];
  conversion_table_changed(0);
}

void conversion_table_servo(void) {
  const struct table* table = present;
  const struct conversion_entry *e = table->entries, *end = e + table->count;
  for (; e != end; ++e) {
    if (e->convert == 0) /* nearly all are: no call */
      conversion_software_1t(e);
    else
      e->convert(e);
  }
}

/* A time base that has had its trigger shows it in its line. */
void conversion_table_pass(void) {
  if (!present->armed) return;
  for (uint32_t i = 0; i < present->count; ++i) {
    const struct conversion_entry* e = &present->entries[i];
    if (e->method != METHOD_ARMED || !e->state->runs) continue;
    const uint32_t running = (e->setup & ~(uint32_t)METHOD) | (uint32_t)METHOD_RUNNING << METHOD_SHIFT;
    i_variable_write(I8000_CONVERSION_TABLE + e->line, running);
    return; /* the table is another one now */
  }
}

bool conversion_table_is_not_built(uint32_t address) {
  for (uint32_t i = 0; i < present->count; ++i) {
    const struct conversion_entry* e = &present->entries[i];
    if (e->method == METHOD_EXTENDED && e->result == hal_x(address)) return true;
  }
  return false;
}
