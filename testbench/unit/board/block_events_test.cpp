// When blocks of the model's board have something to do (systemc/core/model_block.h): no event where nothing is to
// come, or it would cost time, and each at the tick at which it comes.
#include <gtest/gtest.h>

#include <vector>

#include "systemc/board/bus_read.h"
#include "systemc/board/bus_sync.h"
#include "systemc/board/clock_select.h"
#include "systemc/board/gate_ics.h"
#include "systemc/board/watchdog.h"
#include "testbench/unit/board/words.h"

namespace brick {
namespace {

// A strobe is taken at the edge of clk_ref that finds it new behind three flip-flops, and made at the next one. A write
// shows its strobe from the tick before to that edge; of a read nobody but the on-chip page sees the beginning.
TEST(BlockEvents, OfTheBusAreTheAccesses) {
  for (const bool write : {false, true})
    for (const bool internal : {false, true})
      for (Tick phase = 0; phase < 2 * kTicksPerRef; ++phase) {
        SCOPED_TRACE(::testing::Message() << "write " << write << ", internal " << internal << ", tick " << phase);
        BusSync bus(sc_core::sc_gen_unique_name("bus"));
        BusStrobes strobes;
        PortAPins pins;
        bus.reset(0);
        bus.set_pins(pins, strobes);
        EXPECT_EQ(bus.next_event(), kNever);
        bus.advance(phase);
        pins.pa_aa = 2;
        pins.pa_int = internal;
        bus.set_pins(pins, strobes);
        EXPECT_EQ(bus.next_event(), kNever) << "no strobe";
        EXPECT_FALSE(bus.under_way());
        EXPECT_EQ(bus.internal_pending(), internal);
        (write ? pins.pa_wr_n : pins.pa_rd_n) = false;
        strobes.set_pins(pins, true);
        bus.set_pins(pins, strobes);
        EXPECT_EQ(bus.write_pending(), write);
        EXPECT_TRUE(bus.internal_pending());
        const Tick taken = next_ref_edge(phase + 3), made = taken + kTicksPerRef;
        std::vector<Tick> events;
        while (bus.next_event() != kNever && events.size() < 9) {
          events.push_back(bus.next_event());
          const bool shown = events.back() == made - 1;
          bus.advance(events.back());
          EXPECT_EQ(write ? bus.we() : bus.rd(), shown);
          EXPECT_FALSE(write ? bus.rd() : bus.we());
        }
        EXPECT_EQ(events, (write || internal ? std::vector<Tick>{made - 1, made} : std::vector<Tick>{made}));
        EXPECT_FALSE(bus.under_way()) << "whatever the level";
        EXPECT_FALSE(bus.write_pending());
        EXPECT_EQ(bus.internal_pending(), internal);
        if (write) { EXPECT_EQ(bus.where().aa, 2u); }
        bus.advance(made + 50);
        (write ? pins.pa_wr_n : pins.pa_rd_n) = true;
        strobes.set_pins(pins, true);
        bus.set_pins(pins, strobes);
        EXPECT_EQ(bus.next_event(), kNever) << "the end of the strobe";
      }
}

// Asked at any edge it says the same; what is of no register region shows no strobe.
TEST(BlockEvents, OfTheBusAreForeseenAtEachEdge) {
  for (const bool write : {false, true})
    for (const std::uint8_t aa : {0, 1, 2, 3, 4, 8})
      for (Tick reset = 0; reset < 2 * kTicksPerRef; ++reset) {
        SCOPED_TRACE(::testing::Message() << "write " << write << ", aa " << unsigned{aa} << ", reset " << reset);
        BusSync bus(sc_core::sc_gen_unique_name("bus"));
        BusStrobes strobes;
        PortAPins pins;
        bus.reset(reset);
        pins.pa_aa = aa;
        (write ? pins.pa_wr_n : pins.pa_rd_n) = false;
        strobes.set_pins(pins, true);
        bus.set_pins(pins, strobes);
        const bool own = aa == 0 || (aa & 2) != 0;
        const Tick made = next_ref_edge(reset + 3) + kTicksPerRef, taken = made - kTicksPerRef;
        for (Tick t = reset; t < made + 3; ++t) {
          bus.advance(t);
          const Tick next = t < taken || (own && t < made) ? (write && t < made - 1 ? made - 1 : made) : kNever;
          EXPECT_EQ(bus.next_event(), next) << "tick " << t;
          EXPECT_EQ(write ? bus.we() : bus.rd(), own && t == made - 1) << "tick " << t;
        }
      }
}

// D goes with /RD or with another read that falls, not with a write strobe that moves beside the read.
TEST(BlockEvents, OfAReadAreItsSampleAndItsEnd) {
  BusRead read;
  read.reset();
  read.set_rd(false, 1);
  EXPECT_FALSE(read.oe());
  read.take(0x123456, 1, false);
  EXPECT_TRUE(read.oe());
  read.set_rd(false, 1);
  EXPECT_TRUE(read.oe()) << "/RD is still low, and has not fallen again";
  EXPECT_EQ(read.data(), 0x123456u);
  read.set_rd(true, 1);
  EXPECT_FALSE(read.oe());
  read.set_rd(false, 2);
  EXPECT_FALSE(read.oe()) << "until there is a sample of this one";
  read.take(0x654321, 1, false);
  EXPECT_FALSE(read.oe()) << "of the read before";
  read.take(0x654321, 2, true);
  EXPECT_FALSE(read.oe()) << "the on-chip page has no pins";
  read.take(0x654321, 2, false);
  EXPECT_TRUE(read.oe());
  read.reset();
  EXPECT_FALSE(read.oe());
  EXPECT_EQ(read.data(), 0u);
}

// Levels and pins from outside come with the next tick, drivers with the next edge of clk_ref, a conflict when it has
// lasted three ticks; at rest there is nothing to come.
TEST(BlockEvents, OfTheClockSelectionAreItsMoves) {
  for (const bool servo : {false, true}) {
    SCOPED_TRACE(servo ? "SERVO" : "PHASE");
    ClockSelect select(sc_core::sc_gen_unique_name("select"));
    std::uint32_t& level = servo ? select.servo_level : select.phase_level;
    bool& outside = servo ? select.ext_servo : select.ext_phase;
    select.reset(0);
    EXPECT_EQ(select.next_event(), kNever);
    outside = false;
    EXPECT_EQ(select.next_event(), kNever) << "nobody follows it";
    select.advance(100);
    outside = true;
    (servo ? select.in.servo : select.in.phase) = 0x6;
    EXPECT_EQ(select.next_event(), 102) << "clk_ref takes the drivers";
    select.advance(101);
    EXPECT_EQ(select.next_event(), 102);
    select.advance(102);
    EXPECT_EQ(select.next_event(), kNever);
    Tick now = 200;
    select.advance(now);
    level = ~0x6u;
    EXPECT_EQ(select.next_event(), now + 1) << "the levels move";
    select.advance(++now);
    EXPECT_EQ(select.next_event(), now + 1) << "the net follows";
    select.advance(++now);
    EXPECT_EQ(select.next_event(), kNever);
    level = ~0x4u;
    EXPECT_EQ(select.next_event(), now + 1);
    select.advance(++now);
    EXPECT_EQ(select.next_event(), now + 1) << "the net follows IC 1";
    select.advance(++now);
    EXPECT_FALSE(select.conflict());
    EXPECT_EQ(select.next_event(), now + 2) << "the third tick of the fight";
    select.advance(++now);
    EXPECT_EQ(select.next_event(), now + 1);
    select.advance(++now);
    EXPECT_TRUE(select.conflict());
    EXPECT_EQ(select.next_event(), kNever);
    select.advance(now += 50);
    level = ~0u;
    EXPECT_EQ(select.next_event(), now + 1);
    select.advance(++now);
    EXPECT_EQ(select.next_event(), kNever) << "IC 1 is where it was";
    select.in = {0, 0, true};
    EXPECT_EQ(select.next_event(), next_ref_edge(now));
    select.advance(now = 600);
    EXPECT_EQ(select.next_event(), kNever);
    outside = false;
    for (int n = 0; n < 3; ++n) {  // two flip-flops and the net
      EXPECT_EQ(select.next_event(), now + 1) << n;
      select.advance(++now);
    }
    EXPECT_EQ(select.next_event(), kNever);
    EXPECT_FALSE(servo ? select.servo() : select.phase());
    EXPECT_TRUE(servo ? select.phase() : select.servo());
  }
}

// An IC is looked at when an output of it is due, or something about it moves, and the others are left alone.
TEST(BlockEvents, OfAnIcConcernNoOther) {
  constexpr std::uint32_t kClockWord = 4, kPwmWord = 0x1C;
  GateIcs ics(0x40007);
  ics.reset(0);
  ics.take_changes();
  EXPECT_EQ(ics.next_event(), kNever);
  MotorOutputs pulse, count;
  pulse.set(motor_pin::kPfmPulse, 0, 1);
  count.set(motor_pin::kCount, 0, ~0u);
  ics.watch(0, pulse, 300);
  EXPECT_EQ(ics.take_changes(), 1u);
  ics.watch(1, pulse, 300);
  EXPECT_EQ(ics.take_changes(), 2u);
  ics.watch(1, pulse, 301);
  EXPECT_EQ(ics.take_changes(), 0u) << "as before";
  ics.watch(2, count, 302);  // all that a reset begins has come to rest
  EXPECT_EQ(ics.take_changes(), 4u);
  EXPECT_EQ(ics.next_event(), kNever);
  const auto write = [&ics](unsigned ic, bool x, std::uint32_t offset, std::uint32_t value, Tick t) {
    ics.write(ic, x, offset, value, t);
  };
  for (const unsigned ic : {0u, 1u}) {
    write(ic, true, kChannelControl, 0x800000, 303);
    EXPECT_EQ(ics.take_changes(), 1u << ic);
    write(ic, false, kOutC, ic == 0 ? 0x040000 : 0x068000, 303);
    EXPECT_EQ(ics.take_changes(), 1u << ic);
  }
  EXPECT_EQ(ics.next_clock_event(), kNever);
  std::vector<unsigned> looks(4);
  Tick now = 303;
  for (int n = 0; n < 60; ++n) {
    const Tick next = ics.next_event();
    ASSERT_GT(next, now);
    EXPECT_FALSE(ics.advance(now = next)) << "no clock moves";
    const std::uint32_t changes = ics.take_changes();
    ASSERT_LT(changes, 4u) << "IC 2 has none";
    ASSERT_GT(changes, 0u);
    ++looks[changes];
  }
  EXPECT_GT(looks[1], 5u);
  EXPECT_GT(looks[2], 5u);

  ics.set_clocks(true, true, now);
  ics.set_trip(false, now);
  ics.set_macro_gates(0, now);
  ics.send_adc(0, {}, now);
  EXPECT_EQ(ics.take_changes(), 0u) << "nothing has moved";
  ics.set_clocks(false, true, now);
  EXPECT_EQ(ics.take_changes(), 7u);
  ics.set_clocks(false, true, now);
  EXPECT_EQ(ics.take_changes(), 0u);
  ics.watch(1, {}, now);
  EXPECT_EQ(ics.take_changes(), 0u);
  ics.set_motor_inputs(1, {}, now);
  EXPECT_EQ(ics.take_changes(), 0u) << "nobody watches it";
  ics.watch(1, pulse, now);
  EXPECT_EQ(ics.take_changes(), 2u);
  EXPECT_EQ(GateIcs(~0u).built(), (1u << 22) - 1);
  ics.set_motor_inputs(2, {}, now);
  EXPECT_EQ(ics.take_changes(), 4u);
  EXPECT_EQ(ics.next_clock_event(), kNever) << "an IC that follows them";
  ics.set_trip(true, now);
  EXPECT_EQ(ics.take_changes(), 7u);
  ics.set_trip(true, now);
  EXPECT_EQ(ics.take_changes(), 0u);
  EXPECT_EQ(ics.next_event(), kNever) << "no pulses any more";
  write(1, true, kPwmWord, 100 << 8, now);
  EXPECT_EQ(ics.take_changes(), 2u);
  EXPECT_EQ(ics.next_clock_event(), kNever);
  write(2, true, kClockWord, 0, now);
  EXPECT_EQ(ics.next_clock_event(), now + 1) << "it will drive them";
  EXPECT_EQ(ics.next_event(), now + 1);
  EXPECT_EQ(ics.drivers().phase, 0u);
  EXPECT_TRUE(ics.advance(now + 1));
}

// An input acts when it comes, on an IC that nobody has looked at as on one that is asked all the time.
TEST(BlockEvents, InputsOfAnIcThatLagsBehindActWhenTheyCome) {
  GateIcs lazy(0x40003), eager(0x40003);
  const auto both = [&](const auto& act) {
    act(lazy);
    act(eager);
  };
  Tick now = 300;
  both([](GateIcs& ics) {
    ics.reset(0);
    ics.write(0, true, 0x1C, 100 << 8 | 1, 300);
    ics.write(0, true, kChannelControl, 0, 300);
    ics.write(0, false, kOutA, 20 << 8, 300);
  });
  const auto run = [&](Tick ticks) {
    for (const Tick end = now + ticks; now < end;) eager.motor_outputs(0, now = std::min(end, now + 97));
  };
  const auto compare = [&](const char* what) {
    EXPECT_EQ(lazy.motor_outputs(0, now), eager.motor_outputs(0, now)) << what;
    EXPECT_EQ(lazy.channels(0, now)->pwm_times(0).balance, eager.channels(0, now)->pwm_times(0).balance) << what;
    EXPECT_EQ(lazy.channels(0, now)->adc_lines(false), eager.channels(0, now)->adc_lines(false)) << what;
  };
  run(30'000);
  both([&](GateIcs& ics) { ics.set_trip(true, now); });
  run(1000);
  compare("trip");
  run(1000);
  both([&](GateIcs& ics) { ics.set_trip(false, now); });
  run(1000);
  compare("no trip");
  run(1000);
  both([&](GateIcs& ics) { ics.set_clocks(false, true, now); });
  run(300);
  both([&](GateIcs& ics) { ics.set_clocks(true, true, now); });
  run(300);  // the first bits of a stream of 48 ticks each
  ConverterWords words;
  words.fill(0x800000);
  both([&](GateIcs& ics) {
    for (const unsigned ic : {0u, 2u, 17u, 18u, 19u, 22u}) ics.send_adc(ic, words, now);
  });
  compare("words");
  EXPECT_EQ(lazy.channels(0, now)->adc_lines(false), 0xFu) << "bit 23 is the present one";
  EXPECT_EQ(lazy.channels(1, now)->adc_lines(false), 0u);
  run(100);
  compare("words");
  EXPECT_EQ(lazy.channels(0, now)->adc_lines(false), 0u);
}

// EQU of channels of servo IC 0 and 1 that interrupt, and of no others.
TEST(BlockEvents, EquThatInterruptsIsThatOfItsChannel) {
  namespace control = regs::servo_channel::control;
  constexpr std::uint32_t kSet = control::kEquWrite.mask() | control::kEquState.mask(),
                          kClear = control::kEquWrite.mask();
  for (const std::uint32_t mask : {0xFFu, 0x0Fu, 0xF0u, 0x21u, 0x00u}) {
    GateIcs ics(0x7);
    ics.reset(0);
    ics.set_interrupting(mask, 300);
    EXPECT_EQ(ics.next_event(), kNever);
    Tick now = 300;
    std::uint32_t set = 0;
    const auto write = [&](unsigned ic, unsigned channel, std::uint32_t value) {
      ics.write(ic, true, 8 * channel + kChannelControl, value, now += kTicksPerRef);
      if (ic < 2) set = (set & ~(1u << (4 * ic + channel))) | (value == kSet ? 1u : 0u) << (4 * ic + channel);
      EXPECT_EQ(ics.equ(), set & mask) << std::hex << mask << ", IC " << ic << ", channel " << channel;
    };
    for (unsigned ic = 0; ic < 3; ++ic)
      for (unsigned channel = 0; channel < kChannels; ++channel) write(ic, channel, kSet);
    EXPECT_EQ(ics.next_event() == kNever, mask == 0) << "the compares have just been written";
    ics.set_interrupting(mask ^ 0xFF, now);
    EXPECT_EQ(ics.equ(), mask ^ 0xFF);
    ics.set_interrupting(mask, now);
    EXPECT_EQ(ics.equ(), mask);
    for (unsigned ic = 3; ic-- > 0;)
      for (const unsigned channel : {1u, 0u, 3u, 2u}) write(ic, channel, kClear);
    while (ics.next_event() != kNever && now < 2000) ics.advance(now = ics.next_event());
    EXPECT_LT(now, 2000) << "they come to rest";
  }
}

// The watchdog has its first edge of clk_ref, the end of the time of the strobe or of SERVO, whichever is sooner, and
// each edge while 5 V go away (servo-ic:10).
TEST(BlockEvents, OfTheWatchdogAreItsStartAndItsEnd) {
  const auto edge = [](Tick n) { return n * kTicksPerRef; };
  constexpr Tick kUnit = 1024, kTime = 960;  // 25 ms
  for (const bool servo_moves : {false, true})
    for (const bool strobe : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "servo " << servo_moves << ", strobe " << strobe);
      Watchdog watchdog(sc_core::sc_gen_unique_name("watchdog"));
      watchdog.reset(0);
      EXPECT_EQ(watchdog.next_event(), edge(1));
      watchdog.advance(edge(1) - 1);
      EXPECT_FALSE(watchdog.relay());
      watchdog.advance(edge(1));
      EXPECT_TRUE(watchdog.relay());
      EXPECT_EQ(watchdog.next_event(), edge(kTime * kUnit));
      watchdog.advance(edge(2 * kUnit + 10));
      watchdog.strobe = strobe;
      watchdog.advance(edge(2 * kUnit + 11));
      watchdog.strobe = false;
      watchdog.advance(edge(3 * kUnit + 10));
      watchdog.servo = !servo_moves;
      watchdog.advance(edge(3 * kUnit + 20));
      const Tick end = edge((kTime + (strobe && servo_moves ? 2 : 0)) * kUnit);
      EXPECT_EQ(watchdog.next_event(), end) << "the strobe's is the sooner one";
      watchdog.advance(end - 1);
      EXPECT_FALSE(watchdog.trip());
      watchdog.advance(end);
      EXPECT_TRUE(watchdog.trip());
      EXPECT_EQ(watchdog.next_event(), kNever);
    }
  Watchdog watchdog(sc_core::sc_gen_unique_name("watchdog"));
  watchdog.reset(30);
  watchdog.advance(100);
  watchdog.pwr_good = false;
  for (Tick t = 102; t <= 108; t += kTicksPerRef) {
    EXPECT_FALSE(watchdog.trip());
    EXPECT_EQ(watchdog.next_event(), t);
    watchdog.advance(t);
  }
  EXPECT_TRUE(watchdog.trip());
  EXPECT_FALSE(watchdog.relay());
  EXPECT_EQ(watchdog.next_event(), kNever);
}

}  // namespace
}  // namespace brick
