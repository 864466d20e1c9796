/* Elementary functions: exact argument reduction, then a short series. Integer work on the bits of the double replaces
 * what a C library would do with frexp, ldexp and floor. */
#include "firmware/base/mathematics.h"

#define PI 3.14159265358979323846
#define HALF_PI_HIGH 1.57079632673412561417 /* the upper 33 bits of pi/2: a multiple of it stays exact */
#define HALF_PI_LOW 6.07710050650619224932e-11
#define LN2_HIGH 0.693147180369123816490
#define LN2_LOW 1.90821492927058770002e-10
/* Logarithms of the largest double, and of the smallest that is not denormal, rounded inwards. */
#define EXP_LARGEST 709.782712893384
#define EXP_SMALLEST (-708.396418532264)

union bits {
  double value;
  uint64_t word;
};

enum { EXPONENT_BIAS = 1023, FRACTION_BITS = 52 };

#define FRACTION_MASK ((UINT64_C(1) << FRACTION_BITS) - 1u)

double math_absolute(double x) { return x < 0.0 ? -x : x; }

int64_t math_nearest(double x) {
  if (!(x < MATH_LARGEST)) return (int64_t)MATH_LARGEST - 1;
  if (!(x > -MATH_LARGEST)) return -(int64_t)MATH_LARGEST;
  return x < 0.0 ? -(int64_t)(0.5 - x) : (int64_t)(x + 0.5);
}

int64_t math_to_integer(double x) {
  union bits b = {x};
  bool negative = (b.word >> 63) != 0;
  int exponent = (int)((b.word >> FRACTION_BITS) & 0x7FFu) - EXPONENT_BIAS;
  uint64_t significand = (b.word & FRACTION_MASK) | (FRACTION_MASK + 1u);
  if (exponent >= 62) return negative ? -(INT64_C(1) << 62) : INT64_C(1) << 62;
  if (exponent < 0) return negative && (b.word << 1) != 0 ? -1 : 0;
  if (exponent >= FRACTION_BITS) {
    int64_t whole = (int64_t)(significand << (unsigned)(exponent - FRACTION_BITS));
    return negative ? -whole : whole;
  }
  unsigned below = (unsigned)(FRACTION_BITS - exponent);
  int64_t whole = (int64_t)(significand >> below);
  bool fraction = (significand & ((UINT64_C(1) << below) - 1u)) != 0;
  return negative ? -whole - (fraction ? 1 : 0) : whole;
}

bool math_is_finite(double x) {
  const union bits b = {x};
  return ((b.word >> FRACTION_BITS) & 0x7FFu) != 0x7FFu;
}

double math_from_fixed(int64_t mantissa, int exponent) {
  if (mantissa == 0) return 0.0;
  union bits b;
  bool negative = mantissa < 0;
  uint64_t magnitude = negative ? 0u - (uint64_t)mantissa : (uint64_t)mantissa;
  int top = 63 - __builtin_clzll(magnitude); /* at most 2^53: nothing is rounded */
  b.word = (magnitude << (unsigned)(FRACTION_BITS - top)) & FRACTION_MASK;
  b.word |= (uint64_t)(unsigned)(top + exponent + EXPONENT_BIAS) << FRACTION_BITS;
  if (negative) b.word |= UINT64_C(1) << 63;
  return b.value;
}

bool math_to_fixed(double x, unsigned bits, int64_t* mantissa, int* exponent) {
  union bits b = {x};
  int biased = (int)((b.word >> FRACTION_BITS) & 0x7FFu);
  *mantissa = 0;
  *exponent = 0;
  if (biased == 0) return true;
  unsigned below = (unsigned)FRACTION_BITS + 1u - bits;
  uint64_t significand = (b.word & FRACTION_MASK) | (FRACTION_MASK + 1u);
  uint64_t lost = significand & ((UINT64_C(1) << below) - 1u);
  int64_t m = (int64_t)(significand >> below);
  *exponent = biased - (EXPONENT_BIAS - 1);
  if (lost >> (below - 1u)) m++;
  if (m >> bits) { /* rounded up to the next power of two */
    m >>= 1;
    ++*exponent;
  }
  *mantissa = (b.word >> 63) ? -m : m;
  return lost == 0;
}

double math_floor(double x) {
  if (math_absolute(x) >= 4503599627370496.0) return x; /* 2^52: no fraction left */
  return (double)math_to_integer(x);
}

/* x = m * 2^*exponent with 0.5 <= |m| < 1; zero gives 0 and exponent 0. */
static double split(double x, int* exponent) {
  union bits b = {x};
  int biased = (int)((b.word >> FRACTION_BITS) & 0x7FFu);
  *exponent = 0;
  if (biased == 0) return 0.0; /* zero, and numbers too small to matter */
  *exponent = biased - (EXPONENT_BIAS - 1);
  b.word = (b.word & ~(UINT64_C(0x7FF) << FRACTION_BITS)) | ((uint64_t)(EXPONENT_BIAS - 1) << FRACTION_BITS);
  return b.value;
}

double math_scale(double m, int exponent) {
  int own;
  union bits b = {split(m, &own)};
  int biased = own + exponent + EXPONENT_BIAS - 1;
  if (b.value == 0.0 || biased <= 0) return 0.0;
  if (biased >= 0x7FF) biased = 0x7FE;
  b.word = (b.word & ~(UINT64_C(0x7FF) << FRACTION_BITS)) | ((uint64_t)(unsigned)biased << FRACTION_BITS);
  return b.value;
}

/* |x| < 2^this. */
static int magnitude(double x) {
  const union bits b = {x};
  return (int)((b.word >> FRACTION_BITS) & 0x7FFu) - (EXPONENT_BIAS - 1);
}

double math_bitwise(enum math_bits operation, double a, double b) {
  enum { BELOW = 61 };
  const int of_a = magnitude(a), of_b = magnitude(b), larger = of_a > of_b ? of_a : of_b;
  const int64_t x = math_to_integer(math_scale(a, BELOW - larger)), y = math_to_integer(math_scale(b, BELOW - larger));
  const int64_t both = operation == MATH_AND ? x & y : operation == MATH_OR ? x | y : x ^ y;
  return math_scale((double)both, larger - BELOW);
}

/* A product or a division takes some 400 cycles: no more than one of them from pause to pause. */
static double paused(double value) {
  mathematics_pause();
  return value;
}

double math_divide(double a, double b) {
  mathematics_pause();
  if (b == 0.0) return a < 0.0 ? -MATH_LARGEST : MATH_LARGEST;
  return paused(a / b);
}

double math_modulo(double a, double b) {
  if (b == 0.0) return 0.0;
  const double n = math_absolute(b), width = b > 0.0 ? n : n + n, from = b > 0.0 ? a : a + n;
  const double rest = from - paused(width * math_floor(paused(from / width)));
  /* Rounding can give the upper end, and anything when the quotient has no fraction any more. */
  return (rest >= 0.0 && rest < width ? rest : 0.0) - (b > 0.0 ? 0.0 : n);
}

double math_square_root(double x) {
  if (x <= 0.0) return 0.0;
  union bits b = {x};
  b.word = (b.word >> 1) + (UINT64_C(0x1FF8) << 48); /* halves the exponent: within 6 % of the root */
  double root = b.value;
  mathematics_pause();
  for (int i = 0; i < 4; i++) { root = paused(0.5 * paused(root + paused(x / root))); }
  return root;
}

/* c[0] x^(n-1) + ... + c[n-1] */
static double polynomial(double x, const double* c, unsigned n) {
  double p = c[0];
  for (unsigned i = 1; i < n; i++) { p = paused(paused(p * x) + c[i]); }
  return p;
}

/* sin and cos on [-pi/4, pi/4]; the first term left out is below 1e-17. */
static double sine_series(double x) {
  static const double TERMS[] = {-1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
                                 -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0};
  const double s = paused(x * x), cube = paused(x * s);
  return x + paused(cube * polynomial(s, TERMS, sizeof TERMS / sizeof TERMS[0]));
}

static double cosine_series(double x) {
  static const double TERMS[] = {1.0 / 20922789888000.0, -1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0,
                                 1.0 / 40320.0,          -1.0 / 720.0,         1.0 / 24.0};
  const double s = paused(x * x), fourth = paused(s * s), first = paused(1.0 - paused(0.5 * s));
  return first + paused(fourth * polynomial(s, TERMS, sizeof TERMS / sizeof TERMS[0]));
}

/* Reduces to [-pi/4, pi/4] radians and returns the quadrant. Degrees are reduced before the conversion, so SIN(180) is
 * exactly 0. */
static unsigned quadrant(double x, int degrees, double* reduced) {
  if (math_absolute(x) > MATH_LARGEST) x = 0.0; /* hardly anything of the angle is left */
  mathematics_pause();
  const double turns = paused(math_floor(paused(paused(x / (degrees ? 90.0 : PI / 2.0)) + 0.5)));
  const double rest = paused(x - paused(turns * (degrees ? 90.0 : HALF_PI_HIGH)));
  *reduced = degrees ? paused(rest * (PI / 180.0)) : paused(rest - paused(turns * HALF_PI_LOW));
  return (unsigned)(math_to_integer(turns) & 3);
}

static double circular(unsigned q, double r) {
  double v = (q & 1u) ? cosine_series(r) : sine_series(r);
  return (q & 2u) ? -v : v;
}

double math_sine(double x, int degrees) {
  double r;
  unsigned q = quadrant(x, degrees, &r);
  return circular(q, r);
}

double math_cosine(double x, int degrees) {
  double r;
  unsigned q = quadrant(x, degrees, &r);
  return circular(q + 1u, r);
}

double math_tangent(double x, int degrees) {
  return paused(math_divide(math_sine(x, degrees), math_cosine(x, degrees)));
}

/* A division costs more than the rest of a step. */
static const double odd_parts[] = {1.0 / 1.0,  1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0,
                                   1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};

/* Tangent of half the angle. */
static double halved(double x) { return paused(x / paused(1.0 + math_square_root(paused(1.0 + paused(x * x))))); }

/* atan on [0, 1]: a quarter of the angle has a tangent below 0.2, then the series. */
static double arc_series(double tangent) {
  const double x = halved(halved(tangent)), s = paused(x * x);
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = paused(odd_parts[k / 2] - paused(s * sum));
  return paused(paused(4.0 * x) * sum);
}

double math_arc_tangent(double x, int degrees) {
  double a = math_absolute(x);
  mathematics_pause();
  double angle = a > 1.0 ? PI / 2.0 - arc_series(paused(1.0 / a)) : arc_series(a);
  mathematics_pause();
  if (degrees) angle = paused(angle * (180.0 / PI));
  return x < 0.0 ? -angle : angle;
}

double math_arc_tangent2(double y, double x, int degrees) {
  double half = degrees ? 180.0 : PI;
  if (x == 0.0) return y > 0.0 ? half / 2.0 : y < 0.0 ? -half / 2.0 : 0.0;
  mathematics_pause();
  double angle = math_arc_tangent(paused(y / x), degrees);
  if (x > 0.0) return angle;
  return y < 0.0 ? angle - half : angle + half;
}

double math_arc_sine(double x, int degrees) {
  if (math_absolute(x) > 1.0) return 0.0;
  return math_arc_tangent2(x, math_square_root(paused(paused(1.0 - x) * paused(1.0 + x))), degrees);
}

double math_arc_cosine(double x, int degrees) {
  if (math_absolute(x) > 1.0) return 0.0;
  return math_arc_tangent2(math_square_root(paused(paused(1.0 - x) * paused(1.0 + x))), x, degrees);
}

double math_logarithm(double x) {
  if (x <= 0.0) return 0.0;
  int exponent;
  double m = split(x, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    exponent--;
  }
  const double t = paused((m - 1.0) / (m + 1.0)), s = paused(t * t);
  double sum = 0.0;
  for (int k = 21; k >= 1; k -= 2) { sum = odd_parts[k / 2] + paused(s * sum); }
  const double high = paused((double)exponent * LN2_HIGH), low = paused((double)exponent * LN2_LOW);
  return high + (paused((t + t) * sum) + low);
}

double math_exponential(double x) {
  if (x > EXP_LARGEST) x = EXP_LARGEST;
  if (x < EXP_SMALLEST) return 0.0;
  const double k = paused(math_floor(paused(x / (LN2_HIGH + LN2_LOW)) + 0.5));
  const double high = paused(k * LN2_HIGH), r = (x - high) - paused(k * LN2_LOW);
  double sum = 1.0;
  for (int i = 14; i >= 1; i--) { sum = 1.0 + paused(paused(sum * r) / (double)i); }
  return math_scale(sum, (int)k);
}
