// The Port A bus master against the formulas of host-bus:2.2: every guaranteed time, at every number of wait states and
// several CPU clocks; /TA stretching; areas; the registers that shape the cycles.
#include "systemc/cpu/port_a.h"

#include <gmock/gmock.h>

#include "testbench/unit/covers.h"
#include "testbench/unit/machine/port_a_rig.h"

namespace brick {
namespace {

constexpr double kNs = 1e6;  // femtoseconds

double tc_ns(unsigned n) { return 1e9 / (9'830'400.0 * n); }  // CPU clock period
int form(unsigned ws) { return ws <= 3 ? 0 : ws <= 7 ? 1 : 2; }
constexpr double kEpsilon = 1e-5;  // ns, rounding to femtoseconds

// The rows as the data sheet prints them, guard bands included.
void expect_read_rows(const PortACycle& c, unsigned ws, double tc) {
  const double valid = c.end / kNs - c.start / kNs, low = (c.strobe_high - c.strobe_low) / kNs;
  EXPECT_GE(valid, (ws + 1 + form(ws)) * tc - 4 - kEpsilon) << "row 100";
  EXPECT_LE((c.data_time - c.start) / kNs, (ws + 0.75) * tc - 5 + kEpsilon)
      << "row 104: the CPU may not ask for data earlier";
  EXPECT_GE((c.data_time - c.start) / kNs, (ws + 0.75) * tc - 5 - kEpsilon) << "row 104";
  EXPECT_GE((c.data_time - c.strobe_low) / kNs, (ws + 0.25) * tc - 5 - kEpsilon) << "row 105";
  EXPECT_GE((c.strobe_low - c.start) / kNs, 0.5 * tc - 2 - kEpsilon) << "row 115";
  EXPECT_GE(low, (ws + 0.25) * tc - 4 - kEpsilon) << "row 116";
  EXPECT_GE((c.end - c.strobe_high) / kNs, (ws == 1 ? 0.25 : ws <= 7 ? 1.25 : 2.25) * tc - 2 - kEpsilon) << "row 117";
  EXPECT_GE((c.strobe_high - c.ta_time) / kNs, 0.25 * tc + 2.0 - kEpsilon) << "row 118";
}

void expect_write_rows(const PortACycle& c, unsigned ws, double tc) {
  EXPECT_GE((c.end - c.start) / kNs, (ws + 1 + form(ws)) * tc - 4 - kEpsilon) << "row 100";
  EXPECT_GE((c.strobe_low - c.start) / kNs, (ws == 1 ? 0.25 : ws <= 3 ? 0.75 : 1.25) * tc - 2 - kEpsilon) << "row 101";
  EXPECT_GE((c.strobe_high - c.strobe_low) / kNs, (ws == 1   ? 1.5
                                                   : ws <= 3 ? ws
                                                             : ws - 0.5) *
                                                          tc -
                                                      4 - kEpsilon)
      << "row 102";
  EXPECT_GE((c.end - c.strobe_high) / kNs, (0.25 + form(ws)) * tc - 2 - kEpsilon) << "row 103 and 109";
  EXPECT_GE((c.strobe_high - c.start) / kNs, (ws + 0.75) * tc - 4 - kEpsilon) << "row 107";
  EXPECT_GE((c.strobe_high - c.data_time) / kNs, (ws - 0.25) * tc - 3 - kEpsilon) << "row 108";
  if (ws == 1) return;
  EXPECT_GE((c.data_time - c.strobe_low) / kNs, (ws <= 3 ? 0.25 : -0.25) * tc - 3.7 - kEpsilon) << "row 110";
}

TEST(PortA, KeepsEveryRowAtEveryWaitStateAndClock) {
  BRICK_COVERS("CARD-5");
  for (const unsigned n : {1u, 7u, 8u, 10u, 16u, 24u, 32u}) {
    for (unsigned ws = 1; ws <= 31; ++ws) {
      SCOPED_TRACE(::testing::Message() << "multiplier " << n << ", " << ws << " wait states");
      PortARig rig;
      rig.set_clock(n);
      rig.set_wait_states(ws);
      const double tc = tc_ns(n);
      rig.read('X', 0x078000);
      const PortACycle read = *rig.last;
      EXPECT_EQ(read.wait_states, ws);
      // At 320 MHz and one wait state 5 ns before the end lie before /RD falls: the rows cannot all hold
      // (illegal, host-bus:2.3).
      if ((ws + 0.25) * tc > 5) expect_read_rows(read, ws, tc);
      rig.write('Y', 0x078001, 0x123456);
      const PortACycle write = *rig.last;
      if (ws > 1 || (0.25 * tc > 2 && 1.5 * tc > 4)) expect_write_rows(write, ws, tc);
      if (ws == 1) continue;  // the rows below begin with two wait states
      EXPECT_GE((write.data_time - read.strobe_high) / kNs, (1.25 + form(ws)) * tc - 4 - kEpsilon) << "row 112";
      rig.write('Y', 0x078001, 1);
      EXPECT_GE((rig.last->strobe_low - write.strobe_high) / kNs, (ws <= 3   ? 2.0
                                                                   : ws <= 7 ? 2.5
                                                                             : 3.5) *
                                                                          tc -
                                                                      4 - kEpsilon)
          << "row 114";
      rig.read('X', 0x078000);
      const PortACycle first = *rig.last;
      rig.read('X', 0x078000);
      EXPECT_GE((rig.last->strobe_low - first.strobe_high) / kNs, (ws <= 7 ? 1.75 : 2.75) * tc - 4 - kEpsilon)
          << "row 113";
    }
  }
}

// A line of the check table 2.3, scaled from 80 MHz to 78.6432 MHz: 7 wait states take 9 clocks.
TEST(PortA, SevenWaitStatesAtResetClockTakeNineClocks) {
  BRICK_COVERS("CARD-5");
  PortARig rig;
  rig.set_wait_states(7);
  const auto start = rig.cycle;
  rig.read('X', 0x078000);
  EXPECT_EQ(rig.cycle - start, 9);
  EXPECT_NEAR((rig.last->data_time - rig.last->start) / kNs, 7.75 * tc_ns(8) - 5, 1e-5);
}

TEST(PortA, ResetValuesAreAllWaitStatesAndEightTimesTheClock) {
  PortARig rig;
  EXPECT_EQ(rig.read('X', 0xFFFFFB), 0x1FFFFFu);
  EXPECT_EQ(rig.read('X', 0xFFFFFD), 7u);
  rig.read('X', 0x078000);
  EXPECT_EQ(rig.last->wait_states, 31u);
  rig.read('X', 0x060000);
  EXPECT_EQ(rig.last->wait_states, 7u);
}

TEST(PortA, EachRegionHasItsAreaAndWaitStates) {
  PortARig rig;
  rig.write('X', 0xFFFFFB, 1 | 2 << 5 | 3 << 10 | 4 << 13 | 5 << 16);
  struct Case {
    char space;
    std::uint32_t address;
    unsigned aa, ws;
  };
  for (const Case& c : {Case{'Y', 0x060000, 4, 3},
                        {'X', 0x063FFF, 4, 3},
                        {'X', 0x070010, 0, 5},
                        {'X', 0x0700FF, 0, 5},
                        {'Y', 0x00FF00, 2, 2},  // servo-ic:11.4/5
                        {'X', 0x00FFFF, 2, 2},
                        {'Y', 0x078000, 2, 2},
                        {'X', 0x07BFFF, 2, 2}}) {
    rig.read(c.space, c.address);
    EXPECT_EQ(rig.last->aa, c.aa) << std::hex << c.address;
    EXPECT_EQ(rig.last->wait_states, c.ws) << std::hex << c.address;
  }
  EXPECT_EQ(rig.port_a.wait_states(0), 1u);
}

// Also the bits that move nothing here: BA3W, because flash is not on this bus, and the three of bus arbitration.
TEST(PortA, EveryBitOfItsTwoRegistersReadsBack) {
  PortARig rig;
  for (unsigned bit = 0; bit < 24; ++bit) {
    rig.write('X', 0xFFFFFB, 1u << bit);
    EXPECT_EQ(rig.read('X', 0xFFFFFB), 1u << bit) << "BCR bit " << bit;
    for (const std::uint32_t address : {0x060000u, 0x070010u, 0x078000u}) {
      rig.read('X', address);
      const unsigned lsb = address == 0x060000 ? 10 : address == 0x070010 ? 16 : 5, width = address == 0x060000 ? 3 : 5;
      EXPECT_EQ(rig.last->wait_states, bit >= lsb && bit < lsb + width ? 1u << (bit - lsb) : 0u)
          << std::hex << address << " bit " << bit;
    }
    EXPECT_EQ(rig.port_a.wait_states(0), bit < 5 ? 1u << bit : 0u);
  }
  rig.write('X', 0xFFFFFB, 0x1FFFFF);
  for (unsigned bit = 0; bit < 24; ++bit) {
    rig.write('X', 0xFFFFFD, 1u << bit);
    EXPECT_EQ(rig.read('X', 0xFFFFFD), bit < 5 ? 1u << bit : 0u) << "PCTL bit " << bit;
  }
}

TEST(PortA, NothingAnswersOutsideTheRegions) {
  PortARig rig;
  for (const std::uint32_t address :
       {0x040000u, 0x05FFFFu, 0x064000u, 0x06FFFFu, 0x070100u, 0x077FFFu, 0x07C000u, 0x080000u, 0xFFFF7Fu})
    EXPECT_EQ(rig.access('X', address, false), tlm::TLM_ADDRESS_ERROR_RESPONSE) << std::hex << address;
  EXPECT_EQ(rig.access('Y', 0xFFFFC6, false), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "the on-chip page is in X space";
  EXPECT_EQ(rig.access('X', 0x078000, true, 1, 2), tlm::TLM_BURST_ERROR_RESPONSE);
  EXPECT_FALSE(rig.last) << "and no cycle was made";
}

// They keep their own pace when the core gets faster than 8 x 9.83 MHz (docs/port_a.md).
TEST(PortA, OnChipAccessesHaveAtLeastSevenWaitStatesOrOneForEachMultipleOfTheClock) {
  PortARig rig;
  for (const unsigned i52 : {0u, 7u, 8u, 15u, 31u}) {
    rig.write('X', 0xFFFFFD, i52);
    rig.write('X', 0xFFFFC7, 0x41);
    EXPECT_EQ(rig.last->wait_states, std::max(7u, i52));
  }
}

// host-bus:2.4/8: both cycles have nine clocks of the old clock, the one behind them is of the new one.
TEST(PortA, ANewClockStartsAfterTheWritingCycle) {
  PortARig rig;
  rig.set_wait_states(31);
  rig.set_wait_states(7);
  ASSERT_EQ(rig.cycle % 2, 0) << "at an edge of the clock that all are made of: two clocks are three of it";
  rig.read('X', 0x078000);
  const auto first = rig.last->start;
  rig.write('X', 0xFFFFFD, 15);
  rig.read('X', 0x078000);
  EXPECT_NEAR((rig.last->start - first) / kNs, (9 + 9) * tc_ns(8), 1e-5);
  EXPECT_NEAR((rig.last->data_time - rig.last->start) / kNs, 7.75 * tc_ns(16) - 5, 1e-5);
}

TEST(PortA, OnChipAccessesMoveNoBusSignal) {
  PortARig rig;
  rig.write('X', 0xFFFFC7, 0x41);
  EXPECT_TRUE(rig.last->on_chip);
  EXPECT_EQ(rig.last->wait_states, 7u);
  for (const char* name : {"bus.addr", "bus.data", "bus.aa"})
    EXPECT_EQ(rig.signals.value(*rig.signals.find(name)), 0u) << name;
  rig.write('X', 0x070010, 0x2);
  EXPECT_EQ(rig.signals.value(*rig.signals.find("bus.addr")), 0x70010u);
  EXPECT_EQ(rig.signals.value(*rig.signals.find("bus.data")), 2u);
}

// /TA says "not yet" up to tick `release`.
std::function<BoardOutputs(Tick)> busy_until(Tick release) {
  return [release](Tick t) {
    BoardOutputs o;
    o.set(pin::kPaTaN, t < release);
    o.set(pin::kPaData, t < release ? 0xBAD : 0x600D);
    o.set(pin::kPaDataOe, 1);
    return o;
  };
}

TEST(PortA, TaAddsClocksUntilItIsLowAtTheSample) {
  BRICK_COVERS("CARD-5");
  PortARig rig(busy_until(60));
  rig.set_wait_states(3);
  const auto start = rig.cycle;
  EXPECT_EQ(rig.read('Y', 0x060000), 0x600Du);
  const PortACycle c = *rig.last;
  ASSERT_GT(c.stretched, 0u);
  EXPECT_EQ(rig.cycle - start, 4 + c.stretched);
  EXPECT_GE(fs_to_tick_floor(c.ta_time), 60) << "the sample that ended the cycle";
  const auto clock = static_cast<TimeFs>(tc_ns(8) * kNs);
  EXPECT_LT(fs_to_tick_floor(c.ta_time - clock), 60) << "the sample before";
  EXPECT_NEAR((c.strobe_high - c.strobe_low) / kNs, (3.25 + c.stretched) * tc_ns(8), 1e-4);
  rig.read('Y', 0x060000);
  EXPECT_GE((rig.last->strobe_low - c.strobe_high) / kNs, 1.75 * tc_ns(8) - 4 - kEpsilon) << "row 113 behind it";
}

TEST(PortA, TaCountsOnlyWithWaitStates) {
  PortARig rig(busy_until(1000));
  rig.set_wait_states(0);
  EXPECT_EQ(rig.read('Y', 0x060000), 0xBADu);
  EXPECT_EQ(rig.last->stretched, 0u);
}

TEST(PortA, ReadsWhatThePinsShowAtTheSampleAndNotLater) {
  BRICK_COVERS("CARD-5");
  // The device is ready at tick 45; with few wait states the CPU asks earlier and gets what was there before.
  const auto slow = [](Tick t) {
    BoardOutputs o;
    o.set(pin::kPaData, t < 45 ? 0x111111 : 0x222222);
    o.set(pin::kPaDataOe, 1);
    return o;
  };
  PortARig quick(slow), patient(slow);
  quick.write('X', 0xFFFFFB, 2 << 5);
  patient.write('X', 0xFFFFFB, 15 << 5);
  EXPECT_EQ(quick.read('X', 0x078000), 0x111111u);
  EXPECT_EQ(patient.read('X', 0x078000), 0x222222u);
}

TEST(PortA, NewClockStartsWithAnEdgeAndCountsExactly) {
  PortARig rig;
  rig.set_clock(10);
  const Tick edge = rig.port_a.clock().tick(rig.cycle);
  EXPECT_EQ(rig.port_a.clock().time(rig.cycle), tick_to_fs(edge));
  // 10 x 9.8304 MHz: ten cycles are twelve ticks.
  EXPECT_EQ(rig.port_a.clock().time(rig.cycle + 1'000'000'000), tick_to_fs(edge + 1'200'000'000));
  EXPECT_EQ(rig.port_a.clock().tick(rig.cycle + 1), edge + 2);
  EXPECT_EQ(rig.port_a.clock().first_cycle(edge + 2), rig.cycle + 2);
}

// A pin that moves within the aperture of an edge is taken early or late, lines of a bus one by one, and every other
// move as without one.
TEST(PortA, ApertureTakesMovesNearAnEdgeEarlyOrLate) {
  constexpr TimeFs kWidth = kFsPerNs;
  Aperture aperture(kWidth, 7);
  PortARig rig, plain;
  rig.port_a.set_aperture(&aperture);
  std::vector<Tick> falls, plain_falls;
  unsigned steps = 0;
  rig.on_pins = [&](Tick t, const BoardInputs& before, const BoardInputs& after) {
    if (before.pa_rd_n && !after.pa_rd_n) falls.push_back(t + 1);
    if (!after.pa_rd_n) return;
    steps += before.pa_addr != after.pa_addr;
  };
  plain.on_pins = [&](Tick t, const BoardInputs& before, const BoardInputs& after) {
    if (before.pa_rd_n && !after.pa_rd_n) plain_falls.push_back(t + 1);
  };
  unsigned early = 0, late = 0, reads = 0;
  std::vector<PortACycle> cycles;
  for (PortARig* r : {&rig, &plain}) {
    r->set_clock(23);  // a cycle is 12/23 of a tick: edges at every 23rd of one
    for (unsigned ws = 4; ws <= 31; ++ws) {
      r->set_wait_states(ws);
      for (unsigned i = 0; i < 40; ++i) {
        r->read('X', 0x078000 | (i % 2 == 0 ? 0x2AAAu : 0x1555u));  // all lines move
        if (r == &rig) cycles.push_back(*rig.last);
        r->cycle += 2 + i % 5;  // the address stands alone
      }
    }
  }
  ASSERT_EQ(falls.size(), plain_falls.size());
  ASSERT_EQ(falls.size(), cycles.size());
  for (std::size_t i = 0; i < falls.size(); ++i, ++reads) {
    const Tick sure = fs_to_tick(cycles[i].strobe_low);
    ASSERT_EQ(plain_falls[i], sure);
    const bool near_next = tick_to_fs(sure) - cycles[i].strobe_low < kWidth;
    const bool near_last = cycles[i].strobe_low - tick_to_fs(sure - 1) <= kWidth;
    if (falls[i] < sure) {
      EXPECT_TRUE(near_last);
      EXPECT_EQ(falls[i], sure - 1);
      ++early;
    } else if (falls[i] > sure) {
      EXPECT_TRUE(near_next);
      EXPECT_EQ(falls[i], sure + 1);
      ++late;
    }
  }
  // In doubt are the edge itself and two 23rds before and after it; half of these are taken otherwise than by their
  // time.
  EXPECT_NEAR(early, reads / 23.0, reads / 46.0);
  EXPECT_NEAR(late, reads * 1.5 / 23.0, reads / 46.0);
  EXPECT_GT(steps, cycles.size() + cycles.size() / 20) << "some addresses in two steps";
  EXPECT_GT(aperture.counts().split, 100u);
}

TEST(PortA, NoApertureIsExact) {
  Aperture none;
  PortARig with, without;
  with.port_a.set_aperture(&none);
  std::vector<Tick> moves[2];
  for (PortARig* rig : {&with, &without})
    rig->on_pins = [&list = moves[rig == &with]](Tick t, const BoardInputs&, const BoardInputs&) { list.push_back(t); };
  for (PortARig* rig : {&with, &without}) {
    rig->set_clock(24);
    rig->set_wait_states(22);
    for (unsigned i = 0; i < 100; ++i) rig->write('Y', 0x078000 + i, i);
  }
  EXPECT_GT(moves[0].size(), 400u);
  EXPECT_EQ(moves[0], moves[1]);
  EXPECT_EQ(none.counts().inside(), 0u);
}

// host-bus:2.6: whatever the CPU clock, the wait states of host-bus:2.5 keep what the board's side needs, with a
// nanosecond of aperture and the delays of the pads, by the rows as the data sheet prints them. At I52 = 31 the gate
// ICs and latches cannot have as many as row 105 asks for.
TEST(PortA, WaitStatesOfEachClockKeepWhatTheBoardNeeds) {
  BRICK_COVERS("CARD-5");
  constexpr double kRef = 1e9 / 39'321'600.0, kAperture = 1.0;
  constexpr double kPad = kRef / 3, kOutput = 10.0;  // 0 to a period of clk_pwm; from the clock to D
  // After the strobe falls at the CPU.
  const double sampled_earliest = kRef - kAperture - kPad, sampled_latest = 2 * kRef + kAperture + kPad;
  const double shown_latest = 3 * kRef + kAperture + kPad;
  for (unsigned i52 = 0; i52 <= 31; ++i52) {
    const double tc = tc_ns(i52 + 1);
    const unsigned gate = i52 <= 7 ? 8 : i52 <= 9 ? 10 : i52 <= 15 ? 16 : i52 <= 23 ? 24 : 31;
    const unsigned latches = i52 <= 9 ? 15 : 31, on_chip = std::max(7u, i52);
    const auto keeps = [&](unsigned ws, double output) {
      SCOPED_TRACE(::testing::Message() << "I52 = " << i52 << ", " << ws << " wait states");
      const double after = 1.25 + (ws >= 8 ? 1 : 0);
      const double wr_low = (ws - 0.5) * tc - 4, hold = after * tc - 2;
      EXPECT_EQ((ws + 0.25) * tc - 5 > shown_latest + output, output == 0 || i52 < 31) << "row 105: the word of a read";
      EXPECT_GT(wr_low, 2 * kRef + kAperture) << "row 102: /WR is low long enough";
      EXPECT_LT(wr_low - ((ws - 0.25) * tc - 3), sampled_earliest) << "row 108: write data late";
      EXPECT_GT(wr_low + hold, sampled_latest) << "rows 103 and 109: address and data gone early";
      EXPECT_GT((ws + 0.25) * tc - 4 + hold, sampled_latest) << "row 117";
    };
    keeps(gate, kOutput);
    keeps(latches, kOutput);
    keeps(on_chip, 0);  // no pads
  }
}

}  // namespace
}  // namespace brick
