// Included by a source with many mutants in it: the number of one chooses it (reached.cpp).
#pragma once

#ifdef __cplusplus
extern "C" {
#endif
extern unsigned brick_mutant_number;
extern unsigned char brick_mutant_reached[];

static inline int brick_mutant(unsigned n) {
  brick_mutant_reached[n] = 1;
  return brick_mutant_number == n;
}

#ifdef __cplusplus
}

// A selector that never takes this case.
template <class T, class Label>
T brick_without(Label label, T value) {
  return value == label ? static_cast<T>(~static_cast<unsigned long long>(value)) : value;
}
#endif
