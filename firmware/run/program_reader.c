#include "firmware/run/program_reader.h"

#include "firmware/buffers/program_links.h"
#include "firmware/buffers/rotary.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/slice.h"

enum { GENERATION_NONE = 1 }; /* odd: no program can be read in it */

void reader_rotary(struct program_reader* reader, uint32_t cs) {
  *reader = (struct program_reader){.rotary = true, .number = cs};
}

void reader_fixed(struct program_reader* reader, enum fixed_kind kind, uint32_t number, uint32_t offset) {
  *reader = (struct program_reader){
      .kind = (uint16_t)kind, .number = number, .offset = offset, .generation = GENERATION_NONE};
}

/* Finds the program anew when something has moved. */
static enum reader_result look(struct program_reader* reader) {
  const uint32_t generation = fixed_programs_generation();
  if (generation == reader->generation) return READER_WORD;
  if ((generation & 1u) != 0) return READER_LATER;
  const struct fixed_program* program = fixed_program_find((enum fixed_kind)reader->kind, reader->number);
  if (program == 0) return READER_BAD;
  switch (program_links_make(program)) {
    case LINKS_MOVED:
      return READER_LATER;
    case LINKS_BAD:
      return READER_BAD;
    default:
      break;
  }
  reader->base = program->base;
  reader->words = program->words;
  reader->generation = generation;
  return READER_WORD;
}

enum reader_result reader_check(enum fixed_kind kind, uint32_t number) {
  struct program_reader reader = {.kind = (uint16_t)kind, .number = number, .generation = GENERATION_NONE};
  return look(&reader);
}

enum reader_result reader_peek(struct program_reader* reader, uint32_t ahead, word48_t* word) {
  if (reader->rotary) return rotary_peek(reader->number, ahead, word) ? READER_WORD : READER_LATER;
  const enum reader_result found = look(reader);
  if (found != READER_WORD) return found;
  if (reader->offset + ahead >= reader->words) return READER_END;
  *word = user_memory_read(reader->base + reader->offset + ahead);
  return READER_WORD;
}

bool reader_advance(struct program_reader* reader, uint32_t count) {
  if (reader->rotary) return rotary_consume(reader->number, count);
  reader->offset += count;
  return look(reader) != READER_WORD || reader->offset >= reader->words ||
         (user_memory_read(reader->base + reader->offset) & WORD_START_OF_LINE) != 0;
}

void reader_skip_line(struct program_reader* reader) {
  word48_t word;
  if (reader->rotary) {
    rotary_skip_line_rest(reader->number);
    return;
  }
  for (;;) {
    if (reader_peek(reader, 0, &word) != READER_WORD) return;
    const struct instruction in = word_decode(word);
    if (reader_advance(reader, 1u + word_raw_count(&in))) return;
    slice_pause();
  }
}

uint32_t reader_offset(const struct program_reader* reader) {
  return reader->rotary ? rotary_buffers[reader->number].read : reader->offset;
}

uint32_t reader_link(const struct program_reader* reader, uint32_t offset) {
  return offset < reader->words ? fixed_program_links[reader->base + offset] : LINK_NONE;
}
