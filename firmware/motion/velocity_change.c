#include "firmware/motion/velocity_change.h"

#include "firmware/kernel/slice.h"

/* With s the part of the length that each S takes, acceleration rises to 1/(1 - s), stays and falls. */
uint32_t velocity_change(int64_t length, int64_t s_curve, struct velocity_part parts[VELOCITY_PARTS]) {
  if (length <= 0) return 0;
  const int64_t curve = s_curve < length / 2 ? s_curve : length / 2;
  if (curve <= 0) {
    parts[0] = (struct velocity_part){length, 1.0, 0.5, 0.5, 0.0};
    return 1;
  }
  const double s = (double)curve / (double)length;
  slice_pause();
  const double peak = 1.0 / (1.0 - s), bend = peak * s * s;
  const int64_t constant = length - 2 * curve;
  uint32_t count = 0;
  parts[count++] = (struct velocity_part){curve, s, bend / 6.0, 0.0, bend / 6.0};
  slice_pause();
  if (constant > 0) {
    const double middle = 1.0 - 2.0 * s;
    parts[count++] = (struct velocity_part){constant, 1.0 - s, 0.5 - s + bend / 6.0, peak * middle * middle / 2.0, 0.0};
    slice_pause();
  }
  parts[count++] = (struct velocity_part){curve, 1.0, 0.5, bend / 2.0, -bend / 6.0};
  return count;
}
