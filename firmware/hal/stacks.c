/* Places of the stacks: symbols of image/turbo.ld. */
#include "firmware/hal/stacks.h"

#define PLACE(function, symbol)            \
  static inline uint32_t* function(void) { \
    uint32_t* at;                          \
    __asm__("la %0, " symbol : "=r"(at));  \
    return at;                             \
  }

PLACE(main_bottom, "__stack_bottom")
PLACE(main_top, "__stack_top")
PLACE(slices_bottom, "__side_stack_bottom")
PLACE(slices_top, "__side_stack_top")

const volatile uint32_t* hal_stack(enum stack stack, uint32_t* words) {
  uint32_t* const bottom = stack == STACK_MAIN ? main_bottom() : slices_bottom();
  *words = (uint32_t)((stack == STACK_MAIN ? main_top() : slices_top()) - bottom);
  return bottom;
}

/* Each real-time interrupt does it: no loop. */
static inline bool holds(const volatile uint32_t* guard) {
  return ((guard[0] ^ STACK_MARK) | (guard[1] ^ STACK_MARK) | (guard[2] ^ STACK_MARK) | (guard[3] ^ STACK_MARK)) == 0u;
}
_Static_assert(STACK_GUARD_WORDS == 4, "holds() looks at four");

bool hal_stack_guards_hold(void) { return holds(main_bottom()) && holds(slices_bottom()); }

/* Cause 3, which nothing else has. */
void hal_stack_fault(void) { __asm__ volatile("ebreak"); }
