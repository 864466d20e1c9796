/* Status and identification queries (firmware:5). */
#include "firmware/command/report_commands.h"

#include "firmware/base/status.h"
#include "firmware/command/motor_report.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/image_checksum.h"
#include "firmware/motion/motion_status.h"

enum { WORD_DIGITS = 6 };

static error_t text(const char* line) {
  reply_text(line);
  reply_end_line();
  return ERR_NONE;
}

static error_t number(int64_t value) {
  reply_integer(value);
  reply_end_line();
  return ERR_NONE;
}

static error_t motor(void (*report)(uint32_t motor)) {
  report(session.motor);
  reply_end_line();
  return ERR_NONE;
}

static error_t motor_status(struct lexer* lx) {
  (void)lx;
  return motor(motor_report_status);
}

static error_t cs_status(struct lexer* lx) {
  (void)lx;
  for (unsigned word = 0; word < 3u; ++word) reply_hex(motion_cs_status(session.cs, word), WORD_DIGITS);
  reply_end_line();
  return ERR_NONE;
}

static error_t global_status(struct lexer* lx) {
  (void)lx;
  reply_hex(status_word(), WORD_DIGITS);
  reply_hex(motion_global_status2(), WORD_DIGITS);
  reply_end_line();
  return ERR_NONE;
}

static error_t position(struct lexer* lx) {
  (void)lx;
  return motor(motor_report_position);
}

static error_t velocity(struct lexer* lx) {
  (void)lx;
  return motor(motor_report_velocity);
}

static error_t following_error(struct lexer* lx) {
  (void)lx;
  return motor(motor_report_following_error);
}

static error_t version(struct lexer* lx) {
  (void)lx;
  return text("1.947");
}

static error_t type(struct lexer* lx) {
  (void)lx;
  const uint32_t product = hal_strap(HAL_STRAP_PRODUCT);
  if ((product & HAL_PRODUCT_TURBO_PMAC_1) != 0u) return text("TURBO1, X4");
  if ((product & HAL_PRODUCT_ULTRALITE) != 0u) return text("TURBOU, X4");
  return text("TURBO2, X4");
}

static error_t card(struct lexer* lx) {
  (void)lx;
  return number((int64_t)hal_strap(HAL_STRAP_CARD));
}

static error_t cpu(struct lexer* lx) {
  (void)lx;
  return text("DSP56321");
}

static error_t vendor(struct lexer* lx) {
  (void)lx;
  return text("1");
}

static error_t date(struct lexer* lx) {
  (void)lx;
  return text("07/01/2014");
}

/* Of 1.947: no digit of its own, Turbo PMAC2. */
static error_t extended_version(struct lexer* lx) {
  (void)lx;
  return text("1947001");
}

static error_t serial_number(struct lexer* lx) {
  (void)lx;
  reply_hex(0, 4);
  reply_hex(hal_strap(HAL_STRAP_CARD), 8);
  reply_end_line();
  return ERR_NONE;
}

static error_t id_number(struct lexer* lx) {
  (void)lx;
  reply_hex(0, 8);
  reply_hex(hal_strap(HAL_STRAP_CARD), 8);
  reply_end_line();
  return ERR_NONE;
}

static error_t checksum(struct lexer* lx) {
  (void)lx;
  reply_hex(image_checksum(), 0);
  reply_end_line();
  return ERR_NONE;
}

const struct command_entry report_commands[] = {
    {"???", global_status},
    {"??", cs_status},
    {"?", motor_status},
    {"P", position},
    {"V", velocity},
    {"F", following_error},
    {"VERSION", version},
    {"VER", version},
    {"TYPE", type},
    {"CID", card},
    {"CPU", cpu},
    {"VID", vendor},
    {"DATE", date},
    {"DAT", date},
    {"EAVERSION", extended_version},
    {"EAVER", extended_version},
    {"SID", serial_number},
    {"IDNUMBER", id_number},
    {"CHECKSUM", checksum},
    {"CHKS", checksum},
    {0, 0},
};
