/* CRC-32 as Ethernet has it (IEEE 802.3: polynomial $04C11DB7, low bit first, begun and ended inverted) over words of
 * 32 bits, low byte first. */
#ifndef FIRMWARE_BASE_CRC32_H
#define FIRMWARE_BASE_CRC32_H

#include <stdint.h>

#define CRC32_BEGIN 0xFFFFFFFFu /* the sum of no words; what is sent or kept is the complement of a sum */

void crc32_initialize(void); /* before any sum: makes the table, 0.1 ms */
uint32_t crc32_add(uint32_t sum, uint32_t word);
uint32_t crc32_words(uint32_t sum, const uint32_t* words, uint32_t count);

#endif
