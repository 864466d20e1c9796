/* The background task. */
#ifndef FIRMWARE_IMAGE_BACKGROUND_PASS_H
#define FIRMWARE_IMAGE_BACKGROUND_PASS_H

void background_pass(void); /* housekeeping and one command line */

#endif
