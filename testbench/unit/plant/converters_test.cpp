// Serial converters, PWM measurement and stepper drive, with edges written by hand; expected values by hand, too.
#include <gtest/gtest.h>

#include "testbench/plant/adc_peer.h"
#include "testbench/plant/amplifier.h"
#include "testbench/plant/dac_peer.h"
#include "testbench/plant/pwm_meter.h"
#include "testbench/plant/stepper.h"

namespace brick::plant {
namespace {

// One stream of 24 bits as the IC makes it: strobe and data change with the falling edge of the clock.
void send(DacPeer& dac, MotorOutputs& pins, std::uint32_t strobe, std::uint32_t a1, std::uint32_t b4) {
  const auto apply = [&](auto change) {
    const MotorOutputs before = pins;
    change();
    dac.changed(before, pins);
  };
  for (int bit = 23; bit >= 0; --bit) {
    apply([&] {
      pins.set(motor_pin::kDacClk, 0, 0);
      pins.set(motor_pin::kDacStrobe, 0, strobe >> bit);
      pins.set(motor_pin::kDac, 0, a1 >> bit);
      pins.set(motor_pin::kDacB, 3, b4 >> bit);
    });
    apply([&] { pins.set(motor_pin::kDacClk, 0, 1); });
  }
  apply([&] { pins.set(motor_pin::kDacClk, 0, 0); });
}

TEST(DacPeer, LatchesEighteenBits) {
  DacPeer dac;
  MotorOutputs pins;
  send(dac, pins, 0x7FFFC0, 0x123456, 0xFFFFC0);
  EXPECT_EQ(dac.value(0), 0x123456 >> 6);
  EXPECT_EQ(dac.value(3, true), -1);
  EXPECT_EQ(dac.value(0, true), 0);
  EXPECT_EQ(dac.value(3), 0);
  EXPECT_EQ(dac.updates(), 1u);
  send(dac, pins, 0x7FFFC0, 0x800000, 0x400000);
  EXPECT_EQ(dac.volts(0), -10);
  EXPECT_EQ(dac.volts(3, true), 5);
  send(dac, pins, 0x7FFFC0, 0x7FFFC0, 0x000040);
  EXPECT_DOUBLE_EQ(dac.volts(0), 10.0 * 131071 / 131072);
  EXPECT_DOUBLE_EQ(dac.volts(3, true), 10.0 / 131072);
}

TEST(DacPeer, LatchesSixteenBits) {
  DacPeer dac(16);
  MotorOutputs pins;
  send(dac, pins, 0x7FFF00, 0x123400, 0xFFFF00);
  EXPECT_EQ(dac.value(0), 0x1234);
  EXPECT_EQ(dac.value(3, true), -1);
  // The strobe word for 18 bits makes a 16-bit converter take the lower 16 of them.
  send(dac, pins, 0x7FFFC0, 0x123456, 0);
  EXPECT_EQ(dac.value(0), static_cast<std::int16_t>(0x123456 >> 6 & 0xFFFF));
  EXPECT_THROW(DacPeer(12), std::invalid_argument);
}

struct AdcStream {
  AdcPeer adc;
  MotorOutputs pins;
  Tick tick = 0;
  unsigned starts = 0, commands = 0;

  void apply(const MotorOutputs& next) {
    const MotorOutputs before = pins;
    pins = next;
    tick += 24;
    const AdcPeer::Event event = adc.changed(tick, before, pins);
    starts += event.start;
    commands += event.command;
    if (event.start) adc.set_word(1, false, 0x2ABCD), adc.set_word(2, true, 0x15432);
  }
  // `bits` of a stream; returns what the IC samples at the rising edges on line `b` of `channel`.
  std::uint32_t run(std::uint32_t strobe, unsigned channel, bool b, int bits = 24) {
    std::uint32_t sampled = 0;
    MotorOutputs next = pins;
    for (int bit = 23; bit > 23 - bits; --bit) {
      next.set(motor_pin::kAdcClk, 0, 0);
      next.set(motor_pin::kAdcStrobe, 0, strobe >> bit);
      apply(next);
      sampled = sampled << 1 | (adc.lines(b) >> channel & 1);  // stands before the edge that samples it
      next.set(motor_pin::kAdcClk, 0, 1);
      apply(next);
      EXPECT_EQ(adc.lines(b) >> channel & 1, sampled & 1) << "stands until the clock falls";
    }
    next.set(motor_pin::kAdcClk, 0, 0);
    apply(next);
    return sampled;
  }
};

// Four bits of header, 18 of value, two more: the value stands 2 bits above the bottom.
TEST(AdcPeer, SendsTheWordBehindItsHeader) {
  AdcStream s;
  EXPECT_EQ(s.run(0xFFFFFE, 1, false), 0x2ABCDu << 2);
  EXPECT_EQ(s.run(0xFFFFFE, 2, true), 0x15432u << 2);
  EXPECT_EQ(s.run(0xFFFFFE, 1, true), 0u);
  EXPECT_EQ(s.run(0xFFFFFE, 2, false), 0u);
  EXPECT_EQ(s.starts, 4u);
}

TEST(AdcPeer, ReadsTheCommandOnTheStrobe) {
  AdcStream s;
  EXPECT_EQ(s.run(0xF84DFE, 1, false), 0x2ABCDu << 2);  // rises five times on its way
  EXPECT_EQ(s.starts, 1u);
  EXPECT_EQ(s.commands, 1u);
  EXPECT_EQ(s.adc.command(), 0xF84DFEu);
  s.run(0x7FFFFE, 1, false);  // begins one bit late: 23 bits are not a command
  EXPECT_EQ(s.starts, 2u);
  EXPECT_EQ(s.commands, 1u);
}

TEST(AdcPeer, StartsAgainAfterABrokenStream) {
  AdcStream s;
  s.run(0xFFFFFE, 1, false, 7);
  MotorOutputs next = s.pins;
  next.set(motor_pin::kAdcStrobe, 0, 0);  // reset
  s.apply(next);
  s.tick += 385;
  EXPECT_EQ(s.run(0xFFFFFE, 1, false), 0x2ABCDu << 2);
}

// Phase A: 600 ticks top, 100 dead, 300 bottom: (600 - 300) / 1000. B always bottom. C: dead, from half time on top.
TEST(PwmMeter, AveragesSinceTheLastCall) {
  PwmMeter meter;
  meter.changed(1000, 0b001001);
  meter.take(1000);
  meter.changed(1500, 0b011001);
  meter.changed(1600, 0b011000);
  meter.changed(1700, 0b011010);
  const auto average = meter.take(2000);
  EXPECT_DOUBLE_EQ(average[0], 0.3);
  EXPECT_DOUBLE_EQ(average[1], -1);
  EXPECT_DOUBLE_EQ(average[2], 0.5);
  EXPECT_DOUBLE_EQ(meter.take(2001)[0], -1);
  EXPECT_FALSE(meter.take_short());
  meter.changed(2100, 0b011011);
  meter.changed(2101, 0b011010);
  EXPECT_TRUE(meter.take_short());
  EXPECT_FALSE(meter.take_short());
}

// On from the start at tick 1000 to the one change at 1250: half of the 500 ticks on top, half at the bottom.
TEST(PwmMeter, StartsFromPinsThatStand) {
  PwmMeter meter;
  meter.begin(1000, 0b000001);
  meter.changed(1250, 0b000010);
  EXPECT_DOUBLE_EQ(meter.take(1500)[0], 0);
  PwmMeter still;
  still.begin(1000, 0b000001);
  EXPECT_DOUBLE_EQ(still.take(1500)[0], 1);
  still.changed(1500, 0b000011);  // shorted, and then nobody looks for 8000 ticks
  still.begin(10'000, 0b000010);
  EXPECT_DOUBLE_EQ(still.take(10'100)[0], -1) << "what was before the second start";
  EXPECT_FALSE(still.take_short());
}

TEST(Stepper, TakesNoStepForAPulseThatStandsAtTheStart) {
  Stepper stepper({});
  stepper.begin(true, true);
  stepper.changed(1000, true, true, true);
  EXPECT_EQ(stepper.steps(), 0);
  stepper.changed(1010, false, true, true);
  stepper.changed(1020, true, true, true);
  EXPECT_EQ(stepper.steps(), -1);
  EXPECT_EQ(stepper.violations(), 0u);
}

TEST(Stepper, MovesOneStepAPulse) {
  StepperParameters p;
  p.units_per_step = 2 * kUnitsPerCount;
  p.move_time = 100;
  Stepper stepper(p);
  Motion motion;
  stepper.changed(1000, true, false, true);
  motion = stepper.motion(1000, motion);
  EXPECT_EQ(motion.at(1000), 0);
  EXPECT_EQ(motion.at(1050), kUnitsPerCount);
  EXPECT_EQ(motion.at(1100), 2 * kUnitsPerCount);
  stepper.changed(1010, false, false, true);
  motion = stepper.motion(1010, motion);
  EXPECT_EQ(motion.at(1100), 2 * kUnitsPerCount);  // the end of a pulse does nothing
  stepper.changed(1050, true, true, true);
  motion = stepper.motion(1050, motion);
  EXPECT_EQ(motion.at(1050), kUnitsPerCount);
  EXPECT_EQ(motion.at(1150), 0);
  stepper.changed(1200, false, true, true);
  stepper.changed(1300, true, true, false);  // not enabled
  EXPECT_EQ(stepper.steps(), 0);
}

TEST(Stepper, CountsViolatedTimes) {
  StepperParameters p;
  p.min_width = 50;
  p.dir_setup = 30;
  Stepper stepper(p);
  stepper.changed(100, true, false, true);
  stepper.changed(150, false, false, true);
  EXPECT_EQ(stepper.violations(), 0u);
  stepper.changed(200, false, true, true);
  stepper.changed(230, true, true, true);
  EXPECT_EQ(stepper.violations(), 0u);
  stepper.changed(279, false, true, true);  // 49 ticks wide
  EXPECT_EQ(stepper.violations(), 1u);
  stepper.changed(300, true, false, true);  // together with DIR
  EXPECT_EQ(stepper.violations(), 2u);
}

// 14 bits for +-10 A: 1 A is 819.2; the nibble below is status.
TEST(Amplifier, PacksCurrentAndStatus) {
  Amplifier amplifier({});
  EXPECT_EQ(amplifier.adc_word(0, 0, 0), 0u);
  EXPECT_EQ(amplifier.adc_word(5, 0, 3), 4096u << 4 | 3);
  EXPECT_EQ(amplifier.adc_word(1, 0, 0), 819u << 4);
  EXPECT_EQ(amplifier.adc_word(-5, 0, 0), (16384u - 4096) << 4);
  EXPECT_EQ(amplifier.adc_word(5, -7, 0), 4089u << 4);
  EXPECT_EQ(amplifier.adc_word(11, 0, 0), 8191u << 4);
  EXPECT_EQ(amplifier.adc_word(-11, 0, 0), 8192u << 4);
}

TEST(Amplifier, KeepsTheFirstFaultUntilItsAxisIsCleared) {
  Amplifier amplifier({});
  EXPECT_FALSE(amplifier.on());
  amplifier.enable(true);
  EXPECT_TRUE(amplifier.on());
  amplifier.watch(-20);
  EXPECT_TRUE(amplifier.on());
  amplifier.watch(-20.01);
  EXPECT_FALSE(amplifier.on());
  EXPECT_TRUE(amplifier.fault_pin());
  amplifier.trip(Amplifier::Fault::kI2t);
  EXPECT_EQ(amplifier.fault(), Amplifier::Fault::kOverCurrent);
  for (std::uint32_t word :
       {0xF9CDFEu, 0xF84DFEu, 0xE8CDFEu, 0xFFFFFEu}) {  // other axis, no reset, no address, default
    amplifier.command(0, word);
    EXPECT_FALSE(amplifier.on()) << std::hex << word;
  }
  amplifier.command(0, 0xF8CDFE);
  EXPECT_TRUE(amplifier.on());
  EXPECT_FALSE(amplifier.fault_pin());
}

}  // namespace
}  // namespace brick::plant
