#include "firmware/buffers/program_links.h"

#include "firmware/kernel/slice.h"

enum { LONGEST_LINE = 300 }; /* words: as many as a host line can give; what is longer is damaged */

uint32_t program_links_line(struct program_structure* structure, const struct fixed_program* program, error_t* error) {
  word48_t words[LONGEST_LINE];
  const uint32_t generation = fixed_programs_generation();
  const uint32_t at = structure->offset, count = fixed_program_line(program, at);
  const uint32_t taken = count < LONGEST_LINE ? count : LONGEST_LINE;
  for (uint32_t i = 0; i < taken; i++, slice_pause()) words[i] = fixed_program_word(program, at + i);
  if (fixed_programs_generation() != generation || count == 0) return 0;
  *error = program_structure_line(structure, program->kind == FIXED_PROG, words, taken);
  structure->offset = at + count;
  return count;
}

enum links program_links_make(const struct fixed_program* program) {
  const uint32_t generation = fixed_programs_generation();
  struct program_structure structure;
  uint16_t* links = &fixed_program_links[program->base];
  error_t error = ERR_NONE;
  if (program->linked) return LINKS_MADE;
  program_structure_begin(&structure, links);
  while (error == ERR_NONE && program_links_line(&structure, program, &error) != 0) {
    slice_pause();
    if (fixed_programs_generation() != generation) break;
  }
  if (fixed_programs_generation() != generation) return LINKS_MOVED;
  if (error != ERR_NONE || structure.depth != 0) return LINKS_BAD;
  fixed_program_set_linked(program);
  return LINKS_MADE;
}
