// Hosts that keep no rule and boards that are silent or drive where they may not: each is named, and nothing else is.
#include "testbench/unit/checkers/isa_checker_fixture.h"

namespace brick {
namespace {

// Rows 4 and 14: the board's own, for as long as the limit, and no data on every lane that the host reads.
TEST_F(IsaCheckerTest, ReadThatTheBoardDoesNotAnswerBreaksTheRowOfItsData) {
  Points never;
  never.valid = kNever;
  io(never);
  ASSERT_EQ(broken(), std::vector<std::string>{"t4"});
  EXPECT_EQ(checker_.ledger().violations()[0].measured, never.width);
  EXPECT_EQ(timing_address(checker_.ledger().violations()[0].where), "I/O 0x212");
  checker_.ledger().forget();
  memr(never);
  EXPECT_EQ(broken(), std::vector<std::string>{"t14"});
  checker_.ledger().forget();
  never.ready_low = 70 * kNs;  // that IOCHRDY was low is no excuse
  memr(never);
  EXPECT_EQ(broken(), std::vector<std::string>{"t14"});
  checker_.ledger().forget();
  never.ready_high = 700 * kNs;  // but while it is low nothing is promised
  memr(never);
  EXPECT_EQ(broken(), std::vector<std::string>{"t9"});
  checker_.ledger().forget();
  Points held = never;  // for 15.6 us at most, whether it rises or not
  held.width = 70 * kNs + 15'600 * kNs + 1;
  held.ready_high = held.width + 100 * kNs;
  memr(held);
  EXPECT_THAT(broken(), ::testing::UnorderedElementsAre("t9", "t10"));
  checker_.ledger().forget();
  for (const unsigned lanes : {1u, 2u}) {
    Points half;
    half.lanes = lanes;
    memr(half);
    EXPECT_EQ(broken(), std::vector<std::string>{"t14"}) << lanes;
    checker_.ledger().forget();
    for (const bool sbhe_n : {true, false}) {
      at(end_ + 200 * kNs, [=] { in_.isa_sbhe_n = sbhe_n; });
      io(half);
      EXPECT_EQ(broken().size(), lanes - 1) << "I/O is on the lower lane, whatever SBHE# is";
      checker_.ledger().forget();
    }
  }
  EXPECT_EQ(checker_.read_cycles_answered(), 2u);
}

// A read that the board does not answer breaks the row of its data where it is the board's own, and no other.
class IsaCheckerSwitches : public IsaCheckerTest {
 protected:
  void expect(bool own, const char* row, std::uint32_t address) {
    Points never;
    never.valid = kNever;
    checker_.ledger().forget();
    address < 0x10000 ? io(never, address) : memr(never, address);
    EXPECT_EQ(broken(), own ? std::vector<std::string>{row} : std::vector<std::string>{}) << std::hex << address;
  }
};

// host-bus:3.7: 16 or 64 KiB, and no LA in a slot of 8 bits.
TEST_F(IsaCheckerSwitches, WindowOfTheBoardIsThatOfThem) {
  in_.window = 0xD4000 >> 14;
  for (const bool flat : {false, true}) {
    SCOPED_TRACE(flat ? "64 KiB" : "16 KiB");
    in_.window_flat = flat;
    show();
    for (const std::uint32_t address : {0xD4000u, 0xD7FFEu}) expect(true, "t14", address);
    for (const std::uint32_t outer : {0xD0000u, 0xD3FFEu, 0xD8000u, 0xDFFFEu}) expect(flat, "t14", outer);
    for (const std::uint32_t address : {0xCFFFEu, 0xE0000u, 0x1D4000u}) expect(false, "t14", address);
  }
  in_.slot8 = true;
  show();
  at(end_ + 250 * kNs, [this] { in_.isa_la = 0x7F; });
  expect(true, "t4", 0xD4000);
  at(end_ + 250 * kNs, [this] { in_.isa_la = 0xD4000 >> 17; });
  expect(false, "t4", 0xA4000);
}

TEST_F(IsaCheckerSwitches, IoBlockOfTheBoardIsThatOfThem) {
  in_.io_base = 0x71;
  for (const bool decode16 : {true, false}) {
    SCOPED_TRACE(decode16 ? "16 bits" : "10 bits");
    in_.io_decode16 = decode16;
    show();
    for (const std::uint32_t address : {0x710u, 0x71Fu}) expect(true, "t4", address);
    for (const std::uint32_t address : {0x310u, 0xF10u, 0x8710u}) expect(!decode16, "t4", address);
    for (const std::uint32_t address : {0x700u, 0x730u, 0x610u}) expect(false, "t4", address);
  }
}

// Row 5: each lane that the host reads, until the command ends.
TEST_F(IsaCheckerTest, DataThatGoBeforeTheCommandBreakRow5) {
  for (const unsigned left : {0u, 1u, 2u}) {
    for (const TimeFs early : {kNs, TimeFs{0}}) {
      at(end_ + 900 * kNs - early, [=] { out_.set(pin::kIsaSdOe, left); });
      memr({});
      EXPECT_EQ(broken(), early > 0 ? std::vector<std::string>{"t5"} : std::vector<std::string>{}) << left;
      checker_.ledger().forget();
    }
  }
  at(end_ + 400 * kNs, [=] { out_.set(pin::kIsaSdOe, 1); });  // gone, and back too late
  at(end_ + 300 * kNs + 174 * kNs, [=] { out_.set(pin::kIsaSdOe, 3); });
  memr({});
  EXPECT_EQ(broken(), std::vector<std::string>{"t14"});
}

TEST_F(IsaCheckerTest, ReadThatTheBoardNeedNotAnswerBreaksNothing) {
  Points never;
  never.valid = kNever;
  io(never, 0x220);
  memr(never, 0xE0000);
  in_.isa_aen = true;
  show();
  io(never);
  Points dma = never;
  dma.sa = -50 * kNs;  // nor is it a cycle of row 1
  io(dma);
  in_.isa_aen = false;
  show();
  never.width = 489 * kNs;  // too short for its data, and reported as such
  io(never);
  EXPECT_EQ(broken(), std::vector<std::string>{"t2"});
  checker_.ledger().forget();
  never.width = 600 * kNs;

  // host-bus:3.8/4: from a reset's end, 120 ns.
  for (const auto& level : std::vector<std::function<void(bool)>>{[this](bool on) { in_.isa_resetdrv = on; },
                                                                  [this](bool on) { in_.rst_n = !on; }}) {
    for (const TimeFs after : {120 * kNs - 1, 120 * kNs}) {
      at(end_ + 500 * kNs, [=] { level(true); });
      at(end_ + 1000 * kNs - after, [=] { level(false); });
      never.next = 1000 * kNs;
      io(never);
      EXPECT_EQ(broken().size(), after == 120 * kNs ? 1u : 0u);
      checker_.ledger().forget();
    }
  }
}

TEST_F(IsaCheckerTest, UnsoundHostsAreNamed) {
  at(end_ + 300 * kNs, [this] { in_.isa_sa = 0x217; });
  at(end_ + 500 * kNs, [this] { in_.isa_iow_n = false; });
  at(end_ + 900 * kNs, [this] { in_.isa_ior_n = false; });
  at(end_ + 1100 * kNs, [this] { in_.isa_iow_n = in_.isa_ior_n = true; });
  play();
  ASSERT_EQ(broken(), std::vector<std::string>{"one-command"});
  EXPECT_EQ(timing_address(checker_.ledger().violations()[0].where), "I/O 0x217");
  checker_.ledger().forget();

  end_ = now_;
  at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
  at(end_ + 600 * kNs, [this] { out_.set(pin::kIsaSdOe, 1); });
  at(end_ + 700 * kNs, [this] { in_.isa_sa = 0x219; });
  at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true; });
  at(end_ + 1105 * kNs, [this] { out_.set(pin::kIsaSdOe, 0); });
  play();
  EXPECT_EQ(broken(), std::vector<std::string>{"address-stands"});
  checker_.ledger().forget();

  // Of an address that moves around the fall the board takes the old or the new one, and need not stay silent or speak
  // (host-bus:3.9/2). One that moves later has been taken.
  for (const int moves : {-5, 10, 17, 18, 300})
    for (const auto& [first, second, answered] :
         {std::tuple{0x212u, 0x300u, false}, {0x300u, 0x212u, true}, {0x300u, 0x212u, false}, {0x212u, 0x300u, true}}) {
      end_ = now_;
      at(end_ + 300 * kNs, [=, sa = first] { in_.isa_sa = sa; });
      at(end_ + std::min(500, 500 + moves) * kNs, [=, sa = second] {
        if (moves < 0) in_.isa_sa = sa;
      });
      at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
      if (moves >= 0) at(end_ + (500 + moves) * kNs, [=, sa = second] { in_.isa_sa = sa; });
      at(end_ + 850 * kNs, [=, on = answered] { out_.set(pin::kIsaSdOe, on ? 1 : 0); });
      at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true; });
      at(end_ + 1105 * kNs, [this] { out_.set(pin::kIsaSdOe, 0); });
      play();
      std::vector<std::string> expected{moves < 0 ? "t1" : "address-stands"};
      if (moves > 17 && (first == 0x212) != answered) expected.emplace_back(answered ? "ours-only" : "t4");
      EXPECT_THAT(broken(), ::testing::UnorderedElementsAreArray(expected))
          << moves << ": " << first << (answered ? ", answered" : "");
      checker_.ledger().forget();
    }

  end_ = now_;
  iow({}, 0x217);
  out_.set(pin::kTxde, 0);
  show();
  EXPECT_THAT(broken(), ::testing::IsEmpty());
  iow({}, 0x217);
  EXPECT_EQ(broken(), std::vector<std::string>{"room-in-tx"});
  checker_.ledger().forget();

  for (const bool line : {false, true})
    for (const bool waits : {false, true}) {  // nor are data or IOCHRDY of such a cycle judged
      end_ = now_;
      at(end_ + 300 * kNs, [this] { in_.isa_sa = 0x212; });
      at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
      at(end_ + 600 * kNs, [=] { out_.set(pin::kIsaIochrdy, waits ? 0 : 1); });
      at(end_ + 700 * kNs, [=] { line ? in_.isa_resetdrv = true : in_.rst_n = false; });
      at(end_ + 1050 * kNs, [this] { out_.set(pin::kIsaIochrdy, 1); });
      at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true; });
      at(end_ + 1200 * kNs, [=] { in_.isa_resetdrv = false, in_.rst_n = true; });
      play();
      EXPECT_EQ(broken(), std::vector<std::string>{"whole-cycle"});
      checker_.ledger().forget();
    }
}

TEST_F(IsaCheckerTest, EachLineOfTheAddressHasToStand) {
  const std::vector<std::function<void()>> moves{[this] { in_.isa_sa ^= 0x20; }, [this] { in_.isa_aen = !in_.isa_aen; },
                                                 [this] { in_.isa_sbhe_n = !in_.isa_sbhe_n; }};
  for (const auto& move : moves) {
    at(end_ + 600 * kNs, move);  // and back
    at(end_ + 650 * kNs, move);
    io({});
    EXPECT_EQ(broken(), std::vector<std::string>{"address-stands"});
    checker_.ledger().forget();
  }
}

// One strobe rises in the instant in which another falls: no time between two cycles.
TEST_F(IsaCheckerTest, CommandThatIsHandedOverIsTwoCyclesWithoutRecovery) {
  at(end_ + 300 * kNs, [this] { in_.isa_sa = 0x21A; });
  at(end_ + 500 * kNs, [this] { in_.isa_ior_n = false; });
  at(end_ + 550 * kNs, [this] { out_.set(pin::kIsaSdOe, 1); });
  at(end_ + 1100 * kNs, [this] { in_.isa_ior_n = true, in_.isa_iow_n = false; });
  at(end_ + 1105 * kNs, [this] { out_.set(pin::kIsaSdOe, 0); });
  at(end_ + 1700 * kNs, [this] { in_.isa_iow_n = true; });
  play();
  ASSERT_EQ(broken(), std::vector<std::string>{"t11"});
  EXPECT_EQ(checker_.ledger().violations()[0].measured, 0);
  EXPECT_TRUE(checker_.ledger().violations()[0].where.write);
  EXPECT_EQ(checker_.cycles(IsaChecker::kIoRead, 0, 0), 1u);
  EXPECT_EQ(checker_.cycles(IsaChecker::kIoWrite, 0, 0), 1u);
  checker_.ledger().forget();

  end_ = now_;  // to two at once
  at(end_ + 500 * kNs, [this] { in_.isa_iow_n = false; });
  at(end_ + 1100 * kNs, [this] { in_.isa_iow_n = true, in_.isa_memr_n = in_.isa_memw_n = false; });
  at(end_ + 1700 * kNs, [this] { in_.isa_memr_n = in_.isa_memw_n = true; });
  play();
  EXPECT_THAT(broken(), ::testing::IsSupersetOf({"t11", "one-command"}));
  EXPECT_EQ(checker_.cycles(IsaChecker::kIoWrite, 0, 0), 2u) << "the first of them was sound";
  EXPECT_EQ(checker_.cycles(IsaChecker::kMemoryRead, 0, 0), 0u);
}

TEST_F(IsaCheckerTest, BoardThatDrivesWhereItMayNotIsNamed) {
  Points p;
  p.valid = 50 * kNs;
  io(p, 0x210);
  memr(p, 0xD0000);
  EXPECT_THAT(broken(), ::testing::IsEmpty());
  io(p, 0x220);
  memr(p, 0xE0000);
  memr(p, 0x1D0000);
  iow(p, 0x210);
  in_.isa_aen = true;
  show();
  io(p, 0x211);
  EXPECT_EQ(broken(), std::vector<std::string>(5, "ours-only"));
}

}  // namespace
}  // namespace brick
