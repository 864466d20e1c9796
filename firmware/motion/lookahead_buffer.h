/* Records of the lookahead buffer: a control point of each motor, what the limits ask at the knot of the same number,
 * and the rate there. The words of DEFINE LOOKAHEAD are counted in user memory, 2 x + 4 a record for x motors; what is
 * in them stands in memory that no user can write. */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_BUFFER_H
#define FIRMWARE_MOTION_LOOKAHEAD_BUFFER_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/path.h"

struct lookahead_motor { /* 2 words */
  int64_t point;
  int32_t pace, bend; /* at the knot: motion/lookahead_limits.h */
};

struct lookahead_record { /* 4 words, and the motors */
  int32_t rate;           /* w at the knot: the largest from which it can stop, as the last sweep has found it */
  int32_t cap;            /* of w in the segment behind the knot, by the velocities */
  bool stops;             /* at the knot, for the limit of a desired position behind it */
  uint32_t number;        /* of the move at the control point */
  struct path_line line;
};

struct lookahead_buffer {
  uint64_t* words;
  uint32_t stride, records;
};

/* DEFINE, background: how many of its words are slots of two for assignments that wait for their segments. */
void lookahead_buffer_define(uint32_t cs, uint32_t slots);
bool lookahead_buffer_is_defined(uint32_t cs);
bool lookahead_buffer_is_anywhere(void); /* of any system */
uint32_t lookahead_slots(uint32_t cs, void** slots); /* so many, of 16 bytes; none without a buffer */
/* The buffer of a system with so many motors; no records: there is none. */
void lookahead_buffer_open(uint32_t cs, uint32_t motor_count, struct lookahead_buffer* buffer);

static inline struct lookahead_record* lookahead_at(const struct lookahead_buffer* b, uint32_t number) {
  return (struct lookahead_record*)&b->words[(number % b->records) * b->stride];
}
/* Of a record, without the division: its neighbours and its motors. */
static inline struct lookahead_record* lookahead_before(const struct lookahead_buffer* b, struct lookahead_record* r) {
  uint64_t* words = (uint64_t*)r;
  return (struct lookahead_record*)(words == b->words ? &b->words[(b->records - 1u) * b->stride] : words - b->stride);
}
static inline struct lookahead_record* lookahead_behind(const struct lookahead_buffer* b, struct lookahead_record* r) {
  uint64_t* words = (uint64_t*)r + b->stride;
  return (struct lookahead_record*)(words == &b->words[b->records * b->stride] ? b->words : words);
}
static inline struct lookahead_motor* lookahead_of(struct lookahead_record* r) {
  return (struct lookahead_motor*)((uint64_t*)r + 4);
}
static inline struct lookahead_motor* lookahead_motors(const struct lookahead_buffer* b, uint32_t number) {
  return lookahead_of(lookahead_at(b, number));
}

#endif
