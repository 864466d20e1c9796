/* Compensation tables of the motors (firmware:4.2, firmware:4.3/12): COMP position, TCOMP torque, BLCOMP backlash. Here
 * they are kept, listed and saved; motion/compensation.h puts them to work. Background task. */
#ifndef FIRMWARE_BUFFERS_COMPENSATION_TABLES_H
#define FIRMWARE_BUFFERS_COMPENSATION_TABLES_H

#include "firmware/buffers/regions.h"

enum {
  COMPENSATION_KINDS = REGION_BLCOMP + 1, /* REGION_COMP, REGION_TCOMP, REGION_BLCOMP */
  COMPENSATION_ENTRY_MOST = 0x7FFFFF      /* 24 bits with sign */
};

struct compensation_table {
  uint32_t span;          /* counts of the source motor over which it reaches */
  uint8_t source, target; /* motors, from 0 */
  bool of_desired;        /* position of the source, else the actual one */
  uint32_t base;          /* word offset in user memory: stays, for nothing above can change. Set by define */
};

void compensation_tables_initialize(void);
/* As region_define; all entries are 0. `table` is copied. */
error_t compensation_table_define(enum region_kind kind, uint32_t motor, uint32_t entries,
                                  const struct compensation_table* table);
error_t compensation_table_delete(enum region_kind kind, uint32_t motor);
void compensation_tables_delete_all(void); /* and all that lies below */
const struct compensation_table* compensation_table(enum region_kind kind, uint32_t motor); /* 0: there is none */
int32_t compensation_entry(enum region_kind kind, uint32_t motor, uint32_t index);
void compensation_set_entry(enum region_kind kind, uint32_t motor, uint32_t index, int32_t entry);

/* The table that constants go to, since DEFINE and until it is full. */
void compensation_fill(enum region_kind kind, uint32_t motor);
bool compensation_is_filling(void);
error_t compensation_take(double value); /* ERR003: no integer of 24 bits; it is not taken */

#endif
