#include "firmware/buffers/program_structure.h"

#include "firmware/language/statement_key.h"

enum block { BLOCK_IF, BLOCK_ELSE, BLOCK_WHILE };

void program_structure_begin(struct program_structure* structure, uint16_t* links) {
  *structure = (struct program_structure){.links = links};
}

static void link(struct program_structure* s, uint32_t at, uint32_t target) {
  if (s->links != 0) s->links[at] = (uint16_t)target;
}

/* A word of the line: `from` its statement begins, `at` it stands. */
struct place {
  uint32_t from, at;
};

static error_t push(struct program_structure* s, enum block block, struct place place) {
  if (s->depth >= STRUCTURE_DEPTH) return ERR_STRUCTURE;
  s->blocks[s->depth].kind = (uint8_t)block;
  s->blocks[s->depth].from = (uint16_t)place.from;
  s->blocks[s->depth++].at = (uint16_t)place.at;
  return ERR_NONE;
}

static bool top_is(const struct program_structure* s, enum block block) {
  return s->depth != 0 && s->blocks[s->depth - 1u].kind == (uint8_t)block;
}

static error_t pop(struct program_structure* s, bool fits, struct place place) {
  if (!fits) return ERR_STRUCTURE;
  s->depth--;
  link(s, s->blocks[s->depth].at, place.at + 1u);
  if (s->blocks[s->depth].kind == BLOCK_WHILE) link(s, place.at, s->blocks[s->depth].from + 1u);
  return ERR_NONE;
}

/* `alone`: nothing stands behind it on its line. */
static error_t else_line(struct program_structure* s, bool alone, bool after_one_line, struct place place) {
  const bool of_block = top_is(s, BLOCK_IF) && !after_one_line;
  if (!of_block && !after_one_line) return ERR_STRUCTURE;
  if (of_block) (void)pop(s, true, place);
  return alone ? push(s, BLOCK_ELSE, place) : ERR_NONE;
}

struct scan {
  bool one_line;       /* a condition or ELSE governs the rest of this line */
  bool condition;      /* a condition does */
  bool one_line_if;    /* the first of them is an IF: behind a WHILE, what does not hold leads back to it, not on */
  bool after_one_line; /* the line before was one */
};

/* Behind the last word that is no part of a condition: from there on nothing but the rest of one is left of the line.
 */
static uint32_t last_other(const word48_t* words, uint32_t count) {
  uint32_t last = 0;
  for (uint32_t at = 0; at < count;) {
    const struct instruction in = word_decode(words[at]);
    const bool pushes = in.operation >= OP_PUSH && in.operation <= OP_APPLY;
    const bool continues = in.operation == OP_CONDITION && in.group >= CONDITION_AND;
    at += 1u + word_raw_count(&in);
    if (!pushes && !continues) last = at;
  }
  return last;
}

/* IF and WHILE. */
static error_t condition(struct program_structure* s, const struct instruction* in, bool alone, struct scan* scan,
                         struct place place) {
  s->condition_opened = alone;
  if (alone) return scan->one_line ? ERR_STRUCTURE : push(s, in->group == CONDITION_IF ? BLOCK_IF : BLOCK_WHILE, place);
  if (!scan->condition) scan->one_line_if = in->group == CONDITION_IF;
  scan->one_line = scan->condition = true;
  return ERR_NONE;
}

/* Any part of a condition: the last one has the link. */
static error_t condition_part(struct program_structure* s, const struct instruction* in, bool alone, struct scan* scan,
                              struct place place) {
  error_t error = ERR_NONE;
  if (in->group < CONDITION_AND) {
    error = condition(s, in, alone, scan, place);
  } else if (in->group == CONDITION_AND || in->group == CONDITION_OR) {
    if (!s->condition_may_follow) return ERR_STRUCTURE;
    link(s, s->condition, LINK_CONTINUES);
  }
  s->condition = place.at;
  if (s->condition_opened && s->depth != 0) s->blocks[s->depth - 1u].at = (uint16_t)place.at;
  return error;
}

static error_t statement(struct program_structure* s, const struct instruction* in, bool alone, struct scan* scan,
                         struct place place) {
  if (in->operation == OP_CONDITION) return condition_part(s, in, alone, scan, place);
  if (in->operation != OP_STATEMENT) return ERR_NONE;
  const bool ends = in->number == KEY_ENDIF || in->number == KEY_ENDWHILE;
  const bool is_else = in->number == KEY_ELSE;
  if ((ends || is_else) && scan->one_line) return ERR_STRUCTURE;
  if (in->number == KEY_ENDIF) return pop(s, top_is(s, BLOCK_IF) || top_is(s, BLOCK_ELSE), place);
  if (in->number == KEY_ENDWHILE) return pop(s, top_is(s, BLOCK_WHILE), place);
  if (!is_else) return ERR_NONE;
  if (!alone) scan->one_line = true;
  return else_line(s, alone, scan->after_one_line, place);
}

error_t program_structure_line(struct program_structure* structure, bool motion, const word48_t* words,
                               uint32_t count) {
  struct program_structure s = *structure;
  struct scan scan = {.after_one_line = s.else_may_follow};
  const uint32_t rest = motion ? last_other(words, count) : 0;
  uint32_t from = s.offset;
  if (motion) s.condition_may_follow = s.condition_opened = false;
  for (uint32_t at = 0; at < count;) {
    const struct instruction in = word_decode(words[at]);
    const struct place place = {from, s.offset + at};
    at += 1u + word_raw_count(&in);
    const error_t error = statement(&s, &in, at >= rest, &scan, place);
    if (error != ERR_NONE) return error;
    if (in.operation >= OP_PUSH && in.operation <= OP_APPLY) continue;
    s.condition_may_follow = in.operation == OP_CONDITION;
    s.returns = in.operation == OP_STATEMENT && in.number == KEY_RETURN;
    scan.after_one_line = false;
    if (in.operation != OP_CONDITION || (in.number & CONDITION_MORE) == 0) from = s.offset + at;
  }
  s.else_may_follow = motion && scan.one_line_if;
  s.offset += count;
  *structure = s;
  return ERR_NONE;
}
