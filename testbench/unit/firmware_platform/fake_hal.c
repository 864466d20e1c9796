/* Fake hardware for firmware compiled natively. A store through hal_x or hal_y is noticed at the next call: it is
 * masked to 24 bits, and dropped when no IC stands at the address. Tasks and the host are in fake_tasks.c. */
#include "testbench/unit/firmware_platform/fake_hal.h"

#include <string.h>

#include "firmware/hal/hal.h"
#include "firmware/hal/stacks.h"
#include "firmware/kernel/tasks.h"
#include "rtl/regs/brick_regs.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

enum { WORDS = 0x80000, PERIPHERALS = 0x80, LOG_LENGTH = 4096, EDGES = 4096, LOOK_CYCLES = 100, CYCLES_PER_US = 79 };

static uint32_t memory[2][WORDS], peripheral[2][PERIPHERALS], nothing;
static uint32_t flash[HAL_FLASH_BYTES / 4];
static uint32_t straps[6];
static uint32_t fitted, signals, look;
static uint32_t stuck_at, stuck_value, stuck_word; /* at 0: none */
static uint64_t cycles;
static unsigned breq_edges, writes, strobes;
static struct fake_edge edges[EDGES];
static struct fake_write write_log[LOG_LENGTH];

/* The firmware runs on other stacks here: these stay as they were filled, but for what a test writes. */
static uint32_t stacks[STACK_COUNT][FAKE_STACK_WORDS];
static unsigned stack_faults;

static uint32_t* last;           /* word handed out by the latest call */
static struct fake_write before; /* and what it held then */

static bool fitted_at(uint32_t address) {
  static const uint32_t bases[GATE_IC_COUNT] = GATE_IC_BASES;
  if (address < SERVO_IC_0_BASE) return true;
  if (address == JPAN_Y_INPUTS) return (straps[HAL_STRAP_PRODUCT] & HAL_PRODUCT_JPAN) != 0u;
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic)
    if (address - bases[ic] < 0x20u) return ((fitted >> ic) & 1u) != 0u;
  return false;
}

static void settle(void) {
  if (last == NULL || *last == before.value) return;
  *last &= HAL_WORD_MASK;
  if (before.address >= DPRAM_BASE && writes < LOG_LENGTH) {
    write_log[writes].x = before.x;
    write_log[writes].address = before.address;
    write_log[writes].cycles = before.cycles;
    write_log[writes++].value = *last;
  }
  nothing = HAL_WORD_MASK; /* nobody drives the bus */
}

static volatile uint32_t* word(bool x, uint32_t address) {
  settle();
  if (x && address == stuck_at && stuck_at != 0u) {
    stuck_word = stuck_value;
    last = &stuck_word;
  } else if (address < WORDS)
    last = fitted_at(address) ? &memory[x][address] : &nothing;
  else
    last = &peripheral[x][address & (PERIPHERALS - 1u)];
  before.x = x;
  before.address = address;
  before.cycles = (uint32_t)cycles;
  before.value = *last;
  return last;
}

volatile uint32_t* hal_x(uint32_t address) { return word(true, address); }
volatile uint32_t* hal_y(uint32_t address) { return word(false, address); }

struct fake_word fake_hal_leave_word(void) {
  const struct fake_word left = {last, before};
  last = NULL;
  return left;
}

void fake_hal_return_to_word(struct fake_word left) {
  settle();
  last = left.at;
  before = left.before;
}

void fake_hal_power_on(uint32_t ics) {
  static const uint32_t geo_brick[6] = {0, 0, 603382, 32768, 1, 0};
  memset(memory, 0, sizeof memory);
  memset(peripheral, 0, sizeof peripheral);
  memset(flash, 0xFF, sizeof flash);
  fake_hal_power_goes(FAKE_POWER_STAYS, 0);
  memcpy(straps, geo_brick, sizeof straps);
  straps[HAL_STRAP_FITTED] = fitted = ics;
  signals = 0;
  cycles = 0;
  breq_edges = writes = strobes = 0;
  look = LOOK_CYCLES;
  stuck_at = 0;
  nothing = HAL_WORD_MASK;
  last = NULL;
  for (unsigned i = 0; i < FAKE_STACK_WORDS; ++i) stacks[STACK_MAIN][i] = stacks[STACK_SLICES][i] = STACK_MARK;
  stack_faults = 0;
  fake_tasks_power_on();
}

void fake_hal_set_strap(unsigned index, uint32_t value) { straps[index] = value; }
uint32_t fake_hal_signals(void) { return signals; }

unsigned fake_hal_breq_falls(void) {
  unsigned falls = 0;
  for (unsigned i = 0; i < breq_edges; ++i) falls += edges[i].high ? 0u : 1u;
  return falls;
}

unsigned fake_hal_breq_edges(const struct fake_edge** list) {
  *list = edges;
  return breq_edges;
}

void fake_hal_clear_breq_edges(void) { breq_edges = 0; }
void fake_hal_set_cycles(uint32_t value) { cycles = value; }
void fake_hal_pass(uint32_t passed) { cycles += passed; }
void fake_hal_set_look(uint32_t passed) { look = passed; }
unsigned fake_hal_strobes(void) { return strobes; }

unsigned fake_hal_writes(const struct fake_write** log) {
  settle();
  last = NULL;
  *log = write_log;
  return writes;
}

void fake_hal_clear_writes(void) {
  settle();
  last = NULL;
  writes = 0;
}

/* Time passes by looking at it. */
static bool clocks_stopped;
void fake_hal_stop_clocks(bool stopped) { clocks_stopped = stopped; }
void fake_hal_fit(uint32_t ics) { fitted = ics; }

void fake_hal_stick(uint32_t address, uint32_t value) {
  stuck_at = address;
  stuck_value = value;
}

uint32_t hal_cycles(void) {
  cycles += look;
  if (!clocks_stopped) tasks_phase_stamp = (uint32_t)cycles;
  return (uint32_t)cycles;
}
uint64_t hal_long_cycles(void) { return cycles; }

/* 1, 2, 3, ... up to their number, with a top byte that a sum of 24 bits must lose. */
static unsigned image_looks;
unsigned fake_hal_image_looks(void) { return image_looks; }
const uint32_t* hal_image(uint32_t* words) {
  static uint32_t image[FAKE_IMAGE_WORDS];
  ++image_looks;
  for (uint32_t i = 0; i < FAKE_IMAGE_WORDS; ++i) image[i] = 0xA5000000u + i + 1u;
  *words = FAKE_IMAGE_WORDS;
  return image;
}
const volatile uint32_t* hal_stack(enum stack stack, uint32_t* words) {
  *words = FAKE_STACK_WORDS;
  return stacks[stack];
}
bool hal_stack_guards_hold(void) {
  for (unsigned i = 0; i < STACK_GUARD_WORDS; ++i)
    if (stacks[STACK_MAIN][i] != STACK_MARK || stacks[STACK_SLICES][i] != STACK_MARK) return false;
  return true;
}
void hal_stack_fault(void) { ++stack_faults; }
unsigned fake_hal_stack_faults(void) { return stack_faults; }
uint32_t* fake_hal_stack(unsigned stack) { return stacks[stack]; }

void hal_delay_us(uint32_t us) { cycles += us * CYCLES_PER_US; }
void hal_await_us(uint32_t start, uint32_t us) {
  const uint32_t passed = (uint32_t)cycles - start, wanted = us * CYCLES_PER_US;
  if (passed < wanted) cycles += wanted - passed;
}
void hal_set_cpu_clock(uint32_t i52) { (void)i52; }
uint32_t hal_cycles_per_ms(void) { return 78643; }

void hal_host_signals(uint32_t set, uint32_t clear) {
  const uint32_t next = (signals & ~clear) | set;
  if (((signals ^ next) & HAL_SIGNAL_BREQ) != 0 && breq_edges < EDGES) {
    const struct fake_edge edge = {(next & HAL_SIGNAL_BREQ) != 0, (uint32_t)cycles};
    edges[breq_edges++] = edge;
  }
  signals = next;
}

void hal_watchdog_strobe(void) { ++strobes; }

void hal_clear_words(uint32_t first, uint32_t count) {
  memset(&memory[0][first], 0, 4u * count);
  memset(&memory[1][first], 0, 4u * count);
}

uint32_t hal_strap(unsigned index) { return straps[index]; }

const uint32_t* hal_flash(void) { return flash; }

static uint32_t flash_writes, writes_with_power = FAKE_POWER_STAYS, torn_bits;

void hal_flash_write(uint32_t index, uint32_t value) {
  flash_writes++;
  if (writes_with_power == 0) return;
  if (writes_with_power != FAKE_POWER_STAYS && --writes_with_power == 0)
    value = (value & ~torn_bits) | (flash[index] & torn_bits);
  flash[index] = value;
}

uint32_t* fake_hal_flash(void) { return flash; }

void fake_hal_power_goes(uint32_t after, uint32_t torn) {
  flash_writes = 0;
  writes_with_power = after;
  torn_bits = torn;
}

uint32_t fake_hal_flash_writes(void) { return flash_writes; }
