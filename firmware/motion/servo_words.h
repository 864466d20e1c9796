/* Registers of the servo loop in the words of a motor (motion:1.3, firmware:1.10): variables that stand there too,
 * positions that belong to the servo task. Called for words that motion/live_words.h makes. */
#ifndef FIRMWARE_MOTION_SERVO_WORDS_H
#define FIRMWARE_MOTION_SERVO_WORDS_H

#include <stdbool.h>
#include <stdint.h>

/* Background, real-time task: the variables of motor 1..32 into their words. */
void servo_words_motor_changed(uint32_t motor);

/* Motor 0..31, offset in its words. Which halves were made, bit 0 X, bit 1 Y; 0: an ordinary word. */
unsigned servo_word_read(uint32_t motor, uint32_t offset, uint32_t* x, uint32_t* y);
/* Bits of `mask` of one that was made: the variable is assigned, a position set, anything else stays. */
void servo_word_write(uint32_t motor, uint32_t offset, bool x, uint32_t mask, uint32_t bits);
void servo_word_write_output(uint32_t motor, uint32_t mask, uint32_t bits); /* X:+$3F: what an open loop puts out */
bool servo_word_write_long(uint32_t motor, uint32_t offset, uint32_t x, uint32_t y); /* false: no position */

#endif
