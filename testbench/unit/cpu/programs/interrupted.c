/* Everything that could notice how a run is cut into pieces: phase and servo interrupts that nest, a real-time
   interrupt raised by software, sleep, device accesses, counters and long instructions. The state is one running
   checksum. */
#include <stdint.h>

#define CSR(text) ".option push\n.option arch, +zicsr\n" text "\n.option pop\n"
#define PHASE (1u << 16)
#define SERVO (1u << 17)
#define REAL_TIME (1u << 19)

volatile uint32_t results[8]; /* checksum, phases, servos, real-time, sleeps, last cycle count */
static volatile uint32_t* const device = (volatile uint32_t*)0xC03C0000u;

static inline void set_mip(uint32_t v) { __asm__ volatile(CSR("csrs mip, %0")::"r"(v) : "memory"); }
static inline void clear_mip(uint32_t v) { __asm__ volatile(CSR("csrc mip, %0")::"r"(v) : "memory"); }
static inline void set_mie(uint32_t v) { __asm__ volatile(CSR("csrs mie, %0")::"r"(v) : "memory"); }
static inline void clear_mie(uint32_t v) { __asm__ volatile(CSR("csrc mie, %0")::"r"(v) : "memory"); }
static inline uint32_t cycles(void) {
  uint32_t v;
  __asm__ volatile(CSR("csrr %0, mcycle") : "=r"(v));
  return v;
}

static void mix(uint32_t v) { results[0] = (results[0] << 5 | results[0] >> 27) * 0x9E3779B1u + v; }

__attribute__((interrupt, aligned(4))) static void handler(void) {
  uint32_t cause, epc;
  __asm__ volatile(CSR("csrr %0, mcause\ncsrr %1, mepc") : "=r"(cause), "=r"(epc));
  const uint32_t number = cause & 31u;
  clear_mip(1u << number);
  mix(cycles() / (number + 1u));
  mix(epc);
  if (number == 16u) {
    ++results[1];
    device[1] = results[1];
  } else if (number == 17u) {
    ++results[2];
    set_mip(REAL_TIME);
    /* phase may interrupt the rest */
    clear_mie(SERVO | REAL_TIME);
    __asm__ volatile(CSR("csrsi mstatus, 8")::: "memory");
    mix(device[2]);
    __asm__ volatile(CSR("csrci mstatus, 8")::: "memory");
    set_mie(SERVO | REAL_TIME);
    __asm__ volatile(CSR("csrw mepc, %0")::"r"(epc));
    __asm__ volatile(CSR("csrs mstatus, %0")::"r"(0x80u)); /* MPIE */
  } else {
    ++results[3];
  }
}

int main(void) {
  __asm__ volatile(CSR("csrw mtvec, %0\ncsrs mie, %1\ncsrsi mstatus, 8")::"r"(handler), "r"(PHASE | SERVO | REAL_TIME)
                   : "memory");
  uint64_t wide = 1;
  while (results[1] < 40u) {
    for (uint32_t i = 1; i < 50u; ++i) {
      wide = wide * 6364136223846793005u + i;
      results[5] = cycles();
      __asm__ volatile(CSR("csrci mstatus, 8")::: "memory");
      mix((uint32_t)(wide >> 32) / i + results[5]);
      __asm__ volatile(CSR("csrsi mstatus, 8")::: "memory");
    }
    ++results[4];
    __asm__ volatile("wfi" ::: "memory");
  }
  return 0;
}
