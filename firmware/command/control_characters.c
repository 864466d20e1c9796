/* Control characters: run control of all coordinate systems at once, and the reports of eight motors. Background
 * task; those that stop things in the real-time task too. */
#include "firmware/command/control_characters.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/status.h"
#include "firmware/buffers/gather.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/command/command.h"
#include "firmware/command/motor_report.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/motion/motion_status.h"
#include "firmware/run/motor_stops.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"

enum {
  ABORT_ALL = 0x01,
  MOTOR_STATUS = 0x02,
  CS_STATUS = 0x03,
  DISABLE_PLCS = 0x04,
  GATHER_SOURCES = 0x05,
  FOLLOWING_ERRORS = 0x06,
  GLOBAL_STATUS = 0x07,
  KILL_ALL = 0x0B,
  CLOSE_ROTARIES = 0x0C,
  HOLD_ALL = 0x0F,
  POSITIONS = 0x10,
  QUIT_ALL = 0x11,
  RUN_ALL = 0x12,
  STEP_ALL = 0x13,
  OPEN_ROTARIES = 0x15,
  VELOCITIES = 0x16,
  GROUP = 8
};

static void report_motors(void (*report)(uint32_t motor)) {
  const uint32_t first = session.motor_group * GROUP;
  for (uint32_t motor = first; motor < first + GROUP; ++motor) {
    if (motor != first) reply_char(' ');
    report(motor);
  }
  reply_end_line();
}

static void report_cs_status(void) {
  const uint32_t active = (uint32_t)i_integer(I68_ACTIVE_COORDINATE_SYSTEMS) + 1u;
  for (uint32_t cs = 0; cs < active; ++cs) {
    if (cs != 0u) reply_char(' ');
    for (unsigned word = 0; word < 3u; ++word) reply_hex(motion_cs_status(cs, word), 6);
  }
  reply_end_line();
}

static void run_all(bool single_step) {
  for (uint32_t cs = 0; cs <= (uint32_t)i_integer(I68_ACTIVE_COORDINATE_SYSTEMS); ++cs)
    (void)run_start(cs, single_step);
}

/* What stops things also stops the coordinate systems that I68 has put out of reach. */
static void all(void (*action)(uint32_t cs)) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; ++cs) action(cs);
}

bool control_character(uint8_t c) {
  switch (c) {
    case ABORT_ALL:
      motors_abort_all();
      return false;
    case KILL_ALL:
      motors_kill_all();
      return false;
    case HOLD_ALL:
      all(run_hold);
      return false;
    case QUIT_ALL:
      all(run_quit);
      return false;
    case RUN_ALL:
      run_all(false);
      return false;
    case STEP_ALL:
      run_all(true);
      return false;
    case OPEN_ROTARIES:
      (void)command_line("OPEN ROT");
      return false;
    case CLOSE_ROTARIES: /* no other buffer */
      if (open_buffer_kind() == OPEN_ROTARY || open_buffer_kind() == OPEN_BINARY_ROTARY) (void)command_line("CLOSE");
      return false;
    case DISABLE_PLCS:
      plc_disable(0xFFFFFFFFu);
      return false;
    case MOTOR_STATUS:
      report_motors(motor_report_status);
      return true;
    case FOLLOWING_ERRORS:
      report_motors(motor_report_following_error);
      return true;
    case POSITIONS:
      report_motors(motor_report_position);
      return true;
    case VELOCITIES:
      report_motors(motor_report_velocity);
      return true;
    case GATHER_SOURCES:
      gather_report_sources(reply_byte);
      if (reply_line_is_open()) reply_end_line(); /* at the port that takes lines */
      return true;
    case CS_STATUS:
      report_cs_status();
      return true;
    case GLOBAL_STATUS:
      reply_hex(status_word(), 6);
      reply_hex(motion_global_status2(), 6);
      reply_end_line();
      return true;
    default:
      return false; /* the rest has no meaning on this port */
  }
}
