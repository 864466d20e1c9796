// SAVE through the flash store: across `$$$`, across the power, and in a file from one run to the next.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "systemc/machine/board_file.h"
#include "testbench/unit/random_seed.h"
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

// While the machine runs: whoever kills it then finds all of it.
TEST_P(SavedDataFile, IsWrittenWholeAtEachSave) {
  start_with_file();
  for (const char* line : {"I17=21 P5=1.5", "I17=22 P8191=3", "I17=23"}) {
    ask(line);
    EXPECT_EQ(ask("SAVE"), "");
    std::ifstream in(file(), std::ios::binary);
    const std::string kept{std::istreambuf_iterator<char>(in), {}};
    const std::uint8_t* store = machine().cpu().memory(0x30000000, 1 << 20);
    EXPECT_EQ(kept, std::string(reinterpret_cast<const char*>(store), 1 << 20)) << line;
  }
}

TEST_P(SavedDataFile, AFileThatCannotBeWrittenFailsTheRunAndStopsNothing) {
  start_with_file();
  std::filesystem::remove(file());
  std::filesystem::create_directory(file());  // in its place
  ask("I17=21");
  for (int again = 0; again < 3; ++again) EXPECT_EQ(ask("SAVE"), "") << "the controller has done its part";
  EXPECT_EQ(ask("I17"), "21");
  const auto errors = machine().take_run_errors();
  ASSERT_EQ(errors.size(), 1u) << "the same each time";
  EXPECT_THAT(errors[0], ::testing::HasSubstr("flash file " + file().string() + ": cannot be written"));
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

// All that takes a value has one. What sets up the clocks, the CPU and the dialogue keeps its own.
class SavedVariables : public Controller {
 protected:
  void set_all() {
    for (const char* line : {"I5..6=1", "I8=1", "I11..18=1", "I42..49=1", "I69..99=1"})
      EXPECT_EQ(ask(line), "") << line;
    // A table of 192 entries takes more than a servo interrupt, 32 phase searches at the start more than the CPU has,
    // and so do 32 current loops at each phase interrupt.
    const char* kLines[] = {"I8000=0 I8001..8191=1", "I7=3",          "I100..3299=1",
                            "I180,32,100=0",         "I3300..4899=1", "I5000..6799=1"};
    for (const char* line : kLines) EXPECT_EQ(ask(line), "") << line;
    for (unsigned ic = 6800; ic < 8000; ic += 50) {
      const auto number = [&](unsigned offset) { return std::to_string(ic + offset); };
      const std::string channels = " I" + number(10) + ".." + number(49) + "=1";
      EXPECT_EQ(ask("I" + number(5) + "=1 I" + number(6) + "=1" + channels), "");
    }
  }
  // Of each variable but what no SAVE keeps: timers, Isx15, Isx21.
  std::vector<std::string> values() {
    std::vector<std::string> all;
    const auto take = [&](unsigned first, unsigned end) {
      for (unsigned from = first; from < end; from += 100)
        for (std::string& line :
             link().command("I" + std::to_string(from) + ".." + std::to_string(std::min(from + 100, end) - 1)).lines)
          all.push_back(std::move(line));
    };
    take(0, 5100);
    for (unsigned cs = 5100; cs < 6700; cs += 100) {
      take(cs, cs + 11);
      take(cs + 13, cs + 15);
      take(cs + 16, cs + 21);
      take(cs + 22, cs + 100);
    }
    take(6700, 8192);
    return all;
  }
};

TEST_P(SavedVariables, AllAtOnceComeBackWithinTheHardwareWatchdogsTime) {
  for (const std::string board : {"geobrick-lv-8", "all-ics"}) {
    MachineConfig config;
    config.board = read_board_file("boards/" + board + ".toml");
    start(config);
    set_all();
    const std::vector<std::string> before = values();
    ASSERT_EQ(before.size(), 8192u - 16 * 4) << board;
    EXPECT_GE(std::count_if(before.begin(), before.end(), [](const auto& value) { return value != "0"; }), 6500)
        << board;
    EXPECT_EQ(ask("SAVE"), "");
    for (const bool power : {false, true}) {
      ask("I130=2 I5187=2 I3350=2");
      if (power)
        machine().power_cycle();
      else
        link().command("$$$");
      ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(150))) << board << (power ? ", power" : ", $$$");
      EXPECT_EQ(values() == before, true) << board << (power ? ", power" : ", $$$");
      EXPECT_EQ(ask("I5115 I5121 I6615 I6621"), "0|0|0|0") << board << (power ? ", power" : ", $$$");
    }
  }
}

// By the reset line and by the power, at random instants of a SAVE and about its end, in which the image comes to
// count: one in each eighth of 30 us before the acknowledge and as much behind it. All that comes back is of one SAVE.
TEST_P(SavedDataFile, AStartInsideSaveLeavesOldOrNew) {
  start();
  std::mt19937 random(random_seed(7));
  int stored = 1;
  const auto set = [this](int n) { ask("I17=" + std::to_string(n) + " P1=" + std::to_string(n) + " P8000=P1"); };
  const auto text = [](int n) { return std::to_string(n) + "|" + std::to_string(n) + "|" + std::to_string(n); };
  set(stored);
  const Tick begin = machine().now();
  link().send("SAVE");
  while ((bus().port_status() & HostBus::kRxdf) == 0) ASSERT_LT(machine().now() - begin, ms_to_ticks(100));
  const Tick duration = machine().now() - begin;
  ASSERT_TRUE(link().finish().complete);
  constexpr int kAboutTheEnd = 8;
  const Tick part = ms_to_ticks(1) / 30 * 2 / kAboutTheEnd;
  unsigned old_ones = 0, new_ones = 0, old_at_the_end = 0;
  for (int cut = 0; cut < 2 * kAboutTheEnd; ++cut) {
    const bool at_the_end = cut % 2 == 0;
    set(stored + 1);
    const Tick sent = machine().now();
    link().send("SAVE");
    const Tick at = at_the_end ? duration + (cut / 2 - kAboutTheEnd / 2) * part +
                                     static_cast<Tick>(random() % static_cast<unsigned>(part))
                               : static_cast<Tick>(random() % static_cast<unsigned>(duration));
    wait(std::max<Tick>(0, sent + at - machine().now()));
    if (cut % 4 < 2)
      machine().reset();
    else
      machine().power_cycle();
    ASSERT_TRUE(link().connect(ms_to_ticks(50)));
    EXPECT_EQ(status() & kFlashError, 0u);
    const std::string got = ask("I17 P1 P8000");
    if (got == text(stored + 1)) {
      ++stored;
      ++new_ones;
    } else {
      ASSERT_EQ(got, text(stored)) << cut;
      ++old_ones;
      old_at_the_end += at_the_end ? 1 : 0;
    }
  }
  EXPECT_GE(old_ones, 6u);
  EXPECT_GE(new_ones, 1u);
  EXPECT_GE(old_at_the_end, 1u) << "the image counts before these 30 us";
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
BRICK_ON_ENGINES(SavedVariables, Engine::kSystemC);

}  // namespace
}  // namespace brick
