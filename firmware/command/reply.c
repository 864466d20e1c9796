/* Replies: framing of data lines by I3, checksums by I4, and numbers as text. Every character goes straight to
 * its port. */
#include "firmware/command/reply.h"

#include "firmware/variables/i_variables.h"
#include "rtl/regs/dpram_map.h"

enum { TAG = 0x02, BELL = 0x07, LINE_FEED = 0x0A, CARRIAGE_RETURN = 0x0D, DECIMALS = 10 };

static enum reply_to recipient;

static bool line_open;
static uint8_t line_sum;
static uint32_t line_count;

static void send(uint8_t c) {
  if (recipient == REPLY_TO_NOBODY) return;
  line_sum = (uint8_t)(line_sum + c);
  reply_sink(c);
}

static bool is_tagged(void) { return recipient == REPLY_TO_PROGRAM && i_integer(I64_INTERNAL_REPLY_TAG) != 0; }
static bool has_line_feeds(void) { return (i_integer(I3_IO_HANDSHAKE) & 1) != 0; }

void reply_to(enum reply_to whom) {
  recipient = whom;
  line_open = false;
}

static void begin_line(void) {
  line_open = true;
  line_sum = 0;
  if (has_line_feeds()) send(LINE_FEED);
  if (is_tagged()) send(TAG);
}

/* What the dual-ported RAM calls a line; 0: it does not go there. */
static uint32_t line_code(void) {
  switch (recipient) {
    case REPLY_TO_DPRAM:
      return DPRAM_RESPONSE_LINE;
    case REPLY_TO_DPRAM_PROGRAM:
      return DPRAM_RESPONSE_COMMAND;
    case REPLY_TO_DPRAM_TEXT:
      return DPRAM_RESPONSE_SEND;
    default:
      return 0;
  }
}

/* False: no port of lines. */
static bool put_to_lines(uint8_t c) {
  const uint32_t code = line_code();
  if (code == 0u) return false;
  line_open = true;
  reply_lines.put(code, c);
  return true;
}

void reply_byte(uint8_t byte) {
  if (!put_to_lines(byte)) send(byte);
}

void reply_char(char c) {
  if (put_to_lines((uint8_t)c)) return;
  if (!line_open) begin_line();
  send((uint8_t)c);
}

void reply_text(const char* text) {
  while (*text != '\0') reply_char(*text++);
}

void reply_end_line(void) {
  const uint32_t code = line_code();
  if (code != 0u) {
    reply_lines.end(code);
  } else {
    if (!line_open) begin_line();
    send(CARRIAGE_RETURN);
    if ((i_integer(I4_COMMUNICATIONS_INTEGRITY) & 1) != 0) send(line_sum);
  }
  line_open = false;
  line_count++;
  reply_between_lines();
}

void reply_no_line(void) { line_count++; }

uint32_t reply_line_count(void) { return line_count; }

bool reply_line_is_open(void) { return line_open; }

/* Numbers have two digits (firmware:6.4). */
static void error_text(error_t error) {
  for (const char* text = "ERR0"; *text != '\0'; ++text) reply_byte((uint8_t)*text);
  reply_byte((uint8_t)('0' + error / 10));
  reply_byte((uint8_t)('0' + error % 10));
}

/* The code of a command's error is the number itself. That of a program's command would end the host's own answer: it
 * is a line. */
static void report_error_in_lines(error_t error) {
  if (recipient == REPLY_TO_DPRAM) {
    const uint32_t number = (uint32_t)error;
    reply_lines.end(DPRAM_RESPONSE_ERROR | number / 10u << 4 | number % 10u);
    return;
  }
  error_text(error);
  reply_end_line();
}

/* A program's error is one line by its tag: the CR that I6 = 3 puts behind BELL would end it. */
void reply_error(error_t error) {
  const int32_t style = i_integer(I6_ERROR_REPORTING);
  if ((recipient == REPLY_TO_PROGRAM || recipient == REPLY_TO_DPRAM_PROGRAM) && style == 2) return;
  if (line_code() != 0u) {
    report_error_in_lines(error);
    return;
  }
  const bool tagged = is_tagged(), numbered = (style & 1) != 0;
  if (!tagged) send(BELL);
  if (!tagged && style == 3) send(CARRIAGE_RETURN);
  if (numbered && has_line_feeds()) send(LINE_FEED);
  if (tagged) send(TAG);
  if (numbered) error_text(error);
  if (numbered || tagged) send(CARRIAGE_RETURN);
}

void reply_integer(int64_t value) {
  char digits[20];
  unsigned count = 0;
  uint64_t rest = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
  if (value < 0) reply_char('-');
  while (rest > 0xFFFFFFFFu) { /* 64-bit division is slow on this CPU: leave it as soon as 32 bits are enough */
    digits[count++] = (char)('0' + rest % 10u);
    rest /= 10u;
  }
  uint32_t low = (uint32_t)rest;
  do {
    digits[count++] = (char)('0' + low % 10u);
    low /= 10u;
  } while (low != 0u);
  while (count != 0u) reply_char(digits[--count]);
}

void reply_hex(uint32_t value, unsigned digits) {
  unsigned count = 1;
  while (count < 8u && (value >> (4u * count)) != 0u) ++count;
  if (digits != 0u) count = digits;
  while (count-- != 0u) reply_char("0123456789ABCDEF"[(value >> (4u * count)) & 0xFu]);
}

/* A 36-bit mantissa is good for ten digits: decimals are given up one by one as the integer part grows. */
void reply_number(double value) {
  const double limit = 140737488355328.0; /* 2^47 */
  const bool negative = value < 0.0;
  if (negative) value = -value;
  if (!(value < limit)) value = limit;
  int64_t whole = (int64_t)value;
  int64_t scale = 10;
  unsigned decimals = DECIMALS;
  for (; decimals != 0u && scale <= whole * 10; scale *= 10) --decimals;
  scale = 1;
  for (unsigned i = 0; i < decimals; ++i) scale *= 10;
  int64_t fraction = (int64_t)((value - (double)whole) * (double)scale + 0.5);
  if (fraction >= scale) {
    ++whole;
    fraction -= scale;
  }
  if (negative && (whole != 0 || fraction != 0)) reply_char('-');
  reply_integer(whole);
  if (fraction == 0) return;
  char digits[DECIMALS];
  for (unsigned i = decimals; i-- != 0u; fraction /= 10) digits[i] = (char)('0' + fraction % 10);
  while (digits[decimals - 1u] == '0') --decimals;
  reply_char('.');
  for (unsigned i = 0; i < decimals; ++i) reply_char(digits[i]);
}
