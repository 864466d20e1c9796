// Homing and moves until a trigger (motion:4.3), `$*` (motion:4.4): a motor that is always where it is commanded to be,
// an encoder counter and capture registers as the servo IC has them (servo-ic:2.1).
#include <cmath>
#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/command/control_characters.h"
#include "firmware/motion/homing.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/jog_plan.h"
#include "firmware/motion/jog_servo.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/motor_status.h"
#include "firmware/motion/rollover.h"
}

namespace {

using platform::host;

constexpr double kUnits = 32 * 96;
constexpr std::uint32_t kStatus = 0x78000, kServoCounter = 0x78002, kCaptured = 0x78003, kParallel = 0x10F0,
                        kAdc = 0x78015, kWord = 0xFFFFFF;
constexpr std::uint32_t kCaptureFlag = 1u << 11;
constexpr unsigned kPartsOfACount = 4096;

class Homing : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I8000=$C78000 I125=$78000 I124=$20001 I103=$3501 I104=$3501 I111=0 I112=0"), "");
    ASSERT_EQ(host("I119=1 I120=0 I121=10 I122=20 I192=2 I126=0"), "");
  }

  // Where counter and motor are 0 of each other; the loop is closed.
  void begin(double counter) {
    zero_ = counter;
    encoder();
    ASSERT_EQ(host("I100=1"), "");
    platform::servo_ticks(3);
    zero_ = counter - commanded();
    ASSERT_EQ(host("#1J/"), "");
    run(10);
  }
  static double commanded() { return static_cast<double>(motors[0].commanded) / kUnits; }
  // What the counter would show with all its bits and a fraction.
  double place() const { return zero_ + commanded(); }

  // One servo interrupt: the IC has latched the counter, and the captured one when the motor went over `trigger_`.
  void tick() {
    const double now = place();
    encoder();
    if (armed_ && (now - trigger_) * (before_ - trigger_) <= 0 && now != before_) capture();
    before_ = now;
    const bool searched = motors[0].status.home_search;
    platform::servo_ticks(1);
    if (!searched || motors[0].status.home_search) return;
    *hal_x(kStatus) &= ~kCaptureFlag;  // as the IC does when the register is read
    zero_ = latched_ - static_cast<double>(motors[0].actual) / kUnits;
    found_++;
  }
  void capture() {
    const double counts = std::floor(trigger_);
    *hal_x(kCaptured) = static_cast<std::uint32_t>(static_cast<std::int64_t>(counts)) & kWord;
    *hal_y(kStatus) = static_cast<std::uint32_t>((trigger_ - counts) * kPartsOfACount) << 12;
    *hal_x(kStatus) |= kCaptureFlag;
    armed_ = false;
  }
  void encoder() {
    const double counts = std::floor(place()), part = place() - counts;
    const auto counter = static_cast<std::int64_t>(counts);
    *hal_x(kServoCounter) = static_cast<std::uint32_t>(counter * 2) & kWord;
    *hal_y(kStatus + 1) = static_cast<std::uint32_t>(part * kPartsOfACount) << 12;
    *hal_y(kParallel) = static_cast<std::uint32_t>(counter * 1024 + static_cast<int>(part * 1024)) & kWord;
    latched_ = counts + std::floor(part * parts_) / parts_;
  }
  void run(unsigned ticks) {
    for (unsigned i = 0; i < ticks; ++i) tick();
  }
  void settle() {
    run(20);
    for (int i = 0; i < 100000 && jog_is_moving(0); ++i) tick();
    ASSERT_FALSE(jog_is_moving(0));
    run(2);
  }
  void trigger_at(double place) {
    trigger_ = place;
    armed_ = true;
  }

  double zero_ = 0, trigger_ = 0, before_ = 0, latched_ = 0;
  unsigned parts_ = 1;  // that the table makes of a count of the counter
  bool armed_ = false;
  unsigned found_ = 0;
};

TEST_F(Homing, ZeroIsTheCapturedCountAtAnySpeedUpTo100CountsAMs) {
  std::mt19937 random(brick::random_seed(7));
  std::uniform_real_distribution<> speed(0.5, 100), way(50, 5000), start(-8e6, 8e6);
  begin(std::floor(start(random)));
  for (int i = 0; i < 200; ++i) {
    const double velocity = (random() % 2 ? 1 : -1) * speed(random);
    const int offset = static_cast<int>(random() % 4000) - 2000;
    ASSERT_EQ(host("I123=" + std::to_string(velocity) + " I126=" + std::to_string(offset * 16)), "");
    const double at = place() + std::copysign(way(random), velocity);
    trigger_at(at);
    ASSERT_EQ(host("#1HM"), "");
    EXPECT_FALSE(motors[0].status.home_complete);
    settle();
    ASSERT_EQ(found_, static_cast<unsigned>(i + 1)) << velocity;
    EXPECT_TRUE(motors[0].status.home_complete);
    EXPECT_EQ(motors[0].trajectory, 0);
    EXPECT_EQ(place(), std::floor(at) + offset) << velocity << " counts a ms, trigger at " << at;
    EXPECT_EQ(*hal_y(0xCE), static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(at))) & kWord)
        << "what users read of it";
  }
}

// motion:1.4/7: what tables have added while positions were counted from elsewhere is no part of home; nothing jumps.
TEST_F(Homing, ZeroKnowsNothingOfATableThatCountedFromElsewhere) {
  begin(0);
  for (const std::string source : {"#1", "#1D"}) {
    SCOPED_TRACE(source);
    ASSERT_EQ(host("#1DEFINE COMP 4," + source + ",#1,10000"), "");
    ASSERT_EQ(host("1600 -800 480 0"), "");  // 100, -50 and 30 counts at 2500, 5000 and 7500
    ASSERT_EQ(host("I51=1 I123=20 I126=160"), "");
    run(10);
    double last = place(), largest = 0;
    const auto to_rest = [&] {
      for (unsigned i = 0, quiet = 0; i < 20000 && quiet < 50; ++i) {
        tick();
        largest = std::max(largest, std::abs(place() - last));
        last = place();
        quiet = jog_is_moving(0) ? 0 : quiet + 1;
      }
    };
    ASSERT_EQ(host("#1J=2400"), "");
    to_rest();
    const double at = place() + 50.5;
    for (const unsigned search : {1u, 2u}) {
      trigger_at(at);
      ASSERT_EQ(host("#1HM"), "");
      found_ = 0;
      to_rest();
      ASSERT_EQ(found_, 1u);
      EXPECT_EQ(motors[0].trajectory, 0);
      // 10 counts behind the trigger, the correction between -10 and 0 is 30 * 10 / 2500 of it
      EXPECT_NEAR(place(), std::floor(at) + 10 - 0.12, 0.02) << search;
      ASSERT_EQ(host("#1J=-100"), "");
      to_rest();
    }
    EXPECT_LT(largest, 20 * platform::kDefaultI10 / 8388608.0 * 1.1 + 0.1) << "at 20 counts a ms";
    ASSERT_EQ(host("I51=0 #1DELETE COMP"), "");
    run(10);
  }
}

TEST_F(Homing, CapturedFractionCountsWithIxx24Bit12) {
  std::mt19937 random(brick::random_seed(8));
  std::uniform_real_distribution<> way(50, 500);
  parts_ = 32;
  ASSERT_EQ(host("I8000=$CF8000 I124=$21001 I123=-15.5 I126=160"), "");
  begin(1000);
  for (int i = 0; i < 20; ++i) {
    const double at = place() - way(random);
    trigger_at(at);
    ASSERT_EQ(host("#1HM"), "");
    settle();
    EXPECT_NEAR(place(), std::floor(at * kPartsOfACount) / kPartsOfACount + 10, 1.01 / kUnits) << at;
  }
  ASSERT_EQ(host("I124=$20001"), "");
  trigger_at(place() - 100.75);
  ASSERT_EQ(host("#1HM"), "");
  settle();
  EXPECT_NEAR(place(), std::floor(trigger_) + 10, 1.01 / kUnits) << "not asked for";
}

TEST_F(Homing, ACountOfTheHardwareIs1024StepsOfTheTableWithIxx24Bit11) {
  parts_ = 1024;
  ASSERT_EQ(host("I8000=$2810F0 I8001=$018000 I8002=0 I103=$3502 I104=$3502 I124=$21801 I123=200 I122=300"), "");
  zero_ = 7;
  encoder();
  ASSERT_EQ(host("I100=1"), "");
  // A count of the motor is 32 steps of the table: 1/32 count of the hardware.
  ASSERT_EQ(host("#1J/"), "");
  platform::servo_ticks(20);
  const double start = commanded();
  const auto hardware = [&] { return 7 + (commanded() - start) / 32; };
  double latched = 0;
  const auto follow = [&] {
    latched = std::floor(hardware() * 1024) / 1024;
    *hal_y(kParallel) = static_cast<std::uint32_t>(latched * 1024) & kWord;
  };
  ASSERT_EQ(host("#1HM"), "");
  for (int i = 0; i < 400; ++i) {
    follow();
    platform::servo_ticks(1);
  }
  ASSERT_GT(hardware(), 20.5);
  const double actual = static_cast<double>(motors[0].actual) / kUnits, at = hardware() - 0.625;
  const double counts = std::floor(at);
  *hal_x(kCaptured) = static_cast<std::uint32_t>(counts);
  *hal_y(kStatus) = static_cast<std::uint32_t>((at - counts) * kPartsOfACount) << 12;
  *hal_x(kStatus) |= kCaptureFlag;
  jog_servo(0);
  ASSERT_TRUE(motors[0].status.home_complete);
  const double zero = actual - static_cast<double>(motors[0].actual) / kUnits;  // position that is 0 now, as it was
  EXPECT_NEAR(zero, actual + (std::floor(at * kPartsOfACount) / kPartsOfACount - latched) * 32, 1.01 / kUnits);
}

TEST_F(Homing, SoftwareCaptureTakesThePlaceWhereItIsSeen) {
  ASSERT_EQ(host("I123=40 I197=1"), "");
  begin(0);
  trigger_at(place() + 700.5);
  ASSERT_EQ(host("#1HM"), "");
  settle();
  EXPECT_EQ(found_, 1u);
  EXPECT_GT(place(), trigger_);
  EXPECT_LT(place(), trigger_ + 40 * 3 * platform::kDefaultI10 / 8388608.0) << "servo interrupts late";
}

TEST_F(Homing, WarningFollowingErrorIsATriggerWithIxx97Bit1) {
  ASSERT_EQ(host("I123=40 I197=3"), "");
  begin(0);
  trigger_at(place() + 300);
  ASSERT_EQ(host("#1HM"), "");
  run(200);
  EXPECT_EQ(found_, 0u) << "the flag is none";
  const double at = place();
  motors[0].found.warning_error = true;
  settle();
  EXPECT_EQ(found_, 1u);
  EXPECT_TRUE(motors[0].status.home_complete);
  EXPECT_NEAR(place(), at, 40 * 3 * platform::kDefaultI10 / 8388608.0);
}

TEST_F(Homing, WhatWasCapturedBeforeDoesNotCount) {
  begin(0);
  *hal_x(kStatus) |= kCaptureFlag;
  ASSERT_EQ(host("#1I123=20 HM"), "");
  run(4);
  EXPECT_FALSE(motors[0].status.home_search) << "Ixx92 is not over";
  *hal_x(kStatus) &= ~kCaptureFlag;  // the read that arms
  run(300);
  EXPECT_TRUE(motors[0].status.home_search);
  EXPECT_EQ(found_, 0u);
}

TEST_F(Homing, StatusOfASearch) {
  begin(0);
  ASSERT_EQ(host("#1HMZ"), "");
  ASSERT_EQ(host("I123=20 HM"), "");
  EXPECT_FALSE(motors[0].status.home_complete) << "cleared by the command";
  run(100);
  EXPECT_TRUE(jog_is_homing(0));
  EXPECT_TRUE(motors[0].status.home_search);
  EXPECT_FALSE(motors[0].status.timed_move) << "before its trigger";
  EXPECT_FALSE(motors[0].status.trigger_move) << "of jogs only";
  trigger_at(place() + 10);
  for (unsigned i = 0; i < 10 && !motors[0].status.home_complete; ++i) tick();
  EXPECT_FALSE(motors[0].status.home_search) << "until the trigger, though the motion is the same for Ixx92";
  run(8);
  EXPECT_FALSE(jog_is_homing(0));
  EXPECT_TRUE(motors[0].status.home_complete) << "at the trigger, not at the end";
  EXPECT_TRUE(jog_is_moving(0));
  run(10);
  EXPECT_TRUE(motors[0].status.timed_move);
  settle();
  EXPECT_FALSE(motors[0].status.timed_move);
}

// motion:4.2/3: Ixx92 passes behind a trigger, too.
TEST_F(Homing, TheSearchGoesOnForIxx92BehindItsTrigger) {
  ASSERT_EQ(host("I123=20 I192=20"), "");
  begin(0);
  ASSERT_EQ(host("#1HM"), "");
  run(200);
  trigger_at(place() + 1);
  for (unsigned i = 0; i < 10 && !motors[0].status.home_complete; ++i) tick();
  ASSERT_TRUE(motors[0].status.home_complete);
  const double ms = platform::kDefaultI10 / 8388608.0;
  double last = place();
  for (unsigned i = 1; i * ms < 20 - ms; ++i, last = place()) {
    tick();
    ASSERT_NEAR(place() - last, 20 * ms, 1.0 / 16) << i;
  }
  run(20);
  last = place();
  tick();
  EXPECT_LT(place() - last, 20 * ms - 1);
}

TEST_F(Homing, ASearchThatIsStoppedEndsWithoutHome) {
  begin(0);
  for (const char* stop : {"J/", "K", "J=0", "\x01"}) {
    ASSERT_EQ(host("#1J/ I123=20 HM"), "");
    run(100);
    ASSERT_TRUE(jog_is_homing(0)) << stop;
    if (*stop == '\x01')
      ASSERT_FALSE(control_character(1));
    else
      ASSERT_EQ(host(stop), "");
    run(900);
    EXPECT_FALSE(jog_is_homing(0)) << stop;
    EXPECT_FALSE(motors[0].status.home_search) << stop;
    EXPECT_FALSE(motors[0].status.home_complete) << stop;
    EXPECT_FALSE(jog_is_moving(0)) << stop;
  }
}

TEST_F(Homing, ATriggerWhileSomethingElseIsAskedForMakesHomeOnly) {
  ASSERT_EQ(host("I192=20"), "");
  begin(0);
  for (const bool planned : {false, true}) {
    ASSERT_EQ(host("#1I123=20 HM"), "");
    run(200);
    const double target = zero_ + 3000;
    ASSERT_EQ(host("J=3000"), "");
    if (planned) run(6);
    trigger_at(place() + 1);
    settle();
    EXPECT_TRUE(motors[0].status.home_complete);
    EXPECT_EQ(place(), target) << "a place stays where it was";
    EXPECT_EQ(commanded(), target - std::floor(trigger_));
  }
}

// Ixx25 = 0 names no flags: X:$0, which counts servo interrupts, is none either. An error is a trigger all the same.
TEST_F(Homing, WithoutFlagsNoTriggerComes) {
  ASSERT_EQ(host("I125=0"), "");
  begin(0);
  ASSERT_EQ(host("#1I123=20 HM"), "");
  while ((*hal_x(0) & kCaptureFlag) == 0) tick();
  run(10);
  EXPECT_TRUE(jog_is_homing(0));
  EXPECT_FALSE(motors[0].status.home_complete);
  ASSERT_EQ(host("J/"), "");
  settle();
  ASSERT_EQ(host("I197=3 HM"), "");
  run(50);
  motors[0].found.warning_error = true;
  settle();
  EXPECT_TRUE(motors[0].status.home_complete);
}

TEST_F(Homing, JogUntilATriggerGoesOnFromThere) {
  begin(500);
  const double zero = zero_;
  for (const char* form : {"J=3000^-25.5", "J:3000^-25.5", "J^3000^-25.5", "J==3000^-25.5", "J==3000 J=0 J=^-25.5"}) {
    ASSERT_EQ(host(std::string("#1J=0 ") + form), "") << form;
    const double at = place() + 700.75;
    trigger_at(at);
    EXPECT_TRUE(motors[0].status.trigger_move) << form;
    run(30);
    EXPECT_TRUE(motors[0].status.home_search) << form;
    EXPECT_TRUE(motors[0].status.timed_move) << form;
    EXPECT_FALSE(jog_is_homing(0)) << form;
    while (motors[0].status.home_search) tick();
    EXPECT_TRUE(motors[0].status.trigger_move) << "to its end: " << form;
    run(20);
    EXPECT_TRUE(motors[0].status.trigger_move) << form;
    settle();
    EXPECT_EQ(place(), std::floor(at) - 25.5) << form;
    EXPECT_EQ(zero_, zero) << "positions stay";
    EXPECT_FALSE(motors[0].status.trigger_move) << form;
    ASSERT_EQ(host("#1J=0"), "");
    settle();
  }
}

// Before a trigger it goes at the speeds of its command, from there at those that there are then.
TEST_F(Homing, TheWayBehindATriggerIsAtTheSpeedsOfThen) {
  begin(0);
  const double ms = platform::kDefaultI10 / 8388608.0;
  for (const bool homes : {false, true}) {
    ASSERT_EQ(host("#1I122=2 I123=2 I126=-48000"), "");
    ASSERT_EQ(host(homes ? "#1HM" : "#1J:9000^-3000"), "");
    run(200);
    ASSERT_EQ(host(homes ? "#1I123=-30 I122=4" : "#1I123=4 I122=30"), "");
    double last = place(), fastest = 0;
    run(100);
    EXPECT_NEAR((place() - last) / 100 / ms, 2, 0.05) << "as it was told";
    trigger_at(place() + 1);
    for (int n = 0; n < 20000 && (n < 50 || jog_is_moving(0)); ++n) {
      last = place();
      tick();
      fastest = std::max(fastest, std::abs(place() - last) / ms);
    }
    EXPECT_NEAR(fastest, 30, 0.5) << homes;
  }
}

// Whoever ends it: bit 7 says afterwards whether there was no trigger.
TEST_F(Homing, AJogUntilATriggerThatIsStoppedTellsWhetherItWasFound) {
  begin(0);
  for (const char* stop : {"J/", "K", "\x01"}) {
    for (const bool comes : {false, true}) {
      ASSERT_EQ(host("#1J/"), "");
      settle();
      ASSERT_EQ(host("#1J:9000^500"), "");
      run(200);
      ASSERT_TRUE(motors[0].status.home_search);
      if (comes) trigger_at(place() + 1);
      run(comes ? 20 : 0);
      EXPECT_EQ(motors[0].status.home_search, !comes);
      if (*stop == '\x01')
        ASSERT_FALSE(control_character(1));
      else
        ASSERT_EQ(host(stop), "");
      settle();
      EXPECT_EQ(motors[0].status.trigger_move, !comes) << stop;
    }
  }
  ASSERT_EQ(host("#1J=0"), "");
  EXPECT_FALSE(motors[0].status.trigger_move) << "another move";
}

// One that is asked for as the other finds its trigger has not found its own.
TEST_F(Homing, AJogUntilATriggerBehindAnotherWaitsForItsOwn) {
  ASSERT_EQ(host("I192=20"), "");
  begin(0);
  ASSERT_EQ(host("#1J=9000^0"), "");
  run(200);
  ASSERT_EQ(host("J=-9000^0"), "");
  trigger_at(place() + 1);
  run(20);
  ASSERT_EQ(found_, 1u);
  EXPECT_TRUE(motors[0].status.trigger_move);
  ASSERT_EQ(host("J=0"), "");
  settle();
  EXPECT_FALSE(motors[0].status.trigger_move);
}

TEST_F(Homing, JogUntilATriggerThatDoesNotComeEndsAtItsTarget) {
  begin(0);
  ASSERT_EQ(host("#1J=-800^5"), "");
  settle();
  EXPECT_EQ(commanded(), -800);
  EXPECT_TRUE(motors[0].status.trigger_move) << "not found";
  EXPECT_FALSE(motors[0].status.home_search);
  ASSERT_EQ(host("J==700 J=0"), "");
  EXPECT_FALSE(motors[0].status.trigger_move);
  settle();
  ASSERT_EQ(host("J=^5"), "");
  settle();
  EXPECT_EQ(commanded(), 700) << "where it was before";
  EXPECT_EQ(host("J=^"), "ERR003");
}

TEST_F(Homing, HmzZeroesTheCommandedPositionOfAMovingMotorToo) {
  begin(100);
  ASSERT_EQ(host("#1J+"), "");
  run(200);
  const double before = place();
  ASSERT_EQ(host("HMZ"), "");
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_TRUE(motors[0].status.home_complete);
  zero_ = before;
  const double speed = 20 * platform::kDefaultI10 / 8388608.0;
  tick();
  EXPECT_NEAR(commanded(), speed, 1.0 / 16) << "it goes on";
  ASSERT_EQ(host("J=0"), "");
  for (int i = 0; i < 400; ++i) {
    const double last = commanded();
    tick();
    ASSERT_LE(std::abs(commanded() - last), speed + 1.0 / 16) << "without a jump";
  }
  settle();
  EXPECT_EQ(place(), before);
}

TEST_F(Homing, AbsolutePositionAtPowerOn) {
  begin(12345);
  ASSERT_EQ(host("#1J=50"), "");
  settle();
  ASSERT_EQ(host("$*"), "");
  EXPECT_EQ(motors[0].loop, LOOP_KILLED);
  EXPECT_FALSE(motors[0].status.home_complete);
  platform::servo_ticks(1);   // what had been latched before
  *hal_x(kServoCounter) = 0;  // as the IC has it from now on
  platform::servo_ticks(1);
  EXPECT_EQ(host("#1P"), "0") << "the cleared counter is no movement";
  EXPECT_EQ(motors[0].velocity, 0);
  platform::servo_ticks(1);
  *hal_x(kServoCounter) = 2 * 7;
  platform::servo_ticks(1);
  EXPECT_EQ(host("#1P"), "7");
}

struct Sensor {
  const char* description;
  std::uint32_t ixx95, low, high;
  double counts;
};

TEST_F(Homing, SensorsOfIxx95) {
  begin(0);
  ASSERT_EQ(host("I126=-80"), "");  // 5 counts
  for (const Sensor& s : {Sensor{"8 bits", 0x080000, 0xABCDEF, 0, 0xEF},
                          {"24 bits", 0x180000, 0xFFFFFE, 0, 16777214},
                          {"24 signed", 0x980000, 0xFFFFFE, 0, -2},
                          {"25 bits", 0x190000, 1, 0xFFFFFF, 16777217},
                          {"30 bits", 0x1E0000, 1, 0xFFFFC1, 16777217},
                          {"30 signed", 0x9E0000, 1, 0x3F, -16777215},
                          {"X", 0x4C0000, 0xFFF, 0, 4095},
                          {"48 signed", 0xB00000, 0xFFFFFF, 0xFFFFFF, -1}}) {
    const bool x = (s.ixx95 & 0x400000) != 0;
    const auto word = [x](std::uint32_t address) { return x ? hal_x(address) : hal_y(address); };
    *word(0x10E0) = s.low;
    *word(0x10E1) = s.high;
    ASSERT_EQ(host("I110=$10E0 I195=" + std::to_string(s.ixx95)), "");
    ASSERT_EQ(host("#1$*"), "") << s.description;
    EXPECT_TRUE(motors[0].status.home_complete) << s.description;
    EXPECT_EQ(static_cast<double>(motors[0].actual), (s.counts + 5) * kUnits) << s.description;
  }
  for (const std::uint32_t wrong : {0x070000u, 0x310000u, 0x180001u, 0x18F000u}) {
    ASSERT_EQ(host("I195=" + std::to_string(wrong)), "");
    EXPECT_EQ(host("#1$*"), "ERR018") << wrong;
  }
}

TEST_F(Homing, SensorsAreReadAtEachStart) {
  ASSERT_EQ(host("I110=$10E0 I195=$180000 I126=0 I210=$10E0 I295=$180000 I280=4"), "");
  ASSERT_EQ(host("SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("#1P"), "0");
  EXPECT_TRUE(motors[0].status.home_complete);
  EXPECT_FALSE(motors[1].status.home_complete) << "Ixx80 bit 2";
  *hal_y(kAdc) = 123456;  // no start clears it
  ASSERT_EQ(host("I110=$78015 I126=160 SAVE"), "");
  platform::reset();
  EXPECT_EQ(host("#1P"), "123446") << "less Ixx26";
}

TEST_F(Homing, WhileItMovesNoReferenceIsTaken) {
  begin(0);
  ASSERT_EQ(host("#1J+"), "");
  run(100);
  EXPECT_EQ(host("$"), "ERR018");
  EXPECT_EQ(host("$*"), "ERR018");
}

TEST_F(Homing, RolloverGoesTheShortestWayOrByTheSign) {
  const auto target = [](double from, double to) { return rollover_target(0, from, to, std::signbit(to)); };
  EXPECT_EQ(target(100, 27000), 27000) << "off";
  ASSERT_EQ(host("I127=36000 I128=160"), "");
  EXPECT_EQ(target(0, 27000), -9000) << "the data sheet's";
  for (const double half : {18000, -18000}) EXPECT_EQ(target(0, half), 18000) << "half a turn is upwards";
  EXPECT_EQ(target(72000 + 35000, 1000), 72000 + 37000);
  EXPECT_EQ(target(-72000 - 35000, 1000), -72000 - 35000);
  EXPECT_EQ(target(-100, 36000 * 5 - 200), -200);
  ASSERT_EQ(host("I127=-36000"), "");
  EXPECT_EQ(target(0, 27000), 27000);
  EXPECT_EQ(target(0, -27000), -27000) << "-270 degrees are 90, from above";
  EXPECT_EQ(target(0, -9000), -9000);
  EXPECT_EQ(target(35000, 1000), 37000);
  EXPECT_EQ(target(35000, -35000), 1000);
  EXPECT_EQ(target(35000, -1000), 35000) << "it is there";
  EXPECT_EQ(target(5000, 5009.5), 5000) << "within Ixx28";
  EXPECT_EQ(target(5000, -30990.5), 5000);
  EXPECT_EQ(target(5000, 4980), 40980);
  EXPECT_EQ(target(5000, -30980), -30980);
}

}  // namespace
