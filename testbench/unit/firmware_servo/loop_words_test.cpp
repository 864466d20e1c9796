// What goes into the servo loop and comes out of it, natively: sources and Ixx60, the words of motion:1.3, outputs of
// motion:1.5.
#include "testbench/unit/firmware_servo/position_loop_rig.h"

extern "C" {
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/conversion_table.h"
}

namespace brick {
namespace {

class LoopWords : public PositionLoopRig {
 protected:
  std::int32_t place_ = 0;
};

// motion:1.3: what the loop shows, in units of 1/(32 Ixx08) count and in bits of 24.
TEST_F(LoopWords, WordsOfTheLoop) {
  c_.line("I130=4000 I131=0 I132=0 I133=131072 I134=0 I168=100 I137=0.5");
  close(0, 0);
  cycle(-10 * 32 * 96, 0, 0);
  cycle(-12 * 32 * 96, 0, 0);
  const auto word = [this](const char* command) { return std::stol(c_.line(command)); };
  const long integral = -22 * 32 * 96 / 64;  // Ixx33 / 2^23 = 1/64
  EXPECT_EQ(word("RX$9E"), -1);
  EXPECT_EQ(word("RY$9E"), integral);
  EXPECT_EQ(word("RX$87"), -1);
  EXPECT_EQ(word("RY$87"), -2 * 32 * 96);
  const double pid = (-12 - 22 / 64.0) * 4000 * 96 / 524288;  // bits of 16
  EXPECT_NEAR(word("RX$AE") / 256.0, pid, 0.01);
  const double before = -10 * (1 + 1 / 64.0) * 4000 * 96 / 524288;
  EXPECT_EQ(word("RX$BF"), motors[0].output);
  EXPECT_NEAR(word("RX$BF") / 256.0, pid - 100, 0.01) << "N2 is two closures back";
  cycle(-12 * 32 * 96, 0, 0);
  EXPECT_NEAR(word("RX$BF") / 256.0, (-12 - 34 / 64.0) * 4000 * 96 / 524288 + 0.5 * before, 0.01);
  EXPECT_EQ(word("RX$88"), -1);
  EXPECT_EQ(word("RY$88"), -12 * 32 * 96);
  at(-5 * 32, -5 * 32);
  position_loop_servo(0);
  EXPECT_EQ(word("RX$8B"), -1);
  EXPECT_EQ(word("RY$8B"), -5 * 32 * 96);
  EXPECT_EQ(word("RX$9D"), -5 * 32 * 96);
  cycle(6000 * 32 * 96, 5999 * 32, 0);
  EXPECT_EQ(word("RX$88"), 1);
  EXPECT_EQ(word("RY$88"), 6000 * 32 * 96 - 16777216);
  EXPECT_EQ(word("RX$8B"), 1);
  EXPECT_EQ(word("RY$8B"), 5999 * 32 * 96 - 16777216);
}

// motion:1.3/2: the loop of a killed motor writes what goes out, nothing.
TEST_F(LoopWords, OutputOfAKilledMotorIsZero) {
  c_.line("I130=4000 I131=0 I132=0 I133=0");
  close(0, 0);
  cycle(-10 * 32 * 96, 0, 0);
  ASSERT_LT(std::stol(c_.line("RX$BF")), 0);
  motor_kill(0);
  position_loop_servo(0);
  EXPECT_EQ(c_.line("RX$BF"), "0");
}

// What the notch is given may be far beyond a word, which shows its end.
TEST_F(LoopWords, TheWordOfThePidHasAnEnd) {
  c_.line("I130=8388607 I131=0 I132=0 I133=0");
  close(0, 0);
  cycle(5000 * 32 * 96, 0, 0);
  EXPECT_EQ(c_.line("RX$AE"), "8388607");
  cycle(-5000 * 32 * 96, 0, 0);
  EXPECT_EQ(c_.line("RX$AE"), "-8388607");
}

// A counter that is cleared is neither movement nor velocity: in the interrupt after that and in the next.
TEST_F(LoopWords, MovementThatIsForgotten) {
  close(0, 0);
  position_loop_forget_movement(0);
  const std::int64_t before = motors[0].actual;
  at(1000, 1000);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].output, 0);
  at(1100, 1100);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, before);
  EXPECT_EQ(motors[0].output, 0);
  at(1132, 1132);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
}

// With Ixx60 too it is two interrupts, not two closures: what moves in the third counts.
TEST_F(LoopWords, MovementThatIsForgottenBetweenClosures) {
  c_.line("I160=7");
  for (int first = 0; first < 8; ++first) {  // interrupts from a closure to the third
    close(0, 0);
    for (int n = 0; n < 5 + first; ++n) position_loop_servo(0);
    position_loop_forget_movement(0);
    const std::int64_t before = motors[0].actual;
    at(1000, 1000);
    position_loop_servo(0);
    at(1100, 1100);
    position_loop_servo(0);
    EXPECT_EQ(motors[0].actual, before) << first;
    at(1132, 1164);
    for (int n = 0; n < 8; ++n) position_loop_servo(0);
    EXPECT_EQ(motors[0].actual - before, 32 * 96) << first;
  }
}

// motion:1.1: registers of the loop are zero whenever it is open, killed or by O.
TEST_F(LoopWords, AnOpenLoopShowsNothingOfTheOneThatWasClosed) {
  c_.line("I130=20 I131=0 I132=0 I133=1280 I134=0 I163=4194304");
  for (const bool killed : {true, false}) {
    close(0, 0);
    for (int i = 1; i < 5; ++i) cycle(i * 1000000, 0, 0);
    ASSERT_NE(position_loop_step(0), 0);
    ASSERT_NE(position_loop_integral(0), 0);
    ASSERT_NE(position_loop_filtered(0), 0);
    if (killed)
      motor_kill(0);
    else
      ASSERT_TRUE(motor_open(0, 500));
    position_loop_servo(0);
    EXPECT_EQ(motors[0].output, killed ? 0 : 500);
    EXPECT_EQ(position_loop_step(0), 0) << killed;
    EXPECT_EQ(position_loop_integral(0), 0) << killed;
    EXPECT_EQ(position_loop_filtered(0), 0) << killed;
    EXPECT_EQ(c_.line("RX$87 RY$87 RX$9E RY$9E RX$AE"), "0|0|0|0|0");
  }
}

// Steps of up to 2^36 units count whole, which the smallest gains do not put out at once: Ixx67 = 0, velocity alone.
TEST_F(LoopWords, LargeStepsCountWhole) {
  c_.line("I130=1 I131=0 I132=1 I133=0 I135=0 I167=0 I168=0");
  close(0, 0);
  std::int64_t at = 0;
  for (const std::int64_t step :
       {std::int64_t{1} << 30, std::int64_t{5} << 33, -(std::int64_t{3} << 34), std::int64_t{7} << 33}) {
    at += step;
    cycle(at, 0, 0);
    EXPECT_NEAR(output_, expected_, 0.01) << step;
    EXPECT_NE(output_, 0);
  }
}

// Movement counts from a start on, activated or not: of both words, and of the variables as they are then.
TEST_F(LoopWords, MovementCountsFromTheStartOn) {
  c_.line("I100=0");
  at(70, 90);
  position_loop_initialize();
  position_loop_begin(1);
  motors[0].actual = 0;
  at(70 + 1000, 90 + 640);
  c_.line("I100=1");
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, 1000 * 96);
  EXPECT_EQ(motors[0].velocity, 640 * 96);
}

// The words of a motor that is not activated are the user's: nobody but him writes them.
TEST_F(LoopWords, AMotorThatIsNotActivatedShowsNoPosition) {
  c_.line("M1->D:$88 M2->D:$8B");
  motors[0].commanded = 70;
  motors[0].actual = 80;
  c_.line("M1=5 M2=6");
  const std::uint32_t active = motors_active;
  motors_active = active & ~1u;
  position_loop_show(0);
  EXPECT_EQ(c_.line("M1 M2"), "5|6");
  motors_active = active | 1u;
  position_loop_show(0);
  EXPECT_EQ(c_.line("M1 M2"), "70|80");
}

// Two halves of a word are two variables, with their signs.
TEST_F(LoopWords, HalvesOfAWordAreVariablesOfTheirOwn) {
  c_.line("I132=11 I160=2 I133=13 I163=-14");
  c_.line("WX$8F,-21");
  EXPECT_EQ(c_.line("I132 I160"), "-21|2");
  c_.line("WY$8F,3");
  EXPECT_EQ(c_.line("I132 I160"), "-21|3");
  c_.line("WY$9F,-24");
  EXPECT_EQ(c_.line("I133 I163"), "13|-24");
  c_.line("WX$9F,23");
  EXPECT_EQ(c_.line("I133 I163"), "23|-24");
  EXPECT_EQ(c_.line("RX$8F RY$8F RX$9F RY$9F"), "-21|3|23|-24");
  c_.line("WX$AE,5");
  EXPECT_EQ(c_.line("RX$AE"), "0") << "the firmware's";
}

// D:$8D, D:$90 and D:$CC are set by writes of either half.
TEST_F(LoopWords, PositionsThatMayBeWritten) {
  std::int64_t* const positions[] = {&motors[0].master, &motors[0].compensation, &motors[0].bias};
  const char* const addresses[] = {"$8D", "$90", "$CC"};
  for (int k = 0; k < 3; ++k) {
    const std::string at = addresses[k];
    c_.line("WX" + at + ",-2");
    c_.line("WY" + at + ",5");
    EXPECT_EQ(*positions[k], -2 * 16777216 + 5) << at;
    EXPECT_EQ(c_.line("RX" + at), "-2") << at;
    EXPECT_EQ(c_.line("RY" + at), "5") << at;
    c_.line("WY" + at + ",-1");
    EXPECT_EQ(*positions[k], -2 * 16777216 + 16777215) << at;
    c_.line("WX" + at + ",1");
    EXPECT_EQ(*positions[k], 2 * 16777216 - 1) << at;
  }
}

// motion:1.3: $80 words a motor from $80 on, whole or by halves; below and behind them there is none.
TEST_F(LoopWords, EachMotorHasWordsOfItsOwn) {
  const auto at = [](unsigned motor, unsigned offset) {
    char text[8];
    std::snprintf(text, sizeof text, "$%X", 0x80 * motor + offset);
    return std::string(text);
  };
  for (const unsigned motor : {0u, 1u, 2u, 31u, 32u, 33u}) {
    SCOPED_TRACE(motor);
    EXPECT_EQ(c_.line("M1->D:" + at(motor, 0x4C) + " M2->D:" + at(motor, 0x10)), "");
    static unsigned unmasked;
    unmasked = 0;
    fake_hal_on_unmask([] {  // no servo interrupt sees one half of it
      ++unmasked;
      for (const struct motor& m : motors) {
        EXPECT_TRUE(m.bias == 0 || m.bias == -5) << m.bias;
        EXPECT_TRUE(m.compensation == 0 || m.compensation == 16777220) << m.compensation;
      }
    });
    const std::string reply = c_.line("M1=-5 M2=16777220");
    fake_hal_on_unmask(nullptr);
    EXPECT_EQ(reply, "");
    EXPECT_GE(unmasked, 2u) << "one each";
    EXPECT_EQ(c_.line("WX" + at(motor, 0x0D) + ",3 WY" + at(motor, 0x0D) + ",7 WX" + at(motor, 0x3F) + ",11"), "");
    for (unsigned i = 0; i < MOTORS; ++i) {
      const bool is_it = i + 1 == motor;
      EXPECT_EQ(motors[i].bias, is_it ? -5 : 0) << i;
      EXPECT_EQ(motors[i].compensation, is_it ? 16777220 : 0) << i;
      EXPECT_EQ(motors[i].master, is_it ? 3 * 16777216 + 7 : 0) << i;
      EXPECT_EQ(motors[i].open_output, is_it ? 11 : 0) << i;
    }
    if (motor == 0 || motor > MOTORS) continue;
    EXPECT_EQ(c_.line("M1"), "-5");
    EXPECT_EQ(c_.line("RY" + at(motor, 0x0D)), "7");
    motor_kill(motor - 1);
    motors[motor - 1].bias = motors[motor - 1].compensation = motors[motor - 1].master = 0;
    motors[motor - 1].open_output = 0;
  }
}

// motion:2: up to 2^18 bits of a parallel word an interrupt, 24 bits that go round, and no count is lost.
TEST_F(LoopWords, AParallelWordMayMoveByTwoTo18) {
  c_.line("I8000=$2010F2 I8001=$18000 I103=$3502 I104=$3502 I8002=0");
  conversion_table_servo();
  position_loop_servo(0);
  const std::int64_t begin = motors[0].actual;
  for (std::int64_t n = 1; n <= 1000; ++n) {
    *hal_y(0x10F2) = static_cast<std::uint32_t>(n * 262143) & HAL_WORD_MASK;
    conversion_table_servo();
    position_loop_servo(0);
  }
  EXPECT_EQ(motors[0].actual - begin, 1000 * 262143ll * 32 * 96);
}

// Every Ixx60+1 interrupts; velocities are those of a closure.
TEST_F(LoopWords, ExtensionSlowsTheLoopOnly) {
  c_.line("I160=3 I130=2000 I131=1280 I132=0");
  close(0, 0);
  int closures = 0;
  for (int n = 1; n <= 40; ++n) {
    const std::int64_t before = motors[0].actual;
    at(n * 32, n * 32);
    motors[0].trajectory = n * 32 * 96;
    desired_position_servo(0);
    position_loop_servo(0);
    if (motors[0].actual != before) {
      closures++;
      if (closures > 1) { EXPECT_EQ(motors[0].velocity, 4 * 32 * 96); }
    }
    EXPECT_EQ(motors[0].desired_step, 32 * 96) << "the trajectory goes on every interrupt";
  }
  EXPECT_EQ(closures, 10);
}

// The raw word is that of a closure; V stays that of a servo interrupt.
TEST_F(LoopWords, ReportedVelocityKnowsNoExtension) {
  c_.line("I160=3 I60=0 I61=4");
  close(0, 0);
  for (int n = 1; n <= 40; ++n) {
    at(n * 32 * 5, n * 32 * 5);
    position_loop_servo(0);
    average_velocity_servo();
  }
  EXPECT_EQ(c_.line("RX$9D"), std::to_string(4 * 5 * 32 * 96));
  EXPECT_EQ(c_.line("#1V"), "5");
}

// motion:1.3/4: V is the way of sixteen samples, I60 + 1 interrupts apart, over 2^I61.
TEST_F(LoopWords, VIsTheMeanOfSixteenSamples) {
  struct Case {
    unsigned spacing, shift;
  };
  for (const Case& c : {Case{0, 4}, {1, 5}, {3, 6}, {15, 8}, {3, 2}}) {
    c_.line("I109=48 I60=" + std::to_string(c.spacing) + " I61=" + std::to_string(c.shift));
    c_.line("I100=0");
    EXPECT_EQ(c_.line("#1V"), "0") << "not activated";
    average_velocity_initialize();  // the next interrupt has a sample
    c_.line("I100=1");
    EXPECT_EQ(c_.line("#1V"), "0") << "where it has been before does not count";
    std::vector<std::int64_t> samples(16, motors[0].actual);
    for (std::uint32_t n = 0; n < 600; ++n) {
      place_ += 32 * (static_cast<int>(n % 7) - 2) * (n < 300 ? 1 : -3);
      at(place_, place_);
      position_loop_servo(0);
      average_velocity_servo();
      if (n % (c.spacing + 1) != 0) continue;
      samples.push_back(motors[0].actual);
      const auto way = static_cast<double>(samples.back() - samples[samples.size() - 17]);
      const double mean = way / (32.0 * 96 * (1u << c.shift));
      ASSERT_NEAR(std::stod(c_.line("#1V")), mean, 1.0 / 64 + 0.001) << n << ", I60 = " << c.spacing;
      const std::int64_t word =
          std::stoll(c_.line("RX$EF")) * 16777216 + (std::stoll(c_.line("RY$EF")) & HAL_WORD_MASK);
      ASSERT_NEAR(static_cast<double>(word), mean * 32 * 48, 1.0) << "D:$EF";
      ASSERT_EQ(average_velocity_word(0), static_cast<std::uint32_t>(word) & HAL_WORD_MASK);
    }
  }
}

// motion:1.3/4: with another I60 the samples begin anew, in the middle of a round too: at an even speed the mean rises
// to it and is never more.
TEST_F(LoopWords, AnotherDistanceOfSamplesBeginsAnew) {
  for (unsigned before : {15u, 3u, 0u}) {
    for (unsigned after : {0u, 3u, 15u}) {
      c_.line("I60=" + std::to_string(before) + " I61=8");
      average_velocity_initialize();
      c_.line("I100=0 I100=1");
      std::int64_t most = 0;
      for (unsigned n = 0; n < 600; ++n) {
        if (n == 300) c_.line("I60=" + std::to_string(after));
        motors[0].actual += 25600;
        average_velocity_servo();
        if (n < 300) continue;
        most = std::max(most, average_velocity(0));
        ASSERT_LE(average_velocity(0), 100 * (n - 299)) << before << ", " << after << ": more than it has moved since";
      }
      EXPECT_EQ(most, 25600 * 16 * (after + 1) / 256) << before << ", " << after;
    }
  }
}

TEST_F(LoopWords, TheVelocityOfABlockHasAnEnd) {
  c_.line("I60=0 I61=0");
  average_velocity_initialize();
  c_.line("I100=0 I100=1");
  for (const std::int64_t way : std::vector<std::int64_t>{8388606, 8388607, 8388608, 9000000000}) {
    motors[0].actual += way;
    average_velocity_servo();
    EXPECT_EQ(average_velocity_word(0), std::min<std::int64_t>(way, 8388607)) << way;
    motors[0].actual -= 2 * way;
    c_.line("I100=0 I100=1");
    motors[0].actual -= way;
    average_velocity_servo();
    EXPECT_EQ(average_velocity_word(0), (0x1000000 - std::min<std::int64_t>(way, 8388607)) & 0xFFFFFF) << way;
    c_.line("I100=0 I100=1");
  }
}

TEST_F(LoopWords, SourcesRollOver) {
  close(0x7FFFF0, 0x7FFFF0);
  position_loop_servo(0);
  const std::int64_t before = motors[0].actual;
  at(-0x7FFFF0, -0x7FFFF0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
  EXPECT_EQ(motors[0].velocity, 32 * 96);
}

// One word for position and velocity is read once; then Ixx04 or Ixx09 become others, and nothing jumps.
TEST_F(LoopWords, VelocityOfTheSameWord) {
  c_.line("I104=$10F0");
  close(0, 0);
  const auto velocity_after = [this](std::int64_t position) {
    at(position, 5000);
    position_loop_servo(0);
    return motors[0].velocity;
  };
  velocity_after(0);
  EXPECT_EQ(velocity_after(7), 7 * 96);
  EXPECT_EQ(velocity_after(9), 2 * 96);
  c_.line("I109=48");
  EXPECT_EQ(velocity_after(10), 48);
  c_.line("I109=96");
  EXPECT_EQ(velocity_after(14), 4 * 96);
  c_.line("I104=$10F1");
  EXPECT_EQ(velocity_after(15), 0);
}

// Where another source stands is no movement.
TEST_F(LoopWords, AnotherSourceIsNoMovement) {
  close(1000, 1000);
  position_loop_servo(0);
  at(1000, 5000);
  position_loop_servo(0);
  const std::int64_t before = motors[0].actual;
  c_.line("I103=$10F1 I104=$10F0");
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, before);
  EXPECT_EQ(motors[0].velocity, 0);
  at(1000, 5032);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 32 * 96);
}

// A smaller Ixx60 acts at once, a loop that waits for its turn does not wait for the old one.
TEST_F(LoopWords, ASmallerExtensionActsAtOnce) {
  c_.line("I160=255");
  close(0, 0);
  position_loop_servo(0);
  at(32, 32);
  c_.line("I160=1");
  position_loop_servo(0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual, 32 * 96);
}

// From a word of a converter over table, master, desired position and loop to the output.
TEST_F(LoopWords, OneServoInterruptLeadsFromSourceToOutput) {
  c_.line("I8000=$2810F2 I8001=$18000 I8002=0 I105=$3502 I107=96 I106=1 I111=0 I130=2000 I131=0 I132=0 I133=0");
  *hal_y(0x10F2) = 0;
  close(0, 0);
  c_.servo(2);
  EXPECT_EQ(*hal_y(kDac), 0u);
  *hal_y(0x10F2) = 100 * 32;
  c_.servo(1);
  EXPECT_NEAR(hal_signed(*hal_y(kDac)) / 256.0, 100 * 2000 * 96 / 524288.0, 0.01);
}

TEST_F(LoopWords, AScaleOf0CountsAs1) {
  c_.line("I108=0");
  at(0, 0);
  position_loop_servo(0);
  const std::int64_t before = motors[0].actual;
  at(320, 0);
  position_loop_servo(0);
  EXPECT_EQ(motors[0].actual - before, 320);
}

TEST_F(LoopWords, OpenLoopPutsOutWhatItIsTold) {
  ASSERT_TRUE(motor_open(0, 1234 << 8));
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 1234u << 8);
  motor_kill(0);
  EXPECT_EQ(*hal_y(kDac), 0u);
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0u) << "nor later";
}

// A variable O command: whoever writes X:$BF of an open loop says what it puts out, all of it or a part.
TEST_F(LoopWords, AnOpenLoopPutsOutWhatItsRegisterIsGiven) {
  c_.line("M168->X:$BF,8,16,S M5->X:$BF,0,24,S M6->X:$13F,8,16,S");
  const auto output = [] {
    position_loop_servo(0);
    motor_output_servo(0);
    return hal_signed(*hal_y(kDac));
  };
  ASSERT_EQ(c_.line("#1O10"), "");
  const std::int32_t before = output();
  EXPECT_EQ(c_.line("M6=77"), "") << "that of motor 2";
  EXPECT_EQ(output(), before);
  c_.line("M5=$7F M168=-5000");
  EXPECT_EQ(output(), -5000 * 256 + 0x7F);
  EXPECT_EQ(c_.line("M168"), "-5000");
  c_.line("M5=8388607");
  EXPECT_EQ(output(), 8388607);
  c_.line("#1O0");
  EXPECT_EQ(output(), 0);
  close(0, 0);
  c_.line("M168=5000");
  EXPECT_EQ(output(), 0) << "a loop that is closed";
  motor_kill(0);
  c_.line("M168=5000");
  EXPECT_EQ(output(), 0);
  ASSERT_TRUE(motor_open(0, 0));
  EXPECT_EQ(output(), 0) << "what was written before counts for nothing";
}

// The bias is added after the clip, and stays on the output of a killed motor.
TEST_F(LoopWords, BiasIsAddedToTheWord) {
  c_.line("I129=-300 I169=1000 I130=100000");
  close(0, 0);
  cycle(1000 * 32 * 96, 0, 0);
  motor_output_servo(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), (1000 - 300) * 256);
  motor_kill(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), -300 * 256);
  c_.line("I129=32767 I169=32767");
  close(0, 0);
  cycle(1000 * 32 * 96, 0, 0);
  motor_output_servo(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), 0x7FFFFF);
  c_.line("I129=-32768");
  cycle(-1000 * 32 * 96, 0, 0);
  motor_output_servo(0);
  EXPECT_EQ(hal_signed(*hal_y(kDac)), -0x7FFFFF);
}

// What the registers hold at a start is not known.
TEST_F(LoopWords, AStartPutsTheBiasOut) {
  c_.line("I129=0 SAVE");
  *hal_y(kDac) = 0x123400;
  c_.restart();
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0u);
}

TEST_F(LoopWords, AKilledMotorLeavesItsRegisterToTheUser) {
  motor_output_servo(0);
  c_.line("WY$78002,$123400");
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0x123400u);
  ASSERT_TRUE(motor_open(0, 0));
  motor_output_servo(0);
  EXPECT_EQ(*hal_y(kDac), 0u);
}

TEST_F(LoopWords, TheWordGoesToXForIxx01Of2) {
  c_.line("I101=2 I102=$10F8");
  ASSERT_TRUE(motor_open(0, 77 << 8));
  position_loop_servo(0);
  motor_output_servo(0);
  EXPECT_EQ(*hal_x(0x10F8), 77u << 8);
}

}  // namespace
}  // namespace brick
