/* There is one port, which is the active one and the parallel one: SENDS, SENDR and SENDA have nobody to go to, and
 * commands that want their answer there are executed without one. While the host does not read, texts stay in their
 * queues, and a program whose queue is full stays at its statement. Nothing here waits for the host but a reply to
 * COMMANDP of more than 2,048 characters; programs go on meanwhile, and a host that would rather send than read is not
 * kept waiting (host_port.c). */
#include "firmware/host/program_texts.h"

#include "firmware/base/error.h"
#include "firmware/command/command.h"
#include "firmware/command/control_characters.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
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
  program_output_initialize();
}

static bool is_here(enum program_port port) { return port == PORT_ACTIVE || port == PORT_PARALLEL; }

/* SEND ------------------------------------------------------------------------------------------------------------- */

static void send_text(const struct program_text* t) {
  if (!is_here((enum program_port)t->port)) return;
  const bool whole =
      t->control == 0 && (i_integer(I62_NO_CR_AFTER_SEND) == 0 || i_integer(I64_INTERNAL_REPLY_TAG) != 0);
  host_port_open_output();
  if (!whole) {
    for (uint32_t i = 0; i < t->length; i++) host_port_send((uint8_t)t->text[i]);
    return;
  }
  reply_to(REPLY_TO_PROGRAM);
  for (uint32_t i = 0; i < t->length; i++) reply_char(t->text[i]);
  reply_end_line();
  reply_to(REPLY_TO_HOST);
}

/* A ^X drops what has not been sent. */
static void forget_flushed(void) {
  if (flushes == host_port_flushes()) return;
  flushes = host_port_flushes();
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++) text_queue_empty(&send_queues[task]);
}

/* Room that a ^X has just made is not for what it drops. */
static bool has_room_for_text(void) {
  const bool has_room = host_port_room() >= ROOM_FOR_TEXT;
  forget_flushed();
  return has_room;
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
  const enum program_port port = (enum program_port)t->port;
  const bool is_return = t->control != 0 && t->text[0] == RETURN;
  error_t error = ERR_NONE;
  if (t->control == 0) add(text, t);
  session_begin_program(t->cs, t->motor);
  host_port_program_sends(true);
  host_port_open_output();
  reply_to(port == PORT_PARALLEL ? REPLY_TO_PROGRAM : REPLY_TO_NOBODY);
  if (is_return || (t->control == 0 && i_integer(I62_NO_CR_AFTER_SEND) == 0))
    error = execute(text);
  else if (t->control != 0)
    (void)control_character((uint8_t)t->text[0]);
  if (reply_line_is_open()) reply_end_line();
  reply_to(is_here(port) ? REPLY_TO_PROGRAM : REPLY_TO_NOBODY);
  if (error != ERR_NONE && host_port_room() >= ROOM_FOR_TEXT) reply_error(error);
  reply_to(REPLY_TO_HOST);
  host_port_program_sends(false);
  session_end_program();
}

/* What answers needs room for it. */
static bool may_execute(const struct text_queue* queue) {
  return !text_queue_is_empty(queue) &&
         (text_queue_next_port(queue) != PORT_PARALLEL || host_port_room() >= ROOM_FOR_REPLY);
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
    while (has_room_for_text() && text_queue_pop(&send_queues[task], &t)) send_text(&t);
    if (may_execute(&command_queues[task]) && text_queue_pop(&command_queues[task], &t))
      command(&command_texts[task], &t);
    if (may_execute(&command_queues[task])) background_wake();
  }
}
