/* The few C library functions that the compiler itself may call: the image is linked without a C library. Words are
 * moved where both addresses allow it; the compiler calls these for whole structures, which are aligned. */
#include <stddef.h>
#include <stdint.h>

void* memset(void* destination, int value, size_t bytes);
void* memcpy(void* destination, const void* source, size_t bytes);
void* memmove(void* destination, const void* source, size_t bytes);
int memcmp(const void* a, const void* b, size_t bytes);

/* The loops must not be turned back into calls of the functions they implement. */
#define NO_PATTERN __attribute__((optimize("no-tree-loop-distribute-patterns")))

typedef uint32_t __attribute__((may_alias)) word_t;

enum { WORD = 4, BLOCK = 4 * WORD, LONG_BLOCK = 16 * WORD };

NO_PATTERN void* memset(void* destination, int value, size_t bytes) {
  uint8_t* to = destination;
  if ((uintptr_t)to % WORD == 0u) {
    const uint32_t pattern = (uint8_t)value * 0x01010101u;
    for (; bytes >= LONG_BLOCK; bytes -= LONG_BLOCK, to += LONG_BLOCK) { /* a start clears some 100 KB so */
      word_t* words = (word_t*)(void*)to;
      words[0] = words[1] = words[2] = words[3] = words[4] = words[5] = words[6] = words[7] = pattern;
      words[8] = words[9] = words[10] = words[11] = words[12] = words[13] = words[14] = words[15] = pattern;
    }
    for (; bytes >= BLOCK; bytes -= BLOCK, to += BLOCK) {
      word_t* words = (word_t*)(void*)to;
      words[0] = pattern;
      words[1] = pattern;
      words[2] = pattern;
      words[3] = pattern;
    }
  }
  while (bytes-- != 0u) *to++ = (uint8_t)value;
  return destination;
}

NO_PATTERN void* memcpy(void* destination, const void* source, size_t bytes) {
  uint8_t* to = destination;
  const uint8_t* from = source;
  if (((uintptr_t)to | (uintptr_t)from) % WORD == 0u) {
    for (; bytes >= BLOCK; bytes -= BLOCK, to += BLOCK, from += BLOCK) {
      word_t* words = (word_t*)(void*)to;
      const word_t* source_words = (const word_t*)(const void*)from;
      words[0] = source_words[0];
      words[1] = source_words[1];
      words[2] = source_words[2];
      words[3] = source_words[3];
    }
  }
  while (bytes-- != 0u) *to++ = *from++;
  return destination;
}

NO_PATTERN void* memmove(void* destination, const void* source, size_t bytes) {
  uint8_t* to = destination;
  const uint8_t* from = source;
  if (to < from) return memcpy(destination, source, bytes);
  while (bytes-- != 0u) to[bytes] = from[bytes];
  return destination;
}

NO_PATTERN int memcmp(const void* a, const void* b, size_t bytes) {
  const uint8_t* left = a;
  const uint8_t* right = b;
  for (; bytes != 0u; --bytes, ++left, ++right)
    if (*left != *right) return *left < *right ? -1 : 1;
  return 0;
}
