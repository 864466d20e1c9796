// Reports in the dual-ported RAM (host-bus:6.4, host-bus:6.5): values against what commands report, handshake, periods.
#include "testbench/host/dpram_reports.h"

#include <cmath>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/dpram_host.h"

extern "C" {
#include "firmware/host/dpram_motors.h"
#include "firmware/host/dpram_report.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/motor.h"
}

namespace {

using brick::MotorReport;
using platform::background;
using platform::host;
using platform::servo_ticks;

constexpr double kPositionScale = 32.0 * 96.0;  // 32 Ixx08, 32 Ixx09
constexpr int kSettling = 40;                   // passes or servo cycles that the longest set takes

class DpramReportsTest : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1"), "");
    reports.clear_handshakes();
  }
  bool ready() { return (ram.read(DPRAM_MOTOR_READY) & DPRAM_DATA_READY) != 0; }
  std::uint32_t servo_count() { return static_cast<std::uint32_t>(std::stoul(host("RX$0"))); }

  platform::NativeDpram ram;
  brick::DpramReports reports{ram};
};

// Registers of motor 3 written as its servo loop would if it were activated; P, V, F and ? report them.
void move_motor_3() {
  for (const char* line : {"M1->D:$188", "M2->D:$18B", "M3->D:$190", "M4->D:$1CC", "M5->X:$19D,0,24,S", "#3->100X"})
    ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("M1=-8000000000 M2=-9000001000 M3=3072 M4=-614400 M5=-12345 I300=0"), "");
}

void expect_as_reported(const MotorReport& m) {
  const auto number = [](const char* command) { return std::stod(host(command)); };
  EXPECT_NEAR(static_cast<double>(m.position - m.master + m.bias) / kPositionScale, number("#3P"), 1.0 / 64);
  EXPECT_NEAR(m.velocity / kPositionScale, number("#3V"), 1.0 / 64);
  EXPECT_NEAR(static_cast<double>(m.following_error) / kPositionScale, number("#3F"), 1.0 / 64);
  const std::string status = host("#3?");
  EXPECT_EQ(m.servo_status, std::stoul(status.substr(0, 6), nullptr, 16));
  EXPECT_EQ(m.status, std::stoul(status.substr(6), nullptr, 16));
  EXPECT_EQ(m.position, -9000001000);
  EXPECT_EQ(m.master, 3072);
  EXPECT_EQ(m.bias, -614400);
  EXPECT_EQ(m.following_error, 1000001000);
  EXPECT_EQ(m.output, 0);
}

TEST_F(DpramReportsTest, MotorsAreWrittenByTheServoTask) {
  ASSERT_NO_FATAL_FAILURE(move_motor_3());
  reports.choose_motors(1U << 2);
  ASSERT_EQ(host("I47=1 I48=1"), "");
  servo_ticks(1);
  const auto set = reports.read_motors(0);
  ASSERT_TRUE(set);
  expect_as_reported(set->motors[0]);
  EXPECT_EQ(set->timer, servo_count());
}

TEST_F(DpramReportsTest, MotorsAreWrittenByTheBackground) {
  ASSERT_NO_FATAL_FAILURE(move_motor_3());
  reports.choose_motors(1U << 2);
  ASSERT_EQ(host("I50=1 I57=1"), "");
  servo_ticks(3);
  EXPECT_FALSE(ready());
  background(1);
  const auto set = reports.read_motors(0);
  ASSERT_TRUE(set);
  expect_as_reported(set->motors[0]);
}

TEST_F(DpramReportsTest, OnlyMotorsOfTheMaskAreWritten) {
  for (std::uint32_t offset = DPRAM_MOTOR_BLOCKS; offset < DPRAM_BACKGROUND_COUNT; offset += 2)
    ram.write(offset, 0xABCD);
  reports.choose_motors(0x8000'0101);
  ASSERT_EQ(host("I47=1 I48=1"), "");
  servo_ticks(kSettling);
  for (unsigned motor = 0; motor < 32; ++motor) {
    const bool chosen = motor == 0 || motor == 8 || motor == 31;
    const std::uint32_t block = DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_STRIDE * motor;
    for (std::uint32_t at = 0; at < DPRAM_MOTOR_STRIDE; at += 2)
      EXPECT_EQ(ram.read(block + at) == 0xABCD, !chosen) << motor << " word " << at;
  }
}

TEST_F(DpramReportsTest, ThePeriodIsCountedInServoCycles) {
  reports.choose_motors(1);
  for (const int period : {1, 2, 7, 255}) {
    ASSERT_EQ(host("I48=0 I47=" + std::to_string(period)), "");
    servo_ticks(1);
    ASSERT_EQ(host("I48=1"), "");
    servo_ticks(1);
    const auto first = reports.read_motors(0);
    servo_ticks(static_cast<unsigned>(period) - 1);
    const auto same = reports.read_motors(0);
    servo_ticks(1);
    const auto second = reports.read_motors(0);
    ASSERT_TRUE(first && same && second) << period;
    EXPECT_EQ(same->timer, first->timer) << period;
    EXPECT_EQ(second->timer, first->timer + static_cast<std::uint32_t>(period));
  }
  ASSERT_EQ(host("I47=0"), "");
  ram.write(DPRAM_MOTOR_READY, 0);
  servo_ticks(300);
  EXPECT_FALSE(ready()) << "I47 = 0 is off";
}

// host-bus:6.4/1, host-bus:6.5/1: both reports of the background, also where no cycle goes by in a pass.
TEST_F(DpramReportsTest, TheBackgroundsPeriodIsCountedInServoCycles) {
  reports.choose_motors(1);
  reports.choose_systems(1);
  const auto timers = [this] {
    background(kSettling);
    return std::pair{ram.read(DPRAM_MOTOR_TIMER), ram.read(DPRAM_BACKGROUND_TIMER)};
  };
  for (const unsigned period : {1U, 2U, 7U, 255U}) {
    ASSERT_EQ(host("I49=0 I57=0 I50=" + std::to_string(period)), "");
    servo_ticks(1);
    background(2);
    ASSERT_EQ(host("I49=1 I57=1"), "");
    const auto first = timers();
    EXPECT_EQ(first, (std::pair<std::uint16_t, std::uint16_t>(servo_count(), servo_count())));
    servo_ticks(period - 1);
    EXPECT_EQ(timers(), first) << period;
    servo_ticks(1);
    EXPECT_EQ(timers(), (std::pair<std::uint16_t, std::uint16_t>(first.first + period, first.second + period)));
  }
  ASSERT_EQ(host("I50=0"), "");
  background(2);
  EXPECT_FALSE(ready() || (ram.read(DPRAM_BACKGROUND_READY) & DPRAM_DATA_READY) != 0) << "I50 = 0 is off";
}

TEST_F(DpramReportsTest, NothingIsWrittenWhileTheHostIsBusy) {
  ASSERT_EQ(host("I100=0 M2->D:$8B M2=5"), "");
  reports.choose_motors(1);
  ASSERT_EQ(host("I47=1 I48=1"), "");
  servo_ticks(1);
  ram.write(DPRAM_MOTOR_HOST_BUSY, DPRAM_HOST_BUSY);
  ASSERT_EQ(host("M2=6"), "");
  servo_ticks(5);
  EXPECT_TRUE(ready()) << "the set that stands there";
  EXPECT_EQ(reports.fixed_long(DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_POSITION), 5);
  ram.write(DPRAM_MOTOR_HOST_BUSY, 0);
  servo_ticks(1);
  EXPECT_EQ(reports.fixed_long(DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_POSITION), 6);
}

// 32 motors are written in parts; a host that becomes busy in between finds nothing ready until the set is whole.
TEST_F(DpramReportsTest, ASetThatHasBegunIsFinishedBeforeItIsReady) {
  reports.choose_motors(0xFFFF'FFFF);
  ASSERT_EQ(host("I47=100 I48=1"), "");
  servo_ticks(2);
  EXPECT_FALSE(ready());
  ram.write(DPRAM_MOTOR_HOST_BUSY, DPRAM_HOST_BUSY);
  servo_ticks(kSettling);
  EXPECT_TRUE(ready());
}

TEST_F(DpramReportsTest, TheForegroundWins) {
  reports.choose_motors(1);
  ASSERT_EQ(host("I47=3 I48=1 I50=1 I57=1"), "");
  servo_ticks(1);
  const std::uint32_t first = ram.read(DPRAM_MOTOR_TIMER);
  background(10);
  servo_ticks(2);
  background(10);
  EXPECT_EQ(ram.read(DPRAM_MOTOR_TIMER), first);
  servo_ticks(1);
  EXPECT_EQ(ram.read(DPRAM_MOTOR_TIMER), first + 3);
  ASSERT_EQ(host("I48=0"), "");
  servo_ticks(1);
  background(2);
  EXPECT_EQ(ram.read(DPRAM_MOTOR_TIMER), first + 4) << "by the background again";
}

// What the background has begun is whole before the servo task begins its own.
TEST_F(DpramReportsTest, TheForegroundComesBehindASetOfTheBackground) {
  reports.choose_motors(0xFF);  // four parts
  for (const int period : {1, 2, 255}) {
    ASSERT_EQ(host("I48=0 I57=0 I50=255 I47=" + std::to_string(period)), "");
    servo_ticks(1);
    background(1);
    ASSERT_EQ(host("I57=1"), "");
    background(1);
    ASSERT_EQ(host("I48=1"), "");
    servo_ticks(3);
    EXPECT_FALSE(ready()) << period;
    background(3);
    EXPECT_TRUE(ready()) << period;
    const std::uint32_t now = servo_count() & 0xFFFF;
    servo_ticks(4);
    EXPECT_TRUE(ready()) << period;
    EXPECT_EQ(ram.read(DPRAM_MOTOR_TIMER), now + 1) << period;
  }
}

TEST_F(DpramReportsTest, SystemsShowWhatCommandsReport) {
  for (const char* line : {"&2DEF ROT 100", "&1DEF ROT 100", "&2B0", "&1B0", "OPEN ROT", "&2F250 X10Y-2.5", "X20",
                           "X30", "&1TM20 INC A3", "CLOSE", "&2%50", "&2R"})
    ASSERT_EQ(host(line), "") << line;
  servo_ticks(200);
  reports.choose_systems(3);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  background(kSettling);
  const auto set = reports.read_systems(5);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->timer, servo_count());
  const std::string global = host("???");
  EXPECT_EQ(set->global[0], std::stoul(global.substr(0, 6), nullptr, 16));
  EXPECT_EQ(set->global[1], std::stoul(global.substr(6), nullptr, 16));
  for (unsigned cs = 1; cs <= 3; ++cs) {
    const brick::SystemReport& s = set->systems[cs - 1];
    const std::string address = "&" + std::to_string(cs), status = host(address + "??");
    for (unsigned word = 0; word < 3; ++word)
      EXPECT_EQ(s.status[word], std::stoul(status.substr(6 * word, 6), nullptr, 16)) << cs << " word " << word;
    EXPECT_NEAR(s.time_base / 3713991.0 * 100, std::stod(host(address + "%")), 0.001) << cs;
    if (cs != 3) { EXPECT_EQ(s.lines, std::stoul(host(address + "PR"))) << cs; }
    const unsigned base = 0x2000 + 0x100 * (cs - 1);
    for (unsigned axis = 0; axis < 9; ++axis) {
      char read[16];
      std::snprintf(read, sizeof read, "RL$%X", base + 0x41 + axis);
      EXPECT_EQ(s.targets[axis], std::stod(host(read))) << cs << " axis " << axis;
    }
  }
  EXPECT_EQ(set->systems[0].feed_rate, 1000.0) << "Isx89: TM20 has not been calculated";
  EXPECT_EQ(set->systems[1].feed_rate, 250.0);
  EXPECT_EQ(set->systems[1].targets[6], 10.0);
  EXPECT_EQ(set->systems[1].targets[7], -2.5);
  EXPECT_EQ(set->systems[1].time_base_source, 0x2100U) << "I5293";
  // X10 Y-2.5 at F250 by the second, TS = 50 ms: Tm = |(10, 2.5)| / 250 s, from rest to rest and 100 ms.
  const double whole = std::hypot(10, 2.5) / 250 * 1000 + 100;
  EXPECT_LT(set->systems[1].move_ms_left, whole);
}

// Moves of 1 s with Ta = 100 ms, at 100 %, looked at a known number of servo cycles after their beginning.
TEST_F(DpramReportsTest, TimesLeftOfTheExecutingMove) {
  for (const char* line : {"&1DEF ROT 100", "&1B0", "OPEN ROT", "TA0 TS50 TM1000 X10", "CLOSE", "R"})
    ASSERT_EQ(host(line), "") << line;
  reports.choose_systems(1);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  const auto left = [this] {
    background(4);
    return reports.read_systems(5)->systems[0];
  };
  while (left().move_ms_left == 0) servo_ticks(1);
  const double cycle = 3713991.0 / 8388608.0;  // ms
  const brick::SystemReport began = left();
  EXPECT_NEAR(began.move_ms_left, 1100, 1);
  EXPECT_NEAR(began.acceleration_ms_left, 100, 1);
  servo_ticks(100);
  EXPECT_NEAR(left().move_ms_left, 1100 - 100 * cycle, 2);
  EXPECT_NEAR(left().acceleration_ms_left, 100 - 100 * cycle, 2);
  servo_ticks(200);
  EXPECT_EQ(left().acceleration_ms_left, 0U);
}

// The slope about the corner is TA200; a late end stops in what is left of it in front of the corner, twice.
TEST_F(DpramReportsTest, TimeLeftOfAMoveThatEndsLateIsThatOfItsShorterStop) {
  for (const char* line : {"&1DEF ROT 100", "&1B0", "OPEN ROT", "TA200 TS0 TM1000 X100", "TA20 X200", "CLOSE", "R"})
    ASSERT_EQ(host(line), "") << line;
  reports.choose_systems(1);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  const auto left = [this] {
    background(4);
    return reports.read_systems(5)->systems[0].move_ms_left;
  };
  while (left() == 0) servo_ticks(1);
  while (left() > 150) servo_ticks(1);  // 50 ms in front of the corner, half of TA behind it
  ASSERT_EQ(host("/"), "");
  servo_ticks(2);
  EXPECT_NEAR(left(), 100, 4);
}

// host-bus:6.2/3: bits 15..0 and 23..16 of the servo counter, and bit 15 of the second word.
TEST_F(DpramReportsTest, TheTimerIsTheLowestBitsOfTheServoCounterInTwoWords) {
  for (const std::uint32_t began :
       {0u, 1u, 0x8000u, 0xFFFFu, 0x10000u, 0x20001u, 0x810000u, 0xA5C396u, 0x5A3C69u, 0xFFFFFFu, 0x12345678u}) {
    dpram_report report{DPRAM_BACKGROUND_HOST_BUSY, DPRAM_BACKGROUND_TIMER, 0, began, true, true};
    ram.write(DPRAM_BACKGROUND_TIMER, 0x5555);
    ram.write(DPRAM_BACKGROUND_READY, 0x5555);
    dpram_report_end(&report);
    EXPECT_EQ(ram.read(DPRAM_BACKGROUND_TIMER), began % 0x10000) << began;
    EXPECT_EQ(ram.read(DPRAM_BACKGROUND_READY), 0x8000 + began / 0x10000 % 0x100) << began;
  }
}

// The items of a block by their numbers in host-bus:6.4, each from a word of its own value: low half first,
// sign-extended.
TEST_F(DpramReportsTest, EachItemOfAMotorsBlockIsItsSource) {
  ASSERT_EQ(host("&3#5->1000X I500=0"), "");
  ASSERT_EQ(host("WX$288,$123456 WY$288,$789ABC WX$28B,$0F0E0D WY$28B,$8C0B0A WX$290,$111111 WY$290,$922222"), "");
  ASSERT_EQ(host("WX$2CC,$800001 WY$2CC,$700002 I60=0 I61=0"), "");
  motors_active |= 1u << 4;  // for its velocity alone: one sample
  motors[4].actual -= 0x12346;
  average_velocity_servo();
  const std::uint32_t block = DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_STRIDE * 4;
  for (unsigned n = 0; n < DPRAM_MOTOR_STRIDE; n += 2) ram.write(block + n, 0x5555);
  reports.choose_motors(1U << 4);
  ASSERT_EQ(host("I47=1 I48=1"), "");
  ASSERT_TRUE(dpram_motors_servo());
  // $123456789ABC - $0F0E0D8C0B0A = $032648EC8FB2
  const std::vector<std::uint32_t> items = {0xFFEC8FB2, 0x00032648, 0,          0x00050000, 0x00278000, 0x00700002,
                                            0xFF800001, 0xFFFEDCBA, 0xFF922222, 0x00111111, 0xFF8C0B0A, 0x000F0E0D};
  for (unsigned n = 0; n < items.size(); ++n) EXPECT_EQ(reports.item(block + 4 * n), items[n]) << "item " << n;
  EXPECT_EQ(host("#5?"), "050000278000") << "items 3 and 4";
}

// host-bus:6.5 likewise: every place of the global part, and the items of a system that moves.
TEST_F(DpramReportsTest, EachItemOfTheBackgroundDataIsItsSource) {
  platform::fit_panel();
  *hal_y(JPAN_Y_INPUTS) = 0xA5C3;
  for (const char* line : {"&2DEF ROT 100 B0 I5294=8388607", "OPEN ROT", "TA100 TS0 F250", "TM1000 A1B2C3U4V5W6X7Y8Z9",
                           "TM1000 INC X1", "X2", "X3", "X4", "CLOSE", "%60 R"})
    ASSERT_EQ(host(line), "") << line;
  platform::panel(0xA5C3 ^ JPAN_INPUTS_RESET);
  for (std::uint32_t at = DPRAM_PANEL_PORT; at < DPRAM_CS_BLOCKS + 2 * DPRAM_CS_STRIDE; at += 2) ram.write(at, 0x5555);
  servo_ticks(20);
  reports.choose_systems(2);
  coordinate_systems[1].slots_short = true;          // bit 19 of word 3
  ASSERT_EQ(host("I50=1 I49=1 I5293=$812345"), "");  // from the next servo interrupt on there is no time base
  background(kSettling);
  ASSERT_TRUE(reports.read_systems(5));
  EXPECT_EQ(reports.item(0x67C), 0xA5C3U) << "inputs of JPAN";
  EXPECT_EQ(reports.item(0x680), 0U) << "machine port";
  EXPECT_EQ(reports.item(0x684), 0U) << "thumbwheel port";
  const auto word = [](const std::string& text, unsigned n) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::stoul(text.substr(6 * n, 6), nullptr, 16) << 8) >>
                                      8);
  };
  const std::string global = host("???"), status = host("&2??");
  EXPECT_EQ(reports.item(0x688), word(global, 0));
  EXPECT_EQ(reports.item(0x68C), word(global, 1));
  for (std::uint32_t at = 0x690; at < 0x69C; at += 2) EXPECT_EQ(ram.read(at), 0x5555) << "spare " << at;
  const std::uint32_t block = 0x69C + 128;
  EXPECT_EQ(reports.float_long(block), 1000.0) << "items 0, 1: TM";
  EXPECT_EQ(reports.item(block + 4 * 2), 2228395U) << "60 % of 3713991 is 2228394.6";
  EXPECT_EQ(reports.item(block + 4 * 3), 0xFF812345U) << "I5293";
  EXPECT_EQ(reports.item(block + 4 * 4), word(status, 2));
  EXPECT_EQ(reports.item(block + 4 * 5), word(status, 0));
  for (unsigned axis = 0; axis < 9; ++axis) EXPECT_EQ(reports.float_long(block + 4 * (6 + 2 * axis)), axis + 1.0);
  EXPECT_EQ(reports.item(block + 4 * 24), word(status, 1));
  EXPECT_NE(word(status, 0), word(status, 1));
  EXPECT_NE(word(status, 2), word(status, 1));
  EXPECT_EQ(host("&2PR"), std::to_string(reports.item(block + 4 * 25)));
  EXPECT_GT(reports.item(block + 4 * 25), 0U);
  // 1000 ms and 100 ms to stop, less at most 20 servo cycles of 0.6 x 0.443 ms.
  EXPECT_LE(reports.item(block + 4 * 26), 1100U);
  EXPECT_GE(reports.item(block + 4 * 26), 1100U - 6);
  EXPECT_LE(reports.item(block + 4 * 27), 100U);
  EXPECT_GE(reports.item(block + 4 * 27), 100U - 6);
  EXPECT_EQ(host("&2PE"), "P0:" + std::to_string(reports.item(block + 4 * 28)));
  EXPECT_GT(reports.item(block + 4 * 28), 0U);
  for (std::uint32_t at = block + 4 * 29; at < block + 128; at += 2) EXPECT_EQ(ram.read(at), 0x5555) << "spare " << at;
}

// host-bus:6.5/3, item 28: words of PROG 7, not of PROG 1 that has called it.
TEST_F(DpramReportsTest, ThePlaceIsThatOfTheInnermostCall) {
  for (const char* line : {"OPEN PROG 1 CLEAR", "CALL7", "CLOSE OPEN PROG 7 CLEAR", "TA0 TS0 TM1000", "X10", "CLOSE"})
    ASSERT_EQ(host(line), "") << line;
  ASSERT_EQ(host("&1B1R"), "");
  servo_ticks(20);
  reports.choose_systems(1);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  background(kSettling);
  const auto set = reports.read_systems(5);
  ASSERT_TRUE(set);
  EXPECT_EQ(host("PE"), "P1:0>P7.3");
  EXPECT_EQ(set->systems[0].executing, 3U);
}

TEST_F(DpramReportsTest, ABoardWithoutAPanelShowsNoInputs) {
  *hal_y(JPAN_Y_INPUTS) = 0xA5C3;
  ram.write(DPRAM_PANEL_PORT, 0x5555);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  background(kSettling);
  EXPECT_EQ(reports.item(DPRAM_PANEL_PORT), 0U);
}

// host-bus:6.4/4: a report that is off has nothing ready, and takes no more away.
TEST_F(DpramReportsTest, NothingIsReadyOfAReportThatIsOff) {
  reports.choose_motors(1);
  reports.choose_systems(1);
  const auto turn = [](const char* line) {
    ASSERT_EQ(host(line), "");
    servo_ticks(3);
    background(kSettling);
  };
  const auto systems_ready = [this] { return (ram.read(DPRAM_BACKGROUND_READY) & DPRAM_DATA_READY) != 0; };
  turn("I47=1 I50=1 I48=1");
  EXPECT_TRUE(ready());
  for (const char* off : {"I48=0", "I47=0"}) {
    turn(off);
    EXPECT_FALSE(ready()) << off;
    turn("I47=1 I48=1");
    EXPECT_TRUE(ready());
  }
  turn("I48=0 I57=1 I49=1");
  EXPECT_TRUE(ready()) << "that of the background";
  EXPECT_TRUE(systems_ready());
  turn("I57=0");
  EXPECT_FALSE(ready());
  EXPECT_TRUE(systems_ready());
  turn("I48=1 I49=0");
  EXPECT_TRUE(ready());
  EXPECT_FALSE(systems_ready());
  turn("I48=0");
  ram.write(DPRAM_MOTOR_READY, DPRAM_DATA_READY);
  ram.write(DPRAM_BACKGROUND_READY, DPRAM_DATA_READY);
  turn("P1=1");
  EXPECT_TRUE(ready() && systems_ready()) << "what is off writes nothing";
}

// The background's report is turned off while the servo task writes: nothing is left of it to take the ready word back.
TEST_F(DpramReportsTest, TheBackgroundIsOffBehindTheForegroundToo) {
  reports.choose_motors(1);
  ASSERT_EQ(host("I47=1 I50=1 I57=1"), "");
  servo_ticks(2);
  background(kSettling);
  ASSERT_TRUE(ready());
  ASSERT_EQ(host("I48=1"), "");
  servo_ticks(2);
  ASSERT_TRUE(ready());
  ASSERT_EQ(host("I57=0"), "");
  background(2);
  EXPECT_TRUE(ready()) << "that of the servo task";
  ASSERT_EQ(host("I48=0"), "");
  background(2);
  servo_ticks(2);
  EXPECT_FALSE(ready());
  ram.write(DPRAM_MOTOR_READY, 0x5555 | DPRAM_DATA_READY);
  ASSERT_EQ(host("I49=1"), "");
  background(kSettling);
  EXPECT_EQ(ram.read(DPRAM_MOTOR_READY), 0x5555 | DPRAM_DATA_READY);
}

// What the RAM holds at a start is left, whatever was on before it.
TEST_F(DpramReportsTest, AStartLeavesTheRamAsItIs) {
  for (const char* on : {"I47=1 I48=1", "I47=1 I50=1 I57=1"}) {
    reports.choose_motors(1);
    ASSERT_EQ(host(on), "");
    servo_ticks(3);
    background(kSettling);
    ASSERT_TRUE(ready()) << on;
    platform::reset("$$$");
    ram.write(DPRAM_MOTOR_READY, 0x5555 | DPRAM_DATA_READY);
    servo_ticks(3);
    background(kSettling);
    EXPECT_EQ(ram.read(DPRAM_MOTOR_READY), 0x5555 | DPRAM_DATA_READY) << on;
  }
}

TEST_F(DpramReportsTest, MoreSystemsThanThereAreAreSixteen) {
  ram.write(DPRAM_COMMAND_CONTROL, 0x5A5A);
  reports.choose_systems(255);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  background(kSettling);
  EXPECT_NE(ram.read(DPRAM_CS_BLOCKS + 15 * DPRAM_CS_STRIDE + DPRAM_CS_TIME_BASE), 0);
  EXPECT_EQ(ram.read(DPRAM_COMMAND_CONTROL), 0x5A5A) << "what is behind the sixteenth";
}

// host-bus:6.5/2
TEST_F(DpramReportsTest, TheCountIsTheLowByteOfItsWord) {
  const auto time_base = [](unsigned cs) { return DPRAM_CS_BLOCKS + (cs - 1) * DPRAM_CS_STRIDE + DPRAM_CS_TIME_BASE; };
  for (unsigned cs = 1; cs <= 16; ++cs) ram.write(time_base(cs), 0x5555);
  ram.write(DPRAM_BACKGROUND_COUNT, 0xFF02);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  background(kSettling);
  for (unsigned cs = 1; cs <= 16; ++cs) EXPECT_EQ(ram.read(time_base(cs)) == 0x5555, cs > 2) << cs;
}

TEST_F(DpramReportsTest, OffWithoutRamOrBase) {
  reports.choose_motors(1);
  reports.choose_systems(1);
  ASSERT_EQ(host("I24=$6C000 I47=1 I48=1 I49=1 I50=1 I57=1"), "");
  servo_ticks(5);
  background(kSettling);
  EXPECT_FALSE(ready());
  EXPECT_EQ(ram.read(DPRAM_BACKGROUND_READY), 0);
}

// The host's part of the handshake is taken back where no set comes.
TEST_F(DpramReportsTest, AHostWaitsForASetNoLongerThanItSays) {
  reports.choose_motors(1);
  reports.choose_systems(1);
  const brick::Tick begin = ram.now();
  EXPECT_FALSE(reports.read_motors(7));
  EXPECT_EQ(ram.now() - begin, 7);
  EXPECT_EQ(ram.read(DPRAM_MOTOR_HOST_BUSY), 0u);
  EXPECT_FALSE(reports.read_systems(9));
  EXPECT_EQ(ram.now() - begin, 7 + 9);
  EXPECT_EQ(ram.read(DPRAM_BACKGROUND_HOST_BUSY), 0u);
}

}  // namespace
