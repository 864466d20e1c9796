/* Entry of lines into the open fixed program: its structure, the words, BREQ. Background task. */
#ifndef FIRMWARE_BUFFERS_FIXED_ENTRY_H
#define FIRMWARE_BUFFERS_FIXED_ENTRY_H

#include "firmware/buffers/fixed_programs.h"

/* Takes away the RETURN of the last end. */
error_t fixed_entry_begin(enum fixed_kind kind, uint32_t number);
/* A host line of so many characters; each of its program lines begins with the mark. Nothing is stored unless all of it
 * is. ERR003 too long to be listed, ERR006 no room, ERR009 structure. */
error_t fixed_entry_store(word48_t* words, uint32_t count, uint32_t characters);
void fixed_entry_clear(void);
/* Appends a RETURN where none is the last statement. */
error_t fixed_entry_end(void); /* ERR009: a block is still open; the program is closed all the same */

#endif
