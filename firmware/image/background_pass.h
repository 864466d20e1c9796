/* The background task. */
#ifndef FIRMWARE_IMAGE_BACKGROUND_PASS_H
#define FIRMWARE_IMAGE_BACKGROUND_PASS_H

void background_pass(void);          /* one command line, what programs send, and ... */
void background_meanwhile(void);     /* ... the rest, which goes on while a reply waits for the host */
void background_between_lines(void); /* the same now and then while a long reply does not wait */

#endif
