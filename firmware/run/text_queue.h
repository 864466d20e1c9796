/* A queue of texts from one task to the background. The producer owns the head, the background the tail; both run
 * freely and are reduced when used. */
#ifndef FIRMWARE_RUN_TEXT_QUEUE_H
#define FIRMWARE_RUN_TEXT_QUEUE_H

#include <stdbool.h>
#include <stdint.h>

enum { TEXT_LONGEST = 255, TEXT_QUEUE_BYTES = 1024 }; /* a power of two */

struct program_text {
  uint8_t port;      /* enum program_port */
  uint8_t cs, motor; /* addressed by the program, from 0 */
  uint8_t control;   /* 1: `^letter`, one control character and no text */
  uint8_t length;
  char text[TEXT_LONGEST];
};

struct text_queue {
  volatile uint32_t head, tail;
  uint8_t bytes[TEXT_QUEUE_BYTES];
};

void text_queue_empty(struct text_queue* queue);                              /* background */
bool text_queue_push(struct text_queue* queue, const struct program_text* t); /* false: no room */
bool text_queue_pop(struct text_queue* queue, struct program_text* t);        /* false: empty. Background */

static inline bool text_queue_is_empty(const struct text_queue* queue) { return queue->head == queue->tail; }

/* Of the next text, which there is. */
static inline uint8_t text_queue_next_port(const struct text_queue* queue) {
  return queue->bytes[queue->tail % TEXT_QUEUE_BYTES];
}

#endif
