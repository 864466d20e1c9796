/* What libgcc makes of RV32IM: 64-bit multiplication and division, and IEEE doubles in software. */
#include <stdint.h>

#define COUNT 200
struct Row {
  uint64_t a, b;
  uint64_t product, quotient, remainder;
  int64_t signed_quotient, signed_remainder, shifted;
  double x, y, sum, product_d, quotient_d, root;
  float narrow;
  int32_t whole;
} results[COUNT];

static uint64_t state = 88172645463325252u;
static uint64_t next(void) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return state;
}

static double root_of(double v) { /* Newton, a fixed number of steps */
  double r = v > 1.0 ? v : 1.0;
  for (int i = 0; i < 60; ++i) r = 0.5 * (r + v / r);
  return r;
}

int main(void) {
  for (int i = 0; i < COUNT; ++i) {
    struct Row* row = &results[i];
    row->a = next();
    row->b = (next() >> (next() & 63u)) | 1u;
    row->product = row->a * row->b;
    row->quotient = row->a / row->b;
    row->remainder = row->a % row->b;
    row->signed_quotient = (int64_t)row->a / (int64_t)row->b;
    row->signed_remainder = (int64_t)row->a % (int64_t)row->b;
    row->shifted = (int64_t)row->a >> (row->b & 63u);
    row->x = (double)(int64_t)row->a / 65536.0;
    row->y = (double)row->b * 1e-3;
    row->sum = row->x + row->y;
    row->product_d = row->x * row->y;
    row->quotient_d = row->x / row->y;
    row->root = root_of(row->y);
    row->narrow = (float)row->quotient_d;
    row->whole = (int32_t)(row->a >> 40) / 7 * ((i & 1) != 0 ? -1 : 1);
  }
  return 0;
}
