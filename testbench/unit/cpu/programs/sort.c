/* Quicksort, recursive, of signed halfwords; then the sorted list stays for the test to read. */
#include <stdint.h>

#define COUNT 1000
int16_t results[COUNT];

static void sort(int16_t* first, int16_t* last) {
  while (first < last) {
    const int16_t pivot = first[(last - first) / 2];
    int16_t *low = first, *high = last;
    while (low <= high) {
      while (*low < pivot) ++low;
      while (*high > pivot) --high;
      if (low <= high) {
        const int16_t t = *low;
        *low++ = *high;
        *high-- = t;
      }
    }
    sort(first, high);
    first = low;
  }
}

int main(void) {
  uint32_t seed = 99;
  for (int i = 0; i < COUNT; ++i) {
    seed = seed * 1664525u + 1013904223u;
    results[i] = (int16_t)(seed >> 16);
  }
  sort(results, results + COUNT - 1);
  for (int i = 1; i < COUNT; ++i) {
    if (results[i - 1] > results[i]) return i;
  }
  return 0;
}
