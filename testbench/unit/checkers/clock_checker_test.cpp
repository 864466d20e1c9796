// The clock checker on edge lists made by hand: sound ones pass, each kind of fault is found and named.
#include "testbench/checkers/clock_checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "testbench/unit/covers.h"

namespace brick {
namespace {

using Kind = ClockChecker::Kind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr ClockSetting kDefault{6527, 0, 3}, kEqual{5000, 1, 0}, kSlow{2948, 2, 1};

// Levels of the two nets over time.
struct Wave {
  std::map<Tick, bool> phase, servo;  // edges

  // `periods` of PHASE from a rise at `start`; SERVO falls with fall number `first`, counted from 1, and every divider
  // + 1 after it.
  Tick run(Tick start, const ClockSetting& s, unsigned periods, unsigned first = 1) {
    for (unsigned i = 0; i < periods; ++i) {
      const Tick rise = start + i * s.phase(), fall = rise + s.high();
      phase[rise] = true;
      phase[fall] = false;
      const unsigned number = i + 1;
      if (number < first || (number - first) % (s.servo_divider + 1) != 0) continue;
      servo[fall] = false;
      servo[fall + (s.servo_divider == 0 ? s.low() : s.phase())] = true;
    }
    return start + periods * s.phase();
  }
};

std::vector<Kind> kinds(const ClockChecker& checker) {
  std::vector<Kind> list;
  for (const auto& v : checker.violations()) list.push_back(v.kind);
  return list;
}

// Gives the edges from `from` up to and including `to` to the checker.
void play(ClockChecker& checker, const Wave& wave, Tick from, Tick to) {
  std::map<Tick, int> ticks;
  for (const auto& [t, level] : wave.phase) ticks[t];
  for (const auto& [t, level] : wave.servo) ticks[t];
  const auto level_at = [](const std::map<Tick, bool>& edges, Tick t) {
    const auto next = edges.upper_bound(t);
    return next == edges.begin() ? true : std::prev(next)->second;
  };
  for (const auto& [t, unused] : ticks)
    if (t >= from && t <= to) checker.pins(t, level_at(wave.phase, t), level_at(wave.servo, t), false);
  checker.finish(to);
}

ClockChecker judged(const Wave& wave, const ClockSetting& s) {
  ClockChecker checker;
  checker.run(0, s);
  play(checker, wave, 0, wave.phase.rbegin()->first);
  return checker;
}

TEST(ClockChecker, PassesWhatTheFormulasSay) {
  BRICK_COVERS("CLK-3 CLK-6");
  for (const ClockSetting s : {kDefault, kEqual, kSlow, ClockSetting{0, 0, 0}, ClockSetting{100, 15, 15}}) {
    Wave wave;
    wave.run(1000, s, 70);
    const ClockChecker checker = judged(wave, s);
    EXPECT_THAT(kinds(checker), IsEmpty()) << checker.violations()[0].text;
    EXPECT_EQ(checker.counts().phase_falls, 70u);
    EXPECT_EQ(checker.counts().servo_falls, (70 - 1) / (s.servo_divider + 1) + 1);
  }
}

TEST(ClockChecker, FindsAnEdgeThatIsOneTickOff) {
  for (const int error : {-1, 1}) {
    Wave wave;
    wave.run(0, kDefault, 10);
    const Tick fall = 3 * 13057 + 6528;
    wave.phase.erase(fall);
    wave.phase[fall + error] = false;
    // A high level too short or too long, and a low one of the other kind.
    EXPECT_THAT(kinds(judged(wave, kDefault)),
                ElementsAre(error < 0 ? Kind::kEarly : Kind::kLate, error < 0 ? Kind::kLate : Kind::kEarly));
  }
}

TEST(ClockChecker, FindsARuntPulse) {
  Wave wave;
  wave.run(0, kDefault, 10, 4);
  wave.phase[2 * 13057 + 1000] = false;  // a notch of five ticks in the high level
  wave.phase[2 * 13057 + 1005] = true;
  const auto found = kinds(judged(wave, kDefault));
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found[0], Kind::kRunt) << "high for 1000";
  EXPECT_EQ(found[1], Kind::kRunt) << "low for 5";
}

TEST(ClockChecker, FindsADoubledPulse) {
  Wave wave;
  wave.run(0, kDefault, 10, 4);
  const Tick fall = 2 * 13057 + 6528;
  wave.phase[fall + 2500] = true;  // the low level of 6529 holds another pulse
  wave.phase[fall + 4500] = false;
  EXPECT_THAT(kinds(judged(wave, kDefault)), ::testing::Contains(Kind::kDoubled));
}

TEST(ClockChecker, FindsAMissingPulse) {
  Wave wave;
  wave.run(0, kDefault, 10, 9);
  wave.phase.erase(3 * 13057);
  wave.phase.erase(3 * 13057 + 6528);
  EXPECT_THAT(kinds(judged(wave, kDefault)), ElementsAre(Kind::kMissing));
}

TEST(ClockChecker, FindsAClockThatStops) {
  Wave wave;
  const Tick end = wave.run(0, kDefault, 10);
  ClockChecker checker;
  checker.run(0, kDefault);
  play(checker, wave, 0, end - 1);
  EXPECT_THAT(kinds(checker), IsEmpty());
  checker.finish(end);
  EXPECT_THAT(kinds(checker), IsEmpty()) << "the rise may come at this very tick";
  checker.finish(end + 1);
  EXPECT_THAT(kinds(checker), ElementsAre(Kind::kMissing));
}

TEST(ClockChecker, FindsServoFallsThatAreDoubledOrMissing) {
  const Tick fall = 6528, phase = 13057;
  Wave doubled;
  doubled.run(0, kDefault, 12);
  doubled.servo[fall + 2 * phase] = false;
  doubled.servo[fall + 3 * phase] = true;
  EXPECT_EQ(kinds(judged(doubled, kDefault)).at(0), Kind::kDoubled);
  Wave missing;
  missing.run(0, kDefault, 12);
  missing.servo.erase(fall + 4 * phase);
  missing.servo.erase(fall + 5 * phase);
  EXPECT_EQ(kinds(judged(missing, kDefault)).at(0), Kind::kMissing);
}

TEST(ClockChecker, FindsServoEdgesThatDoNotBelongToTheirPhaseEdge) {
  const Tick fall = 6528 + 4 * 13057, rise = fall + 13057;
  const auto moved = [&](Tick from, Tick to, bool level) {
    Wave wave;
    wave.run(0, kDefault, 12);
    wave.servo.erase(from);
    wave.servo[to] = level;
    return kinds(judged(wave, kDefault));
  };
  EXPECT_THAT(moved(fall, fall + 1, false), ::testing::Contains(Kind::kRelation));
  EXPECT_THAT(moved(rise, rise - 3, true), ElementsAre(Kind::kRelation));
  EXPECT_THAT(moved(rise, 6 * 13057, true), ::testing::Contains(Kind::kRelation)) << "with a rise of PHASE";
  EXPECT_THAT(moved(rise, rise + 13057, true), ::testing::Contains(Kind::kRelation)) << "low for two periods";
}

TEST(ClockChecker, FindsServoThatIsNotPhaseWhenItShouldBe) {
  Wave wave;
  wave.run(0, kEqual, 12);
  wave.servo.erase(5 * kEqual.phase());
  EXPECT_EQ(kinds(judged(wave, kEqual)).at(0), Kind::kRelation);
}

TEST(ClockChecker, FindsAConflict) {
  ClockChecker checker;
  checker.run(0, kDefault);
  checker.pins(100, true, true, true);
  EXPECT_THAT(kinds(checker), ElementsAre(Kind::kConflict));
  checker.pins(200, true, true, false);
  checker.allow_conflict(true);
  checker.pins(300, true, true, true);
  EXPECT_EQ(checker.violations().size(), 1u);
}

// Change of variables
// -----------------------------------------------------------------------------------------------------

// I7m00 6527 -> 2948 at a bottom turnaround: one period may hold a triangle of each length.
TEST(ClockChecker, AllowsOnePulseOfMixedTriangles) {
  constexpr ClockSetting kTo{2948, 0, 3};
  Wave wave;
  const Tick old_end = wave.run(0, kDefault, 8);
  wave.run(old_end, kTo, 40);
  ClockChecker checker;
  checker.run(0, kDefault);
  play(checker, wave, 0, old_end - 7000);
  checker.change(old_end - 7000, kTo);
  const Tick done = old_end + ClockChecker::settling(kDefault, kTo);
  play(checker, wave, old_end - 6999, done);
  checker.run(done, kTo);
  play(checker, wave, done + 1, wave.phase.rbegin()->first);
  EXPECT_THAT(kinds(checker), IsEmpty()) << checker.violations()[0].text;
}

TEST(ClockChecker, FindsARuntAndANeverEndingPulseWhileVariablesChange) {
  constexpr ClockSetting kTo{2948, 0, 3};
  for (const Tick length : {Tick{2949}, Tick{2948}, Tick{1000}, Tick{6529}, Tick{6530}}) {
    ClockChecker checker;
    checker.run(0, kDefault);
    checker.pins(6000, true, true, false);
    checker.pins(10'000, false, true, false);
    checker.ignore();
    checker.run(10'000, kDefault);
    checker.change(10'000, kTo);
    checker.pins(10'000 + length, true, true, false);
    if (length >= 2949 && length <= 6529)
      EXPECT_THAT(kinds(checker), IsEmpty()) << length;
    else
      EXPECT_THAT(kinds(checker), ElementsAre(length < 2949 / 2 ? Kind::kRunt
                                              : length < 2949   ? Kind::kEarly
                                                                : Kind::kLate))
          << length;
  }
}

// Another source
// ------------------------------------------------------------------------------------------------------------

constexpr Tick kRise = 7 * 13057, kFall = kRise + 6528;  // of PHASE and, with this fall, of SERVO
constexpr Tick kLongestWait = 13057 + 6529 + ClockChecker::kHandOver + 2 * 3 * 5899;

struct HandOver {
  Tick release, tick;            // both nets go high; rise with which the new source takes PHASE
  Tick odd = kSlow.high();       // from then to its first fall
  unsigned first_servo = 1 + 1;  // its fall with which SERVO falls first
  bool notch = false;            // a low pulse while nobody drives
};

// Default clocks, then kSlow from another IC.
std::vector<Kind> handed_over(const HandOver& h, ClockChecker& checker) {
  Wave wave;
  const Tick end = wave.run(0, kDefault, 8, 4);
  for (auto* edges : {&wave.phase, &wave.servo}) {
    edges->erase(edges->lower_bound(h.release), edges->end());
    if (!edges->rbegin()->second) (*edges)[h.release] = true;
  }
  if (h.notch) {
    wave.phase[h.release + 100] = false;
    wave.phase[h.release + 200] = true;
  }
  Wave next;
  const Tick last = next.run(h.tick + h.odd - kSlow.high(), kSlow, 20, h.first_servo);
  next.phase.erase(next.phase.begin());  // high already
  wave.phase.insert(next.phase.begin(), next.phase.end());
  wave.servo.insert(next.servo.begin(), next.servo.end());
  checker.run(0, kDefault);
  play(checker, wave, 0, end - 13057);
  checker.move(end - 13057, kSlow);
  play(checker, wave, end - 13056, last - 5 * kSlow.phase());
  checker.run(last - 5 * kSlow.phase(), kSlow);
  play(checker, wave, last - 5 * kSlow.phase() + 1, wave.phase.rbegin()->first);
  return kinds(checker);
}

TEST(ClockChecker, AllowsOneOddHighLevelWhenTheSourceMoves) {
  BRICK_COVERS("I19-2");
  EXPECT_EQ(ClockChecker::release(kDefault), 13057 + 6529);
  for (const Tick release : {kRise + 1, kRise + 3000, kFall}) {
    for (const Tick wait : {kSlow.high() - kDefault.high(), kLongestWait}) {
      for (const unsigned first_servo : {2u, 3u}) {  // I7m02 + 1 to 2 x I7m02 + 1
        ClockChecker checker;
        EXPECT_THAT(handed_over({release, release + wait, kSlow.high(), first_servo}, checker), IsEmpty())
            << checker.violations()[0].text;
        EXPECT_EQ(checker.counts().odd_highs, 1u);
      }
    }
  }
}

TEST(ClockChecker, FindsALowLevelThatEndsEarlyWhenTheSourceMoves) {
  for (const Tick cut : {Tick{1}, Tick{3000}, Tick{3264}, Tick{3265}, Tick{6528}}) {
    ClockChecker checker;
    EXPECT_EQ(handed_over({kFall + cut, kFall + 30'000}, checker).at(0), cut <= 3264 ? Kind::kRunt : Kind::kEarly)
        << cut;
  }
  // A whole low level of PHASE, but SERVO is cut.
  ClockChecker checker;
  EXPECT_THAT(handed_over({kFall + 6529, kFall + 30'000}, checker), ElementsAre(Kind::kRelation));
}

TEST(ClockChecker, FindsServoThatIsCutWhenTheSourceMoves) {
  for (const Tick rise : {kFall + 1, kFall + 6528, kFall + 13056}) {
    Wave wave;
    wave.run(0, kDefault, 12, 4);
    wave.servo.erase(kFall + 13057);
    wave.servo[rise] = true;
    ClockChecker checker;
    checker.run(0, kDefault);
    play(checker, wave, 0, kRise);
    checker.move(kRise, kSlow);
    play(checker, wave, kRise + 1, kFall + 13057);
    EXPECT_EQ(kinds(checker).at(0), Kind::kRelation);
  }
}

TEST(ClockChecker, FindsAPulseWhileNobodyDrives) {
  ClockChecker checker;
  EXPECT_THAT(handed_over({kRise + 3000, kFall + 30'000, kSlow.high(), 2, true}, checker),
              ::testing::Contains(Kind::kRunt));
}

TEST(ClockChecker, FindsAFirstHighLevelOfTheNewSourceThatIsTooShortOrTooLong) {
  ClockChecker early, late;
  EXPECT_EQ(handed_over({kRise + 1, kRise, kSlow.high() - 1}, early).at(0), Kind::kEarly);
  EXPECT_EQ(handed_over({kFall, kFall + kLongestWait + 1}, late).at(0), Kind::kLate);
}

TEST(ClockChecker, FindsAFirstFallOfServoThatIsTooEarlyOrTooLate) {
  ClockChecker early, late;
  EXPECT_EQ(handed_over({kRise + 1, kFall + 30'000, kSlow.high(), 1}, early).at(0), Kind::kDoubled);
  EXPECT_EQ(handed_over({kRise + 1, kFall + 30'000, kSlow.high(), 4}, late).at(0), Kind::kMissing);
}

TEST(ClockChecker, FindsThatTheSourceDidNotMove) {
  Wave wave;
  const Tick end = wave.run(0, kDefault, 20);
  ClockChecker checker;
  checker.run(0, kDefault);
  play(checker, wave, 0, 40'000);
  checker.move(40'000, kSlow);
  play(checker, wave, 40'001, end - 1);
  checker.run(end - 1, kSlow);
  EXPECT_THAT(kinds(checker), ElementsAre(Kind::kUnsettled));
}

TEST(ClockChecker, AllowsAnyFirstTickAfterNoSourceButNoShortHighLevel) {
  for (const Tick high : {kSlow.high() - 1, kSlow.high(), 20'000 + kSlow.phase() + kSlow.high() + 20'000}) {
    ClockChecker checker;
    checker.start(1000, kSlow, 20'000);
    checker.pins(1000 + high, false, true, false);
    checker.pins(1000 + high + kSlow.low(), true, true, false);
    checker.pins(1000 + high + kSlow.phase(), false, false, false);  // the (I7m02 + 1)th fall
    if (high == kSlow.high())
      EXPECT_THAT(kinds(checker), IsEmpty()) << checker.violations()[0].text;
    else
      EXPECT_THAT(kinds(checker), ElementsAre(high < kSlow.high() ? Kind::kEarly : Kind::kLate));
  }
}

TEST(ClockChecker, FindsEdgesWithoutASource) {
  for (const bool cut : {false, true}) {
    Wave wave;
    wave.run(0, kDefault, 4);
    ClockChecker checker;
    checker.run(0, kDefault);
    const Tick fall = 3 * 13057 + 6528, rise = cut ? fall + 6528 : fall + 6529;
    play(checker, wave, 0, fall);
    checker.stop(fall);
    checker.pins(rise, true, true, false);  // idle high
    if (cut)
      EXPECT_THAT(kinds(checker), ElementsAre(Kind::kEarly));
    else
      EXPECT_THAT(kinds(checker), IsEmpty());
    checker.finish(100'000'000);
    EXPECT_EQ(checker.violations().size(), cut ? 1u : 0u);
    checker.pins(100'000'001, false, true, false);
    EXPECT_EQ(checker.violations().back().kind, Kind::kRelation);
  }
}

// kSlow: PHASE 5899 x 3 = 17697 ticks, high 8848, low 8849, SERVO low 17697, high 17697. kDefault: 13057, 6528, 6529,
// 13057, 39171. While the source moves from one to the other the lesser of each pair is the bound.
TEST(ShortestLevels, EachLevelAtItsBoundAndATickLess) {
  for (const Tick less : {0, 1}) {
    ShortestLevels shortest;
    shortest.pins(90, true, true);
    shortest.pins(100, false, false);  // before the move: no bound
    shortest.pins(200, true, true);
    shortest.begin(kDefault, kSlow);
    shortest.pins(200 + 17697 - less, true, false);
    shortest.pins(200 + 17697 + 13057 - 2 * less, true, true);
    shortest.pins(40000, false, true);
    shortest.pins(40000 + 6529 - less, true, true);
    shortest.pins(40000 + 6529 + 6528 - 2 * less, false, true);
    for (const auto& [servo, high, bound] :
         {std::tuple{false, false, 6529}, {false, true, 6528}, {true, false, 13057}, {true, true, 17697}}) {
      EXPECT_EQ(shortest.level(servo, high).bound, bound);
      EXPECT_EQ(shortest.level(servo, high).length, bound - less);
    }
    EXPECT_EQ(shortest.kept(1), less == 0);
    if (less == 1) {
      EXPECT_EQ(shortest.text().substr(0, 87),
                "PHASE low 6528 ticks (6529 at least, 1 seen), PHASE high 6527 ticks (6528 at least, 2 s");
    }
    EXPECT_FALSE(shortest.kept(2)) << "SERVO low was seen once";
  }
}

// The first high level of the new source may be as long as those of the old one: that it is the new one's is known from
// the low level behind it.
TEST(ClockChecker, KnowsTheNewSourceByItsFirstLowLevel) {
  constexpr ClockSetting kShort{5000, 0, 1};
  Wave wave, next;
  const Tick taken = wave.run(0, kDefault, 5, 3);  // SERVO is high from fall 4 on and would be low from fall 7 on
  const Tick last = next.run(taken + kDefault.high() - kShort.high(), kShort, 20, 2);
  next.phase.erase(next.phase.begin());
  next.phase[taken] = true;
  wave.phase.insert(next.phase.begin(), next.phase.end());
  wave.servo.insert(next.servo.begin(), next.servo.end());
  ClockChecker checker;
  checker.run(0, kDefault);
  play(checker, wave, 0, taken - 100);
  checker.move(taken - 100, kShort);
  play(checker, wave, taken - 99, last - 5 * kShort.phase());
  checker.run(last - 5 * kShort.phase(), kShort);
  play(checker, wave, last - 5 * kShort.phase() + 1, wave.phase.rbegin()->first);
  EXPECT_THAT(kinds(checker), IsEmpty()) << checker.violations()[0].text;
  EXPECT_EQ(checker.counts().odd_highs, 1u);
}

}  // namespace
}  // namespace brick
