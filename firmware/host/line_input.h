/* Host lines: characters become lines, lines become replies (firmware:6). */
#ifndef FIRMWARE_HOST_LINE_INPUT_H
#define FIRMWARE_HOST_LINE_INPUT_H

void line_input_initialize(void);
void line_input_text(
    void); /* background between passes: takes text that has come, so that less is left to do at its CR */
void line_input_urgent(void); /* real-time task: control characters that may not wait for the background */
void line_input_pass(void);   /* background: characters up to the end of one line */

#endif
