/* What a stack has never used lies below its first word that is no mark. Every eighth pass looks at some words of each,
 * going around below the lowest one found so far: a stack of 16 KiB takes 2048 passes, 2.7 s when nothing happens. */
#include "firmware/kernel/stack_watch.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/hal/stacks.h"

enum { WORDS_A_LOOK = 16, PASSES_A_LOOK = 8 }; /* an idle controller does little else: it must stay cheap */

/* Background. */
static uint32_t passes;
static struct { uint32_t unused, next; /* words; 0: not looked at yet */ } looks[STACK_COUNT];

void stack_watch_check(void) {
  if (!hal_stack_guards_hold()) hal_stack_fault();
}

static uint32_t look(enum stack stack) {
  uint32_t words;
  const volatile uint32_t* bottom = hal_stack(stack, &words);
  const uint32_t unused = looks[stack].unused != 0 ? looks[stack].unused : words;
  uint32_t at = looks[stack].next < unused ? looks[stack].next : 0;
  const uint32_t end = at + WORDS_A_LOOK < unused ? at + WORDS_A_LOOK : unused;
  while (at < end && bottom[at] == STACK_MARK) at++;
  looks[stack].unused = at < end ? at : unused;
  looks[stack].next = at;
  return looks[stack].unused * (uint32_t)sizeof *bottom;
}

void stack_watch_pass(void) {
  if (++passes % PASSES_A_LOOK != 0) return;
  *hal_x(MEMORY_STACKS) = look(STACK_MAIN);
  *hal_y(MEMORY_STACKS) = look(STACK_SLICES);
}
