// Sequences of segments one behind the other, where moves do not blend, and a move of another kind behind them all
// (motion:5.3, motion:7.1).
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;

class Sequences : public MovingMotors {
 protected:
  static void add(double ticks, std::uint32_t move, bool continues) {
    piece_ring& ring = cs().ring;
    piece* p = piece_ring_at(&ring, ring.added);
    *p = {};
    piece_set_time(p, std::llround(ticks * platform::kDefaultI10));
    p->to = PIECE_PARTS;
    p->move = move;
    p->continues = continues;
    piece_ring_add(&ring);
  }
};

// Lines without blends are sequences of 100 + 20 + 2 x 5 ms. While the first is executed the others are calculated: a
// DWELL, RAPID, SPLINE or PVT move behind them comes last all the same.
TEST_F(Sequences, AnotherMoveDoesNotOvertakeThoseThatWait) {
  const struct {
    const char* line;
    double way, ms;  // 0: it takes what it takes
  } lasts[] = {
      {"DWELL300", 0, 300}, {"RAPID X1", 1000, 0}, {"SPLINE1 TM100 X1", 1000, 300}, {"PVT100 X1:0", 1000, 100}};
  for (const auto& last : lasts)
    for (const char* blends : {"I5192=1", "I5192=0 I5183=0.9 I5181=0"})
      for (const char* ahead : {"I5120=0", "I5120=40"}) {
        SCOPED_TRACE(std::string(last.line) + " " + blends + " " + ahead);
        platform::power_up();
        fit({"1000X", "1000Y"});
        ASSERT_EQ(host("I5113=5 I116=100 I216=100 I119=1 I120=20 I121=0 I122=20 I192=1 DELETE GATHER"), "");
        ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,10"), "");
        ASSERT_EQ(host(std::string(blends) + " " + ahead), "");
        store({"INC TM100 TA20 TS0 X1", "Y1", "X1", last.line, "P1=1"});
        double x = 0, y = 0, came = 0;
        const double end = run([&](double t) {
          ASSERT_LE(std::abs(at(1) - x) + std::abs(at(2) - y), 21 * kTickMs) << "at " << t;
          x = at(1), y = at(2);
          if (came == 0 && x == 2000 && y == 1000) came = t;
          if (x > 2000) { ASSERT_EQ(y, 1000); }
        });
        EXPECT_NEAR(came, 3 * 130, 3 * 10) << "up to ten servo interrupts from one to the next";
        EXPECT_EQ(motors[0].trajectory, std::llround((2000 + last.way) * kUnit));
        EXPECT_EQ(motors[1].trajectory, 1000 * 3072);
        if (last.ms != 0) { EXPECT_NEAR(end - came, last.ms, 10); }
        EXPECT_EQ(cs().error, RUN_TIME_NONE);
      }
}

// The first piece of a sequence, cut short, is over before an interrupt has seen it: what it is the first of begins all
// the same, from rest with that interrupt (motion:5.1), and the real-time task sees room for another move.
TEST_F(Sequences, AFirstPieceThatNoInterruptSeesBeginsItsSequence) {
  piece_ring& ring = cs().ring;
  add(1.5, 1, false);
  add(0.2, 2, false);
  add(20, 2, true);
  cs_busy |= 1;
  system_path_servo();
  ASSERT_EQ(cs().started, 1u);
  const std::uint32_t before = cs().executing;
  cs().next_valid = cs().placed = true;
  system_path_servo();
  ASSERT_EQ(ring.executing, 0u);
  EXPECT_TRUE(cs().next_valid);
  system_path_servo();
  ASSERT_EQ(ring.executing, 2u) << "2 of 1.5 + 0.2 are over";
  EXPECT_EQ(cs().started, 2u);
  EXPECT_NE(cs().executing, before);
  EXPECT_FALSE(cs().next_valid);
  EXPECT_FALSE(cs().placed);
  EXPECT_EQ(ring.elapsed, 0);
  EXPECT_EQ(ring.fraction, 0u);
}

// Pieces of a move that blends which are over before an interrupt has seen it are time that has passed in it, as far as
// they went; those of the move before are not.
TEST_F(Sequences, AMoveHasTheTimeOfPiecesThatNoInterruptSees) {
  piece_ring& ring = cs().ring;
  add(1.5, 1, false);
  add(0.2, 2, false);
  add(0.3, 2, false);
  add(20, 2, false);
  piece_ring_at(&ring, 2)->end = 100000;
  cs().moves[0].blended = cs().moves[1].blended = true;
  cs_busy |= 1;
  system_path_servo();
  ASSERT_EQ(cs().started, 1u);
  EXPECT_EQ(cs().elapsed, 0);
  system_path_servo();
  EXPECT_EQ(cs().elapsed, platform::kDefaultI10);
  ASSERT_EQ(ring.executing, 0u);
  system_path_servo();
  ASSERT_EQ(ring.executing, 3u) << "2 of 1.5 + 0.2 and 100000 units are over";
  EXPECT_EQ(cs().started, 2u);
  EXPECT_EQ(cs().elapsed, 2 * platform::kDefaultI10 - ring.pieces[0].time);
  system_path_servo();
  EXPECT_EQ(cs().elapsed, 3 * platform::kDefaultI10 - ring.pieces[0].time);
  EXPECT_EQ(ring.elapsed, cs().elapsed - ring.pieces[1].time - 100000);
}

}  // namespace
