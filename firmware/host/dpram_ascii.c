/* A line comes in one piece, or in pieces of 159 characters that no NUL ends; the word of control stays set until it is
 * executed. What the host has not read of earlier answers holds its next command up, and nobody else. */
#include "firmware/host/dpram_ascii.h"

#include <stdint.h>

#include "firmware/base/dpram.h"
#include "firmware/command/command.h"
#include "firmware/command/control_characters.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/hal/hal.h"
#include "firmware/host/active_port.h"
#include "firmware/host/dpram_responses.h"
#include "firmware/host/host_port.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/slice.h"
#include "firmware/variables/dpram_use.h"

enum { LINE_LIMIT = LEXER_LINE_LIMIT, PIECE = DPRAM_COMMAND_BYTES - 1, COMMAND_WAITS = 1, AWAKE_MS = 2 };
enum { LAST_LINE = 0x19, FLUSH = 0x18 };

static struct { char sent[LINE_LIMIT + 1], upper[LINE_LIMIT + 1]; } line;
static uint32_t length; /* as it came, which may be more than is kept */
static bool bad_character, quoted;
static bool on;
static bool executed;    /* the line has been: another one begins */
static uint32_t used_at; /* cycle counter when the port was last used */
static bool is_used;     /* not long ago: the background does not sleep */

void dpram_ascii_initialize(void) {
  on = executed = is_used = bad_character = quoted = false;
  length = 0;
  dpram_responses_initialize();
}

static bool is_enabled(void) { return i_integer(I58_DPRAM_ASCII) != 0 && dpram_is_used(); }

bool dpram_ascii_is_on(void) { return on; }

/* What stood there means nothing. */
static void begin(void) {
  on = true;
  length = 0;
  executed = bad_character = quoted = false;
  dpram_write(DPRAM_COMMAND_CONTROL, 0);
  dpram_write(DPRAM_CONTROL_CHARACTER, 0);
  dpram_write(DPRAM_RESPONSE_CONTROL, 0);
}

static void use(void) {
  is_used = true;
  used_at = hal_cycles();
}

static void begin_answer(void) {
  active_port = PORT_DPRAM;
  session_begin_dpram();
  reply_to(REPLY_TO_DPRAM);
}

static void end_answer(bool acknowledged) {
  if (acknowledged) dpram_responses_end(DPRAM_RESPONSE_ACKNOWLEDGE);
  reply_to(REPLY_TO_HOST);
  session_end();
}

/* Lines ------------------------------------------------------------------------------------------------------------ */

static void start_line(void) {
  length = 0;
  bad_character = quoted = executed = false;
}

/* Text in quotes keeps its case. A host may end its lines as on the other port: CR and LF are not of them. */
static void add(uint32_t c) {
  if (c == '\r' || c == '\n') return;
  if (c < ' ' || c > 0x7Fu) bad_character = true;
  if (c == '"') quoted = !quoted;
  if (length < LINE_LIMIT) {
    line.sent[length] = (char)c;
    line.upper[length] = (char)(!quoted && c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  }
  ++length;
}

/* True when its end was there. */
static bool take_piece(void) {
  for (uint32_t i = 0;; i += DPRAM_WORD_BYTES) {
    const uint32_t word = dpram_read(DPRAM_COMMAND_TEXT + i);
    if ((word & 0xFFu) == 0u) return true;
    add(word & 0xFFu);
    if (word >> 8 == 0u) return true;
    if (i + 1u == PIECE) return false;
    add(word >> 8);
  }
}

static void execute(void) {
  const uint32_t kept = length < LINE_LIMIT ? length : LINE_LIMIT;
  error_t error = ERR_NONE;
  line.sent[kept] = line.upper[kept] = '\0';
  begin_answer();
  if (bad_character)
    error = ERR_CHARACTER;
  else if (length > LINE_LIMIT)
    error = ERR_DATA;
  else
    error = command_line(line.upper);
  executed = true;
  if (reply_line_is_open()) reply_end_line();
  if (error != ERR_NONE) reply_error(error);
  end_answer(error == ERR_NONE);
}

const char* dpram_ascii_as_typed(const char* at) {
  const uintptr_t offset = (uintptr_t)at - (uintptr_t)line.upper;
  return offset > LINE_LIMIT ? at : &line.sent[offset];
}

static void command_pass(void) {
  if ((dpram_read(DPRAM_COMMAND_CONTROL) & COMMAND_WAITS) == 0u || !dpram_responses_are_read()) return;
  slice_hurry = 1;
  if (executed) start_line();
  if (take_piece()) execute();
  dpram_write(DPRAM_COMMAND_CONTROL, 0);
  if (!host_port_waiting()) slice_hurry_over();
  use();
}

/* Control characters ----------------------------------------------------------------------------------------------- */

static void report_last_line(void) {
  reply_text(executed ? line.sent : "");
  reply_end_line();
}

static void control_character_pass(void) {
  const uint8_t c = (uint8_t)dpram_read(DPRAM_CONTROL_CHARACTER);
  if (c == 0u) return;
  if (c == CONTROL_SERIAL_ACTIVE) {
    active_port = PORT_SERIAL;
  } else if (c == FLUSH) {
    start_line();
    dpram_responses_flush();
  } else {
    begin_answer();
    if (c == LAST_LINE) report_last_line();
    end_answer(c == LAST_LINE || control_character(c));
  }
  dpram_write(DPRAM_CONTROL_CHARACTER, 0);
  use();
}

static void end(void) {
  dpram_responses_off();
  on = is_used = false;
}

void dpram_ascii_pass(void) {
  if (!is_enabled()) {
    end();
    return;
  }
  if (!on) begin();
  control_character_pass();
  command_pass();
  if (!on && !is_enabled()) { /* the command was a restart */
    end();
    return;
  }
  if (!on) begin();
  if (dpram_responses_pass()) use();
  if (is_used && hal_cycles() - used_at > AWAKE_MS * hal_cycles_per_ms()) is_used = false;
  if (is_used) background_wake();
}
