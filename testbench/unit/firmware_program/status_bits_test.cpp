// Each bit of the status words of motors and coordinate systems (firmware:5.2 to firmware:5.6) by what it shows, and
// nothing else with it: causes that the test sets one by one, in the first system, one between and the last.
#include <functional>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_status.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/system_findings.h"
}

namespace {

using platform::host;

struct Owner {
  unsigned motor, cs;
};
constexpr Owner kOwners[] = {{0, 0}, {6, 4}, {31, 15}};

class StatusBits : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I68=15"), "");
  }
  static void assign(const Owner& of) {
    ASSERT_EQ(host("&" + std::to_string(of.cs + 1) + "#" + std::to_string(of.motor + 1) + "->1000X"), "");
    motors_active |= 1u << of.motor;
  }
  static coordinate_system& system(const Owner& of) { return coordinate_systems[of.cs]; }
  static move& executing(const Owner& of) { return system(of).moves[system(of).executing]; }
  static move& next(const Owner& of) { return system(of).moves[system(of).executing ^ 1u]; }
};

// firmware:5.2, firmware:5.3
TEST_F(StatusBits, OfMotors) {
  struct Cause {
    unsigned word, bit;
    const char* what;
    std::function<void(const Owner&)> set;
  };
  const auto found = [](bool motor_findings::*which) {
    return [which](const Owner& of) { motors[of.motor].found.*which = true; };
  };
  const auto limit = [](volatile bool motor_findings::*which) {
    return [which](const Owner& of) { motors[of.motor].found.*which = true; };
  };
  const auto flag = [](volatile bool motor_status_flags::*which) {
    return [which](const Owner& of) { motors[of.motor].status.*which = true; };
  };
  const Cause causes[] = {
      {0, 22, "negative limit", limit(&motor_findings::negative_limit)},
      {0, 21, "positive limit", limit(&motor_findings::positive_limit)},
      {0, 17, "timed move", flag(&motor_status_flags::timed_move)},
      {0, 17, "of its program",
       [](const Owner& of) {
         motors[of.motor].path = PATH_SYSTEM;
         system(of).active = true;
         executing(of).kind = MOVE_LINEAR;
       }},
      {0, 15, "DWELL",
       [](const Owner& of) {
         system(of).active = true;
         executing(of).kind = MOVE_DWELL;
       }},
      {0, 14, "no move in time",
       [](const Owner& of) {
         system(of).error = RUN_TIME_LATE;
         system(of).motors = 1u << of.motor;
       }},
      {0, 12, "ramp", flag(&motor_status_flags::aborting)},
      {0, 10, "search", flag(&motor_status_flags::home_search)},
      {1, 12, "desired limit", found(&motor_findings::on_desired_limit)},
      {1, 11, "limit", found(&motor_findings::on_limit)},
      {1, 10, "home", flag(&motor_status_flags::home_complete)},
      {1, 9, "phase search", [](const Owner& of) { phasing_searched |= 1u << of.motor; }},
      {1, 8, "phase reference", [](const Owner& of) { phasing_missing |= 1u << of.motor; }},
      {1, 7, "trigger move", flag(&motor_status_flags::trigger_move)},
      {1, 6, "integrated error", found(&motor_findings::integrated_error)},
      {1, 5, "integrated current", found(&motor_findings::integrated_current)},
      {1, 4, "backlash", [](const Owner& of) { desired_paths[of.motor].down = true; }},
      {1, 3, "amplifier fault", found(&motor_findings::amplifier_fault)},
      {1, 2, "fatal error", found(&motor_findings::fatal_error)},
      {1, 1, "warning error", found(&motor_findings::warning_error)},
      {1, 0, "in position", found(&motor_findings::in_position)},
  };
  for (const Owner& of : kOwners)
    for (const Cause& cause : causes) {
      SCOPED_TRACE(::testing::Message() << "#" << of.motor + 1 << ": " << cause.what);
      platform::power_up();
      ASSERT_EQ(host("I68=15"), "");
      ASSERT_NO_FATAL_FAILURE(assign(of));
      const std::uint32_t before[] = {motor_status(of.motor, 0), motor_status(of.motor, 1)};
      EXPECT_EQ(before[1], of.cs << 20 | 7u << 16 | 1u << 15) << "X of its system";
      const unsigned other = of.motor ^ 1u;
      const std::uint32_t of_other[] = {motor_status(other, 0), motor_status(other, 1)};
      cause.set(of);
      for (unsigned word = 0; word < 2; ++word) {
        EXPECT_EQ(motor_status(of.motor, word) ^ before[word], cause.word == word ? 1u << cause.bit : 0u) << word;
        EXPECT_EQ(motor_status(other, word), of_other[word]) << "another's";
      }
    }
}

// What takes two: nothing is shown of the one alone.
TEST_F(StatusBits, OfMotorsByTwoCauses) {
  const Owner of = {6, 4};
  ASSERT_NO_FATAL_FAILURE(assign(of));
  const std::uint32_t first = motor_status(6, 0), second = motor_status(6, 1);
  motor& m = motors[6];
  const std::pair<motor_loop, std::uint32_t> loops[] = {
      {LOOP_KILLED, 1u << 18}, {LOOP_OPEN, 1u << 19 | 1u << 18}, {LOOP_CLOSED, 1u << 19 | 1u << 13}};
  for (const auto& [loop, bits] : loops)
    for (const std::int32_t step : {0, 1, -1}) {
      m.loop = loop;
      m.desired_step = step;
      EXPECT_EQ(motor_status(6, 0) & 0xC2000u, step == 0 ? bits : bits & ~(1u << 13)) << loop << " " << step;
      EXPECT_EQ(motor_status(6, 1) >> 14 & 1u, loop == LOOP_KILLED ? 0u : 1u);
    }
  m.loop = LOOP_KILLED;
  m.path = PATH_SYSTEM;
  EXPECT_EQ(motor_status(6, 0), first) << "nothing executes";
  m.path = PATH_OWN;
  system(of).active = true;
  executing(of).kind = MOVE_LINEAR;
  EXPECT_EQ(motor_status(6, 0), first) << "it is not on that path";
  system(of).active = false;
  executing(of).kind = MOVE_DWELL;
  EXPECT_EQ(motor_status(6, 0), first) << "a DWELL that is over";
  for (const run_time_error error : {RUN_TIME_FEEDRATE, RUN_TIME_LATE, RUN_TIME_IN_POSITION}) {
    system(of).error = error;
    for (const std::uint32_t motors_of : {0u, ~(1u << 6), 1u << 6}) {
      system(of).motors = motors_of;
      EXPECT_EQ(motor_status(6, 0) ^ first, error == RUN_TIME_LATE && motors_of == 1u << 6 ? 1u << 14 : 0u) << error;
    }
  }
  m.found.foreground_in_position = true;
  EXPECT_EQ(motor_status(6, 1), second) << "I13 = 0";
  ASSERT_EQ(host("I13=1"), "");
  EXPECT_EQ(motor_status(6, 1) ^ second, 1u << 13);
  m.found.foreground_in_position = false;
  m.found.in_position = true;
  EXPECT_EQ(motor_status(6, 1) ^ second, 1u);
  jogs_busy |= 1u << 6;
  EXPECT_EQ(motor_status(6, 1), second) << "it is about to move";
}

// firmware:5.4 to firmware:5.6
TEST_F(StatusBits, OfSystems) {
  struct Cause {
    unsigned word;
    std::uint32_t bits;  // that change
    const char* what;
    std::function<void(const Owner&)> set;
  };
  const auto fault = [](bool motor_findings::*which) {
    return [which](const Owner& of) { motors[of.motor].found.*which = true; };
  };
  const auto executes = [](move_kind kind, bool active) {
    return [kind, active](const Owner& of) {
      executing(of).kind = kind;
      system(of).active = active;
    };
  };
  const auto corner = [](corner_stop stop, bool sharp) {
    return [stop, sharp](const Owner& of) {
      system(of).corner = stop;
      next(of).is_sharp = sharp;
    };
  };
  std::vector<Cause> causes = {
      {0, 1u << 5, "vector absolute", [](const Owner& of) { system(of).vector_absolute = true; }},
      {0, 1u << 3, "move by time", [](const Owner& of) { system(of).time_mode ^= true; }},
      {0, 1u, "runs", [](const Owner& of) { system(of).running = true; }},
      {0, 0, "ended", [](const Owner& of) { system(of).running = system(of).ended = true; }},
      {0, 1u << 4 | 1u, "R", [](const Owner& of) { system(of).running = system(of).continuous = true; }},
      {0, 0, "R before", [](const Owner& of) { system(of).continuous = true; }},
      {0, 1u, "R without blends",
       [](const Owner& of) { system(of).running = system(of).continuous = system(of).unblended = true; }},
      {0, 1u << 1 | 1u, "S", [](const Owner& of) { system(of).running = system(of).stepping = true; }},
      {0, 0, "S before", [](const Owner& of) { system(of).stepping = true; }},
      {0, 1u << 1 | 1u, "Q", [](const Owner& of) { system(of).running = system(of).quit = true; }},
      {0, 0, "Q at the end", [](const Owner& of) { system(of).running = system(of).quit = system(of).ended = true; }},
      {0, 1u << 2, "blends",
       [](const Owner& of) {
         system(of).active = executing(of).blended = true;
         executing(of).kind = MOVE_LINEAR;
       }},
      {0, 0, "has blended", [](const Owner& of) { executing(of).blended = true; }},
      {1, 1u << 22, "run-time error", [](const Owner& of) { system(of).error = RUN_TIME_LABEL; }},
      {1, 1u << 20, "amplifier fault", fault(&motor_findings::amplifier_fault)},
      {1, 1u << 19, "fatal error", fault(&motor_findings::fatal_error)},
      {1, 1u << 18, "warning error", fault(&motor_findings::warning_error)},
      {1, 1u << 17, "in position", fault(&motor_findings::in_position)},
      {1, 0, "in position before a move",
       [](const Owner& of) { motors[of.motor].found.in_position = system(of).next_valid = true; }},
      {1, 0, "in position within a move",
       [](const Owner& of) {
         motors[of.motor].found.in_position = system(of).active = true;
         executing(of).kind = MOVE_LINEAR;
       }},
      {1, 1u << 16, "rotary full", [](const Owner& of) { rotary_buffers[of.cs].full = true; }},
      {1, 1u << 14, "end of block", [](const Owner& of) { system(of).end_block = true; }},
      {1, 1u << 14, "end of block of motors", [](const Owner& of) { system(of).quit_at_block = true; }},
      {1, 1u << 12, "DWELL", executes(MOVE_DWELL, true)},
      {1, 0, "a DWELL that is over", executes(MOVE_DWELL, false)},
      {1, 1u << 12, "a DWELL that waits",
       [](const Owner& of) {
         system(of).next_valid = true;
         next(of).kind = MOVE_DWELL;
       }},
      {1, 1u << 7, "segments", executes(MOVE_SEGMENTS, true)},
      {1, 0, "segments that are over", executes(MOVE_SEGMENTS, false)},
      {2, 1u << 6, "sharp corner", corner(CORNER_IN_POSITION, true)},
      {2, 0, "no sharp corner", corner(CORNER_IN_POSITION, false)},
      {2, 0, "no stop", corner(CORNER_NONE, true)},
      {2, 1u << 6 | 1u << 5, "pause at a sharp corner", corner(CORNER_DWELL, true)},
      {2, 1u << 2, "away from where it stopped", [](const Owner& of) { system(of).must_have_returned = true; }},
      {2, 1u << 1, "desired limit", fault(&motor_findings::on_desired_limit)},
      {2, 1u, "PMATCH", [](const Owner& of) { system(of).matching = system(of).running = true; }},
      {2, 0, "PMATCH from outside", [](const Owner& of) { system(of).matching = true; }},
      {2, 1u << 20, "assignments wait", [](const Owner& of) { system(of).slots_wait = true; }},
      {2, 1u << 19, "assignments lost", [](const Owner& of) { system(of).slots_short = true; }}};
  for (unsigned axis = 0; axis < AXIS_COUNT; ++axis) {  // A lowest, Z highest
    causes.push_back(
        {0, 1u << (6 + 2 * axis), "incremental", [axis](const Owner& of) { system(of).incremental ^= 1u << axis; }});
    causes.push_back({0, 1u << (7 + 2 * axis), "feedrate axis",
                      [axis](const Owner& of) { system(of).feedrate_axes ^= 1u << axis; }});
  }
  for (const Owner& of : kOwners)
    for (const Cause& cause : causes) {
      SCOPED_TRACE(::testing::Message() << "&" << of.cs + 1 << ": " << cause.what);
      platform::power_up();
      ASSERT_EQ(host("I68=15"), "");
      ASSERT_NO_FATAL_FAILURE(assign(of));
      const unsigned other = of.cs ^ 1u;
      std::uint32_t before[3], of_other[3];
      for (unsigned word = 0; word < 3; ++word) {
        before[word] = motion_cs_status(of.cs, word);
        of_other[word] = motion_cs_status(other, word);
      }
      EXPECT_EQ(before[0], 0xA80020u | (before[0] & 8u));
      cause.set(of);
      const bool runs = (cause.bits & 1u) != 0;
      for (unsigned word = 0; word < 3; ++word) {
        std::uint32_t changed = motion_cs_status(of.cs, word) ^ before[word];
        if (cause.word == 2 && word == 0 && runs) changed &= ~1u;  // its program runs, which shows there
        EXPECT_EQ(changed, cause.word == word ? cause.bits : 0u) << word;
        EXPECT_EQ(motion_cs_status(other, word), of_other[word]) << "another's, " << word;
      }
    }
  for (const run_time_error error : {RUN_TIME_LATE, RUN_TIME_RADIUS}) {
    coordinate_systems[3].error = error;
    EXPECT_EQ(motion_cs_status(3, 2) >> 3 & 1u, error == RUN_TIME_RADIUS ? 1u : 0u);
  }
}

// A system is in position when all of its motors are; without any, when nothing of a program is under way.
TEST_F(StatusBits, ASystemIsInPositionWithAllItsMotors) {
  EXPECT_EQ(motion_cs_status(2, 1) >> 17 & 1u, 1u) << "virtual axes";
  ASSERT_EQ(host("&3#3->1000X #9->1000Y #32->1000Z &4#4->1000X"), "");
  for (unsigned which = 0; which < 8; ++which) {
    motors[2].found.in_position = (which & 1) != 0;
    motors[8].found.in_position = (which & 2) != 0;
    motors[31].found.in_position = (which & 4) != 0;
    motors[3].found.in_position = which == 0;
    EXPECT_EQ(system_in_position(2), which == 7) << which;
    EXPECT_EQ(motion_cs_status(2, 1) >> 17 & 1u, which == 7 ? 1u : 0u) << which;
  }
  jogs_busy |= 1u << 8;
  EXPECT_FALSE(system_in_position(2)) << "one is about to move";
}

}  // namespace
