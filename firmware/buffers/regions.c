/* Memory manager of the user buffers. Because regions can only be stacked on top, the manager is a list of sizes: the
 * base of a region is the sum of all sizes below it. */
#include "firmware/buffers/regions.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/user_memory.h"

static struct {
  uint32_t words[REGION_KINDS]
                [COORDINATE_SYSTEMS]; /* 0: does not exist. GATHER uses index 0 only. Owner: background task */
  uint32_t fixed;                     /* words of fixed programs, below all others */
} regions;

static uint32_t owner_index(enum region_kind kind, uint32_t cs) { return kind == REGION_GATHER ? 0 : cs; }

/* Something lies above (kind, cs): the same kind in a lower-numbered coordinate system, or any kind that comes later.
 */
static bool is_covered(enum region_kind kind, uint32_t cs) {
  for (uint32_t lower = 0; lower < cs; lower++)
    if (regions.words[kind][lower] != 0) return true;
  for (uint32_t later = (uint32_t)kind + 1; later < REGION_KINDS; later++)
    for (uint32_t any = 0; any < COORDINATE_SYSTEMS; any++)
      if (regions.words[later][any] != 0) return true;
  return false;
}

void regions_initialize(void) {
  for (uint32_t kind = 0; kind < REGION_KINDS; kind++)
    for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) regions.words[kind][cs] = 0;
  regions.fixed = 0;
}

uint32_t region_open_words(void) {
  uint32_t used = regions.fixed;
  for (uint32_t kind = 0; kind < REGION_KINDS; kind++)
    for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) used += regions.words[kind][cs];
  return USER_MEMORY_WORDS - used;
}

uint32_t region_words(enum region_kind kind, uint32_t cs) { return regions.words[kind][owner_index(kind, cs)]; }

uint32_t region_base(enum region_kind kind, uint32_t cs) {
  uint32_t base = regions.fixed;
  for (uint32_t below = 0; below < (uint32_t)kind; below++)
    for (uint32_t any = 0; any < COORDINATE_SYSTEMS; any++) base += regions.words[below][any];
  for (uint32_t higher = owner_index(kind, cs) + 1; higher < COORDINATE_SYSTEMS; higher++)
    base += regions.words[kind][higher];
  return base;
}

error_t region_resize_fixed(uint32_t words) {
  if (words == regions.fixed) return ERR_NONE;
  if (words > regions.fixed + region_open_words()) return ERR_NO_ROOM;
  for (uint32_t kind = 0; kind < REGION_KINDS; kind++)
    for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
      if (regions.words[kind][cs] != 0) return ERR_DATA;
  regions.fixed = words;
  return ERR_NONE;
}

error_t region_define(enum region_kind kind, uint32_t cs, uint32_t words) {
  uint32_t index = owner_index(kind, cs);
  if (words == 0 || regions.words[kind][index] != 0 || is_covered(kind, index)) return ERR_DATA;
  if (words > region_open_words()) return ERR_NO_ROOM;
  regions.words[kind][index] = words;
  return ERR_NONE;
}

error_t region_define_rest(void) {
  uint32_t words = region_open_words();
  if (regions.words[REGION_GATHER][0] == 0 && words == 0) return ERR_NO_ROOM;
  return region_define(REGION_GATHER, 0, words);
}

error_t region_delete(enum region_kind kind, uint32_t cs) {
  uint32_t index = owner_index(kind, cs);
  if (is_covered(kind, index)) return ERR_DATA;
  regions.words[kind][index] = 0;
  return ERR_NONE;
}

void region_delete_temporaries(void) {
  for (uint32_t kind = REGION_KINDS; kind-- > 0;)
    for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) regions.words[kind][cs] = 0;
}
