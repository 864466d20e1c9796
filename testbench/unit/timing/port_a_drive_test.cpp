// Strobes at the pins of a made-up board, tick by tick: D is driven from the edge that the rules name to the end of
// /RD. Each fault has a life of its own.
#include "testbench/checkers/port_a_drive.h"

#include <gmock/gmock.h>

#include <functional>

namespace brick {
namespace {

constexpr Tick kFall = 30, kRise = 45;     // applied behind these edges; /RD is found low by 31
constexpr Tick kRegister = 39, kRam = 33;  // 31 + 3 = 34, so edge 36 takes the address and 39 the sample; 31 + 2

// A cycle between kFall and kRise of a board that drives D while `drives` says so, looked at after each edge and after
// each move of the strobe.
PortADrive life(PortADrive::Cycle of, bool write, const std::function<bool(Tick tick, bool low)>& drives,
                Tick word_moves = kNever) {
  PortADrive judge;
  judge.cycle(of, write);
  PortAPins pins;
  pins.pa_rd_n = pins.pa_wr_n = true;
  const auto shown = [&](Tick tick) {
    BoardOutputs o;
    o.set(pin::kPaDataOe, drives(tick, !pins.pa_rd_n || !pins.pa_wr_n) ? 1 : 0);
    o.set(pin::kPaData, tick >= word_moves ? 6 : 5);
    return o;
  };
  for (Tick tick = kFall - 5; tick < kRise + 10; ++tick) {
    judge.edge(tick, shown(tick));
    if (tick != kFall && tick != kRise) continue;
    (write ? pins.pa_wr_n : pins.pa_rd_n) = tick == kRise;
    judge.lines(tick, pins, shown(tick));
  }
  return judge;
}

bool never(Tick, bool) { return false; }
auto from(Tick on) {
  return [on](Tick tick, bool low) { return low && tick >= on; };
}

TEST(PortADrive, ReadsOfTheBoardFromTheirEdgeToTheEndOfTheStrobe) {
  EXPECT_EQ(life(PortADrive::kRegisters, false, from(kRegister)).text(), "");
  EXPECT_EQ(life(PortADrive::kRam, false, from(kRam)).text(), "");
  EXPECT_EQ(life(PortADrive::kRam, false, from(kRam)).driven(PortADrive::kRam), 1u);
  for (const PortADrive::Cycle of : {PortADrive::kOther, PortADrive::kRegisters, PortADrive::kRam})
    EXPECT_EQ(life(of, true, never).text(), "");
  EXPECT_EQ(life(PortADrive::kOther, false, never).text(), "");
}

TEST(PortADrive, EachFaultIsNamed) {
  using ::testing::HasSubstr;
  const struct {
    PortADrive::Cycle of;
    bool write;
    std::function<bool(Tick, bool)> drives;
    const char* text;
  } faults[] = {
      {PortADrive::kRegisters, false, from(kRegister - 1), "driven too early in a read of a register"},
      {PortADrive::kRegisters, false, from(kRegister + 1), "not driven in a read of its own"},
      {PortADrive::kRam, false, from(kRam - 1), "driven too early in a read of the RAM"},
      {PortADrive::kRam, false, from(kRam + 1), "not driven in a read of its own"},
      {PortADrive::kRam, false, never, "not driven in a read of its own"},
      {PortADrive::kRam, false, [](Tick t, bool low) { return low && t >= kRam && t != 40; },
       "not driven in a read of its own"},
      {PortADrive::kRam, false, [](Tick t, bool) { return t >= kRam && t <= kRise; }, "driven behind /RD"},
      {PortADrive::kRegisters, true, from(kRegister), "driven in a write of a register"},
      {PortADrive::kOther, true, from(kRegister), "driven in a write of another device"},
      {PortADrive::kOther, false, from(kRam), "driven in a read of another device"},
      {PortADrive::kOther, false, [](Tick t, bool) { return t == kFall - 2; }, "driven behind /RD"},
  };
  for (const auto& f : faults) EXPECT_THAT(life(f.of, f.write, f.drives).text(), HasSubstr(f.text));
  EXPECT_THAT(life(PortADrive::kRam, false, from(kRam), kRise - 2).text(), HasSubstr("a word that moves"));
}

}  // namespace
}  // namespace brick
