#include "firmware/run/motion_program.h"

#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"

struct motion_program motion_programs[COORDINATE_SYSTEMS];

void motion_program_forget_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  s->pending_axes = s->pending_triggers = s->pending_velocities = s->pending_vectors = 0;
  s->sets_position = s->sets_normal = false;
}

void motion_program_point(uint32_t cs, bool rotary, uint32_t number, struct program_entry entry) {
  struct motion_program* p = &motion_programs[cs];
  if (rotary)
    reader_rotary(&p->x.at.reader, cs);
  else
    reader_fixed(&p->x.at.reader, FIXED_PROG, number, entry.offset);
  executor_begin(&p->x, cs);
  p->x.at.line = rotary ? reader_offset(&p->x.at.reader) : entry.line;
  p->depth = 0;
  motion_program_forget_line(cs);
  p->in_block = p->under_way = p->reading = p->asks_time = p->labelled = p->prelude.on = false;
}

void motion_program_end_read(struct motion_program* p) {
  if (!p->reading) return;
  p->callers[p->depth - 1u] = p->x.at;
  p->x.at = p->reader;
  p->reading = false;
}

void motion_program_drop_line(struct motion_program* p) {
  motion_program_end_read(p);
  executor_skip_line(&p->x);
  p->under_way = false;
}

void motion_program_restart(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  motion_program_point(cs, s->pointer == POINTER_ROTARY, s->fixed_program, program_top);
}

/* Program and line of a position; program 0 is the rotary buffer. */
static struct program_place place(const struct program_position* at, uint32_t offset) {
  const uint32_t program = at->reader.rotary ? 0 : at->reader.number;
  return (struct program_place){(uint16_t)program, (uint16_t)offset};
}

void motion_program_trace(uint32_t cs, struct program_trace* trace) {
  const struct motion_program* p = &motion_programs[cs];
  trace->depth = p->depth;
  for (uint32_t i = 0; i < p->depth; i++) trace->places[i] = place(&p->callers[i], p->callers[i].line);
  trace->places[p->depth] = place(&p->x.at, p->x.at.line);
}

void motion_program_next(uint32_t cs, struct program_trace* trace) {
  const uint32_t state = hal_mask_real_time();
  motion_program_trace(cs, trace);
  struct program_position at = motion_programs[cs].x.at;
  hal_unmask(state);
  if (at.reader.rotary) {
    trace->places[trace->depth].offset = (uint16_t)rotary_lines_ahead(cs).offset;
  } else {
    if (at.in_line) reader_skip_line(&at.reader);
    trace->places[trace->depth].offset = (uint16_t)at.reader.offset;
  }
}
