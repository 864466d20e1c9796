/* CPU clock and Port A wait states: I52 sets the clock, the bus control register gets the factory wait states for it
 * plus those of I37 (host-bus:2.4, host-bus:2.5). Both take effect at power-up and reset only. */
#include "firmware/kernel/bus_setup.h"

#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

enum { RESET_I52 = 7, AREAS = 5 };

/* Areas AA0 main memory, AA1 gate ICs, AA2 DPRAM, AA3 flash, default. The rows above I52 = 15 are the same device
 * budgets at the higher clock: the word of a gate IC is there 95.8 ns after the strobe, where the CPU gives it
 * (W + 0.25) Tc - 5 ns; at I52 = 31 the most there is, 31, gives 94.3. At I52 = 0 to 4 the DPRAM needs write data
 * sooner after the strobe than three wait states give them. */
static const struct {
  uint8_t i52, wait[AREAS];
} rows[] = {
    {4, {1, 8, 4, 7, 15}},   {7, {1, 8, 3, 7, 15}},   {9, {1, 10, 4, 7, 15}},
    {15, {2, 16, 7, 7, 31}}, {23, {4, 24, 7, 7, 31}}, {31, {5, 31, 7, 7, 31}},
};

static const struct {
  uint8_t lsb, width, added_lsb, added_width; /* field of BCR; bits of I37 that are added to it */
} areas[AREAS] = {{0, 5, 0, 2}, {5, 5, 0, 0}, {10, 3, 10, 1}, {13, 3, 13, 1}, {16, 5, 16, 2}};

static uint32_t clock_in_force = RESET_I52;

uint32_t bus_setup_cpu_clock(void) { return clock_in_force; }

static uint32_t wait_states(uint32_t i52, uint32_t i37) {
  unsigned row = 0;
  while (rows[row].i52 < i52) ++row;
  uint32_t word = 0;
  for (unsigned area = 0; area < AREAS; ++area) {
    const uint32_t most = (1u << areas[area].width) - 1u;
    uint32_t wait = rows[row].wait[area] + ((i37 >> areas[area].added_lsb) & ((1u << areas[area].added_width) - 1u));
    if (wait > most) wait = most;
    word |= wait << areas[area].lsb;
  }
  return word;
}

/* The slowest bus while the clock changes, so that no cycle is ever too short. */
static void set_bus(uint32_t i52, uint32_t bcr) {
  *hal_x(CPU_BUS_X_BCR) = CPU_BUS_BCR_RESET;
  *hal_x(CPU_BUS_X_PCTL) = i52;
  *hal_x(CPU_BUS_X_BCR) = bcr;
  clock_in_force = i52;
  hal_set_cpu_clock(i52);
}

/* Until I52 and I37 are known: the clock after reset, main memory at its pace, the devices with the most they can have.
 * What `brick run --bcr` forces acts when this is left, so with no other clock than the one it is meant for. */
void bus_setup_first(void) {
  const uint32_t main_memory = wait_states(RESET_I52, 0) & CPU_BUS_BCR_BA0W_MASK;
  set_bus(RESET_I52, (CPU_BUS_BCR_RESET & ~CPU_BUS_BCR_BA0W_MASK) | main_memory);
}

void bus_setup(uint32_t i52, uint32_t i37) { set_bus(i52, wait_states(i52, i37)); }
