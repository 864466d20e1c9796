#include "firmware/language/statement_table.h"

#include "firmware/language/statement_key.h"

#define STATEMENT(name, brief, code, argument, where) {name, brief, code, argument, where},
#define KEY WORD_KEY

const struct statement_row statement_rows[] = {
#include "firmware/language/statements.def"
};

const uint32_t statement_row_count = sizeof statement_rows / sizeof statement_rows[0];

const struct statement_row* statement_row_of(uint32_t code) {
  for (uint32_t i = 0; i < statement_row_count; i++)
    if (statement_rows[i].code == code) return &statement_rows[i];
  return 0;
}
