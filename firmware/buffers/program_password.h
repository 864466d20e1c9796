/* The password of programs (firmware:5.10/7): until it has been entered, PROG 1000 to 32767, PLC 0 to 15 and kinematic
 * programs are neither opened nor listed. No password, no protection. Background task. */
#ifndef FIRMWARE_BUFFERS_PROGRAM_PASSWORD_H
#define FIRMWARE_BUFFERS_PROGRAM_PASSWORD_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/buffers/fixed_programs.h"

enum { PASSWORD_LENGTH = 248 }; /* a host line has no room for more */

void program_password_initialize(void); /* none */
/* `PASSWORD=`: a new one, if the present one has been entered or there is none; else this has to be it (ERR002). */
error_t program_password_enter(const char* text, uint32_t length);
bool program_password_protects(enum fixed_kind kind, uint32_t number); /* it has yet to be entered */

/* SAVE and start-up. What is restored has to be entered again. */
uint32_t program_password(const char** text); /* its length */
void program_password_restore(const char* text, uint32_t length);

#endif
