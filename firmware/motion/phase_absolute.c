/* Halls (Ixx91 bit 23): bits 22..20 of X:Ixx81 are U, V, W. Going up they show 011 010 110 100 101 001, 60 degrees
 * each; the first of them begins at bits 21..16 of Ixx91, in 1/64 of a cycle. With bit 22 they show the same going
 * down. The middle of the sector is taken: 30 degrees are unknown on both sides.
 *
 * Parallel: bits 21..16 are the number of bits, 8 to 24 of one word, up to 48 with the next address; bit 22: X words.
 * The position is theirs times Ixx70, plus Ixx75. */
#include "firmware/motion/phase_absolute.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { HALLS = 1 << 23, REVERSED = 1 << 22, X_WORDS = 1 << 22, FIELD_SHIFT = 16, FIELD = 63 };
enum { HALL_SHIFT = 20, HALL_MASK = 7, NO_SECTOR = 6, WORD_BITS = 24, FEWEST_BITS = 8, MOST_BITS = 48 };

static int32_t variable(uint32_t motor, enum i_name name) { return i_integer(i_motor(motor + 1u, name)); }

static uint32_t address_of(uint32_t motor) { return (uint32_t)variable(motor, IXX81_POWER_ON_PHASE_ADDRESS); }

bool phase_absolute_is_set(uint32_t motor) { return address_of(motor) != 0u; }

static bool read_halls(uint32_t motor, uint32_t format, double* position) {
  static const uint8_t SECTOR[HALL_MASK + 1] = {NO_SECTOR, 5, 1, 0, 3, 4, 2, NO_SECTOR}; /* by UVW */
  if (!word_exists(true, address_of(motor))) return false;
  const uint32_t sector = SECTOR[(word_read(true, address_of(motor)) >> HALL_SHIFT) & HALL_MASK];
  if (sector == NO_SECTOR) return false;
  const double middle = ((double)sector + 0.5) / 6.0, offset = (double)((format >> FIELD_SHIFT) & FIELD) / 64.0;
  *position = ((format & REVERSED) != 0u ? offset - middle : offset + middle) *
              (double)variable(motor, IXX71_COMMUTATION_COUNTS);
  return true;
}

static bool read_parallel(uint32_t motor, uint32_t format, double* position) {
  const uint32_t bits = (format >> FIELD_SHIFT) & FIELD, address = address_of(motor);
  const bool x = (format & X_WORDS) != 0u;
  if (bits < FEWEST_BITS || bits > MOST_BITS || !word_exists(x, address)) return false;
  uint64_t value = word_read(x, address);
  if (bits > WORD_BITS) value |= (uint64_t)word_read(x, address + 1u) << WORD_BITS;
  value &= (1ull << bits) - 1u;
  *position =
      (double)value * (double)variable(motor, IXX70_COMMUTATION_CYCLES) + (double)variable(motor, IXX75_PHASE_OFFSET);
  return true;
}

bool phase_absolute_read(uint32_t motor, int32_t* position) {
  const uint32_t format = (uint32_t)variable(motor, IXX91_POWER_ON_PHASE_FORMAT);
  const double cycle = (double)variable(motor, IXX71_COMMUTATION_COUNTS);
  double found;
  if (cycle == 0.0 || !phase_absolute_is_set(motor)) return false;
  if (!((format & HALLS) != 0u ? read_halls(motor, format, &found) : read_parallel(motor, format, &found)))
    return false;
  *position = (int32_t)math_modulo(found, cycle);
  return true;
}
