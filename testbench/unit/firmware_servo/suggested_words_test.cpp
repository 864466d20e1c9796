// The M-variables that users of a Brick have for motor 1 and coordinate system 1 (firmware:1.10), on motors that move:
// each says what `?`, `??`, P, V and F say.
#include <cstdio>

#include "testbench/unit/firmware_servo/protection_rig.h"

namespace brick {
namespace {

class SuggestedWords : public ProtectionRig {
 protected:
  SuggestedWords() {
    for (const char* definition :
         {"M128->X:$B0,22",    "M130->Y:$C0,11",        "M131->X:$B0,22",        "M132->X:$B0,21",
          "M133->X:$B0,13",    "M135->X:$B0,15",        "M137->X:$B0,17",        "M138->X:$B0,18",
          "M139->Y:$C0,14",    "M140->Y:$C0,0,1",       "M141->Y:$C0,1",         "M142->Y:$C0,2",
          "M143->Y:$C0,3",     "M145->Y:$C0,10",        "M147->Y:$C0,5",         "M148->Y:$C0,8",
          "M149->Y:$C0,9",     "M161->D:$88",           "M162->D:$8B",           "M163->D:$C7",
          "M164->D:$CC",       "M166->X:$9D,0,24,S",    "M167->D:$8D",           "M168->X:$BF,8,16,S",
          "M169->D:$90",       "M173->Y:$CE,0,24,S",    "M263->D:$147",          "M5180->X:$2040,0",
          "M5182->Y:$203F,22", "M5187->Y:$203F,17",     "M5188->Y:$203F,18",     "M5189->Y:$203F,19",
          "M5190->Y:$203F,20", "M5197->X:$2000,0,24,S", "M5198->X:$2002,0,24,S", "M5141->L:$2041",
          "M5147->L:$2047",    "M5148->L:$2048"})
      EXPECT_EQ(c_.line(definition), "") << definition;
    c_.line("I215=1 I216=200 I217=1 I219=10 I220=0 I221=0 I292=1");
    c_.line("I111=0 I115=1 I119=10 I120=0 I121=0 I122=32 I192=1 I116=200 I117=1");
  }
  double m(unsigned number) { return std::stod(c_.line("M" + std::to_string(number))); }
  double counts_of(unsigned number) { return m(number) / kFine; }
  double reported(const char* command) { return std::stod(c_.line(command)); }
};

TEST_F(SuggestedWords, OfAJog) {
  c_.line("I60=0 I61=4");
  close_all();
  follow(6);
  EXPECT_EQ(c_.line("M140 M133 M138 M139 M137 M5187"), "1|1|0|1|0|1");
  c_.line("#1J=2500");
  follow(60);
  EXPECT_EQ(c_.line("M140 M133 M138 M139 M137 M5187"), "0|0|0|1|1|0");
  EXPECT_EQ(counts_of(163), 2500) << "target";
  EXPECT_EQ(counts_of(161), at(1));
  // The test has it where it was commanded to be an interrupt ago: 32 counts/ms for 0.4427 ms.
  const double step = 32 * 3713991.0 / 8388608;
  EXPECT_NEAR(counts_of(161) - counts_of(162), step, 1.0 / 16);
  EXPECT_NEAR(counts_of(166), step, 1.0 / 16) << "velocity, Ixx09 = 96 too";
  EXPECT_NEAR(reported("#1F"), step, 1.0 / 16);
  EXPECT_NEAR(reported("#1V"), step, 1.0 / 16);
  EXPECT_NEAR(reported("#1P"), counts_of(162), 1.0 / 32);
  EXPECT_EQ(m(168), motors[0].output / 256);
  follow(300);
  EXPECT_EQ(c_.line("M140 M133 M137"), "1|1|0");
  EXPECT_EQ(counts_of(161), 2500);
  EXPECT_EQ(counts_of(163), 2500);
  c_.line("M144->Y:$C0,7 M136->X:$B0,10 #1J=4000^100");
  follow(10);
  EXPECT_EQ(c_.line("M144 M136 M137"), "1|1|1") << "until a trigger";
  follow(300);
  EXPECT_EQ(c_.line("M144 M136"), "1|0") << "which has not come";
  c_.line("#1J-");
  follow(30);
  EXPECT_EQ(c_.line("M144"), "0");
  EXPECT_EQ(m(137), 0) << "no end is known";
  EXPECT_EQ(counts_of(163), at(1));
  c_.line("#1K");
  EXPECT_EQ(c_.line("M133 M138 M139"), "0|1|0");
}

// motion:1.3/4: with I60 = 15 and I61 = 8 over 256 interrupts, with 1 and 5 over 32; homing does not disturb it.
TEST_F(SuggestedWords, OfTheAveragedVelocity) {
  c_.line("M174->D:$EF I119=1000");
  close_all();
  c_.line("#1J+");
  const double step = 32 * 3713991.0 / 8388608;
  follow(600);
  EXPECT_NEAR(counts_of(174), step, 1.0 / 64);
  c_.line("#1J/");
  follow(100);
  EXPECT_GT(counts_of(174), step / 2) << "156 of 256 interrupts were at full speed";
  EXPECT_LT(counts_of(174), step * 0.8);
  follow(200);
  EXPECT_EQ(m(174), 0);
  c_.line("I60=1 I61=5 #1J-");
  follow(60);
  EXPECT_NEAR(counts_of(174), -step, 1.0 / 64);
  c_.line("#1J/");
  follow(60);
  EXPECT_EQ(m(174), 0);
  // The encoder goes on through an assignment of home.
  c_.line("#1K");
  double place = at(1);
  for (int n = 0; n < 100; ++n) {
    if (n == 60) { EXPECT_EQ(c_.line("#1HMZ"), ""); }
    counts(1, place += 3);
    servo();
    if (n > 40) { ASSERT_NEAR(counts_of(174), 3, 1.0 / 64) << n; }
  }
}

TEST_F(SuggestedWords, OfAProgram) {
  run({"TM400 TA50 TS0 X5000 Y-2500", "DWELL100", "RAPID X1000 Y0", "LINEAR TM100000 X9000", "DWELL5"});
  follow(50);
  EXPECT_EQ(c_.line("M5180 M5187 M140 M137 M135"), "1|0|0|1|0");
  EXPECT_EQ(counts_of(163), 5000);
  EXPECT_EQ(counts_of(263), -2500);
  EXPECT_EQ(c_.line("M5147 M5148 M5141"), "5000|-2500|0") << "targets of axes";
  follow(1100);  // 450 ms are 1017 interrupts
  EXPECT_EQ(c_.line("M5180 M5187 M140 M135 M133"), "1|0|0|1|1") << "DWELL: desired velocity 0, not in position";
  EXPECT_EQ(counts_of(163), 5000);
  follow(120);
  EXPECT_EQ(c_.line("M5147 M5148"), "1000|0") << "RAPID";
  EXPECT_EQ(counts_of(163), 1000);
  EXPECT_EQ(counts_of(263), 0);
  follow(500);
  EXPECT_EQ(counts_of(163), 9000);
  EXPECT_EQ(c_.line("M5147"), "9000");
  EXPECT_EQ(m(5197), 3713991);
  EXPECT_EQ(m(5198), 3713991);
  c_.line("&1A");
  follow(100);
  EXPECT_EQ(c_.line("M5180 M5187 M140"), "0|1|1");
}

TEST_F(SuggestedWords, OfSplinesAndPvt) {
  const std::vector<std::string> programs[] = {{"SPLINE1 TM200", "X1000 Y0", "X3000 Y100", "X3000 Y100"},
                                               {"PVT200", "X1000:5 Y0:0", "X3000:0 Y100:0", "X3000 Y100"}};
  for (const auto& program : programs) {
    const std::string& mode = program.front();
    c_.line("#1HMZ #2HMZ");
    run(program);
    follow(800);
    EXPECT_EQ(c_.line("M5147 M5148"), "3000|100") << mode;
    if (mode == "PVT200") {
      EXPECT_LT(at(1), 2900);
      EXPECT_EQ(counts_of(163), 3000);
    }
    follow(2000);
    EXPECT_EQ(counts_of(163), 3000) << mode;
    c_.line("#1K #2K");
    counts(1, 0);
    counts(2, 0);
    servo(3);
  }
}

// Down with backlash, up without.
TEST_F(SuggestedWords, OfBacklash) {
  c_.line("M144->Y:$C0,4 I185=16 I186=160 I187=16");
  ASSERT_TRUE(motor_close(0));
  c_.line("#1J=-100");
  follow(60);
  EXPECT_EQ(c_.line("M144"), "1");
  c_.line("#1J=100");
  follow(60);
  EXPECT_EQ(c_.line("M144"), "0");
}

TEST_F(SuggestedWords, OfFaults) {
  close_all();
  c_.line("I211=1600 I212=160");
  counts(2, 11);
  servo(3);
  EXPECT_EQ(c_.line("M5188 M5189 M5190 M142"), "1|0|0|0");
  counts(2, 101);
  servo(3);
  EXPECT_EQ(c_.line("M5188 M5189 M5190"), "1|1|0");
  EXPECT_EQ(c_.line("M142 M143"), "0|0") << "that of motor 2";
  counts(2, 0);
  servo(3);
  close_all();
  flags(1, kFault);
  servo(3);
  EXPECT_EQ(c_.line("M5188 M5189 M5190 M143 M142"), "0|0|1|1|0");
  flags(1, kPositive);
  close_all();
  servo(3);
  EXPECT_EQ(c_.line("M131 M132 M143"), "0|1|0");
}

// Reports in the dual-ported RAM (host-bus:6.4, host-bus:6.5) of motors that a program moves, and that RAPID moves.
TEST_F(SuggestedWords, DpramReportsTellOfMotion) {
  // Items of motor 1 from byte $74 on, of coordinate system 1 from $69C on: a Y and an X word of 16 bits each.
  const auto item = [this](unsigned offset) {
    const unsigned at = 0x60000 + offset / 4;
    char line[40];
    std::snprintf(line, sizeof line, "RHY$%X", at);
    const unsigned long low = std::stoul(c_.line(line), nullptr, 16) & 0xFFFF;
    std::snprintf(line, sizeof line, "RHX$%X", at);
    return low | (std::stoul(c_.line(line), nullptr, 16) & 0xFFFF) << 16;
  };
  const auto long_of = [&item](unsigned offset) {  // the low 24 bits first
    return static_cast<std::int64_t>((item(offset + 4) & 0xFFFFFF) << 24 | (item(offset) & 0xFFFFFF));
  };
  c_.line("WY$6001C,$FF WX$6001C,0 WY$6019D,1 WX$6019D,0 I48=1 I47=1 I49=1 I50=1 I60=0 I61=4");
  run({"TM400 TA50 TS0 X5000 Y2500", "X5100", "RAPID X9000 Y0"});
  follow(500);
  EXPECT_EQ(long_of(0x74 + 40), motors[0].actual);
  EXPECT_EQ(long_of(0x74), motors[0].commanded - motors[0].actual) << "following error";
  EXPECT_GT(long_of(0x74), 0);
  // 5000 counts in 400 ms, by the mean of sixteen interrupts.
  const double step = 5000 / 400.0 * 3713991.0 / 8388608;
  EXPECT_NEAR(static_cast<double>(item(0x74 + 28)) / kFine, step, 1.0 / 16) << "averaged velocity";
  EXPECT_EQ(item(0x74 + 8) & 0xFFFFFF, static_cast<unsigned long>(motors[0].output) & 0xFFFFFF);
  const unsigned long status = std::stoul(c_.line("#1?").substr(0, 6), nullptr, 16);
  EXPECT_EQ(item(0x74 + 12) & 0xFFFFFF, status);
  EXPECT_NEAR(static_cast<double>(item(0x69C + 104)), 450 - 500 * 3713991.0 / 8388608, 3) << "ms left";
  follow(1500);
  EXPECT_GT(motors[0].desired_step, 0) << "RAPID";
  for (int passes = 0; passes < 4; ++passes) c_.line("");
  EXPECT_EQ(item(0x69C + 104), 0u) << "not known";
  EXPECT_EQ(item(0x69C + 108), 0u);
}

// ^P ^V ^F ^B ^C tell the same as the commands.
TEST_F(SuggestedWords, ControlCharactersTellOfMotion) {
  close_all();
  c_.line("#1J=2500 #2J-");
  follow(60);
  const auto control = [this](char c) {
    std::string text = c_.send(std::string(1, c));
    return text.substr(0, text.find('\r'));
  };
  const auto join = [this](const char* what) {
    std::string all;
    for (int motor = 1; motor <= 8; ++motor)
      all += (motor == 1 ? "" : " ") + c_.line("#" + std::to_string(motor) + what);
    return all;
  };
  EXPECT_EQ(control('\x10'), join("P"));
  EXPECT_EQ(control('\x16'), join("V"));
  EXPECT_EQ(control('\x06'), join("F"));
  EXPECT_EQ(control('\x02'), join("?"));
  EXPECT_NE(join("P").substr(0, 2), "0 ");
  std::string systems;
  for (int cs = 1; cs <= 8; ++cs) systems += (cs == 1 ? "" : " ") + c_.line("&" + std::to_string(cs) + "??");
  EXPECT_EQ(control('\x03').substr(0, systems.size()), systems);
}

}  // namespace
}  // namespace brick
