/* `TODAY` answers `SAT 01/01/2000`, `TIME` 00:00:00; `TODAY=02/29/2028`, `TIME=17:45:24` and `TIME=08:30` set them. */
#include "firmware/command/calendar_commands.h"

#include <stdbool.h>
#include <stdint.h>

#include "firmware/command/reply.h"
#include "firmware/kernel/calendar.h"

enum { DAY = 86400, HOUR = 3600, MINUTE = 60, FIRST_YEAR = 2000, LAST_YEAR = 2099, WEEK = 7, FOUR_YEARS = 1461 };

static const char WEEKDAYS[WEEK][4] = {"SAT", "SUN", "MON", "TUE", "WED", "THU", "FRI"}; /* from 2000-01-01 on */

/* Every fourth year until 2099 is a leap year. */
static uint32_t days_in(uint32_t year, uint32_t month) {
  static const uint8_t DAYS[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2u && year % 4u == 0u ? 29u : DAYS[month - 1u];
}

static uint32_t first_day_of(uint32_t year) { return ((year - FIRST_YEAR) * FOUR_YEARS + 3u) / 4u; }

static void report_padded(uint32_t value, unsigned digits) {
  uint32_t unit = 1;
  for (unsigned i = 1; i < digits; ++i) unit *= 10u;
  for (; unit != 0u; unit /= 10u) reply_char((char)('0' + value / unit % 10u));
}

static void report_date(uint32_t day) {
  uint32_t year = FIRST_YEAR, month = 1;
  reply_text(WEEKDAYS[day % WEEK]);
  while (first_day_of(year + 1u) <= day) ++year;
  for (day -= first_day_of(year); day >= days_in(year, month); ++month) day -= days_in(year, month);
  reply_char(' ');
  report_padded(month, 2);
  reply_char('/');
  report_padded(day + 1u, 2);
  reply_char('/');
  report_padded(year, 4);
}

static void report_time(uint32_t second) {
  report_padded(second / HOUR, 2);
  reply_char(':');
  report_padded(second / MINUTE % 60u, 2);
  reply_char(':');
  report_padded(second % MINUTE, 2);
}

/* A number from `low` to `high`. */
static bool read_between(struct lexer* lx, int32_t low, int32_t high, uint32_t* number) {
  int32_t value;
  if (lexer_integer(lx, &value) != ERR_NONE || value < low || value > high) return false;
  *number = (uint32_t)value;
  return true;
}

static error_t set_date(struct lexer* lx) {
  uint32_t year, month, day;
  if (!read_between(lx, 1, 12, &month) || !lexer_accept(lx, '/') || !read_between(lx, 1, 31, &day) ||
      !lexer_accept(lx, '/') || !read_between(lx, FIRST_YEAR, LAST_YEAR, &year) || day > days_in(year, month))
    return ERR_DATA;
  uint32_t days = first_day_of(year) + day - 1u;
  while (--month != 0u) days += days_in(year, month);
  calendar_set(days * DAY + calendar_seconds() % DAY);
  return ERR_NONE;
}

static error_t set_time(struct lexer* lx) {
  uint32_t hour, minute, second = 0;
  if (!read_between(lx, 0, 23, &hour) || !lexer_accept(lx, ':') || !read_between(lx, 0, 59, &minute)) return ERR_DATA;
  if (lexer_accept(lx, ':') && !read_between(lx, 0, 59, &second)) return ERR_DATA;
  const uint32_t now = calendar_seconds();
  calendar_set(now - now % DAY + hour * HOUR + minute * MINUTE + second);
  return ERR_NONE;
}

static error_t today(struct lexer* lx) {
  if (lexer_accept(lx, '=')) return set_date(lx);
  report_date(calendar_seconds() / DAY);
  reply_end_line();
  return ERR_NONE;
}

static error_t time_of_day(struct lexer* lx) {
  if (lexer_accept(lx, '=')) return set_time(lx);
  report_time(calendar_seconds() % DAY);
  reply_end_line();
  return ERR_NONE;
}

const struct command_entry calendar_commands[] = {{"TODAY", today}, {"TIME", time_of_day}, {0, 0}};
