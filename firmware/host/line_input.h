/* Host lines: characters become lines, lines become replies (firmware:6). */
#ifndef FIRMWARE_HOST_LINE_INPUT_H
#define FIRMWARE_HOST_LINE_INPUT_H

void line_input_initialize(void);
void line_input_text(void);   /* background between passes: takes and compiles text that has come, before its CR */
void line_input_urgent(void); /* real-time task: control characters that may not wait for the background */
void line_input_pass(void);   /* background: characters up to the end of one line */

/* The line that is executed, from `at` on, before letters were made capital. What is not of a host line is itself. */
const char* line_input_as_typed(const char* at);

#endif
