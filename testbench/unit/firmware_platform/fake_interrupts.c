/* Interrupts at the accesses of the native firmware. Compiled without the calls that it answers. */
#include "testbench/unit/firmware_platform/fake_interrupts.h"

#include <stddef.h>
#include <string.h>

#include "firmware/hal/hal.h"

enum { SOON = 16 };

static bool on, soon, leaves_time;
static uint32_t random_state, average, left; /* left: accesses until the next */
static struct fake_interrupt_counts counts;
static void (*on_take)(enum fake_task task);

/* The latest access of eight bytes, between whose halves an interrupt comes or has come. */
static struct {
  uint32_t* halves; /* null: none */
  bool store;
  uint32_t kept[2];  /* store: as they were before; load: as memory is now */
  uint32_t shown[2]; /* load: as the interrupted code reads them */
  enum fake_task task;
} torn;

static uint32_t chance(uint32_t below) {
  random_state ^= random_state << 13;
  random_state ^= random_state >> 17;
  random_state ^= random_state << 5;
  return random_state % below;
}

static enum fake_task some_task(void) {
  static const uint8_t tasks[8] = {FAKE_HOST,  FAKE_HOST,  FAKE_HOST,  FAKE_PHASE,
                                   FAKE_SERVO, FAKE_SERVO, FAKE_SERVO, FAKE_SERVO};
  return (enum fake_task)tasks[chance(8)];
}

static bool take(enum fake_task task) {
  const bool taken = fake_task_take(task);
  if (taken)
    ++counts.taken[task];
  else
    ++counts.held_off;
  return taken;
}

void fake_interrupts_taken(enum fake_task task) {
  if (on && on_take != NULL) on_take(task);
}

/* A store: new in the low half, old in the high one, then the interrupt, then the new high half. */
static void finish_store(uint32_t* halves, uint32_t old_high, enum fake_task task) {
  const uint32_t high = halves[1];
  halves[1] = old_high;
  if (take(task)) ++counts.torn;
  halves[1] = high;
}

void fake_interrupts_mend(void) {
  uint32_t* const halves = torn.halves;
  if (halves == NULL) return;
  torn.halves = NULL;
  if (torn.store)
    finish_store(halves, torn.kept[1], torn.task);
  else if (memcmp(halves, torn.shown, sizeof torn.shown) == 0)
    memcpy(halves, torn.kept, sizeof torn.kept);
}

/* A load: the low half as it was before the interrupt, the high one as it is after it. */
static void tear_load(uint32_t* halves, enum fake_task task) {
  const uint32_t low = halves[0];
  if (!take(task) || halves[0] == low) return;
  ++counts.torn;
  memcpy(torn.kept, halves, sizeof torn.kept);
  torn.shown[0] = halves[0] = low;
  torn.shown[1] = halves[1];
  torn.store = false;
  torn.halves = halves;
}

/* Linked to a fixed place (cmake/Options.cmake): below 4 GiB, where neither stacks nor the heap are. Those belong to
 * one task, and words in them may be pointers, which are one access on the target. */
static bool is_static(uintptr_t address) { return address <= UINT32_MAX; }

static void access(uintptr_t address, size_t size, bool store) {
  if (!on) return;
  fake_interrupts_mend();
  if (hal_real_time_pending() && fake_task_take(FAKE_REAL_TIME)) ++counts.taken[FAKE_REAL_TIME];
  if (--left != 0) return;
  left = 1 + chance(2 * average);
  if (soon) hal_request_real_time();
  const enum fake_task task = soon ? FAKE_REAL_TIME : some_task();
  soon = false;
  if (size != 8 || !is_static(address) || chance(2) == 0) {
    (void)take(task);
    return;
  }
  uint32_t* halves = (uint32_t*)address; /* NOLINT(performance-no-int-to-ptr) */
  if (!store) {
    tear_load(halves, task);
    return;
  }
  torn.store = true;
  torn.halves = halves;
  torn.task = task;
  memcpy(torn.kept, halves, sizeof torn.kept);
}

void fake_interrupts_begin(uint32_t seed, uint32_t gap) {
  random_state = seed * 2654435761u + 1u;
  average = gap;
  left = 1 + chance(2 * average);
  torn.halves = NULL;
  soon = leaves_time = false;
  memset(&counts, 0, sizeof counts);
  fake_hal_slices_leave(true);
  on = true;
}

void fake_interrupts_end(void) {
  fake_interrupts_mend();
  on = false;
  fake_hal_slices_leave(false);
}

void fake_interrupts_soon(void) {
  if (!on) return;
  left = 1 + chance(SOON);
  soon = true;
}

bool fake_interrupts_are_on(void) { return on; }
void fake_interrupts_leave_time(void) { leaves_time = true; }
bool fake_interrupts_time_is_left(void) { return on && leaves_time; }
struct fake_interrupt_counts fake_interrupts_counts(void) {
  return counts;
}
void fake_interrupts_on_take(void (*action)(enum fake_task task)) { on_take = action; }

/* What the compiler calls before each access to memory, and at the beginning and end of a function; its thread
 * sanitizer has defined them. The address sanitizer knows what of memory that is not the firmware's own may be used. */
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-*,readability-identifier-naming) */
void __asan_loadN(uintptr_t at, size_t size);
void __asan_storeN(uintptr_t at, size_t size);

static void read_of(uintptr_t at, size_t size) {
  access(at, size, false);
  __asan_loadN(at, size);
}

static void write_of(uintptr_t at, size_t size) {
  access(at, size, true);
  __asan_storeN(at, size);
}

#define ACCESSES(size)                                                  \
  void __tsan_read##size(uintptr_t at) { read_of(at, size); }           \
  void __tsan_write##size(uintptr_t at) { write_of(at, size); }         \
  void __tsan_unaligned_read##size(uintptr_t at) { read_of(at, size); } \
  void __tsan_unaligned_write##size(uintptr_t at) { write_of(at, size); }
#pragma GCC diagnostic ignored "-Wmissing-prototypes"
ACCESSES(1)
ACCESSES(2)
ACCESSES(4)
ACCESSES(8)
ACCESSES(16)
void __tsan_read_range(uintptr_t at, size_t size) { read_of(at, size); }
void __tsan_write_range(uintptr_t at, size_t size) { write_of(at, size); }
void __tsan_func_entry(void* caller) { access((uintptr_t)caller, 0, false); }
void __tsan_func_exit(void) { access(0, 0, false); }
void __tsan_atomic_signal_fence(int order) { (void)order; }
void __tsan_init(void) {}
/* NOLINTEND(bugprone-reserved-identifier,cert-*,readability-identifier-naming) */
