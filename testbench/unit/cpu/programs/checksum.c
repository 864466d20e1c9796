/* CRC-32 over a generated text, bit by bit and by table. */
#include <stdint.h>

volatile uint32_t results[2];
static uint8_t text[3000];
static uint32_t table[256];

static uint32_t step(uint32_t crc) {
  for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0u ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
  return crc;
}

int main(void) {
  uint32_t seed = 12345;
  for (uint32_t i = 0; i < sizeof text; ++i) {
    seed = seed * 1103515245u + 12345u;
    text[i] = (uint8_t)(seed >> 16);
  }
  uint32_t slow = ~0u, fast = ~0u;
  for (uint32_t i = 0; i < sizeof text; ++i) slow = step(slow ^ text[i]);
  for (uint32_t i = 0; i < 256u; ++i) table[i] = step(i);
  for (uint32_t i = 0; i < sizeof text; ++i) fast = (fast >> 8) ^ table[(fast ^ text[i]) & 0xFFu];
  results[0] = ~slow;
  results[1] = ~fast;
  return slow == fast ? 0 : 1;
}
