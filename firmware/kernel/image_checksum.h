/* Checksum of the image: the sum of the words of code and constants, 24 bits (firmware:5.1). The image has some thirty
 * thousand words, so the background adds them up in pieces after each start. */
#ifndef FIRMWARE_KERNEL_IMAGE_CHECKSUM_H
#define FIRMWARE_KERNEL_IMAGE_CHECKSUM_H

#include <stdint.h>

void image_checksum_pass(void); /* background: the next piece, unless the host is at a line */
uint32_t image_checksum(void);  /* background: what is left is added at once */

#endif
