/* Host lines of up to 255 characters. Control characters act where they stand, also inside a line; a carriage return
 * hands the line to the command interpreter and frames its reply by I3, I4 and I6. One line a background pass. */
#include "firmware/host/line_input.h"

#include <stdbool.h>
#include <stdint.h>

#include "firmware/command/command.h"
#include "firmware/command/control_characters.h"
#include "firmware/command/program_line.h"
#include "firmware/command/reply.h"
#include "firmware/host/active_port.h"
#include "firmware/host/host_port.h"
#include "firmware/kernel/slice.h"
#include "firmware/variables/i_variables.h"

enum {
  LINE_LIMIT = LEXER_LINE_LIMIT,
  ROUNDS_A_PASS = 64,
  ACKNOWLEDGE = 0x06,
  BACKSPACE = 0x08,
  REPEAT = 0x09,
  LINE_FEED = 0x0A,
  RETURN = 0x0D
};
enum { CHECKSUM_SO_FAR = 0x0E, LAST_LINE = 0x19 };

/* The line is kept as it came and in upper case, converted and, as far as it can be, compiled as it comes: little is
 * left to do at its end. */
static struct text { char sent[LINE_LIMIT + 1], upper[LINE_LIMIT + 1]; } texts[2];
static uint32_t letter;  /* where the last letter stands: a number before it is complete */
static uint32_t looked;  /* `letter` when the line was last compiled as far as it goes */
static uint32_t current; /* which of `texts` is being received; the other is the last line executed */
static uint32_t length;  /* as it came, which may be more than is kept */
static uint32_t last_length;
static bool bad_character, quoted;

static void start_line(void) {
  length = letter = looked = 0;
  bad_character = quoted = false;
  program_line_forget_ahead();
}

void line_input_initialize(void) {
  current = last_length = 0;
  start_line();
}

static uint8_t checksum(const char* text, uint32_t count) {
  uint32_t sum = 0;
  for (uint32_t i = 0; i < count; ++i) sum += (uint8_t)text[i];
  return (uint8_t)sum;
}

/* A line that turns acknowledging by ACK on or off is acknowledged by ACK itself: both what a client that goes by the
 * old setting and what one that goes by the new setting waits for. A function of its own for who debugs: it is where
 * an answer ends (docs/debugging.md). */
static __attribute__((noinline)) void acknowledge(int32_t style_before, uint8_t sum) {
  const int32_t style = i_integer(I3_IO_HANDSHAKE);
  if (style >= 2 || style_before >= 2)
    host_port_send(ACKNOWLEDGE);
  else if (style == 1)
    host_port_send(LINE_FEED);
  else
    return;
  if ((i_integer(I4_COMMUNICATIONS_INTEGRITY) & 1) != 0) host_port_send(sum);
}

static void execute(void) {
  const int32_t style_before = i_integer(I3_IO_HANDSHAKE);
  struct text* const line = &texts[current];
  const uint32_t count = length;
  error_t error = ERR_NONE;
  active_port = PORT_PARALLEL;
  host_port_open_output();
  if (bad_character)
    error = ERR_CHARACTER;
  else if (count > LINE_LIMIT)
    error = ERR_DATA;
  else {
    line->upper[count] = '\0';
    current ^= 1u;
    last_length = count;
    error = command_line(line->upper);
  }
  start_line();
  if (reply_line_is_open()) reply_end_line();
  if (error != ERR_NONE)
    reply_error(error);
  else
    acknowledge(style_before, (i_integer(I4_COMMUNICATIONS_INTEGRITY) & 1) != 0 ? checksum(line->sent, count) : 0u);
  if (!host_port_waiting()) slice_hurry_over(); /* else another line is on its way */
}

const char* line_input_as_typed(const char* at) {
  struct text* const line = &texts[current ^ 1u];
  const uintptr_t offset = (uintptr_t)at - (uintptr_t)line->upper;
  if (offset > LINE_LIMIT) return at;
  line->sent[last_length] = '\0';
  return &line->sent[offset];
}

/* Text in quotes keeps its case. */
static char upper_case(char c) {
  if ((uint8_t)c > 0x7Fu) bad_character = true;
  if (c == '"') quoted = !quoted;
  return !quoted && c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

/* False: a control character. */
static bool add_one(char c) {
  if ((uint8_t)c < ' ') return false;
  const uint32_t at = length++;
  if (at >= LINE_LIMIT) {
    if ((uint8_t)c > 0x7Fu) bad_character = true;
    return true;
  }
  texts[current].sent[at] = c;
  texts[current].upper[at] = c = upper_case(c);
  if (c >= 'A' && c <= 'Z') letter = at;
  return true;
}

static __attribute__((noinline)) uint32_t add_others(const uint8_t* from, uint32_t count) {
  uint32_t taken = 0;
  while (taken != count && add_one((char)from[taken])) ++taken;
  return taken;
}

/* Takes characters up to a control character; returns their number. Runs for each character in the time to BREQ: those
 * that stay as they are go the shortest way, without a call, and the last letter is looked for from the end. */
static uint32_t add(const uint8_t* from, uint32_t count) {
  const uint8_t *const begin = from, *const end = from + count;
  struct text* const text = &texts[current];
  if (length + count > LINE_LIMIT) return add_others(from, count);
  for (char* to = text->sent + length; from != end; ++from, ++to) {
    const uint32_t c = *from;
    if (c - ' ' >= 'a' - ' ' || c == '"') break;
    to[0] = (char)c;
    to[sizeof text->sent] = (char)c; /* text->upper */
  }
  const uint32_t taken = (uint32_t)(from - begin);
  for (const uint8_t* at = from; at != begin; --at) {
    if ((uint32_t)at[-1] - 'A' > 'Z' - 'A') continue;
    letter = length + (uint32_t)(at - begin) - 1u;
    break;
  }
  length += taken;
  return from == end ? taken : taken + add_others(from, count - taken);
}

static void backspace(void) {
  if (length == 0u) return;
  if (--length < LINE_LIMIT && texts[current].sent[length] == '"') quoted = !quoted;
  letter = looked = 0; /* what is compiled may end differently now: the rest waits for the end of the line */
  program_line_forget_ahead();
}

static void repeat_last(void) {
  start_line();
  (void)add((const uint8_t*)texts[current ^ 1u].sent, last_length);
}

/* True when a line was executed. */
static bool character(uint8_t c) {
  if (c == RETURN) {
    execute();
    return true;
  }
  if (add(&c, 1) != 0u) return false;
  switch (c) {
    case LINE_FEED:
      break;
    case BACKSPACE:
      backspace();
      break;
    case REPEAT:
      repeat_last();
      execute();
      return true;
    case CHECKSUM_SO_FAR:
      host_port_open_output();
      host_port_send(checksum(texts[current].sent, length < LINE_LIMIT ? length : LINE_LIMIT));
      break;
    case LAST_LINE:
      host_port_open_output();
      texts[current ^ 1u].sent[last_length] = '\0';
      reply_text(texts[current ^ 1u].sent);
      reply_end_line();
      acknowledge(0, 0);
      break;
    case CONTROL_SERIAL_ACTIVE:
      active_port = PORT_SERIAL;
      break;
    default:
      active_port = PORT_PARALLEL;
      host_port_open_output();
      if (control_character(c)) acknowledge(0, c);
      break;
  }
  return false;
}

/* Number of characters. */
static uint32_t take_text(void) {
  const uint8_t* text;
  bool flushed;
  const uint32_t stored = host_port_text(&text, &flushed);
  if (flushed) start_line();
  if (stored == 0u) return 0;
  const uint32_t taken = add(text, stored);
  host_port_text_taken(taken);
  return taken;
}

void line_input_text(void) {
  if (take_text() == 0u) {
    slice_hurry_over(); /* woken by something else: the host has paused */
  } else if (letter != looked) {
    looked = letter;
    program_line_ahead(texts[current].upper, texts[current].upper + letter);
  }
}

void line_input_urgent(void) {
  uint32_t urgent = host_port_urgent();
  for (uint8_t c = 0; urgent != 0u; ++c, urgent >>= 1)
    if ((urgent & 1u) != 0u) (void)control_character(c);
}

void line_input_pass(void) {
  uint32_t left = ROUNDS_A_PASS; /* a host that never pauses does not hold the rest of the background off */
  uint8_t c;
  bool flushed, some;
  do {
    (void)take_text();
    some = host_port_take(&c, &flushed);
    if (flushed) start_line();
  } while (some && !character(c) && --left != 0u);
}
