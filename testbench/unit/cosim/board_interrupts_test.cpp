// The interrupt lines that come from outside or from a user program, the lamps of the control panel, and the 8259 in
// the place of the other controller: how they are wired, through the pins of the whole board, on both engines.
#include <gtest/gtest.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cosim/engines.h"
#include "testbench/unit/cosim/board_map.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr std::uint32_t kHostSignals = 0x070010, kControlOutputs = 0x070012;

class BoardInterrupts : public ::testing::TestWithParam<bool> {
 protected:
  BoardInterrupts() : rig(GetParam() ? make_rtl_board(kTwoServoIcs) : make_model_board(kTwoServoIcs), kTwoServoIcs) {}

  void cycle(bool BoardInputs::*command, unsigned offset) {
    rig.in.isa_sa = kIoBase + offset;
    rig.apply();
    rig.run(10);
    rig.in.*command = false;
    rig.apply();
    run(60);
    data = rig.get(pin::kIsaSd) & 0xFF;
    rig.in.*command = true;
    rig.apply();
    run(12);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      rig.run(1);
      irq_low = rig.get(pin::kIsaIrq) != 0 ? 0 : irq_low + 1;
      longest_low = std::max(longest_low, irq_low);
    }
  }
  // Ticks for which IRQ is low after a cycle that serves, before it is high again.
  template <class Service>
  int low_after(Service service) {
    longest_low = irq_low = 0;
    service();
    run(30);
    EXPECT_EQ(rig.get(pin::kIsaIrq), 1u);
    return longest_low;
  }
  void io_write(unsigned offset, std::uint16_t value) {
    rig.in.isa_sd = value;
    cycle(&BoardInputs::isa_iow_n, offset);
  }
  std::uint32_t io_read(unsigned offset) {
    cycle(&BoardInputs::isa_ior_n, offset);
    return data;
  }
  void select(unsigned ir5, unsigned ir6, unsigned ir7) {
    rig.in.line_select = static_cast<std::uint16_t>(ir5 | ir6 << 4 | ir7 << 8);
    settle();
  }
  void settle() {
    rig.apply();
    rig.run(12);
  }
  void fit_8259() {
    rig.in.pic_8259 = true;
    settle();
    for (const auto& [offset, value] : {std::pair{8u, 0x13}, {9u, 0x08}, {9u, 0x01}, {9u, 0xFD}})
      io_write(offset, static_cast<std::uint16_t>(value));
  }

  BoardRig rig;
  std::uint32_t data = 0;
  int irq_low = 0, longest_low = 0;
};

// host-bus:4.2/3: codes 10 CTRL0, 11 CTRL1, 12 MI1, 13 MI2, 14 AXEXP0, 15 AXEXP1.
TEST_P(BoardInterrupts, LinesFromOutsideAndFromProgramsAreChosenByTheBoard) {
  const auto drive = [&](unsigned code, bool level) {
    if (code == 10 || code == 11) rig.write(true, kControlOutputs, level ? 1u << (code - 10) : 0u);
    if (code == 12) rig.in.mi1 = level;
    if (code == 13) rig.in.mi2 = level;
    if (code == 14) rig.in.axexp0 = level;
    if (code == 15) rig.in.axexp1 = level;
    settle();
  };
  rig.run(6);
  for (unsigned source = 10; source < 16; ++source) {
    drive(source, true);
    for (unsigned code = 0; code < 16; ++code) {
      const bool high = code == source;
      select(code, 0, 0);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x20u : 0u) << source << " by " << code;
      select(0, code, 0);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x40u : 0u) << source << " by " << code;
      select(0, 0, code);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x80u : 0u) << source << " by " << code;
    }
    select(source, source, source);
    EXPECT_EQ(io_read(9), 0xE0u);
    drive(source, false);
    EXPECT_EQ(io_read(9), 0u) << "falls while it is selected";
  }
}

TEST_P(BoardInterrupts, ControlOutputsAreALatchOfTheirOwn) {
  rig.run(6);
  for (unsigned value = 0; value < 4; ++value) {
    rig.write(true, kControlOutputs, 0xFFFFFC | value);
    EXPECT_EQ(rig.read(true, kControlOutputs), value);
    EXPECT_EQ(rig.get(pin::kCtrl0), value & 1);
    EXPECT_EQ(rig.get(pin::kCtrl1), value >> 1);
    EXPECT_EQ(rig.read(true, kHostSignals), 0u);
  }
  rig.write(true, kHostSignals, 0xF);
  EXPECT_EQ(rig.read(true, kControlOutputs), 3u);
  rig.write(false, kControlOutputs, 0);
  EXPECT_EQ(rig.read(true, kControlOutputs), 3u) << "an X word";
}

// servo-ic:10/10: low with the trip, whatever is written; a reset ends it, and nothing is left of what they were.
TEST_P(BoardInterrupts, ControlOutputsAreLowFromTripToReset) {
  rig.run(6);
  for (const unsigned value : {3u, 1u, 2u}) {
    rig.write(true, kControlOutputs, value);
    rig.in.pwr_good = false;
    rig.apply();
    rig.edge(pin::kWdTripped, 1, 20);
    EXPECT_EQ(rig.get(pin::kWdTripped), 1u);
    EXPECT_EQ(rig.get(pin::kCtrl0) + rig.get(pin::kCtrl1), 0u) << "at the tick of the trip";
    EXPECT_EQ(rig.read(true, kControlOutputs), 0u);
    for (const unsigned written : {1u, 2u, 3u}) {
      rig.write(true, kControlOutputs, written);
      EXPECT_EQ(rig.get(pin::kCtrl0) + rig.get(pin::kCtrl1), 0u) << written;
      EXPECT_EQ(rig.read(true, kControlOutputs), 0u) << written;
    }
    rig.in.pwr_good = true;
    rig.in.rst_n = false;
    rig.apply();
    rig.run(30);
    rig.in.rst_n = true;
    rig.apply();
    rig.run(30);
    EXPECT_EQ(rig.get(pin::kWdTripped), 0u);
    EXPECT_EQ(rig.get(pin::kCtrl0) + rig.get(pin::kCtrl1), 0u);
    rig.write(true, kControlOutputs, value);
    EXPECT_EQ(rig.read(true, kControlOutputs), value);
  }
}

// host-bus:3.5/1: one line, high while any enabled line interrupts.
TEST_P(BoardInterrupts, LineToThePcIsActiveHigh) {
  rig.run(6);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u);
  io_write(10, 0x03);
  for (const unsigned signals : {1u, 2u, 3u}) {
    rig.write(true, kHostSignals, signals);
    rig.run(12);
    EXPECT_EQ(rig.get(pin::kIsaIrq), 1u);
    io_write(8, 0);
    EXPECT_EQ(rig.get(pin::kIsaIrq), 0u) << "cleared";
    rig.write(true, kHostSignals, 0);
    rig.run(12);
  }
  rig.write(true, kHostSignals, 4);
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u) << "masked";
}

// host-bus:5.6/5: a low level lights; without the connector they stay dark.
TEST_P(BoardInterrupts, LampsAreTheInverseOfTheirSignals) {
  BRICK_COVERS("BREQ-6");
  const PinField* lamps[] = {&pin::kIpldN, &pin::kBrldN, &pin::kErldN, &pin::kF1ldN};  // bits 0..3 of X:$070010
  for (const bool fitted : {false, true}) {
    rig.in.jpan_fitted = fitted;
    settle();
    for (unsigned value = 0; value < 16; ++value) {
      rig.write(true, kHostSignals, value);
      for (unsigned bit = 0; bit < 4; ++bit)
        EXPECT_EQ(rig.get(*lamps[bit]), fitted && (value >> bit & 1) != 0 ? 0u : 1u) << lamps[bit]->name;
    }
  }
}

// host-bus:4.5: the same lines, other registers; the named signals keep their meaning.
TEST_P(BoardInterrupts, The8259TakesTheOtherControllersPlace) {
  fit_8259();
  EXPECT_EQ(rig.get(pin::kPicMsk), 0x02u);
  EXPECT_EQ(rig.get(pin::kPicElr), 0x00u);
  rig.write(true, kHostSignals, 0x6);  // BREQ, and EROR which is masked
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kPicSig), 0x06u);
  EXPECT_EQ(rig.get(pin::kPicIst), 0x02u);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 1u);
  EXPECT_EQ(io_read(8), 0x06u) << "IRR";
  EXPECT_EQ(io_read(10), 0x09u) << "acknowledged: IR1 of base 08";
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u);
  EXPECT_EQ(io_read(10), 0x0Fu) << "once";
  EXPECT_EQ(io_read(8), 0x04u) << "IRR";
  io_write(8, 0x0B);
  EXPECT_EQ(io_read(8), 0x02u) << "ISR";
  io_write(8, 0x61);
  EXPECT_EQ(io_read(8), 0x00u);
  EXPECT_EQ(io_read(9), 0xFDu) << "IMR";
  EXPECT_EQ(io_read(11), 0xFFu);
}

// host-bus:4.1, host-bus:4.5/13: the named signals are those of the controller that is fitted, by level and by edge.
TEST_P(BoardInterrupts, NamedSignalsAreThoseOfTheControllerThatIsFitted) {
  rig.run(6);
  io_write(10, 0x05);
  io_write(11, 0x04);
  EXPECT_EQ(rig.get(pin::kPicMsk), 0x05u);
  EXPECT_EQ(rig.get(pin::kPicElr), 0x04u);
  rig.write(true, kHostSignals, 0x7);  // an edge, one that is masked, a level
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kPicSig), 0x07u);
  EXPECT_EQ(rig.get(pin::kPicIst), 0x05u);
  rig.write(true, kHostSignals, 0);
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kPicIst), 0x01u);
  fit_8259();
  EXPECT_EQ(rig.get(pin::kPicElr), 0x00u);
  for (const auto& [offset, value] : {std::pair{8u, 0x1Bu}, {9u, 0x08u}, {9u, 0x01u}, {9u, 0xF5u}})  // LTIM
    io_write(offset, static_cast<std::uint16_t>(value));
  EXPECT_EQ(rig.get(pin::kPicElr), 0xFFu);
  EXPECT_EQ(rig.get(pin::kPicMsk), 0x0Au);
  rig.write(true, kHostSignals, 0xE);
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kPicSig), 0x0Eu);
  EXPECT_EQ(rig.get(pin::kPicIst), 0x0Au);
}

// host-bus:3.8/3: RESETDRV resets what stands behind the host bus, and a request with it; an 8259 does not see it.
TEST_P(BoardInterrupts, ResetdrvResetsTheHostSideAndNo8259) {
  const auto resetdrv = [this] {
    for (const bool level : {true, false}) {
      rig.in.isa_resetdrv = level;
      settle();
    }
  };
  rig.run(6);
  io_write(0, 0x08);
  io_write(11, 0x80);
  io_write(10, 0x02);
  rig.write(true, kHostSignals, 2);
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 1u);
  resetdrv();
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u);
  for (const unsigned offset : {0u, 10u, 11u}) EXPECT_EQ(io_read(offset), 0u) << "+" << offset;
  io_write(10, 0x02);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u) << "the line has been high all the time";
  rig.write(true, kHostSignals, 0);
  fit_8259();
  rig.write(true, kHostSignals, 2);
  rig.run(12);
  resetdrv();
  EXPECT_EQ(rig.get(pin::kIsaIrq), 1u);
  EXPECT_EQ(io_read(9), 0xFDu) << "IMR";
}

// host-bus:3.5/2: a PC senses edges, so what a service leaves raises IRQ anew, 4 clocks of clk_ref later.
TEST_P(BoardInterrupts, IrqRisesAnewForALevelThatAClearLeaves) {
  rig.run(6);
  select(12, 0, 0);
  io_write(11, 0x20);
  io_write(10, 0x20);
  rig.in.mi1 = true;
  settle();
  EXPECT_EQ(low_after([&] { io_write(8, 0); }), 12);
  EXPECT_EQ(low_after([&] { io_read(8); }), 0) << "a read of IST serves nothing";
}

TEST_P(BoardInterrupts, IrqRisesAnewForWhatAnAcknowledgeLeaves) {
  fit_8259();
  for (const auto& [offset, value] : {std::pair{8u, 0x13}, {9u, 0x08}, {9u, 0x03}, {9u, 0x00}})  // AEOI
    io_write(offset, static_cast<std::uint16_t>(value));
  select(12, 13, 15);
  rig.in.mi1 = rig.in.mi2 = rig.in.axexp1 = true;
  settle();
  for (const unsigned vector : {0x0Du, 0x0Eu}) {
    EXPECT_EQ(low_after([&] { io_read(10); }), 12);
    EXPECT_EQ(data, vector);
  }
  EXPECT_EQ(io_read(10), 0x0Fu);
  EXPECT_EQ(rig.get(pin::kIsaIrq), 0u);
}

TEST_P(BoardInterrupts, The8259HasTheLinesOfTheBoardInTheirOrder) {
  fit_8259();
  io_write(9, 0x00);
  select(12, 13, 15);
  bool BoardInputs::*const inputs[] = {&BoardInputs::mi1, &BoardInputs::mi2, &BoardInputs::axexp1};
  for (unsigned n = 0; n < 8; ++n) {
    if (n < 4) rig.write(true, kHostSignals, 1u << n);
    if (n == 4) rig.write(true, kHostSignals, 0);
    if (n == 4) io_write(0, 2);  // ICR.TREQ
    if (n == 5) io_write(0, 0);
    for (unsigned i = 0; i < 3; ++i) rig.in.*inputs[i] = n == 5 + i;
    settle();
    EXPECT_EQ(io_read(10), 8 + n);
    io_write(8, static_cast<std::uint16_t>(0x60 | n));
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, BoardInterrupts, ::testing::Values(true, false),
                         [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); });

}  // namespace
}  // namespace brick
