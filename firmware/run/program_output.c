#include "firmware/run/program_output.h"

#include "firmware/kernel/background.h"
#include "firmware/language/statement_argument.h"
#include "firmware/language/statement_key.h"
#include "firmware/run/display.h"

enum { PORTS = PORT_AUXILIARY + 1 };

struct text_queue send_queues[PROGRAM_TASKS], command_queues[PROGRAM_TASKS];

void program_output_initialize(void) {
  for (uint32_t task = 0; task < PROGRAM_TASKS; task++) {
    text_queue_empty(&send_queues[task]);
    text_queue_empty(&command_queues[task]);
  }
  display_initialize();
}

static void unpack(const struct instruction* in, const word48_t* raw, struct program_text* t) {
  t->length = (uint8_t)(in->number & TEXT_LENGTH);
  for (uint32_t i = 0; i < t->length; i++)
    t->text[i] = (char)(raw[i / WORD_TEXT_CHARACTERS] >> (8u * (i % WORD_TEXT_CHARACTERS)));
}

enum program_output program_output_text(const struct instruction* in, const word48_t* raw,
                                        const struct program_caller* caller) {
  struct program_text t;
  unpack(in, raw, &t);
  if (in->group == KEY_DISPLAY) {
    const uint32_t column = (in->number >> TEXT_COLUMN_BIT) & 0xFFu;
    display_text(column == 0 ? 0 : column - 1u, t.text, t.length);
    return OUTPUT_DONE;
  }
  const bool sends = in->group - KEY_SEND < PORTS;
  if (!sends && in->group - KEY_COMMAND >= PORTS) return OUTPUT_ILLEGAL;
  t.port = (uint8_t)(in->group - (sends ? KEY_SEND : KEY_COMMAND));
  t.cs = (uint8_t)caller->cs;
  t.motor = (uint8_t)caller->motor;
  const uint32_t letter = (in->number >> TEXT_CONTROL_BIT) & 0xFFu;
  t.control = letter != 0;
  if (t.control != 0) {
    t.length = 1;
    t.text[0] = (char)(letter & 0x1Fu);
  }
  struct text_queue* queue = sends ? &send_queues[caller->task] : &command_queues[caller->task];
  if (!text_queue_push(queue, &t)) return OUTPUT_LATER;
  background_wake();
  return OUTPUT_DONE;
}

void program_output_value(const struct instruction* in, double value) {
  display_value(in->number & 0xFFu, (in->number >> DISPLAY_WIDTH_BIT) & 0xFFu, in->number >> DISPLAY_DECIMALS_BIT,
                value);
}
