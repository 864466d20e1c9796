/* Memory manager of the user buffers. Because a region can only come and go at the lower end of the others, the manager
 * is a list of sizes: a region lies below the sum of all that come before it. */
#include "firmware/buffers/regions.h"

#include "firmware/base/buffers_end.h"
#include "firmware/base/dimensions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/slice.h"
#include "firmware/variables/i_variables.h"

enum { OWNERS = MOTORS }; /* no fewer than coordinate systems */

static struct {
  uint32_t words[REGION_KINDS][OWNERS]; /* 0: does not exist. Those for all use index 0 only. Owner: background task */
  uint32_t fixed;                       /* words of fixed programs, from the lowest on */
  uint32_t user;                        /* of UBUFFER, the highest */
  uint32_t all;                         /* there are, on this board */
  uint32_t open;                        /* of none, between: kept, because each line stored asks for it */
} regions;

static uint32_t owner_index(enum region_kind kind, uint32_t owner) {
  return kind == REGION_GATHER || kind == REGION_TBUF ? 0 : owner;
}

static bool any_from(uint32_t highest) {
  for (uint32_t kind = highest; kind < REGION_KINDS; kind++)
    for (uint32_t any = 0; any < OWNERS; any++)
      if (regions.words[kind][any] != 0) return true;
  return false;
}

/* Something lies below it: the same kind of a lower-numbered owner, or any kind that comes later. */
static bool is_held(enum region_kind kind, uint32_t index) {
  for (uint32_t lower = 0; lower < index; lower++)
    if (regions.words[kind][lower] != 0) return true;
  return any_from((uint32_t)kind + 1u);
}

static void resize(uint32_t* words, uint32_t to) {
  regions.open += *words;
  regions.open -= to;
  *words = to;
}

void regions_initialize(void) {
  __builtin_memset(&regions, 0, sizeof regions);
  regions.all = regions.open = memory_buffers_end() - MEMORY_BUFFERS;
}

uint32_t region_open_words(void) { return regions.open; }

uint32_t region_words(enum region_kind kind, uint32_t owner) { return regions.words[kind][owner_index(kind, owner)]; }

uint32_t region_base(enum region_kind kind, uint32_t owner) {
  const uint32_t index = owner_index(kind, owner);
  uint32_t base = regions.all - regions.user;
  for (uint32_t before = 0; before < (uint32_t)kind; before++) {
    for (uint32_t any = 0; any < OWNERS; any++) base -= regions.words[before][any];
    slice_pause();
  }
  for (uint32_t higher = index; higher < OWNERS; higher++) base -= regions.words[kind][higher];
  return base;
}

error_t region_resize_fixed(uint32_t words) {
  if (words > regions.fixed + regions.open) return ERR_NO_ROOM;
  resize(&regions.fixed, words);
  return ERR_NONE;
}

error_t region_define(enum region_kind kind, uint32_t owner, uint32_t words) {
  uint32_t index = owner_index(kind, owner);
  if (words == 0 || regions.words[kind][index] != 0 || is_held(kind, index)) return ERR_DATA;
  if (words > regions.open) return ERR_NO_ROOM;
  resize(&regions.words[kind][index], words);
  return ERR_NONE;
}

error_t region_define_rest(void) {
  if (regions.words[REGION_GATHER][0] == 0 && regions.open == 0) return ERR_NO_ROOM;
  return region_define(REGION_GATHER, 0, regions.open);
}

error_t region_delete(enum region_kind kind, uint32_t owner) {
  uint32_t index = owner_index(kind, owner);
  if (is_held(kind, index)) return ERR_DATA;
  resize(&regions.words[kind][index], 0);
  return ERR_NONE;
}

void regions_delete_from(enum region_kind highest) {
  for (uint32_t kind = (uint32_t)highest; kind < REGION_KINDS; kind++)
    for (uint32_t owner = 0; owner < OWNERS; owner++) resize(&regions.words[kind][owner], 0);
}

bool region_restore_user(uint32_t words) {
  if (words > regions.open + regions.user) return false;
  resize(&regions.user, words);
  i_variable_set_open_memory_end(MEMORY_BUFFERS + regions.all - words);
  return true;
}

error_t region_define_user(uint32_t words) {
  if (regions.fixed != 0 || any_from(0)) return ERR_DATA;
  return region_restore_user(words) ? ERR_NONE : ERR_NO_ROOM;
}

uint32_t region_user_words(void) { return regions.user; }
