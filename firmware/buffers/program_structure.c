#include "firmware/buffers/program_structure.h"

#include "firmware/language/statement_table.h"

enum { KEY_ELSE = WORD_KEY(2, 0, 21), KEY_ENDIF = WORD_KEY(2, 0, 22), KEY_ENDWHILE = WORD_KEY(2, 0, 23) };

enum block { BLOCK_IF, BLOCK_ELSE, BLOCK_WHILE };

void program_structure_begin(struct program_structure* structure) { *structure = (struct program_structure){0}; }

static error_t push(struct program_structure* s, enum block block) {
  if (s->depth >= STRUCTURE_DEPTH) return ERR_STRUCTURE;
  s->blocks[s->depth++] = (uint8_t)block;
  return ERR_NONE;
}

static bool top_is(const struct program_structure* s, enum block block) {
  return s->depth != 0 && s->blocks[s->depth - 1u] == (uint8_t)block;
}

static error_t pop(struct program_structure* s, bool fits) {
  if (!fits) return ERR_STRUCTURE;
  s->depth--;
  return ERR_NONE;
}

/* `alone`: nothing stands behind it on its line. */
static error_t else_line(struct program_structure* s, bool alone, bool after_one_line) {
  const bool of_block = top_is(s, BLOCK_IF) && !after_one_line;
  if (!of_block && !after_one_line) return ERR_STRUCTURE;
  if (of_block) s->depth--;
  return alone ? push(s, BLOCK_ELSE) : ERR_NONE;
}

struct scan {
  bool one_line;       /* a condition or ELSE governs the rest of this line */
  bool one_line_if;    /* that was an IF */
  bool after_one_line; /* the line before was one */
};

/* Nothing but the rest of the condition is left of the line. */
static bool ends_line(const word48_t* words, uint32_t at, uint32_t count) {
  while (at < count) {
    const struct instruction in = word_decode(words[at]);
    const bool pushes = in.operation >= OP_PUSH && in.operation <= OP_APPLY;
    const bool continues = in.operation == OP_CONDITION && in.group >= CONDITION_AND;
    if (!pushes && !continues) return false;
    at += 1u + word_raw_count(&in);
  }
  return true;
}

static error_t condition(struct program_structure* s, const struct instruction* in, bool alone, struct scan* scan) {
  if (in->group == CONDITION_AND || in->group == CONDITION_OR)
    return s->condition_may_follow ? ERR_NONE : ERR_STRUCTURE;
  if (alone) return scan->one_line ? ERR_STRUCTURE : push(s, in->group == CONDITION_IF ? BLOCK_IF : BLOCK_WHILE);
  scan->one_line = true;
  scan->one_line_if = in->group == CONDITION_IF;
  return ERR_NONE;
}

static error_t statement(struct program_structure* s, const struct instruction* in, bool alone, struct scan* scan) {
  if (in->operation == OP_CONDITION) return in->group < CONDITION_INNER_AND ? condition(s, in, alone, scan) : ERR_NONE;
  if (in->operation != OP_STATEMENT) return ERR_NONE;
  const bool ends = in->number == KEY_ENDIF || in->number == KEY_ENDWHILE;
  const bool is_else = in->number == KEY_ELSE;
  if ((ends || is_else) && scan->one_line) return ERR_STRUCTURE;
  if (in->number == KEY_ENDIF) return pop(s, top_is(s, BLOCK_IF) || top_is(s, BLOCK_ELSE));
  if (in->number == KEY_ENDWHILE) return pop(s, top_is(s, BLOCK_WHILE));
  if (!is_else) return ERR_NONE;
  if (!alone) scan->one_line = true;
  return else_line(s, alone, scan->after_one_line);
}

error_t program_structure_line(struct program_structure* structure, bool motion, const word48_t* words,
                               uint32_t count) {
  struct program_structure s = *structure;
  struct scan scan = {false, false, s.else_may_follow};
  if (motion) s.condition_may_follow = false;
  for (uint32_t at = 0; at < count;) {
    const struct instruction in = word_decode(words[at]);
    at += 1u + word_raw_count(&in);
    const error_t error = statement(&s, &in, !motion || ends_line(words, at, count), &scan);
    if (error != ERR_NONE) return error;
    if (in.operation >= OP_PUSH && in.operation <= OP_APPLY) continue;
    s.condition_may_follow = in.operation == OP_CONDITION;
    scan.after_one_line = false;
  }
  s.else_may_follow = motion && scan.one_line_if;
  *structure = s;
  return ERR_NONE;
}
