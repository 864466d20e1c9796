// Every mistake in a vector file is one line: file:line: found, expected. Expectations that do not hold are found, too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systemc/core/usage_error.h"
#include "testbench/unit/vectors/runner.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string with_steps(const std::string& steps) {
  return "title = \"t\"\nsection = \"s\"\ndevice = \"channels\"\nunits = { sclk = 12 }\nsteps = '''\n" + steps +
         "\n'''\n[[negative]]\nname = \"n\"\nstuck = \"ch1.equ at 1\"\n";
}
std::string error(const std::string& text) {
  try {
    parse_vector(text, "a.vec");
  } catch (const UsageError& e) { return e.what(); }
  return "no error";
}
// The line of the first step is 6.
std::string step_error(const std::string& step) { return error(with_steps("expect ch1.equ is 0\n" + step)); }

TEST(VectorErrors, NameLineFoundAndExpected) {
  constexpr const char* kExpected =
      " is not known; expected is, high, rises, falls, changes, period, pulses, stays or reads";
  EXPECT_EQ(step_error("expect ch1.equ hihg 3"), std::string("a.vec:7: `hihg`") + kExpected);
  EXPECT_EQ(step_error("wiat 3"),
            "a.vec:7: `wiat` is not known; expected reset, write, read, pin, wait, until, mark, turn, send, command or "
            "expect");
  EXPECT_EQ(step_error("pin ch5.enc_a = 1"),
            "a.vec:7: `ch5.enc_a` is not known; expected a signal of the device 'channels', as ch1.enc_a");
  EXPECT_EQ(step_error("pin ch1.equ = 1"), "a.vec:7: `ch1.equ` is not known; expected an input pin");
  EXPECT_EQ(step_error("write X:$20 = 1"),
            "a.vec:7: `X:$20` is not known; expected a word, X:$00 to X:$1F or Y:$00 to Y:$1F");
  EXPECT_EQ(step_error("write X:$04 1"), "a.vec:7: `1` is not known; expected =");
  EXPECT_EQ(step_error("write X:$04 = 1 << 24"), "a.vec:7: `1` is not known; expected a value of 24 bits");
  EXPECT_EQ(step_error("write X:$04 = $"), "a.vec:7: `$` is not known; expected a number, decimal or $hex");
  EXPECT_EQ(step_error("wait 3 sclk now"), "a.vec:7: `now` is not known; expected nothing behind it");
  EXPECT_EQ(step_error("wait"), "a.vec:7: the line ends; expected a number, decimal or $hex");
  EXPECT_EQ(step_error("wait 3.5 sclk"), "a.vec:7: `3.5` is not known; expected a number, decimal or $hex");
  EXPECT_EQ(step_error("expect ch1.equ stays 0 from a to b"),
            "a.vec:7: `a` is not known; expected a mark that was set before");
  EXPECT_EQ(step_error("expect dac_strobe reads 012 on dac_clk"),
            "a.vec:7: `012` is not known; expected bits, as 0111_1110");
  EXPECT_EQ(step_error("until clock.phase high"), "a.vec:7: `high` is not known; expected rises, falls or changes");
  EXPECT_EQ(step_error("turn ch5 +3 every 4"), "a.vec:7: `ch5` is not known; expected ch1 to ch4");
  EXPECT_EQ(step_error("command \"I19\""),
            "a.vec:7: `\"I19\"` is not known; expected another statement: the device 'channels' has no command lines");
  EXPECT_EQ(step_error("command \"I19"), "a.vec:7: `\"I19` is a text without its end; expected a closing \"");
}

TEST(VectorErrors, WholeFile) {
  EXPECT_THAT(error("title = 3 4"), HasSubstr("a.vec:1: "));
  EXPECT_EQ(error("title = \"t\"\nfoo = 1"),
            "a.vec:2: unknown key foo; expected title, section, number, device, board, units, steps, negative, wave");
  EXPECT_EQ(error("title = 3"), "a.vec:1: title: found 3; expected a text in quotes");
  EXPECT_EQ(error("title = \"t\"\nsection = \"s\"\ndevice = \"toaster\""),
            "a.vec:3: device: found \"toaster\"; expected channels or controller or buses or ssi");
  EXPECT_EQ(error(with_steps("wait 3")),
            "a.vec:5: steps: found \"wait 3 \"; expected a line with 'expect', 'read' or a reply");
  const std::string good = with_steps("expect ch1.equ is 0");
  EXPECT_EQ(error(good), "no error");
  EXPECT_EQ(error(good.substr(0, good.find("[[negative]]"))),
            "a.vec: key negative is missing; expected negative = ...");
  EXPECT_EQ(error(good.substr(0, good.find("[[negative]]")) + "negative = []"),
            "a.vec:8: negative: found []; expected a fault with which it must fail");
  EXPECT_THAT(error(good + "late = \"ch1.equ by 3\"\n"),
              AllOf(HasSubstr("a.vec:8: negative: found "),
                    HasSubstr("; expected one fault: write, read, late, stuck, invert or command")));
  EXPECT_EQ(error(good + "[wave]\nsignals = [\"ch9.equ\"]\n"),
            "a.vec:12: signals: `ch9.equ` is not known; expected a signal of the device 'channels', as ch1.enc_a");
}

// The same 3 ms as host scripts write them, with a space or without.
TEST(VectorTimes, AreThoseOfHostScripts) {
  const auto ticks_of = [](const std::string& duration) {
    const Vector vector = parse_vector(with_steps("expect ch1.equ is 0\nwait " + duration), "a.vec");
    return std::get<step::Wait>(vector.steps.at(1).action).ticks;
  };
  constexpr Tick kThreeMs = (117'964'800 * 3 + 999) / 1000;  // rounded up
  EXPECT_EQ(ticks_of("3 ms"), kThreeMs);
  EXPECT_EQ(ticks_of("3ms"), kThreeMs);
  EXPECT_EQ(ticks_of("3000us"), kThreeMs);
  EXPECT_EQ(ticks_of("5 sclk"), 60);
  EXPECT_EQ(ticks_of("sclk"), 12);
  EXPECT_EQ(ticks_of("4 << 14"), 65536);
  EXPECT_EQ(ticks_of("7 ticks"), 7);
}

// A run of a few lines after PHASE has begun to run with a period of 203 ticks.
std::string failure(const std::string& steps) {
  const Vector vector =
      parse_vector(with_steps("write X:$1C = 100 << 8\nwrite X:$04 = $0008D2\nwait 30000\nuntil clock.phase rises\n"
                              "mark a\nwait 1015\nmark b\n" +
                              steps),
                   "a.vec");
  const auto device = make_channels(false);
  const RunResult result = run_vector(vector, *device);
  return result.failures.empty() ? "" : result.failures.front().substr(result.failures.front().rfind(": ") + 2);
}

TEST(VectorExpectations, HoldOrSayWhatWasFound) {
  EXPECT_EQ(failure("expect clock.phase period 203 from a to b"), "");
  EXPECT_EQ(failure("expect clock.phase period 204 from a to b"),
            "found 203 ticks at tick " + failure("expect clock.phase period 204 from a to b").substr(24));
  EXPECT_EQ(failure("expect clock.phase rises 5 times from a to b"), "");
  EXPECT_EQ(failure("expect clock.phase rises 6 times from a to b"), "found 5 times");
  EXPECT_EQ(failure("expect clock.phase high 505 from a to b"), "");  // 5 x 101
  EXPECT_EQ(failure("expect clock.phase high 504 from a to b"), "found 505 ticks");
  EXPECT_EQ(failure("expect clock.phase rises at a"), "");
  EXPECT_EQ(failure("expect clock.phase falls at a + 101"), "");
  EXPECT_EQ(failure("expect clock.phase falls at a + 100"), "found it 1 ticks later");
  EXPECT_THAT(failure("expect clock.phase pulses 100 from a to b"), HasSubstr("found 101 ticks"));
  EXPECT_EQ(failure("expect clock.phase pulses 101 from a to b"), "");
  EXPECT_EQ(failure("expect clock.phase falls then clock.phase rises after 102 from a to b"), "");
  EXPECT_THAT(failure("expect clock.phase falls then clock.phase rises after 101 from a to b"),
              HasSubstr("found 102 ticks"));
  EXPECT_EQ(failure("expect clock.phase stays 1 from a to a + 101"), "");
  EXPECT_EQ(failure("expect clock.phase stays 1 from a to a + 102"),
            "found a change 101 ticks after the begin of the window");
  EXPECT_EQ(failure("expect ch1.equ stays 1 from a to b"), "found 0");
  EXPECT_EQ(failure("expect ch1.equ is 1"), "found 0");
  EXPECT_EQ(failure("expect ch1.equ reads 00000 on clock.phase from a to b"), "");
  EXPECT_EQ(failure("expect ch1.equ reads 00001 on clock.phase from a to b"), "found 00000");
  EXPECT_EQ(failure("read X:$1C & $00FFFF = $006400"), "");
  EXPECT_EQ(failure("read X:$1C = $006401"), "found $006400");
  EXPECT_EQ(failure("expect clock.phase rises 1 times from b to a"),
            "found a window from tick " + failure("expect clock.phase rises 1 times from b to a").substr(25));
  EXPECT_EQ(failure("until ch1.equ rises within 2 sclk"), "found no rise of ch1.equ within 24 ticks");
}

}  // namespace
}  // namespace brick
