#include "firmware/host/dpram_report.h"

#include "firmware/base/dpram.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/dpram_use.h"

static uint32_t ready_offset(const struct dpram_report* report) { return report->timer + DPRAM_WORD_BYTES; }

void dpram_report_initialize(struct dpram_report* report) {
  report->is_on = report->writes = false;
  report->ready = 0;
}

void dpram_report_off(struct dpram_report* report) {
  if (dpram_is_used()) dpram_write(ready_offset(report), report->ready & DPRAM_TIMER_HIGH);
  dpram_report_initialize(report);
}

/* False while the host reads: what is ready stays ready. */
static bool begin(struct dpram_report* report, uint32_t now) {
  dpram_write(ready_offset(report), report->ready & DPRAM_TIMER_HIGH);
  if ((dpram_read(report->busy) & DPRAM_HOST_BUSY) != 0u) {
    dpram_write(ready_offset(report), report->ready);
    return false;
  }
  report->began = now;
  report->writes = true;
  return true;
}

bool dpram_report_is_due(struct dpram_report* report, int32_t period) {
  const uint32_t now = tasks_servo_count();
  if (period == 0 || !dpram_is_used()) {
    if (report->is_on) dpram_report_off(report);
    return false;
  }
  if (report->writes) return true;
  if (report->is_on && now - report->began < (uint32_t)period) return false;
  report->is_on = true;
  return begin(report, now);
}

void dpram_report_end(struct dpram_report* report) {
  report->writes = false;
  report->ready = DPRAM_DATA_READY | (report->began >> 16 & DPRAM_TIMER_HIGH);
  dpram_write(report->timer, report->began);
  dpram_write(ready_offset(report), report->ready);
}

void dpram_put_word(uint32_t offset, uint32_t word) { dpram_write_item(offset, (uint32_t)hal_signed(word)); }

void dpram_put_long(uint32_t offset, uint32_t x, uint32_t y) {
  dpram_put_word(offset, y);
  dpram_put_word(offset + DPRAM_ITEM_BYTES, x);
}
