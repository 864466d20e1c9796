// Files that users name: all that has an end is read, and nothing is waited for.
#include "systemc/core/input_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

std::string error_of(const std::string& path, const std::string& shown = "") {
  try {
    read_input_file(path, "a tale", shown);
  } catch (const UsageError& e) { return e.what(); }
  return "";
}

std::string path_of(const std::string& name) {
  return ::testing::TempDir() + "brick_input_" + name + std::to_string(getpid());
}

TEST(InputFile, IsReadAsItStands) {
  const std::string path = path_of("whole");
  const std::string text = std::string("a\r\n\0b", 5) + std::string(200'000, 'x') + "\x1A";
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_EQ(read_input_file(path, "a tale"), text);
  std::remove(path.c_str());
  EXPECT_EQ(read_input_file("/dev/null", "a tale"), "");
}

TEST(InputFile, OfThePipeThatAShellHasOpenedIsReadToItsEnd) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "once", 4), 4);
  close(ends[1]);
  EXPECT_EQ(read_input_file("/dev/fd/" + std::to_string(ends[0]), "a tale"), "once");
  close(ends[0]);
}

// Nobody writes to it, and nobody may ever.
TEST(InputFile, ThatIsANamedPipeIsRefused) {
  const std::string path = path_of("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(error_of(path), path + ": is no regular file; expected a tale");
  EXPECT_EQ(error_of(path, "--tale"), "--tale: is no regular file; expected a tale");
  EXPECT_THROW(need_regular_file(path, "a tale"), UsageError);
  EXPECT_TRUE(is_named_pipe(path));
  std::remove(path.c_str());
}

TEST(InputFile, WithoutAnEndIsRefused) {
  EXPECT_EQ(error_of("/dev/zero"), "/dev/zero: has more than 64 MiB; expected a tale");
  EXPECT_THROW(need_regular_file("/dev/zero", "a tale"), UsageError);
}

TEST(InputFile, ThatCannotBeReadSaysSo) {
  for (const char* path : {"/nonexistent/tale", "/tmp"}) {
    EXPECT_EQ(error_of(path), std::string(path) + ": cannot be read; expected a tale");
    EXPECT_THROW(need_regular_file(path, "a tale"), UsageError);
  }
}

TEST(InputFile, ThatIsRegularIsNeeded) {
  const std::string path = path_of("regular");
  std::ofstream(path) << "x";
  EXPECT_NO_THROW(need_regular_file(path, "a tale"));
  std::remove(path.c_str());
  EXPECT_THROW(need_regular_file(path, "a tale"), UsageError);
}

}  // namespace
}  // namespace brick
