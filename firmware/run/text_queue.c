#include "firmware/run/text_queue.h"

#include <stdatomic.h>

enum { HEADER = 5 };

void text_queue_empty(struct text_queue* queue) { queue->tail = queue->head; }

bool text_queue_push(struct text_queue* queue, const struct program_text* t) {
  const uint8_t header[HEADER] = {t->port, t->cs, t->motor, t->control, t->length};
  uint32_t head = queue->head;
  if (TEXT_QUEUE_BYTES - (head - queue->tail) < HEADER + (uint32_t)t->length) return false;
  for (uint32_t i = 0; i < HEADER; i++) queue->bytes[head++ % TEXT_QUEUE_BYTES] = header[i];
  for (uint32_t i = 0; i < t->length; i++) queue->bytes[head++ % TEXT_QUEUE_BYTES] = (uint8_t)t->text[i];
  atomic_signal_fence(memory_order_release);
  queue->head = head;
  return true;
}

bool text_queue_pop(struct text_queue* queue, struct program_text* t) {
  uint8_t header[HEADER];
  uint32_t tail = queue->tail;
  if (queue->head == tail) return false;
  atomic_signal_fence(memory_order_acquire);
  for (uint32_t i = 0; i < HEADER; i++) header[i] = queue->bytes[tail++ % TEXT_QUEUE_BYTES];
  t->port = header[0];
  t->cs = header[1];
  t->motor = header[2];
  t->control = header[3];
  t->length = header[4];
  for (uint32_t i = 0; i < t->length; i++) t->text[i] = (char)queue->bytes[tail++ % TEXT_QUEUE_BYTES];
  atomic_signal_fence(memory_order_release);
  queue->tail = tail;
  return true;
}
