/* The const tables that join the layers: what lower layers call in higher ones. Nothing is registered at run time. */
#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/gather.h"
#include "firmware/command/buffer_commands.h"
#include "firmware/command/calendar_commands.h"
#include "firmware/command/command.h"
#include "firmware/command/gather_commands.h"
#include "firmware/command/list_commands.h"
#include "firmware/command/lock_commands.h"
#include "firmware/command/memory_commands.h"
#include "firmware/command/motor_commands.h"
#include "firmware/command/phase_commands.h"
#include "firmware/command/plc_commands.h"
#include "firmware/command/program_commands.h"
#include "firmware/command/reply.h"
#include "firmware/command/report_commands.h"
#include "firmware/host/dpram_functions.h"
#include "firmware/host/dpram_responses.h"
#include "firmware/host/host_port.h"
#include "firmware/host/panel.h"
#include "firmware/image/background_pass.h"
#include "firmware/image/real_time.h"
#include "firmware/image/system_commands.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/conversion_table.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/kinematics.h"
#include "firmware/motion/live_words.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_variables.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/phase_task.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/servo_update.h"
#include "firmware/motion/time_base.h"
#include "firmware/run/kinematic_program.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_table.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/phase_period.h"
#include "firmware/variables/words.h"

void (*const mathematics_pause)(void) = slice_pause;

static void servo(void) {
  servo_update();
  if (phasing_searched != 0u) phasing_servo();
  gather_servo();
  dpram_functions_servo();
  host_port_reserve();
}

const struct task_hooks task_hooks = {.servo = servo, .real_time = real_time, .phase_period = phase_period};

const struct word_hooks word_hooks = {
    .end = MEMORY_M_DEFINITIONS, .read = live_word_read, .write = live_word_write, .write_long = live_word_write_long};

enum run_time_error (*const kinematics_execute)(uint32_t cs, enum fixed_kind kind) = kinematic_program_execute;

const struct protection_hooks protection_hooks = {.abort = run_abort};
const struct jog_hooks jog_hooks = {.is_in_limit = protection_is_in_limit, .refuse = protection_refuse};

static void buffer_request_changed(uint32_t instance) {
  (void)instance;
  panel_changed();
  buffer_request_evaluate();
}

/* What servo and phase task calculate with, in integers. Motor 1..32. Without a phase reference no loop stays closed.
 */
static void phase_changed(uint32_t motor) {
  phase_task_motor_changed(motor);
  if (motors[motor - 1u].loop == LOOP_CLOSED && phasing_is_missing(motor - 1u)) protection_kill(motor - 1u);
}

static void motor_changed(uint32_t motor) {
  phase_changed(motor);
  motor_variables_changed(motor);
}

static void compensation_tables_changed(uint32_t instance) {
  (void)instance;
  compensation_changed();
}

const i_effect_t i_effects[I_FIELD_COUNT] = {
    [I_FIELD_LOOKAHEAD] = run_by_state,
    [I_FIELD_TIME_BASE] = time_base_source_changed,
    [I_FIELD_TIME_BASE_SLEW] = time_base_slew_changed,
    [I_FIELD_BUFFER_REQUEST] = buffer_request_changed,
    [I_FIELD_DPRAM] = dpram_functions_changed,
    [I_FIELD_DPRAM_BASE] = dpram_functions_changed,
    [I_FIELD_MOTOR_ACTIVE] = motor_changed,
    [I_FIELD_MOTOR_COMMUTATION] = motor_changed,
    [I_FIELD_MOTOR_OUTPUT] = motor_changed,
    [I_FIELD_MOTOR_FEEDBACK] = motor_variables_changed,
    [I_FIELD_MOTOR_FLAGS] = motor_variables_changed,
    [I_FIELD_MOTOR_FLAG_MODE] = motor_changed,
    [I_FIELD_MOTOR_PHASE] = phase_changed,
    [I_FIELD_VELOCITY_SAMPLES] = average_velocity_changed,
    [I_FIELD_COMPENSATION] = compensation_tables_changed,
    [I_FIELD_CONVERSION] = conversion_table_changed,
    [I_FIELD_MOTOR_SERVO] = motor_variables_changed,
    [I_FIELD_MOTOR_CURRENT] = phase_changed,
    [I_FIELD_MOTOR_BOTH] = motor_changed,
};

const struct command_entry* const command_tables[] = {report_commands,
                                                      system_commands,
                                                      memory_commands,
                                                      calendar_commands,
                                                      buffer_commands,
                                                      list_commands,
                                                      plc_commands,
                                                      lock_commands,
                                                      motor_commands,
                                                      phase_commands,
                                                      program_commands,
                                                      gather_commands,
                                                      0};

void (*const reply_sink)(uint8_t c) = host_port_send;

const struct reply_lines reply_lines = {.put = dpram_responses_put, .end = dpram_responses_end};

void (*const host_port_meanwhile)(void) = background_meanwhile;
void (*const reply_between_lines)(void) = background_between_lines;
