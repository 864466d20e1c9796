// @jpan in host scripts: which pins of the control panel port a line drives, and to what level.
#include <gmock/gmock.h>

#include <sstream>

#include "app/script.h"
#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ScriptLine line(const std::string& text) {
  std::istringstream in(text);
  return read_script(in, "job.txt").at(0);
}

TEST(JpanScript, DrivesThePinsOfDocsBoards) {
  const struct {
    const char* text;
    unsigned inputs, levels;
  } cases[] = {
      {"@jpan JOG-=0", 0x0001, 0x0000},        {"@jpan jog+=1", 0x0002, 0x0002},
      {"@jpan PREJOG=0", 0x0004, 0x0000},      {"@jpan START=0", 0x0008, 0x0000},
      {"@jpan START=1", 0x0008, 0x0008},       {"@jpan STEP=1", 0x0010, 0x0010},
      {"@jpan STOP=0", 0x0020, 0x0000},        {"@jpan HOME=1", 0x0040, 0x0040},
      {"@jpan HOLD=1", 0x0080, 0x0080},        {"@jpan FPD0=0", 0x0100, 0x0000},
      {"@jpan FPD3=1", 0x0800, 0x0800},        {"@jpan FPD=0", 0x0F00, 0x0F00},
      {"@jpan FPD=1", 0x0F00, 0x0E00},         {"@jpan FPD=2", 0x0F00, 0x0D00},
      {"@jpan FPD=8", 0x0F00, 0x0700},         {"@jpan FPD=15", 0x0F00, 0x0000},
      {"@jpan fpd=5 start=0", 0x0F08, 0x0A00}, {"@jpan HOLD=0 HOLD=1", 0x0080, 0x0080},
  };
  for (const auto& k : cases) {
    const ScriptLine s = line(k.text);
    EXPECT_EQ(s.kind, ScriptLine::Kind::kJpan);
    EXPECT_EQ(s.inputs, k.inputs) << k.text;
    EXPECT_EQ(s.levels, k.levels) << k.text;
  }
}

// INIT/ is no input of the port.
TEST(JpanScript, InitIsApartFromTheInputs) {
  EXPECT_FALSE(line("@jpan FPD=1").init);
  EXPECT_EQ(line("@jpan INIT=0").init, false);
  EXPECT_EQ(line("@jpan init=1").init, true);
  EXPECT_EQ(line("@jpan INIT=0").inputs, 0u);
  EXPECT_EQ(line("@jpan FPD=1 INIT=0 START=0").inputs, 0x0F08u);
}

TEST(JpanScript, ErrorsNameTheWordAndTheInputs) {
  for (const char* bad : {"FPD", "FPD=16", "FPD=-1", "FPD=x", "FPD4=0", "START=2", "START", "START=", "=1", "GO=0",
                          "START 0", "JOG=0", "JOG P=0", "JOG 0=1", "JOG-+=0", "INIT", "INIT=2", "INIT0=0"}) {
    std::string error = "no error";
    try {
      std::istringstream in("VERSION\n@jpan " + std::string(bad));
      read_script(in, "job.txt");
    } catch (const UsageError& e) { error = e.what(); }
    EXPECT_THAT(error,
                AllOf(HasSubstr("job.txt:2: @jpan: "), HasSubstr("is not known; expected"), HasSubstr("FPD=0 to 15")))
        << bad;
  }
  EXPECT_THROW(line("@jpan"), UsageError);
}

}  // namespace
}  // namespace brick
