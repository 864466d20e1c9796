// SAVE through the flash store: across `$$$`, across the power, and in a file from one run to the next.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned long kFlashError = 1ul << 10;

class SavedDataFile : public Controller {
 protected:
  SavedDataFile()
      : file_(std::filesystem::path(::testing::TempDir()) / ("flash_" + std::to_string(::getpid()) + ".bin")) {
    std::filesystem::remove(file_);
  }
  ~SavedDataFile() override {
    finish();  // the machine writes the file when it goes
    std::filesystem::remove(file_);
  }

  void start_with_file() {
    MachineConfig config;
    config.flash_file = file_.string();
    start(config);
  }
  unsigned long status() { return std::stoul(ask("???").substr(0, 6), nullptr, 16); }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

TEST_P(SavedDataFile, SurvivesResetPowerAndTheNextRun) {
  start_with_file();
  ask("I17=21 I7002=1 P5=1.5");
  EXPECT_EQ(ask("SAVE"), "");
  ask("I17=22 P5=9 I3=2");
  link().command("$$$");
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I17 P5 I7002"), "21|1.5|1");
  machine().power_cycle();
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(ask("I17 P5"), "21|1.5");
  finish();
  start_with_file();
  EXPECT_EQ(ask("I17 P5 I7002"), "21|1.5|1");
  EXPECT_EQ(status() & kFlashError, 0u);
}

TEST_P(SavedDataFile, ADamagedFileIsReportedAndDefaultsAreUsed) {
  start_with_file();
  ask("I17=21");
  EXPECT_EQ(ask("SAVE"), "");
  finish();
  {
    std::fstream flash(file(), std::ios::in | std::ios::out | std::ios::binary);
    flash.seekg(64);
    const auto byte = static_cast<char>(flash.get() ^ 1);
    flash.seekp(64);
    flash.put(byte);
  }
  start_with_file();
  EXPECT_NE(status() & kFlashError, 0u);
  EXPECT_EQ(ask("I17"), "10");
  EXPECT_EQ(ask("SAVE"), "");
  ask("I3=2");
  link().command("$$$");
  ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(50)));
  EXPECT_EQ(status() & kFlashError, 0u) << "a new SAVE repairs it";
}

TEST_P(SavedDataFile, IsRefusedWhileAProgramRuns) {
  start();
  ask("&1DEFINE ROTARY 100");
  ask("B0");
  ask("OPEN ROTARY");
  for (int i = 0; i < 3; ++i) ask("DWELL50");
  ask("CLOSE");
  ask("R");
  EXPECT_EQ(ask("SAVE"), "ERR001");
}

BRICK_ON_ENGINES(SavedDataFile, Engine::kSystemC);

}  // namespace
}  // namespace brick
