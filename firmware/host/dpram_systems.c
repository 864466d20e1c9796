#include "firmware/host/dpram_systems.h"

#include <stdint.h>

#include "firmware/base/dpram.h"
#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/buffers/rotary_ring.h"
#include "firmware/hal/hal.h"
#include "firmware/host/dpram_report.h"
#include "firmware/kernel/background.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/live_words.h"
#include "firmware/motion/motion_status.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"

enum { COUNT_MASK = 0xFF };

static struct dpram_report report = {.busy = DPRAM_BACKGROUND_HOST_BUSY, .timer = DPRAM_BACKGROUND_TIMER};
static uint32_t next, count; /* coordinate systems of the set */

void dpram_systems_initialize(void) { dpram_report_initialize(&report); }

static void write_global(void) {
  const bool has_panel = (hal_strap(HAL_STRAP_PRODUCT) & HAL_PRODUCT_JPAN) != 0u;
  dpram_put_word(DPRAM_PANEL_PORT, has_panel ? *hal_y(JPAN_Y_INPUTS) : 0u);
  dpram_put_word(DPRAM_MACHINE_PORT, 0);
  dpram_put_word(DPRAM_THUMBWHEEL_PORT, 0);
  dpram_put_word(DPRAM_GLOBAL_STATUS, status_word());
  dpram_put_word(DPRAM_GLOBAL_STATUS + DPRAM_ITEM_BYTES, motion_global_status2());
}

/* Of the executing move: until it has ended, and until it has reached its velocity. That motors which go for themselves
 * have left (RAPID, HOME) is not known: 0. */
struct times {
  int64_t move, acceleration;
};

static struct times times_left(const struct coordinate_system* s) {
  struct times left = {0, 0};
  const uint32_t state = hal_mask_servo();
  if (s->active) {
    const struct move* m = &s->moves[s->executing];
    const bool moves = m->kind == MOVE_LINEAR;
    left.move = (moves ? m->blend_in / 2 + m->time + m->stop_length / 2 : m->time) - s->elapsed;
    if (left.move < 0) left.move = 0;
    if (moves && m->blend_in > s->elapsed) left.acceleration = m->blend_in - s->elapsed;
  }
  hal_unmask(state);
  return left;
}

static uint32_t milliseconds(int64_t time) { return (uint32_t)(time >> TRAJECTORY_FRACTION_BITS); }

static void write_system(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t block = DPRAM_CS_BLOCKS + DPRAM_CS_STRIDE * cs;
  const struct float48 rate = float48_pack(cs_real(cs, ISX89_FEEDRATE));
  dpram_put_long(block + DPRAM_CS_FEED_RATE, rate.x, rate.y);
  dpram_put_word(block + DPRAM_CS_TIME_BASE, (uint32_t)s->increment);
  dpram_put_word(block + DPRAM_CS_TIME_BASE_SOURCE, (uint32_t)i_integer(i_cs(cs, ISX93_TIME_BASE_ADDRESS)));
  dpram_put_word(block + DPRAM_CS_STATUS_3, motion_cs_status(cs, 2));
  dpram_put_word(block + DPRAM_CS_STATUS_1, motion_cs_status(cs, 0));
  for (uint32_t axis = 0; axis < AXIS_COUNT; ++axis) {
    uint32_t x = 0, y = 0;
    live_word_read(MEMORY_CS_WORDS + MEMORY_CS_STRIDE * cs + MEMORY_CS_TARGETS + axis, &x, &y);
    dpram_put_long(block + DPRAM_CS_TARGETS + 2u * DPRAM_ITEM_BYTES * axis, x, y);
  }
  dpram_put_word(block + DPRAM_CS_STATUS_2, motion_cs_status(cs, 1));
  dpram_put_word(block + DPRAM_CS_LINES, rotary_buffers[cs].lines);
  const struct times left = times_left(s);
  dpram_put_word(block + DPRAM_CS_MOVE_TIME_LEFT, milliseconds(left.move));
  dpram_put_word(block + DPRAM_CS_ACCELERATION_TIME_LEFT, milliseconds(left.acceleration));
  struct program_trace trace;
  run_executing(cs, &trace);
  dpram_put_word(block + DPRAM_CS_EXECUTING, trace.places[trace.depth].offset);
}

void dpram_systems_pass(void) {
  const int32_t period = i_integer(I49_DPRAM_BACKGROUND_ENABLE) != 0 ? i_integer(I50_DPRAM_BACKGROUND_PERIOD) : 0;
  if (period == 0 && !report.is_on) return;
  const bool begins = !report.writes;
  if (!dpram_report_is_due(&report, period)) return;
  if (begins) {
    const uint32_t wanted = dpram_read(DPRAM_BACKGROUND_COUNT) & COUNT_MASK;
    next = 0;
    count = wanted < COORDINATE_SYSTEMS ? wanted : COORDINATE_SYSTEMS;
    write_global();
  }
  if (next < count) write_system(next++);
  if (next == count)
    dpram_report_end(&report);
  else
    background_wake();
}
