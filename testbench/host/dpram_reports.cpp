#include "testbench/host/dpram_reports.h"

#include <cmath>

#include "rtl/regs/dpram_map.h"

namespace brick {
namespace {

constexpr std::uint32_t kWord = 0xFFFFFF;

std::int32_t signed24(std::uint32_t word) { return static_cast<std::int32_t>(word << 8) >> 8; }

}  // namespace

std::uint32_t DpramReports::item(std::uint32_t offset) {
  const std::uint32_t low = ram_.read(offset);
  return low | static_cast<std::uint32_t>(ram_.read(offset + 2)) << 16;
}

// host-bus:6.1: low half first, 24 bits of each count.
std::int64_t DpramReports::fixed_long(std::uint32_t offset) {
  const std::uint32_t low = item(offset) & kWord;
  return std::int64_t{signed24(item(offset + 4))} * 0x1000000 + low;
}

double DpramReports::float_long(std::uint32_t offset) {
  const std::uint32_t low = item(offset) & kWord;
  const std::int64_t mantissa = std::int64_t{signed24(item(offset + 4))} * 4096 + (low >> 12);
  return std::ldexp(static_cast<double>(mantissa), static_cast<int>(low & 0xFFF) - 2047 - 35);
}

void DpramReports::clear_handshakes() {
  ram_.write(DPRAM_MOTOR_HOST_BUSY, 0);
  ram_.write(DPRAM_MOTOR_READY, 0);
  ram_.write(DPRAM_BACKGROUND_HOST_BUSY, 0);
  ram_.write(DPRAM_BACKGROUND_READY, 0);
}

void DpramReports::choose_motors(std::uint32_t mask) {
  mask_ = mask;
  ram_.write(DPRAM_MOTOR_MASK, static_cast<std::uint16_t>(mask));
  ram_.write(DPRAM_MOTOR_MASK + 2, static_cast<std::uint16_t>(mask >> 16));
}

void DpramReports::choose_systems(unsigned count) {
  count_ = count;
  ram_.write(DPRAM_BACKGROUND_COUNT, static_cast<std::uint16_t>(count));
}

bool DpramReports::begin(std::uint32_t busy, std::uint32_t ready, Tick timeout) {
  if (!heeds_) return true;
  const Tick begin = ram_.now(), limit = begin + timeout;
  ram_.write(busy, DPRAM_HOST_BUSY);
  while ((ram_.read(ready) & DPRAM_DATA_READY) == 0) {
    if (ram_.now() >= limit) {
      ram_.write(busy, 0);
      return false;
    }
    ram_.pause(begin, limit);
  }
  return true;
}

MotorReport DpramReports::motor(unsigned number) {
  const std::uint32_t at = DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_STRIDE * number;
  MotorReport m{};
  m.following_error = fixed_long(at + DPRAM_MOTOR_FOLLOWING_ERROR);
  m.output = signed24(item(at + DPRAM_MOTOR_OUTPUT));
  m.servo_status = item(at + DPRAM_MOTOR_SERVO_STATUS) & kWord;
  m.status = item(at + DPRAM_MOTOR_STATUS) & kWord;
  m.bias = fixed_long(at + DPRAM_MOTOR_BIAS);
  m.velocity = signed24(item(at + DPRAM_MOTOR_VELOCITY));
  m.master = fixed_long(at + DPRAM_MOTOR_MASTER);
  m.position = fixed_long(at + DPRAM_MOTOR_POSITION);
  return m;
}

std::optional<DpramReports::Motors> DpramReports::read_motors(Tick timeout) {
  if (!begin(DPRAM_MOTOR_HOST_BUSY, DPRAM_MOTOR_READY, timeout)) return std::nullopt;
  Motors set{ram_.read(DPRAM_MOTOR_TIMER), {}};
  set.timer |= static_cast<std::uint32_t>(ram_.read(DPRAM_MOTOR_READY) & DPRAM_TIMER_HIGH) << 16;
  for (unsigned number = 0; number < 32; ++number)
    if ((mask_ >> number & 1) != 0) set.motors.push_back(motor(number));
  ram_.write(DPRAM_MOTOR_HOST_BUSY, 0);
  return set;
}

SystemReport DpramReports::system(unsigned number) {
  const std::uint32_t at = DPRAM_CS_BLOCKS + DPRAM_CS_STRIDE * number;
  const auto word = [this, at](std::uint32_t offset) { return item(at + offset) & kWord; };
  SystemReport s{};
  s.feed_rate = float_long(at + DPRAM_CS_FEED_RATE);
  s.time_base = word(DPRAM_CS_TIME_BASE);
  s.time_base_source = word(DPRAM_CS_TIME_BASE_SOURCE);
  s.status[0] = word(DPRAM_CS_STATUS_1);
  s.status[1] = word(DPRAM_CS_STATUS_2);
  s.status[2] = word(DPRAM_CS_STATUS_3);
  for (unsigned axis = 0; axis < s.targets.size(); ++axis)
    s.targets[axis] = float_long(at + DPRAM_CS_TARGETS + 8 * axis);
  s.lines = word(DPRAM_CS_LINES);
  s.move_ms_left = word(DPRAM_CS_MOVE_TIME_LEFT);
  s.acceleration_ms_left = word(DPRAM_CS_ACCELERATION_TIME_LEFT);
  s.executing = word(DPRAM_CS_EXECUTING);
  return s;
}

std::optional<DpramReports::Systems> DpramReports::read_systems(Tick timeout) {
  if (!begin(DPRAM_BACKGROUND_HOST_BUSY, DPRAM_BACKGROUND_READY, timeout)) return std::nullopt;
  Systems set{ram_.read(DPRAM_BACKGROUND_TIMER), {}, {}};
  set.timer |= static_cast<std::uint32_t>(ram_.read(DPRAM_BACKGROUND_READY) & DPRAM_TIMER_HIGH) << 16;
  for (unsigned n = 0; n < 2; ++n) set.global[n] = item(DPRAM_GLOBAL_STATUS + 4 * n) & kWord;
  for (unsigned number = 0; number < count_; ++number) set.systems.push_back(system(number));
  ram_.write(DPRAM_BACKGROUND_HOST_BUSY, 0);
  return set;
}

}  // namespace brick
