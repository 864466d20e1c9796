/* Start-up and SAVE of the controller. Background task. */
#ifndef FIRMWARE_IMAGE_START_H
#define FIRMWARE_IMAGE_START_H

enum start_mode { START_SAVED, START_DEFAULTS };
void start(enum start_mode mode); /* power-up, $$$ and $$$*** */
void start_save(void);            /* SAVE */

#endif
