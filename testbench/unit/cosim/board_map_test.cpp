// How the blocks are wired to each other and to the address map, through the pins of the whole board, the same
// expectations on both engines. A mistake made in RTL and model alike is invisible to lock-step: these are the places
// where that could happen.
#include <gtest/gtest.h>

#include <string>

#include "testbench/unit/cosim/board_map.h"

namespace brick {
namespace {

const auto kEngineNames = [](const auto& engine) { return std::string(engine.param ? "Rtl" : "Model"); };
// docs/boards.md: the port at Y:$078800 shows the pins, two edges of clk_ref after a change; nothing is there without
// the strap.
TEST_P(BoardMap, ControlPanelPortShowsItsInputs) {
  BRICK_COVERS("BREQ-6");
  constexpr std::uint32_t kPort = 0x078800;
  rig.run(6);
  EXPECT_EQ(rig.read(false, kPort), 0u) << "not fitted";
  rig.in.jpan_fitted = true;
  rig.apply();
  rig.run(6);
  EXPECT_EQ(rig.read(false, kPort), 0xFFFFu);
  for (unsigned input = 0; input < 16; ++input) {
    rig.in.jpan = static_cast<std::uint16_t>(0xFFFF ^ 1u << input);
    EXPECT_EQ(rig.read(false, kPort), 0xFFFFu ^ 1u << input);
  }
  rig.write(false, kPort, 0x5555);
  EXPECT_EQ(rig.read(false, kPort), 0x7FFFu) << "inputs only";
  EXPECT_EQ(rig.read(true, kPort), 0u);
  for (const std::uint32_t other : {0x078801u, 0x078810u, 0x078C00u, 0x079800u, 0x07A800u, 0x078808u})
    EXPECT_EQ(rig.read(false, other), 0u);
}

// Two edges of clk_ref through the port, then a read's sample: the word that it takes at an edge has pins that moved
// before the edge two earlier, and it keeps that word whatever follows.
TEST_P(BoardMap, ControlPanelInputsPassTwoStages) {
  rig.in.jpan_fitted = true;
  rig.in.pa_addr = 0x078800;
  rig.in.pa_x = false;
  rig.in.pa_aa = 2;
  rig.apply();
  for (const Tick late : {0, 1}) {
    rig.in.jpan = 0xFFFF;
    rig.apply();
    rig.run(30 + (3 - rig.now() % 3) - 1);  // the next edge is one of clk_ref
    rig.in.pa_rd_n = false;                 // first seen there; its sample is taken two of clk_ref later
    rig.apply();
    rig.run(late);
    rig.in.jpan = 0xFDFF;
    rig.apply();
    rig.run(7 - late);
    EXPECT_EQ(rig.get(pin::kPaDataOe), 1u);
    EXPECT_EQ(rig.get(pin::kPaData), late == 0 ? 0xFDFFu : 0xFFFFu);
    rig.run(30);
    EXPECT_EQ(rig.get(pin::kPaData), late == 0 ? 0xFDFFu : 0xFFFFu) << "one sample a read";
    rig.in.pa_rd_n = true;
    rig.apply();
  }
}

// host-bus:6.1: 8192 words are $060000..$060FFF, host 0x0000..0x3FFF.
TEST_P(BoardMap, SmallDualPortedRamEndsAt060FFF) {
  rig.in.dpram_small = true;
  rig.apply();
  rig.run(6);
  memory_write(0x3FFC, 0x1234);
  memory_write(0x3FFE, 0x5678);
  EXPECT_EQ(rig.read(false, 0x060FFF), 0x1234u);
  EXPECT_EQ(rig.read(true, 0x060FFF), 0x5678u);
  memory_write(0x4000, 0x9999);
  rig.write(false, 0x063FFF, 0x7777);
  EXPECT_EQ(memory_read(0x4000), 0u);
  EXPECT_EQ(rig.read(false, 0x061000), 0u);
  EXPECT_EQ(memory_read(0xFFFC), 0u);
  EXPECT_EQ(memory_read(0x0000), 0u) << "no alias";
  rig.in.dpram_small = false;
  rig.apply();
  rig.run(6);
  rig.write(false, 0x063FFF, 0x7777);
  EXPECT_EQ(memory_read(0xFFFC), 0x7777u);
  EXPECT_EQ(rig.read(true, 0x060FFF), 0x5678u);
}

INSTANTIATE_TEST_SUITE_P(Engines, BoardMap, ::testing::Values(true, false), kEngineNames);

// host-bus:4.2, Turbo PMAC2-PC: IPOS, BREQ, EROR, F1ER, HREQ, EQU1, EQU5, WDO are IR0 to IR7; host-bus:5.7: bits of
// X:$070010.
TEST_P(BoardMap, EachSignalIsItsLineOfTheInterruptController) {
  for (unsigned bit = 0; bit < 4; ++bit) {
    rig.write(true, kHostSignals, 1u << bit);
    EXPECT_EQ(rig.get(pin::kPicSig), 1u << bit);
    EXPECT_EQ(io_read(9), 1u << bit);
  }
  rig.write(true, kHostSignals, 0);
  io_write(0, 2);  // ICR.TREQ while the host port can take a word
  EXPECT_EQ(rig.get(pin::kHreq), 1u);
  EXPECT_EQ(io_read(9), 0x10u);
  io_write(0, 0);
  EXPECT_EQ(io_read(9), 0u);
  rig.edge(pin::kWdTripped, 1);
  rig.run(9);
  EXPECT_EQ(rig.get(pin::kWdo), 1u);
  EXPECT_EQ(io_read(9), 0x80u);
}

// host-bus:4.2: each board has its own sources of IR5, IR6 and IR7. EQU is written by bits 11 and 12 of a channel's
// control word.
TEST_P(BoardMap, ThreeLinesOfTheInterruptControllerAreChosenByTheBoard) {
  const auto set_equ = [this](unsigned n, bool level) {
    rig.write(true, kServoIcBase[n / 4] + 8 * (n % 4) + 5, 1u << 11 | (level ? 1u << 12 : 0u));
    rig.run(9);
  };
  const auto select = [this](unsigned ir5, unsigned ir6, unsigned ir7) {
    rig.in.line_select = static_cast<std::uint16_t>(ir5 | ir6 << 4 | ir7 << 8);
    rig.apply();
    rig.run(9);
  };
  for (unsigned n = 0; n < 8; ++n) {
    SCOPED_TRACE(n + 1);
    set_equ(n, true);
    for (unsigned code = 0; code < 16; ++code) {
      const bool high = code == n + 1;
      select(code, 0, 0);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x20u : 0u);
      select(0, code, 0);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x40u : 0u);
      select(0, 0, code);
      EXPECT_EQ(rig.get(pin::kPicSig), high ? 0x80u : 0u);
    }
    select(n + 1, n + 1, n + 1);
    EXPECT_EQ(rig.get(pin::kPicSig), 0xE0u);
    set_equ(n, false);
    EXPECT_EQ(rig.get(pin::kPicSig), 0u) << "falls while it is selected";
  }
  select(9, 0, 9);
  EXPECT_EQ(rig.get(pin::kPicSig), 0u);
  rig.edge(pin::kWdTripped, 1);
  rig.run(9);
  EXPECT_EQ(rig.get(pin::kPicSig), 0xA0u) << "WDO";
}

// host-bus:1.1: the on-chip page has 128 words, and those of the host port are in it once: 64 below nothing is written,
// nothing is taken.
TEST_P(BoardMap, TheHostPortIsInTheOnChipPageOnce) {
  constexpr unsigned kHcr = 0x42, kHorx = 0x46, kHotx = 0x47, kOther = 0x40;
  constexpr std::uint32_t kHf2 = 1 << 3;
  on_chip_write(kHotx ^ kOther, 0x41);
  on_chip_write(kHcr ^ kOther, kHf2);
  EXPECT_EQ(rig.get(pin::kRxdf), 0u);
  EXPECT_EQ(io_read(2), 0x06u);
  on_chip_write(kHotx, 0x41);
  on_chip_write(kHcr, kHf2);
  EXPECT_EQ(rig.get(pin::kRxdf), 1u);
  EXPECT_EQ(io_read(2), 0x0Fu) << "RXDF, TXDE, TRDY, HF2";
  io_write(7, 0x42);
  io_write(7, 0x43);
  EXPECT_EQ(rig.get(pin::kTxde), 0u) << "HORX and TX are full";
  const auto read = [&](unsigned address) {
    begin_on_chip_read(address);
    rig.run(9);
    const std::uint32_t word = rig.get(pin::kPaData);
    rig.in.pa_rd_n = true;
    rig.apply();
    rig.run(6);
    rig.in.pa_int = false;
    rig.apply();
    rig.run(6);
    return word;
  };
  EXPECT_EQ(read(kHorx ^ kOther), 0u);
  EXPECT_EQ(rig.get(pin::kTxde), 0u);
  EXPECT_EQ(read(kHorx), 0x42u);
  EXPECT_EQ(rig.get(pin::kTxde), 1u);
}

// host-bus:1.1: the latches are X words.
TEST_P(BoardMap, YWordsOfTheLatchesDoNothing) {
  rig.write(true, kHostSignals, 0x5);
  rig.write(false, kHostSignals, 0xA);
  EXPECT_EQ(rig.get(pin::kIpos), 1u);
  EXPECT_EQ(rig.get(pin::kBreq), 0u);
  EXPECT_EQ(rig.read(false, kHostSignals), 0u);
  rig.write(true, kServoIcBase[0] + 4, 0x3008D2);  // SERVO runs, so only the strobe is missing
  rig.run(10 * kPwmClockHz / 1000);
  rig.write(false, kWatchdogStrobe, 1);
  EXPECT_EQ(rig.read(true, kWatchdogStrobe), 0u) << "and a read is no strobe, servo-ic:10/5";
  // 25 ms after reset, not after those.
  EXPECT_LE(rig.edge(pin::kWdTripped, 1), 25 * kPwmClockHz / 1000 + 20);
}

// host-bus:6.1: Y word at host offset 4 (a - $060000), X word at offset + 2, 16 bits of each exist.
TEST_P(BoardMap, WordsOfTheDualPortedRamLieWhereTheHostExpectsThem) {
  for (const std::uint32_t a : {0x60000u, 0x60414u, 0x63FFFu}) {
    const unsigned offset = 4 * (a - 0x60000);
    rig.write(false, a, 0xAB1234);
    rig.write(true, a, 0xCD5678);
    EXPECT_EQ(rig.read(false, a), 0x001234u);
    EXPECT_EQ(rig.read(true, a), 0x005678u);
    EXPECT_EQ(memory_read(offset), 0x1234u) << std::hex << offset;
    EXPECT_EQ(memory_read(offset + 2), 0x5678u);
    memory_write(offset + 2, 0x9ABC);
    EXPECT_EQ(rig.read(true, a), 0x9ABCu);
    EXPECT_EQ(rig.read(false, a), 0x1234u);
  }
}

// host-bus:6.9: BUSY becomes /TA on the CPU's side, IOCHRDY on the host's.
TEST_P(BoardMap, BusyStretchesTheCycleOfTheLaterSide) {
  rig.write(false, 0x60010, 0x1111);
  memory_address(0x40);
  rig.in.isa_sd = 0x2222;
  strobe(&BoardInputs::isa_memw_n, 12);  // the host owns the cell
  EXPECT_EQ(rig.get(pin::kPaTaN), 0u);
  rig.in.pa_addr = 0x60010;
  rig.in.pa_x = false;
  rig.in.pa_aa = 4;
  rig.in.pa_rd_n = false;
  rig.apply();
  rig.run(4);
  EXPECT_EQ(rig.get(pin::kPaTaN), 1u);
  EXPECT_EQ(rig.get(pin::kBusyCpu), 1u);
  EXPECT_EQ(rig.get(pin::kIsaIochrdy), 1u);
  end(&BoardInputs::isa_memw_n);
  EXPECT_EQ(rig.get(pin::kPaTaN), 0u);
  EXPECT_EQ(rig.get(pin::kPaData), 0x2222u) << "the new word";
  strobe(&BoardInputs::isa_memw_n, 12);  // now the CPU holds it
  EXPECT_EQ(rig.get(pin::kIsaIochrdy), 0u);
  EXPECT_EQ(rig.get(pin::kBusyHost), 1u);
  EXPECT_EQ(rig.get(pin::kPaTaN), 0u);
  rig.in.pa_rd_n = true;
  rig.apply();
  rig.run(12);
  EXPECT_EQ(rig.get(pin::kIsaIochrdy), 1u);
  end(&BoardInputs::isa_memw_n);
}

// servo-ic:7.2: the lowest-numbered driver wins each net; here only SERVO has two.
TEST_P(BoardMap, TwoDriversOfServoAloneAreAConflictToo) {
  rig.write(true, kServoIcBase[1] + 4, 0x3008D2);             // IC 1 drives both
  rig.write(true, kServoIcBase[0] + 4, 0x3008D2 | 1u << 12);  // IC 0 drives SERVO from that PHASE
  constexpr Tick kServoPeriod = 4 * 13057;  // pins are released while high and taken with a rise, each within a period
  rig.run(3 * kServoPeriod);
  EXPECT_EQ(rig.get(pin::kPhaseSource), 1u);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 1u);
  rig.write(true, kServoIcBase[1] + 4, 0x3008D2 | 1u << 13);  // IC 1 gives SERVO up
  rig.run(kServoPeriod);
  EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
}

// servo-ic:1.2, the whole table. Engines without a variant for all the ICs are not tested, the model always is.
TEST(AddressMap, EveryServoIcIsAtItsBase) {
  constexpr std::uint32_t kAll = 0x3FFFF;
  const std::uint32_t bases[] = {0x78000, 0x78100, 0x78200, 0x78300, 0x79200, 0x79300, 0x7A200, 0x7A300, 0x7B200,
                                 0x7B300, 0x78220, 0x78320, 0x79220, 0x79320, 0x7A220, 0x7A320, 0x7B220, 0x7B320};
  for (const bool rtl : {false, true}) {
    std::unique_ptr<Board> board;
    try {
      board = rtl ? make_rtl_board(kAll) : make_model_board(kAll);
    } catch (const std::runtime_error&) {
      ASSERT_TRUE(rtl);
      continue;
    }
    SCOPED_TRACE(rtl ? "RTL" : "model");
    BoardRig rig(std::move(board), kAll);
    for (std::uint32_t i = 0; i < 18; ++i) rig.write(true, bases[i] + 0x14, 0x101 * (i + 1));
    for (std::uint32_t i = 0; i < 18; ++i) {
      EXPECT_EQ(rig.read(true, bases[i] + 0x14), 0x101 * (i + 1)) << std::hex << bases[i];
      rig.write(true, bases[i] + 4, 0x3008D2);  // becomes the one source
      rig.run(3 * 13057);                       // with a rise of PHASE
      EXPECT_EQ(rig.get(pin::kPhaseSource), i);
      EXPECT_EQ(rig.get(pin::kSourceConflict), 0u);
      rig.write(true, bases[i] + 4, 0x3038D2);
      rig.run(4 * 13057);  // released while PHASE and SERVO are high
    }
    for (const std::uint32_t hole : {0x78020u, 0x78120u, 0x79000u, 0x7A100u, 0x78600u})
      EXPECT_EQ(rig.read(true, hole + 0x14), 0u);
  }
}

}  // namespace
}  // namespace brick
