/* The few C library functions that the compiler itself may call: the image is linked without a C library. */
#include <stddef.h>
#include <stdint.h>

void* memset(void* destination, int value, size_t bytes);
void* memcpy(void* destination, const void* source, size_t bytes);
void* memmove(void* destination, const void* source, size_t bytes);
int memcmp(const void* a, const void* b, size_t bytes);

/* The loops must not be turned back into calls of the functions they implement. */
#define NO_PATTERN __attribute__((optimize("no-tree-loop-distribute-patterns")))

NO_PATTERN void* memset(void* destination, int value, size_t bytes) {
  uint8_t* to = destination;
  while (bytes-- != 0u) *to++ = (uint8_t)value;
  return destination;
}

NO_PATTERN void* memcpy(void* destination, const void* source, size_t bytes) {
  uint8_t* to = destination;
  const uint8_t* from = source;
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
