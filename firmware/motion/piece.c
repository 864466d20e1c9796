#include "firmware/motion/piece.h"

#include <stdatomic.h>

#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_ratio.h"

/* inverse = 2^125 / (time << shift), with time << shift in [2^62, 2^63): far more bits than the fraction has. */
void piece_set_time(struct piece* piece, int64_t time) {
  time = fixed_larger(time, 1);
  piece->continues = false;
  piece->warp = 0;
  piece->from = 0;
  piece->to = PIECE_PARTS;
  piece->time = piece->end = time;
  const struct fixed_divisor by = fixed_divide_by((uint64_t)time);
  piece->shift = by.shift - 1u;
  piece->inverse = by.inverse;
}

static uint32_t fraction_of(const struct piece* piece, int64_t elapsed) {
  if (elapsed >= piece->time) return UINT32_MAX;
  return (uint32_t)(fixed_multiply_high((uint64_t)elapsed << piece->shift, piece->inverse) >> 29);
}

static uint32_t clamped(int64_t fraction) {
  return fraction < 0 ? 0u : fraction > (int64_t)UINT32_MAX ? UINT32_MAX : (uint32_t)fraction;
}

static uint32_t between(const struct piece* piece, uint32_t part) {
  const int64_t way = ((int64_t)piece->to - piece->from) * (int64_t)part;
  return clamped(((int64_t)piece->from << 28) + (way >> 4));
}

static uint32_t warped(int32_t warp, uint32_t part) {
  const uint32_t bulge = (uint32_t)(((uint64_t)part * ~part) >> 32);
  return clamped((int64_t)part + (((int64_t)bulge * warp) >> 30));
}

void piece_ring_initialize(struct piece_ring* ring, struct cubic* cubics, uint32_t width) {
  ring->cubics = cubics;
  ring->width = width;
  ring->executing = ring->added = 0;
  ring->elapsed = 0;
  ring->fraction = 0;
}

void piece_ring_add(struct piece_ring* ring) {
  atomic_signal_fence(memory_order_release);
  ring->added++;
}

void piece_ring_take_back(struct piece_ring* ring, uint32_t number) {
  if (number - ring->executing <= ring->added - ring->executing) ring->added = number;
}

bool piece_ring_replace(struct piece_ring* ring, uint32_t number, int64_t end, uint32_t count) {
  const int32_t ahead = (int32_t)(number - ring->executing);
  if (ahead < 0 || (ahead == 0 && ring->elapsed > end) || (int32_t)(ring->added - number) <= 0) return false;
  for (uint32_t i = number + 1u; i != ring->added; i++) piece_ring_at(ring, i)->end = 0;
  piece_ring_at(ring, number)->end = end;
  ring->added += count;
  return true;
}

void piece_ring_clear(struct piece_ring* ring) {
  ring->executing = ring->added;
  ring->elapsed = 0;
  ring->fraction = 0;
}

bool piece_ring_advance(struct piece_ring* ring, int64_t increment) {
  if (piece_ring_is_empty(ring)) return false;
  int64_t elapsed = ring->elapsed + increment;
  const struct piece* piece = piece_ring_at(ring, ring->executing);
  while (elapsed >= piece->end) { /* no more than there are pieces */
    elapsed -= piece->end;
    ring->executing++;
    if (piece_ring_is_empty(ring)) {
      ring->elapsed = 0;
      ring->fraction = 0;
      return false;
    }
    piece = piece_ring_at(ring, ring->executing);
  }
  ring->elapsed = elapsed;
  ring->fraction = fraction_of(piece, elapsed);
  if (piece->warp != 0) ring->fraction = warped(piece->warp, ring->fraction);
  if (piece->from != 0 || piece->to != PIECE_PARTS) ring->fraction = between(piece, ring->fraction);
  return true;
}

int64_t piece_end(const struct piece* piece, const struct cubic* cubic) {
  if (piece->to == PIECE_PARTS) return cubic_end(cubic);
  return cubic_at(cubic, (uint32_t)piece->to << 28);
}

int64_t cubic_end(const struct cubic* cubic) { return cubic->start + cubic->linear + cubic->square + cubic->cube; }
