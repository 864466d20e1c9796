// Date and time: every month of every year that the calendar has, by Zeller's congruence and the rule of leap years
// (firmware:5.1/18, firmware:5.1/19).
#include <array>
#include <cstdio>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;

constexpr int kFirstYear = 2000, kLastYear = 2099;

// 30 days have September, April, June and November.
int days_in(int month, int year) {
  if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

// Zeller: 0 is Saturday; January and February count to the year before.
std::string date(int month, int day, int year) {
  static const std::array<const char*, 7> names = {"SAT", "SUN", "MON", "TUE", "WED", "THU", "FRI"};
  const int m = month < 3 ? month + 12 : month, y = month < 3 ? year - 1 : year;
  const int h = (day + 13 * (m + 1) / 5 + y % 100 + y % 100 / 4 + y / 100 / 4 + 5 * (y / 100)) % 7;
  char text[32];
  std::snprintf(text, sizeof text, "%s %02d/%02d/%04d", names.at(static_cast<unsigned>(h)), month, day, year);
  return text;
}

std::string set(int month, int day, int year) {
  return "TODAY=" + std::to_string(month) + "/" + std::to_string(day) + "/" + std::to_string(year);
}

class Calendar : public FirmwareTest {
 protected:
  static void second() { fake_hal_pass(78643000); }  // 1000 hal_cycles_per_ms
};

TEST_F(Calendar, EachMonthOfEachYearEndsWithItsLastDay) {
  for (int year = kFirstYear; year <= kLastYear; ++year)
    for (int month = 1; month <= 12; ++month) {
      const int last = days_in(month, year);
      ASSERT_EQ(host(set(month, last, year) + " TIME=23:59:59 TODAY"), date(month, last, year));
      second();
      const bool ends = month == 12;
      ASSERT_EQ(host("TODAY TIME"), date(ends ? 1 : month + 1, 1, ends ? year + 1 : year) + "|00:00:00");
      ASSERT_EQ(host(set(month, last + 1, year)), "ERR003") << date(month, last, year);
      ASSERT_EQ(host(set(month, 0, year)), "ERR003");
    }
}

TEST_F(Calendar, EachDayOfALeapYearAndOfAnotherIsKept) {
  for (const int year : {2000, 2026, 2028, 2099})
    for (int month = 1; month <= 12; ++month)
      for (int day = 1; day <= days_in(month, year); ++day)
        ASSERT_EQ(host(set(month, day, year) + " TODAY"), date(month, day, year));
}

TEST_F(Calendar, EachHourAndMinuteAndSecondEnds) {
  for (int hour = 0; hour < 24; ++hour)
    for (const int minute : {0, 29, 59}) {
      char text[32], next[32];
      std::snprintf(text, sizeof text, "%02d:%02d:59", hour, minute);
      std::snprintf(next, sizeof next, "%02d:%02d:00", minute == 59 ? (hour + 1) % 24 : hour, (minute + 1) % 60);
      ASSERT_EQ(host(std::string("TIME=") + text + " TIME"), text);
      second();
      ASSERT_EQ(host("TIME"), next);
    }
}

}  // namespace
