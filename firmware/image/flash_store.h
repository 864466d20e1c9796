/* The flash store as two slots of one image each: a new image goes to the slot that does not hold the present one and
 * counts from its last word on, so that power may go at any word. An image has two parts, each with a CRC-32: the first
 * is checked when the image is found, the second later, because the start-up has no time for all of it before the
 * clocks run. Layout and guarantee: docs/save.md. Background task. */
#ifndef FIRMWARE_IMAGE_FLASH_STORE_H
#define FIRMWARE_IMAGE_FLASH_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/hal/hal.h"

enum { FLASH_SLOTS = 2, FLASH_SLOT_WORDS = HAL_FLASH_BYTES / 4 / FLASH_SLOTS, FLASH_PARTS = 2 };

/* First words of a slot; its data follow. */
enum {
  FLASH_WORD_STATE,        /* FLASH_BLANK, FLASH_WHOLE, FLASH_OUTDATED */
  FLASH_WORD_FIRST_CRC,    /* of the first part, then of the four words that follow here */
  FLASH_WORD_SEQUENCE,     /* one more than that of the image before */
  FLASH_WORD_FIRST_WORDS,  /* of the first part */
  FLASH_WORD_SECOND_WORDS, /* of the second part */
  FLASH_WORD_SECOND_CRC,   /* of the second part */
  FLASH_WORD_DATA
};
enum { FLASH_CAPACITY = FLASH_SLOT_WORDS - FLASH_WORD_DATA };
enum { FLASH_FIRST_CAPACITY = 4096 }; /* of the first part: checked in 2 ms */

#define FLASH_BLANK 0xFFFFFFFFu /* as erased: an image is being written, or none ever was */
#define FLASH_WHOLE 0x42524B35u /* the layout above, and that of the data */
#define FLASH_OUTDATED 0u       /* there is a newer one */

struct flash_image {
  const uint32_t* part[FLASH_PARTS];
  uint32_t words[FLASH_PARTS];
  uint32_t second_crc;
};

typedef enum { FLASH_STORE_EMPTY, FLASH_STORE_FOUND, FLASH_STORE_DAMAGED } flash_store_t;

flash_store_t flash_store_find(struct flash_image* image); /* FOUND: header and first part of the newest are whole */
bool flash_store_second_is_whole(const struct flash_image* image); /* may take 50 ms: strobes the hardware watchdog */

/* A new image: words of the first part, then those of the second, FLASH_CAPACITY in all. */
void flash_store_begin(void);
void flash_store_put(uint32_t word);
void flash_store_second_part(void);
void flash_store_commit(void);

#endif
