// The file of the flash store: what others leave beside it when they are killed, and what they still write.
#include "systemc/machine/flash_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace brick {
namespace {

namespace fs = std::filesystem;

class FlashFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("flash_file_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name) const { std::ofstream(path(name)) << "begun"; }
  std::vector<std::uint8_t> content(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.insert(entry.path().filename().string());
    return all;
  }
  static std::string process_that_has_ended() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return std::to_string(child);
  }
  void open(const std::string& name) {
    std::array<std::uint8_t, 16> data{};
    FlashFile(path(name)).load(data.data(), data.size());
  }

 private:
  fs::path folder_;
};

TEST_F(FlashFiles, WhatAKilledProcessHasLeftGoesWithTheNextRun) {
  open("a.bin");
  ASSERT_EQ(names(), (std::set<std::string>{"a.bin"})) << "made, and nothing beside it";
  const std::string ended = process_that_has_ended();
  write("a.bin.new-" + ended);
  open("a.bin");
  EXPECT_EQ(names(), (std::set<std::string>{"a.bin"}));
}

TEST_F(FlashFiles, WhatIsNotOursOrStillWrittenStays) {
  const std::string ended = process_that_has_ended(), alive = std::to_string(::getppid());
  const std::set<std::string> kept = {
      "a.bin",     "a.bin.new-" + alive, "b.bin.new-" + ended, "a.bin.new-" + ended + "x",
      "a.bin.new", "a.bin.new-",         "a.bin.new-0",        "a.bin.old-" + ended};
  for (const std::string& name : kept)
    if (name != "a.bin") write(name);
  open("a.bin");
  EXPECT_EQ(names(), kept);
  open("a.bin");
  EXPECT_EQ(names(), kept);
}

// The last SAVE stands there: a process that has nothing new writes nothing.
TEST_F(FlashFiles, WhatAnotherProcessHasSavedSinceStays) {
  std::array<std::uint8_t, 4> first{1, 2, 3, 4}, second{};
  FlashFile one(path("a.bin")), other(path("a.bin"));
  one.load(first.data(), first.size());
  other.load(second.data(), second.size());
  EXPECT_EQ(second, first);
  first[0] = 9;
  one.save(first.data(), first.size());
  other.save(second.data(), second.size());
  EXPECT_EQ(content("a.bin"), (std::vector<std::uint8_t>{9, 2, 3, 4}));
  second[3] = 7;
  other.save(second.data(), second.size());
  one.save(first.data(), first.size());
  EXPECT_EQ(content("a.bin"), (std::vector<std::uint8_t>{1, 2, 3, 7}));
  fs::remove(path("a.bin"));
  other.save(second.data(), second.size());
  EXPECT_EQ(content("a.bin"), (std::vector<std::uint8_t>{1, 2, 3, 7})) << "made again";
}

// What is left stands beside the file that a link names, not beside the link.
TEST_F(FlashFiles, OfALinkItIsThatOfTheFileItNames) {
  fs::create_directories(path("there"));
  open("there/a.bin");
  fs::create_symlink(path("there/a.bin"), path("link.bin"));
  const std::string left = "a.bin.new-" + process_that_has_ended();
  write("there/" + left);
  open("link.bin");
  EXPECT_FALSE(fs::exists(path("there/" + left)));
}

}  // namespace
}  // namespace brick
