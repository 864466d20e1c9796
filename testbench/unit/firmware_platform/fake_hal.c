/* Fake hardware for firmware compiled natively. A store through hal_x or hal_y is noticed at the next call: it is
 * masked to 24 bits, and dropped when no IC stands at the address. */
#include "testbench/unit/firmware_platform/fake_hal.h"

#include <string.h>

#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/kernel/tasks.h"
#include "rtl/regs/brick_regs.h"

enum { WORDS = 0x80000, PERIPHERALS = 0x80, LOG_LENGTH = 4096, EDGES = 4096, LOOK_CYCLES = 100, CYCLES_PER_US = 79 };
enum { MASK_NONE, MASK_REAL_TIME, MASK_SERVO, MASK_ALL };

static uint32_t memory[2][WORDS], peripheral[2][PERIPHERALS], nothing;
static uint32_t flash[HAL_FLASH_BYTES / 4];
static uint32_t straps[6];
static uint32_t fitted, signals, look, real_time;
static uint64_t cycles;
static uint32_t mask, masked_since, longest_mask; /* enum: who is held off */
static unsigned breq_edges, writes, strobes;
static struct fake_edge edges[EDGES];
static struct fake_write write_log[LOG_LENGTH];

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
  if (address < WORDS)
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

void fake_hal_power_on(uint32_t ics) {
  static const uint32_t geo_brick[6] = {0, 0, 603382, 32768, 1, 0};
  memset(memory, 0, sizeof memory);
  memset(peripheral, 0, sizeof peripheral);
  memset(flash, 0xFF, sizeof flash);
  memcpy(straps, geo_brick, sizeof straps);
  straps[HAL_STRAP_FITTED] = fitted = ics;
  signals = real_time = 0;
  cycles = 0;
  mask = MASK_NONE;
  breq_edges = writes = strobes = 0;
  look = LOOK_CYCLES;
  longest_mask = 0;
  nothing = HAL_WORD_MASK;
  last = NULL;
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
bool fake_hal_masked(void) { return mask != MASK_NONE; }

uint32_t fake_hal_longest_mask(void) {
  const uint32_t longest = longest_mask;
  longest_mask = 0;
  return longest;
}

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

static uint32_t hold_off(uint32_t who) {
  const uint32_t held = mask;
  if (held == MASK_NONE) masked_since = (uint32_t)cycles;
  if (who > mask) mask = who;
  return held;
}

uint32_t hal_mask_real_time(void) { return hold_off(MASK_REAL_TIME); }
uint32_t hal_mask_servo(void) { return hold_off(MASK_SERVO); }
uint32_t hal_mask_all(void) { return hold_off(MASK_ALL); }

void hal_unmask(uint32_t state) {
  mask = state;
  const uint32_t held = (uint32_t)cycles - masked_since;
  if (state == MASK_NONE && held > longest_mask) longest_mask = held;
}

/* Time passes by looking at it. */
static bool clocks_stopped;
void fake_hal_stop_clocks(bool stopped) { clocks_stopped = stopped; }
void fake_hal_fit(uint32_t ics) { fitted = ics; }

uint32_t hal_cycles(void) {
  cycles += look;
  if (!clocks_stopped) tasks_phase_stamp = (uint32_t)cycles;
  return (uint32_t)cycles;
}
uint64_t hal_long_cycles(void) { return cycles; }
uint32_t hal_image_checksum(void) { return 0xABCDEFu; }
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

void hal_interrupts_off(void) { real_time = 0; }
void hal_interrupts_on(void) {}
void hal_request_real_time(void) { real_time = 1; }
void fake_hal_real_time_taken(void) { real_time = 0; }
bool hal_real_time_pending(void) { return real_time != 0; }

/* The host reads all the time. */
static char output[1 << 20];
static uint32_t output_length;

static void host_reads(void) {
  uint8_t c;
  while (output_length < sizeof output && host_port_next_output(&c)) output[output_length++] = (char)c;
}

const char* fake_host_output(uint32_t* length) {
  host_reads();
  *length = output_length;
  output_length = 0;
  return output;
}

static void (*on_wait)(void);

void fake_hal_on_wait(void (*action)(void)) { on_wait = action; }

void hal_idle(const volatile uint32_t* work) {
  (void)work;
  if (on_wait == 0) {
    host_reads();
    return;
  }
  cycles += hal_cycles_per_ms();
  on_wait();
}
void hal_watchdog_strobe(void) { ++strobes; }
void hal_host_interrupts(bool receive, bool transmit) { (void)receive, (void)transmit; }
bool hal_servo_pending(void) { return false; }

static void (*side_task)(void);
static void (*on_pause)(void);
static bool on_side;

void fake_hal_on_pause(void (*action)(void)) { on_pause = action; }

void hal_side_begin(void (*task)(void)) { side_task = task; }

void hal_side_change(void) {
  if (on_side) {
    if (on_pause != 0) on_pause();
    return;
  }
  on_side = true;
  side_task();
  on_side = false;
}

void hal_clear_words(uint32_t first, uint32_t count) {
  memset(&memory[0][first], 0, 4u * count);
  memset(&memory[1][first], 0, 4u * count);
}

uint32_t hal_strap(unsigned index) { return straps[index]; }
uint32_t* hal_flash(void) { return flash; }
