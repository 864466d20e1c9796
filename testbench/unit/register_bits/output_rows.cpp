// Output commands as PWM, DAC and PFM show them, and the words of the ADCs.
#include <algorithm>

#include "testbench/unit/register_bits/bits_stimulus.h"

namespace brick {
namespace {

constexpr unsigned kMaxCount = 20;
constexpr Tick kPeriod = 4 * kMaxCount + 6;

// Ticks a period for which the top switch is on without dead time (servo-ic:5.11).
Tick on_time(int command) {
  const int top = static_cast<int>(kMaxCount) + 1;
  if (command < -top) return 0;
  return command > top ? kPeriod : 2 * command + 2 * static_cast<int>(kMaxCount) + 3;
}

bool pwm_command(BitsRig& rig, unsigned ch, unsigned output, unsigned bit) {
  start_triangle(rig, pwm_control(kMaxCount, 0));
  for (bool level : {false, true}) {
    const std::uint32_t word = level ? 1u << bit : 0;
    rig.write(false, base(ch) + 2 + output, word);
    rig.run(2 * kPeriod);
    Tick on = 0;
    for (Tick t = 0; t < kPeriod; ++t) {
      rig.tick();
      on += rig.pwm(ch) >> (2 * output) & 1;
    }
    if (on != on_time(static_cast<std::int16_t>(word >> 8))) return false;
  }
  return true;
}

bool dac_command(BitsRig& rig, unsigned ch, unsigned output, unsigned bit) {
  rig.start();
  rig.write(ch, words::kControl, kDac);
  for (bool level : {false, true}) {
    const std::uint32_t word = level ? 1u << bit : 0xFFFFC0 & ~(1u << bit);
    rig.write(false, base(ch) + 2 + output, word);
    const std::uint32_t sent = receive(rig, kDacClkPin, [&] { return rig.other(output == 0 ? kDacA : kDacB, ch); });
    if ((sent >> bit & 1) != (level ? 1u : 0u)) return false;
  }
  return true;
}

// A pulse of command -1 leaves the accumulator one or two short of an overflow, so any bit above 0 makes a pulse soon,
// bit 23 by going down, and none does not.
bool pfm_command(BitsRig& rig, unsigned ch, unsigned bit) {
  constexpr Tick kSoon = 40;
  for (bool level : {false, true}) {
    rig.start();
    pfm_pulse(rig, ch, 100);
    rig.write(ch, words::kOutC, level ? 1u << bit : 0);
    const bool pulse = rig.until(kSoon, [&] { return rig.other(kPulse, ch); }) < kSoon;
    if (pulse != level || (level && rig.other(kDir, ch) != (bit == 23))) return false;
  }
  return true;
}

// Sends 24 bits on both ADC lines: 4 of header, 18 of value, 2 more. The line changes when the clock falls.
bool adc_value(BitsRig& rig, unsigned ch, unsigned converter, unsigned bit) {
  rig.start(BitsRig::kFast | 1 << 9);
  for (bool level : {true, false}) {
    const std::uint32_t value = bit < 6 ? 0x3FFFF : (level ? 1u << (bit - 6) : 0x3FFFF & ~(1u << (bit - 6)));
    const std::uint32_t stream = value << 2 | 0xF00003;
    rig.in.phase = false;
    rig.run(12);
    rig.in.phase = true;
    unsigned sent = 0;
    bool last = false;
    for (int t = 0; t < 24 * 6 + 30; ++t) {
      const bool line = (stream >> (23 - std::min(sent, 23u)) & 1) != 0;
      (converter == 0 ? rig.in.adc_a : rig.in.adc_b) = (line ? 1u : 0u) << (ch - 1);
      rig.tick();
      const bool now = (rig.pins().serial & kAdcClkPin) != 0;
      if (last && !now) ++sent;
      last = now;
    }
    rig.in.phase = false;
    rig.run(12);
    if (sent != 24 || rig.bit(false, base(ch) + 5 + converter, bit) != (bit >= 6 && level)) return false;
  }
  return true;
}

}  // namespace

void add_output_rows(BitTable& table) {
  const char* const names[] = {"OUT A", "OUT B", "OUT C"};
  for (unsigned output = 0; output < 3; ++output) {
    const auto add = [&](const char* use, unsigned bit, std::function<bool(BitsRig&, unsigned)> check) {
      table.push_back(
          {std::string(names[output]) + use, Side::kWritten, false, 2 + output, bit, false, false, std::move(check)});
    };
    for (unsigned bit = 8; bit < 24; ++bit)
      add(" PWM", bit, [=](BitsRig& rig, unsigned ch) { return pwm_command(rig, ch, output, bit); });
    for (unsigned bit = 6; bit < 24 && output < 2; ++bit)
      add(" DAC", bit, [=](BitsRig& rig, unsigned ch) { return dac_command(rig, ch, output, bit); });
    for (unsigned bit = 0; bit < 24 && output == 2; ++bit)
      add(" PFM", bit, [=](BitsRig& rig, unsigned ch) { return pfm_command(rig, ch, bit); });
    add_read_back(table, names[output], false, 2 + output, false, 0xFFFFFF);
  }
  for (unsigned converter = 0; converter < 2; ++converter)
    for (unsigned bit = 0; bit < 24; ++bit)
      table.push_back({converter == 0 ? "ADC A" : "ADC B", Side::kRead, false, 5 + converter, bit, false, bit < 6,
                       [=](BitsRig& rig, unsigned ch) { return adc_value(rig, ch, converter, bit); }});
}

}  // namespace brick
