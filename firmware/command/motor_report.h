/* Status, position, velocity and following error of a motor (0..31) as text, from its registers in user memory. */
#ifndef FIRMWARE_COMMAND_MOTOR_REPORT_H
#define FIRMWARE_COMMAND_MOTOR_REPORT_H

#include <stdint.h>

void motor_report_status(uint32_t motor);
void motor_report_position(uint32_t motor);
void motor_report_velocity(uint32_t motor);
void motor_report_following_error(uint32_t motor);

#endif
