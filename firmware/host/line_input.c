/* Host lines of up to 255 characters. Control characters act where they stand, also inside a line; a carriage return
 * hands the line to the command interpreter and frames its reply by I3, I4 and I6. One line a background pass. */
#include "firmware/host/line_input.h"

#include <stdbool.h>
#include <stdint.h>

#include "firmware/command/command.h"
#include "firmware/command/control_characters.h"
#include "firmware/command/reply.h"
#include "firmware/host/host_port.h"
#include "firmware/variables/i_variables.h"

enum {
  LINE_LIMIT = 255,
  CHUNK = 32,
  ACKNOWLEDGE = 0x06,
  BELL = 0x07,
  BACKSPACE = 0x08,
  REPEAT = 0x09,
  LINE_FEED = 0x0A,
  RETURN = 0x0D
};
enum { CHECKSUM_SO_FAR = 0x0E, LAST_LINE = 0x19 };

/* The line is kept as it came and in upper case, converted as it comes: little is left to do at its end. */
static char texts[2][LINE_LIMIT + 1], upper[LINE_LIMIT + 1];
static uint32_t current; /* which of `texts` is being received; the other is the last line executed */
static uint32_t length;  /* as it came, which may be more than is kept */
static uint32_t last_length;
static bool bad_character, quoted;

static void start_line(void) {
  length = 0;
  bad_character = quoted = false;
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

static void report_error(error_t error) {
  const int32_t style = i_integer(I6_ERROR_REPORTING);
  host_port_send(BELL);
  if ((style & 1) == 0) return;
  if (style == 3) host_port_send(RETURN);
  if ((i_integer(I3_IO_HANDSHAKE) & 1) != 0) host_port_send(LINE_FEED);
  host_port_send('E');
  host_port_send('R');
  host_port_send('R');
  host_port_send((uint8_t)('0' + error / 100));
  host_port_send((uint8_t)('0' + error / 10 % 10));
  host_port_send((uint8_t)('0' + error % 10));
  host_port_send(RETURN);
}

/* A line that turns acknowledging by ACK on or off is acknowledged by ACK itself: both what a client that goes by the
 * old setting and what one that goes by the new setting waits for. */
static void acknowledge(int32_t style_before, uint8_t sum) {
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
  const char* text = texts[current];
  const uint32_t count = length;
  error_t error = ERR_NONE;
  host_port_open_output();
  if (bad_character)
    error = ERR_CHARACTER;
  else if (count > LINE_LIMIT)
    error = ERR_DATA;
  else {
    texts[current][count] = '\0';
    upper[count] = '\0';
    current ^= 1u;
    last_length = count;
    error = command_line(upper);
  }
  start_line();
  if (reply_line_is_open()) reply_end_line();
  if (error != ERR_NONE)
    report_error(error);
  else
    acknowledge(style_before, (i_integer(I4_COMMUNICATIONS_INTEGRITY) & 1) != 0 ? checksum(text, count) : 0u);
}

/* Text in quotes keeps its case. */
static void add(const uint8_t* from, uint32_t count) {
  char* text = texts[current];
  uint32_t at = length;
  for (uint32_t i = 0; i < count; ++i) {
    const char c = (char)from[i];
    if (from[i] > 0x7Fu) bad_character = true;
    if (at++ >= LINE_LIMIT) continue;
    if (c == '"') quoted = !quoted;
    text[at - 1u] = c;
    upper[at - 1u] = !quoted && c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
  }
  length = at;
}

static void backspace(void) {
  if (length != 0u && --length < LINE_LIMIT && texts[current][length] == '"') quoted = !quoted;
}

static void repeat_last(void) {
  start_line();
  add((const uint8_t*)texts[current ^ 1u], last_length);
}

/* True when a line was executed. */
static bool character(uint8_t c) {
  if (c == RETURN) {
    execute();
    return true;
  }
  if (c >= ' ') {
    add(&c, 1);
    return false;
  }
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
      host_port_send(checksum(texts[current], length < LINE_LIMIT ? length : LINE_LIMIT));
      break;
    case LAST_LINE:
      host_port_open_output();
      texts[current ^ 1u][last_length] = '\0';
      reply_text(texts[current ^ 1u]);
      reply_end_line();
      acknowledge(0, 0);
      break;
    default:
      host_port_open_output();
      if (control_character(c)) acknowledge(0, c);
      break;
  }
  return false;
}

void line_input_text(void) {
  uint8_t text[CHUNK];
  uint32_t count;
  do {
    bool flushed;
    count = host_port_take_text(text, CHUNK, &flushed);
    if (flushed) start_line();
    add(text, count);
  } while (count == CHUNK);
}

void line_input_urgent(void) {
  uint32_t urgent = host_port_urgent();
  for (uint8_t c = 0; urgent != 0u; ++c, urgent >>= 1)
    if ((urgent & 1u) != 0u) (void)control_character(c);
}

void line_input_pass(void) {
  uint8_t c;
  bool flushed, some;
  do {
    line_input_text();
    some = host_port_take(&c, &flushed);
    if (flushed) start_line();
  } while (some && !character(c));
}
