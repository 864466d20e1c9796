// The four registers of the IC: clock control, DAC and ADC strobe, PWM control.
#include <algorithm>
#include <cstdlib>

#include "testbench/unit/register_bits/bits_stimulus.h"

namespace brick {
namespace {

using Check = std::function<bool(BitsRig&, unsigned)>;
constexpr unsigned kClock = 0x04, kDacStrobe = 0x0C, kAdcStrobe = 0x14, kPwm = 0x1C;  // by the data sheet

// --- Clock control: dividers n with a 0 and a 1 in the bit under test.

// SCLK periods in 960 ticks, as T2 counts them.
Check sclk_divider(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    const auto t2 = [&] {
      rig.in.servo = false;
      rig.run(12);
      const std::uint32_t word = rig.peek(ch, words::kTimer2);
      rig.in.servo = true;
      return static_cast<int>(word);
    };
    for (unsigned n : {0u, 1u << bit}) {
      rig.start(BitsRig::kFast | n);
      const int before = t2();
      rig.run(960 - 12);
      if (std::abs(t2() - before - (320 >> n)) > 1) return false;
    }
    return true;
  };
}

// The pulse is 15 PFM_CLK wide.
Check pfm_divider(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    for (unsigned n : {0u, 1u << bit}) {
      rig.start(BitsRig::kFast | n << 3);
      if (pfm_pulse(rig, ch, 1000) != 15 * (3 << n)) return false;
    }
    return true;
  };
}

Check serial_divider(unsigned bit, unsigned position, unsigned clock) {
  return [=](BitsRig& rig, unsigned) {
    const auto rise = [&] {
      rig.until(200, [&] { return (rig.pins().serial & clock) == 0; });
      rig.until(200, [&] { return (rig.pins().serial & clock) != 0; });
      return rig.now();
    };
    for (unsigned n : {0u, 1u << bit}) {
      rig.start(BitsRig::kFast | n << position);
      rig.latch();
      const Tick first = rise();
      if (rise() - first != 3 << n) return false;
    }
    return true;
  };
}

// A falling edge on the pin latches the position, unless the IC makes the clock itself; its own does not fall that
// soon.
Check direction(bool servo) {
  return [servo](BitsRig& rig, unsigned ch) {
    for (bool external : {false, true}) {
      const std::uint32_t bit = servo ? 1u << 13 : 1u << 12;
      rig.start(external ? BitsRig::kFast : BitsRig::kFast & ~bit);
      rig.write(ch, words::kControl, kX4);
      rig.step(ch, false);
      rig.latch();
      if (rig.peek(true, base(ch) + (servo ? 2 : 1)) != (external ? 0xFFFFFFu : 0u)) return false;
    }
    return true;
  };
}

// Distance of rising (falling) edges once a new setting has settled; `limit` ends a search that has no hope.
Tick period(BitsRig& rig, bool servo, Tick limit) {
  const auto level = [&] { return servo ? !rig.pins().servo : rig.pins().phase; };
  const auto edge = [&] {
    rig.until(limit, [&] { return !level(); });
    rig.until(limit, level);
    return rig.now();
  };
  edge();
  const Tick first = edge();
  return edge() - first;
}

Check clock_divider(unsigned bit, bool servo) {
  return [=](BitsRig& rig, unsigned) {
    start_triangle(rig, pwm_control(1, 0));
    for (unsigned n : {0u, 1u << bit}) {
      rig.write(true, kClock, n << (servo ? 20 : 16));
      rig.run(100);
      if (period(rig, servo, 100) != 5 * (static_cast<Tick>(n) + 1)) return false;
    }
    return true;
  };
}

// --- PWM control

Check max_count(unsigned bit) {
  return [bit](BitsRig& rig, unsigned) {
    start_triangle(rig, 0);
    rig.write(true, kClock, 0);
    rig.run(20);
    if (period(rig, false, 20) != 3) return false;
    const Tick expected = (Tick{2} << bit) + 3;
    rig.write(true, kPwm, 1u << (8 + bit));
    rig.run(10);
    return period(rig, false, expected) == expected;
  };
}

Check dead_time(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    for (bool level : {false, true}) {
      const std::uint32_t units = level ? 1u << bit : 0;
      start_triangle(rig, pwm_control(4, units));
      rig.write(ch, words::kOutA, 0x7FFF00);
      rig.run(2100);  // the longest dead time is over, the top switch on
      if ((rig.pwm(ch) & 3) != 1) return false;
      rig.write(ch, words::kOutA, 0x800000);
      rig.until(100, [&] { return (rig.pwm(ch) & 1) == 0; });
      const Tick off = rig.until(2100, [&] { return (rig.pwm(ch) & 2) != 0; });
      if (off != 16 * static_cast<Tick>(units)) return false;
    }
    return true;
  };
}

Check pulse_width(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    for (bool level : {false, true}) {
      const std::uint32_t width = (level ? 1u << bit : 0) | (bit == 0 ? 2 : 0);  // 0 is as wide as 1
      rig.start();
      rig.write(true, kPwm, pwm_control(6527, width));
      if (pfm_pulse(rig, ch, 400) != 3 * std::max<Tick>(width, 1)) return false;
    }
    return true;
  };
}

// --- Strobe words: each bit at its place on the line.

Check strobe(unsigned addr, unsigned bit) {
  return [=](BitsRig& rig, unsigned) {
    rig.start();
    for (bool level : {false, true}) {
      rig.write(true, addr, level ? 1u << bit : 0xFFFFFF & ~(1u << bit));
      const bool dac = addr == kDacStrobe;
      const std::uint32_t sent = receive(rig, dac ? kDacClkPin : kAdcClkPin, [&] {
        return (rig.pins().serial & (dac ? kDacStrobePin : kAdcStrobePin)) != 0;
      });
      if (sent == 0xFFFFFFFF || (sent >> bit & 1) != (level ? 1u : 0u)) return false;
    }
    return true;
  };
}

}  // namespace

void add_global_rows(BitTable& table) {
  const auto add = [&](const char* name, unsigned addr, unsigned bit, Check check) {
    table.push_back({name, Side::kWritten, true, addr, bit, true, false, std::move(check)});
  };
  for (unsigned bit = 0; bit < 3; ++bit) {
    add("SCLK divider", kClock, bit, sclk_divider(bit));
    add("PFM_CLK divider", kClock, 3 + bit, pfm_divider(bit));
    add("DAC_CLK divider", kClock, 6 + bit, serial_divider(bit, 6, kDacClkPin));
    add("ADC_CLK divider", kClock, 9 + bit, serial_divider(bit, 9, kAdcClkPin));
  }
  add("phase direction", kClock, 12, direction(false));
  add("servo direction", kClock, 13, direction(true));
  for (unsigned bit = 0; bit < 4; ++bit) {
    add("phase divider", kClock, 16 + bit, clock_divider(bit, false));
    add("servo divider", kClock, 20 + bit, clock_divider(bit, true));
  }
  for (unsigned bit = 0; bit < 8; ++bit) {
    add("dead time", kPwm, bit, dead_time(bit));
    add("PFM pulse width", kPwm, bit, pulse_width(bit));
  }
  for (unsigned bit = 0; bit < 15; ++bit) add("maximum count", kPwm, 8 + bit, max_count(bit));
  for (unsigned bit = 0; bit < 24; ++bit) {
    add("DAC strobe", kDacStrobe, bit, strobe(kDacStrobe, bit));
    add("ADC strobe", kAdcStrobe, bit, strobe(kAdcStrobe, bit));
  }
  add_read_back(table, "clock control", true, kClock, true, 0xFF3FFF);  // 15..14 do not exist
  add_read_back(table, "DAC strobe", true, kDacStrobe, true, 0xFFFFFF);
  add_read_back(table, "ADC strobe", true, kAdcStrobe, true, 0xFFFFFF);
  add_read_back(table, "PWM control", true, kPwm, true, 0x7FFFFF);  // 23 does not exist
}

}  // namespace brick
