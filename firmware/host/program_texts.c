/* There are two ports, the parallel one and, while I58 = 1, the dual-ported RAM: SENDS and SENDA have nobody to go to,
 * and commands that want their answer there are executed without one. While a host does not read, texts stay in their
 * queues, and a program whose queue is full stays at its statement. Nothing here waits for the host but a reply to
 * COMMANDP of more than 2,048 characters; programs go on meanwhile, and a host that would rather send than read is not
 * kept waiting (host_port.c). Texts for the dual-ported RAM stand in the way of others for half a second at most. */
#include "firmware/host/program_texts.h"

#include "firmware/base/error.h"
#include "firmware/command/command.h"
#include "firmware/command/control_characters.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/host/active_port.h"
#include "firmware/host/dpram_ascii.h"
#include "firmware/host/dpram_responses.h"
#include "firmware/host/host_port.h"
#include "firmware/kernel/background.h"
#include "firmware/run/program_output.h"
#include "firmware/variables/i_variables.h"

enum { LINE_LIMIT = LEXER_LINE_LIMIT, RETURN = 0x0D, ROOM_FOR_TEXT = 2 * TEXT_LONGEST, ROOM_FOR_REPLY = 2048 };

/* The command being put together, of each task; I62 = 1: more texts than one. */
static struct command_text {
  char line[LINE_LIMIT + 1];
  uint32_t length; /* as it came, which may be more than is kept */
} command_texts[PROGRAM_TASKS];
static uint32_t flushes; /* of the port, at the last pass */

void program_texts_initialize(void) {
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++) command_texts[task].length = 0;
  flushes = host_port_flushes();
  active_port = PORT_PARALLEL;
  program_output_initialize();
}

/* The port that is meant; one that is not there is PORT_SERIAL. */
static enum program_port destination(uint32_t port) {
  const uint32_t named = port == PORT_ACTIVE ? (uint32_t)active_port : port;
  if (named == PORT_PARALLEL) return PORT_PARALLEL;
  return named == PORT_DPRAM && dpram_ascii_is_on() ? PORT_DPRAM : PORT_SERIAL;
}

/* SEND ------------------------------------------------------------------------------------------------------------- */

static void send_line(const struct program_text* t, enum reply_to whom) {
  reply_to(whom);
  for (uint32_t i = 0; i < t->length; i++) reply_char(t->text[i]);
  reply_end_line();
  reply_to(REPLY_TO_HOST);
}

static void send_text(const struct program_text* t) {
  const enum program_port to = destination(t->port);
  if (to == PORT_DPRAM) send_line(t, REPLY_TO_DPRAM_TEXT);
  if (to != PORT_PARALLEL) return;
  const bool whole =
      t->control == 0 && (i_integer(I62_NO_CR_AFTER_SEND) == 0 || i_integer(I64_INTERNAL_REPLY_TAG) != 0);
  host_port_open_output();
  if (!whole) {
    for (uint32_t i = 0; i < t->length; i++) host_port_send((uint8_t)t->text[i]);
    return;
  }
  send_line(t, REPLY_TO_PROGRAM);
}

/* A ^X drops what has not been sent. */
static void forget_flushed(void) {
  if (flushes == host_port_flushes()) return;
  flushes = host_port_flushes();
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++) text_queue_empty(&send_queues[task]);
}

/* Room that a ^X has just made is not for what it drops. */
static bool may_send(const struct text_queue* queue) {
  const bool has_room = host_port_room() >= ROOM_FOR_TEXT;
  forget_flushed();
  if (text_queue_is_empty(queue)) return false;
  return destination(text_queue_next_port(queue)) == PORT_DPRAM ? dpram_responses_take_text() : has_room;
}

/* COMMAND ---------------------------------------------------------------------------------------------------------- */

static void add(struct command_text* to, const struct program_text* t) {
  for (uint32_t i = 0; i < t->length; i++, to->length++) {
    const char c = t->text[i];
    if (to->length < LINE_LIMIT) to->line[to->length] = c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
  }
}

static error_t execute(struct command_text* text) {
  const bool fits = text->length <= LINE_LIMIT;
  text->line[fits ? text->length : 0] = '\0';
  text->length = 0;
  return fits ? command_line(text->line) : ERR_DATA;
}

/* Data come only where the statement names the port; errors also without. */
static void command(struct command_text* text, const struct program_text* t) {
  const enum program_port to = destination(t->port);
  const enum reply_to whom = to == PORT_PARALLEL ? REPLY_TO_PROGRAM : REPLY_TO_DPRAM_PROGRAM;
  const bool is_return = t->control != 0 && t->text[0] == RETURN;
  error_t error = ERR_NONE;
  if (t->control == 0) add(text, t);
  session_begin_program(t->cs, t->motor);
  host_port_program_sends(true);
  host_port_open_output();
  reply_to(t->port == PORT_ACTIVE || to == PORT_SERIAL ? REPLY_TO_NOBODY : whom);
  if (is_return || (t->control == 0 && i_integer(I62_NO_CR_AFTER_SEND) == 0))
    error = execute(text);
  else if (t->control != 0)
    (void)control_character((uint8_t)t->text[0]);
  if (reply_line_is_open()) reply_end_line();
  reply_to(to == PORT_SERIAL ? REPLY_TO_NOBODY : whom);
  if (error != ERR_NONE && (to != PORT_PARALLEL || host_port_room() >= ROOM_FOR_TEXT)) reply_error(error);
  reply_to(REPLY_TO_HOST);
  host_port_program_sends(false);
  session_end();
}

/* What answers needs room for it. */
static bool may_execute(const struct text_queue* queue) {
  if (text_queue_is_empty(queue)) return false;
  const uint8_t port = text_queue_next_port(queue);
  if (port == PORT_DPRAM) return !dpram_ascii_is_on() || dpram_responses_take_text();
  return port != PORT_PARALLEL || host_port_room() >= ROOM_FOR_REPLY;
}

/* Nothing has been queued since, which is what each pass but a few finds. */
static bool nothing_waits(void) {
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++)
    if (!text_queue_is_empty(&send_queues[task]) || !text_queue_is_empty(&command_queues[task])) return false;
  return true;
}

void program_texts_pass(void) {
  static struct program_text t;
  forget_flushed();
  if (nothing_waits()) return;
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++) {
    while (may_send(&send_queues[task]) && text_queue_pop(&send_queues[task], &t)) send_text(&t);
    if (may_execute(&command_queues[task]) && text_queue_pop(&command_queues[task], &t))
      command(&command_texts[task], &t);
    if (may_execute(&command_queues[task])) background_wake();
  }
}
