// Interrupts anywhere in the firmware (testbench/unit/firmware_platform/fake_interrupts.h): what they find, and that
// lines which the host streams into a program that runs are executed once each, in order.
#include "testbench/unit/firmware_platform/fake_interrupts.h"

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/binary_buffer.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motion_status.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/phasing.h"
#include "firmware/variables/words.h"
#include "testbench/unit/firmware_program/published.h"
}

namespace {

using platform::breq;
using platform::host;

class Interrupts : public FirmwareTest {
 protected:
  void TearDown() override {
    fake_interrupts_on_take(nullptr);
    fake_interrupts_end();
    fake_tasks_ignore_masks(false);
  }
};

// The planted races. -------------------------------------------------------------------------------------------------

unsigned looks, halves_seen;

bool is_torn(std::uint64_t wide) { return static_cast<std::uint32_t>(wide) != wide >> 32; }

void look(fake_task task) {
  if (task != FAKE_SERVO) return;
  ++looks;
  if (published.first != published.second || is_torn(published.wide)) ++halves_seen;
}

void write(fake_task task) {
  if (task != FAKE_SERVO) return;
  ++looks;
  published.wide += (std::uint64_t{1} << 32) + 1;
}

struct Seen {
  unsigned looks, halves;
};

template <typename Step>
Seen run_with(void (*action)(fake_task), Step step) {
  published = {};
  looks = halves_seen = 0;
  fake_interrupts_begin(1, 10);
  fake_interrupts_on_take(action);
  for (std::uint32_t i = 1; i <= 4000; ++i) step(i);
  fake_interrupts_end();
  return {looks, halves_seen};
}

constexpr unsigned kLooks = 50;

TEST_F(Interrupts, TwoWordsPublishedWithoutAMaskAreSeenHalf) {
  for (const bool masked : {false, true}) {
    const Seen seen = run_with(look, [&](std::uint32_t i) { publish_words(i, masked); });
    EXPECT_GT(seen.looks, kLooks);
    EXPECT_EQ(seen.halves > 0, !masked) << seen.halves << " of " << seen.looks;
  }
}

TEST_F(Interrupts, WideValuePublishedWithoutAMaskIsSeenHalf) {
  for (const bool masked : {false, true}) {
    const Seen seen = run_with(look, [&](std::uint32_t i) { publish_wide(i, masked); });
    EXPECT_GT(seen.looks, kLooks);
    EXPECT_EQ(seen.halves > 0, !masked) << seen.halves << " of " << seen.looks;
  }
}

TEST_F(Interrupts, WideValueReadWithoutAMaskIsReadHalf) {
  for (const bool masked : {false, true}) {
    unsigned torn = 0;
    const Seen seen = run_with(write, [&](std::uint32_t) { torn += is_torn(read_published(masked)) ? 1 : 0; });
    EXPECT_GT(seen.looks, kLooks);
    EXPECT_EQ(torn > 0, !masked) << torn << " of " << seen.looks;
    EXPECT_FALSE(is_torn(published.wide)) << "what an interrupt wrote is whole again";
  }
}

// The firmware. ------------------------------------------------------------------------------------------------------

constexpr std::uint32_t kX = 1u << AXIS_X, kY = 1u << AXIS_Y;
constexpr unsigned kLines = 400, kBinaryLines = 100, kTries = 3000;

// Line n of coordinate system s: P(1000 s + P(s)) = n, P(s) = P(s) + 1. Empty when each was executed once and in order.
// An interrupt every `gap` accesses.
std::string stream(std::uint32_t seed, std::uint32_t gap) {
  for (unsigned cs = 2; cs >= 1; --cs)
    if (!host("&" + std::to_string(cs) + "DEF ROT 60 B0").empty()) return "no buffer";
  if (!host("OPEN ROT &2R &1R").empty()) return "does not run";
  fake_interrupts_begin(seed, gap);
  for (unsigned n = 0; n < kLines; ++n) {
    const std::string cs = std::to_string(1 + n % 2), next = "P" + cs;
    const std::string line = "P(" + cs + "000+" + next + ")=" + std::to_string(n) + " " + next + "=" + next + "+1";
    if (!host("&" + cs).empty()) return "& is refused";
    std::string reply;
    unsigned tries = 0;
    do { reply = host(line); } while (reply == "ERR006" && ++tries < kTries);  // until there is room
    if (!reply.empty()) return line + " is answered by " + reply;
  }
  for (const char* cs : {"&1", "&2"}) {
    unsigned tries = 0;
    while (host(std::string(cs) + "PR") != "0" && ++tries < kTries) {}
    if (tries == kTries) return std::string(cs) + ": not all are calculated";
  }
  fake_interrupts_end();
  platform::servo_ticks(30);
  for (unsigned cs = 1; cs <= 2; ++cs) {
    if (p_variable_read(cs) != kLines / 2.0) return "executed: " + std::to_string(p_variable_read(cs));
    for (unsigned i = 0; i < kLines / 2; ++i)
      if (p_variable_read(1000 * cs + i) != 2 * i + cs - 1) return "place " + std::to_string(i) + " is another line";
  }
  return host("&1 A &2 A CLOSE DEL ALL TEMPS");
}

TEST_F(Interrupts, StreamedLinesAreExecutedOnceAndInOrder) {
  BRICK_COVERS("BREQ-1");
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    platform::power_up();
    EXPECT_EQ(stream(seed, 20 + seed % 7 * 40), "") << "seed " << seed;
    const fake_interrupt_counts counts = fake_interrupts_counts();
    EXPECT_GT(counts.taken[FAKE_REAL_TIME], 100u);
    EXPECT_GT(counts.held_off, 20u) << "nothing came while it was masked";
  }
}

// The same lines as binary ones, with constants only: a program writes them down. Who stores is set by I45, which
// changes meanwhile when `changes`.
std::string binary_stream(std::uint32_t seed, std::uint32_t gap, bool foreground, bool changes) {
  if (!host("OPEN PROG 7 CLEAR P(Q2+P(Q3))=Q1 P(Q3)=P(Q3)+1 CLOSE").empty()) return "no program";
  platform::BinaryBuffer buffers[2];
  for (unsigned cs = 2; cs >= 1; --cs) {
    buffers[cs - 1].cs = cs;
    buffers[cs - 1].start = 1000 * cs;
    if (!host("&" + std::to_string(cs) + "DEF ROT 20 B0").empty()) return "no buffer";
    buffers[cs - 1].set_up();
  }
  if (!host(foreground ? "I45=1" : "I45=0").empty() || !host("OPEN BIN ROT &2R &1R").empty()) return "does not run";
  for (platform::BinaryBuffer& b : buffers) b.put("Q2=" + std::to_string(1000 * b.cs) + "Q3=" + std::to_string(b.cs));
  fake_interrupts_begin(seed, gap);
  const auto done = [&](const platform::BinaryBuffer& b) { return b.pmac_index() == b.index; };
  for (unsigned n = 0; n < kBinaryLines; ++n) {
    platform::BinaryBuffer& b = buffers[n % 2];
    const bool change = changes && n % 16 == 0;
    const auto line =
        brick::binary_line((change ? "I45=" + std::to_string(n / 16 % 2) : "") + "Q1=" + std::to_string(n) + "CALL7");
    for (unsigned tries = 0; !b.has_room(line.commands) && tries < kTries; ++tries) platform::background(1);
    if (!b.has_room(line.commands)) return "held for ever";
    b.put(line.commands);
    if (n % 5 == 0) platform::background(1);
  }
  for (unsigned tries = 0; !(done(buffers[0]) && done(buffers[1])) && tries < 10 * kTries; ++tries)
    platform::background(1);
  for (const char* cs : {"&1", "&2"}) {
    unsigned tries = 0;
    while (host(std::string(cs) + "PR") != "0" && ++tries < kTries) {}
    if (tries == kTries) return std::string(cs) + ": not all are calculated";
  }
  fake_interrupts_end();
  platform::servo_ticks(30);
  for (unsigned cs = 1; cs <= 2; ++cs) {
    if (p_variable_read(cs) != kBinaryLines / 2.0) return "executed: " + std::to_string(p_variable_read(cs));
    for (unsigned i = 0; i < kBinaryLines / 2; ++i)
      if (p_variable_read(1000 * cs + i) != 2 * i + cs - 1) return "place " + std::to_string(i) + " is another line";
  }
  return host("&1 A &2 A CLOSE DEL ALL TEMPS");
}

TEST_F(Interrupts, BinaryLinesAreExecutedOnceAndInOrder) {
  BRICK_COVERS("BIN-3 BIN-5");
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    platform::power_up();
    EXPECT_EQ(binary_stream(seed, 20 + seed % 3 * 40, seed % 2 != 0, seed > 3), "") << "seed " << seed;
  }
}

void take_motor_1_away(fake_task task) {
  if (task == FAKE_REAL_TIME) i_variable_write(100, 0);
}

// PLC 0 may take a motor away while it is being enabled: nothing controls it then.
TEST_F(Interrupts, AMotorThatIsTakenAwayMeanwhileIsNotEnabled) {
  constexpr std::uint32_t kControl = 0x78005, kEnable = 1u << 14;
  ASSERT_EQ(host("I124=$120001"), "");
  unsigned refused = 0;
  for (const bool closes : {true, false}) {
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
      ASSERT_EQ(host("I100=1 #1K"), "");
      fake_interrupts_begin(seed, 100000);
      fake_interrupts_on_take(take_motor_1_away);
      fake_interrupts_soon();
      const bool enabled = closes ? motor_close(0) : motor_open(0, 100);
      fake_interrupts_on_take(nullptr);
      fake_interrupts_end();
      if ((motors_active & 1u) != 0) continue;  // it came no more
      if (!enabled) refused++;
      ASSERT_EQ(motors[0].loop, LOOP_KILLED) << seed;
      ASSERT_EQ(motors_enabled & 1u, 0u) << seed;
      ASSERT_EQ(*hal_x(kControl) & kEnable, 0u) << seed;
    }
  }
  EXPECT_GT(refused, 20u);
}

void kill_motor_1(fake_task task) {
  if (task != FAKE_SERVO) return;
  motor_kill(0);
  fake_interrupts_on_take(nullptr);
}

// So a search for a phase reference does not begin with a motor that is killed meanwhile.
TEST_F(Interrupts, AKillComesBeforeASearchOrEndsIt) {
  ASSERT_EQ(host("I100=1 I101=1 I171=1000 I173=1000 I174=5"), "");
  unsigned before = 0, behind = 0;
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    fake_interrupts_begin(seed, 80);
    fake_interrupts_on_take(kill_motor_1);
    const bool begins = phasing_begin(0);
    fake_interrupts_on_take(nullptr);
    fake_interrupts_end();
    (begins ? behind : before)++;
    if (motors[0].loop == LOOP_KILLED) {
      ASSERT_FALSE(phase_motors[0].searched) << seed;
      phasing_pass();
      ASSERT_EQ(motors[0].loop, LOOP_KILLED) << seed;
    }
    motor_kill(0);
    phasing_pass();
    ASSERT_FALSE(phasing_is_searched(0));
  }
  EXPECT_GT(before, 2u);
  EXPECT_GT(behind, 20u);
}

// A motor that trips while R looks at it: no program runs with it.
TEST_F(Interrupts, AMotorThatTripsDuringAStartHasNoProgram) {
  constexpr std::uint32_t kStatus = 0x78000, kFault = 1u << 15;
  ASSERT_EQ(host("I100=1 I124=$820001 I111=0 I112=0"), "");
  ASSERT_EQ(host("OPEN PROG 1 CLEAR INC TM1000 X1 X1 X1 CLOSE"), "");
  unsigned refused = 0, aborted = 0;
  for (std::uint32_t seed = 1; seed <= 800; ++seed) {
    ASSERT_EQ(host(seed % 2 != 0 ? "&1#1->1000X" : "&1#1->I"), "") << "no axis: Isx50 = 0";
    *hal_x(kStatus) &= ~kFault;
    ASSERT_EQ(host("&1E B1"), "");
    platform::servo_ticks(3);
    ASSERT_EQ(motors[0].loop, LOOP_CLOSED);
    *hal_x(kStatus) |= kFault;
    fake_interrupts_begin(seed, 60);
    const error_t error = run_start(0, false);
    fake_interrupts_end();
    platform::servo_ticks(12);
    (error == ERR_NONE ? aborted : refused)++;
    ASSERT_EQ(motors[0].loop, LOOP_KILLED);
    ASSERT_FALSE(run_is_running(0)) << seed;
  }
  EXPECT_GT(aborted, 20u);
  EXPECT_GT(refused, 2u);
}

// What a program homes stops with it, whenever the real-time task begins that.
TEST_F(Interrupts, AnAbortStopsWhatTheProgramBeginsToHome) {
  ASSERT_EQ(host("I100=1 I200=1 I111=0 I112=0 I211=0 I212=0 I215=10 I219=1 I220=0 I221=10 I223=20 I292=2 &1#1->X"), "");
  ASSERT_EQ(host("OPEN PROG 1 CLEAR HOME2 CLOSE #1J/#2J/"), "");
  unsigned begun = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    for (int i = 0; i < 2000 && (jog_is_moving(0) || jog_is_moving(1)); ++i) platform::servo_ticks(1);
    platform::servo_ticks(3);
    ASSERT_EQ(host("&1B1R"), "") << seed;
    fake_interrupts_begin(seed, 20);
    run_abort(0);
    fake_interrupts_end();
    begun += jog_is_moving(1) ? 1 : 0;
    ASSERT_TRUE(!jog_is_moving(1) || jog_is_to_ramp(1) || motors[1].status.aborting) << seed;
  }
  EXPECT_GT(begun, 3u);
}

// The host makes X incremental, a program Y, at the same time. Both are afterwards.
bool both_are_incremental(std::uint32_t seed) {
  EXPECT_EQ(host("ABS B2R"), "");
  fake_interrupts_begin(seed, 3);
  for (unsigned i = 0; i < 30; ++i) cs_set_axis_mode(&coordinate_systems[0], i % 2 == 0 ? OP_ABS : OP_INC, kX);
  fake_interrupts_end();
  platform::servo_ticks(6);
  return coordinate_systems[0].incremental == (kX | kY);
}

TEST_F(Interrupts, AxisModesOfHostAndProgramAreBothKept) {
  ASSERT_EQ(host("OPEN PROG 2 CLEAR INC(Y) CLOSE"), "");
  for (std::uint32_t seed = 1; seed <= 200; ++seed) ASSERT_TRUE(both_are_incremental(seed)) << "seed " << seed;
}

TEST_F(Interrupts, AxisModesWithoutMasksAreLost) {
  ASSERT_EQ(host("OPEN PROG 2 CLEAR INC(Y) CLOSE"), "");
  fake_tasks_ignore_masks(true);
  for (std::uint32_t seed = 1; seed <= 200; ++seed)
    if (!both_are_incremental(seed)) return;
  FAIL() << "nothing was found";
}

// The host sets the low byte of a word that is made when it is read, a program of the real-time task the high one. What
// either writes last stays: interrupts are not looked at between the two of a write in parts.
struct SharedWord {
  bool x;
  std::uint32_t address;
};
// Time base and timer of system 1; Ixx31, Ixx69 and the master position of motor 1; I8150 of the conversion table.
constexpr SharedWord kSharedWords[] = {{true, 0x2000}, {true, 0x2015}, {true, 0x92},
                                       {false, 0xAE},  {true, 0x8D},   {false, 0x3501 + 150}};

SharedWord shared_word;
unsigned parts_written, writes_left;  // a try's: what a variable changes is made anew until nobody has written it again

void write_high_byte(fake_task task) {
  if (task != FAKE_REAL_TIME || writes_left == 0) return;
  --writes_left;
  parts_written = parts_written % 0x70 + 1;
  word_write_part(shared_word.x, shared_word.address, 0xFF0000, parts_written << 16);
}

// Tries after which the high byte was not the one written last.
unsigned high_bytes_lost(const SharedWord& word, std::uint32_t seed, unsigned& written) {
  unsigned lost = 0;
  shared_word = word;
  parts_written = 0;
  word_write(word.x, word.address, 0x80);
  fake_interrupts_begin(seed, 15);
  fake_interrupts_on_take(write_high_byte);
  for (unsigned i = 0; i < 40; ++i) {
    writes_left = 2;
    word_write_part(word.x, word.address, 0xFF, 0x80);  // a timer counts down, but not as far as to borrow
    const std::uint32_t state = hal_mask_real_time();
    lost += word_read(word.x, word.address) >> 16 != parts_written ? 1u : 0u;
    hal_unmask(state);
  }
  written = fake_interrupts_counts().taken[FAKE_REAL_TIME];
  fake_interrupts_on_take(nullptr);
  fake_interrupts_end();
  return lost;
}

TEST_F(Interrupts, PartsOfALiveWordAreBothKept) {
  for (const SharedWord& word : kSharedWords)
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      unsigned written = 0;
      EXPECT_EQ(high_bytes_lost(word, seed, written), 0u) << std::hex << word.address << ", seed " << seed;
      EXPECT_GT(written, 20u);
    }
}

TEST_F(Interrupts, PartsOfALiveWordWithoutMasksAreLost) {
  fake_tasks_ignore_masks(true);
  for (const SharedWord& word : kSharedWords) {
    unsigned lost = 0, written = 0;
    for (std::uint32_t seed = 1; seed <= 1000 && lost == 0; ++seed) lost = high_bytes_lost(word, seed, written);
    EXPECT_GT(lost, 0u) << std::hex << word.address;
  }
}

// The host writes a position of two words while it moves: one word after the other it would be off by all of the low
// one.
constexpr std::uint32_t kBiasOfMotor1 = 0xCC;

void move_bias(fake_task task) {
  if (task == FAKE_SERVO) motors[0].bias += 3;
}

unsigned positions_torn(std::uint32_t seed, unsigned& moves) {
  unsigned torn = 0;
  fake_interrupts_begin(seed, 15);
  fake_interrupts_on_take(move_bias);
  for (unsigned i = 0; i < 100; ++i) {
    word_write_long(kBiasOfMotor1, 0, 0xFFFFFE);
    word_write_long(kBiasOfMotor1, 0, 0);
    torn += motors[0].bias >= 1 << 20 ? 1 : 0;
    word_write_long(kBiasOfMotor1, 0xFF, 0xFFFFFE);  // the carry into the upper half of 64 bits
    torn += motors[0].bias < 0xFFFFFFFE ? 1 : 0;
  }
  moves = fake_interrupts_counts().taken[FAKE_SERVO];
  fake_interrupts_on_take(nullptr);
  fake_interrupts_end();
  return torn;
}

TEST_F(Interrupts, APositionOfTwoWordsIsWrittenInOnePiece) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    unsigned moves = 0;
    EXPECT_EQ(positions_torn(seed, moves), 0u) << "seed " << seed;
    EXPECT_GT(moves, 50u);
  }
}

TEST_F(Interrupts, APositionOfTwoWordsWithoutMasksIsTorn) {
  fake_tasks_ignore_masks(true);
  unsigned torn = 0, moves = 0;
  for (std::uint32_t seed = 1; seed <= 10 && torn == 0; ++seed) torn = positions_torn(seed, moves);
  EXPECT_GT(torn, 0u);
}

// What follows a write of I2, while the panel selects in turn a system whose buffer is full and one with room: the pin
// shows what is selected, at once and not with the next real-time task only.
void turn_panel(fake_task task) {
  static bool second;
  if (task != FAKE_REAL_TIME) return;
  second = !second;
  platform::pull_panel(second ? 2u << 8 : 1u << 8);
}

unsigned selections_lost(std::uint32_t seed, unsigned& made) {
  unsigned lost = 0;
  fake_interrupts_begin(seed, 10);
  fake_interrupts_on_take(turn_panel);
  for (unsigned i = 0; i < 600; ++i) {
    panel_changed();
    const std::uint32_t state = hal_mask_real_time();
    lost += breq() != (panel_cs() == 1u) ? 1u : 0u;
    hal_unmask(state);
  }
  made = fake_interrupts_counts().taken[FAKE_REAL_TIME];
  fake_interrupts_on_take(nullptr);
  fake_interrupts_end();
  return lost;
}

class InterruptsOfThePanel : public Interrupts {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    platform::fit_panel();
    for (const char* line : {"I16=1 I17=2", "&2DEF ROT 50", "&1DEF ROT 50 OPEN ROT", "P1=1", "P1=1"})
      ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
    platform::panel(2u << 8);
    ASSERT_TRUE(breq()) << "room";
    platform::panel(1u << 8);
    ASSERT_FALSE(breq()) << "full";
  }
};

TEST_F(InterruptsOfThePanel, PinShowsTheSelectionWhenI2IsWritten) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    unsigned made = 0;
    EXPECT_EQ(selections_lost(seed, made), 0u) << "seed " << seed;
    EXPECT_GT(made, 100u);
  }
}

// A pointer given while an abort is still to be settled, and the real-time task comes in the middle of it: what is left
// of the aborted line is skipped in its own program. In the new one that would be its first line.
TEST_F(Interrupts, APointerGivenBehindAnAbortKeepsItsFirstLine) {
  constexpr std::uint32_t kSeeds = 200;
  ASSERT_EQ(host("OPEN PROG 2 CLEAR"), "");
  for (int i = 0; i < 6; ++i)  // the queue holds five of these texts
    ASSERT_EQ(host("P2=1SEND\"" + std::string(200, 'x') + "\""), "");
  ASSERT_EQ(host("CLOSE OPEN PROG 3 CLEAR P3=P3+1 CLOSE"), "");
  unsigned came = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    ASSERT_EQ(host("B2R"), "");
    platform::servo_ticks(9);
    ASSERT_TRUE(run_is_running(0)) << "it stands in the middle of its last line";
    run_abort(0);
    fake_interrupts_begin(seed, 15);
    ASSERT_EQ(run_point(0, 3.0), ERR_NONE);
    came += fake_interrupts_counts().taken[FAKE_REAL_TIME];
    fake_interrupts_end();
    ASSERT_EQ(host("P3=0 R"), "");
    platform::servo_ticks(12);
    ASSERT_FALSE(run_is_running(0));
    ASSERT_EQ(p_variable_read(3), 1.0) << "seed " << seed;
    platform::background(8);
    (void)platform::sent();
  }
  EXPECT_GT(came, kSeeds / 2);
}

// A move that `/` holds back is dropped by B and never starts, wherever an interrupt comes: nothing is masked there.
TEST_F(Interrupts, AMoveThatIsHeldBackNeverStartsBehindB) {
  constexpr std::uint32_t kSeeds = 300;
  struct coordinate_system& s = coordinate_systems[0];
  ASSERT_EQ(host("OPEN PROG 2 CLEAR TM5 TA2 TS0 INC"), "");
  for (int i = 0; i < 3; ++i) ASSERT_EQ(host("X1"), "");
  ASSERT_EQ(host("CLOSE OPEN PROG 3 CLEAR P3=P3+1 CLOSE"), "");
  unsigned servo = 0, real_time = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    ASSERT_EQ(host("B2R"), "");
    platform::servo_ticks(9);
    ASSERT_EQ(host("/"), "");
    platform::servo_ticks(30);
    ASSERT_TRUE(s.next_valid && !s.active && !s.running) << "nothing is held back";
    const std::uint32_t started = s.started;
    const double position = s.moves[s.executing ^ 1u].start[AXIS_X];
    fake_interrupts_begin(seed, 3);
    ASSERT_EQ(run_point(0, 3.0), ERR_NONE);
    servo += fake_interrupts_counts().taken[FAKE_SERVO];
    real_time += fake_interrupts_counts().taken[FAKE_REAL_TIME];
    fake_interrupts_end();
    platform::servo_ticks(6);
    ASSERT_EQ(s.started, started) << "seed " << seed;
    ASSERT_FALSE(s.active || s.next_valid || s.settling || s.end_block) << "seed " << seed;
    ASSERT_EQ(s.position[AXIS_X], position) << "seed " << seed;
    ASSERT_EQ(host("P3=0 R"), "");
    platform::servo_ticks(6);
    ASSERT_EQ(p_variable_read(3), 1.0) << "seed " << seed;
  }
  EXPECT_GT(servo, kSeeds);
  EXPECT_GT(real_time, kSeeds / 4);
}

// The servo task starts the move that waits, as it does at the end of the one before.
void start_waiting(fake_task task) {
  struct coordinate_system& s = coordinate_systems[15];
  if (task != FAKE_SERVO || !s.next_valid) return;
  s.executing = s.executing ^ 1u;
  s.next_valid = false;
  ++looks;
}

// What starts in the middle of a look at it is not taken for the one that was executed before: a sequence of segments
// ended at such a moment, and its moves did not blend.
TEST_F(Interrupts, AMoveThatStartsWhileItIsLookedAtIsNotTheOneBefore) {
  struct coordinate_system& s = coordinate_systems[15];
  s.moves[0].kind = MOVE_LINEAR;
  s.moves[1].kind = MOVE_DWELL;
  const auto status = [&s] {
    s.executing = 1;
    s.next_valid = true;
    return motion_cs_status(15, 1);
  };
  const std::uint32_t waits = status();
  s.moves[0].kind = MOVE_DWELL;
  const std::uint32_t dwell = waits ^ status();
  ASSERT_NE(dwell, 0u) << "a DWELL that waits is seen";
  s.moves[0].kind = MOVE_LINEAR;
  looks = 0;
  fake_interrupts_begin(1, 10);
  fake_interrupts_on_take(start_waiting);
  unsigned of_before = 0;
  for (int i = 0; i < 500; ++i) of_before += ((status() ^ waits) & dwell) != 0 ? 1u : 0u;
  fake_interrupts_end();
  EXPECT_EQ(of_before, 0u);
  EXPECT_GT(looks, kLooks);
  s.next_valid = false;
}

}  // namespace
