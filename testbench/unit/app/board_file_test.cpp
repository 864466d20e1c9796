// Board files: the boards of the tree, and every way of getting one wrong.
#include "systemc/machine/board_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / ("board_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << text;
  std::string error = "no error";
  try {
    read_board_file(file.string());
  } catch (const BoardFileError& e) { error = e.what(); }
  std::filesystem::remove(file);
  return error;
}

constexpr const char* kGood = "title = \"T\"\ncard = 603382\nservo_ics = [0]\ndpram_words = 8192\n";

TEST(BoardFile, BoardsOfTheTree) {
  const BoardConfig four = read_board_file(BRICK_SOURCE_DIR "/boards/geobrick-lv-4.toml");
  EXPECT_EQ(four.fitted, 0x1u);
  EXPECT_EQ(four.name, "geobrick-lv-4");
  EXPECT_EQ(four.card, 603382u);
  const BoardConfig eight = read_board_file(BRICK_SOURCE_DIR "/boards/geobrick-lv-8.toml");
  EXPECT_EQ(eight.fitted, 0x3u);
  EXPECT_EQ(eight.dpram_words, 32768u);
  EXPECT_EQ(read_board_file(BRICK_SOURCE_DIR "/boards/turbo-pmac2-ultralite.toml").fitted, 1u << 18);
  EXPECT_EQ(read_board_file(BRICK_SOURCE_DIR "/boards/umac-turbo.toml").fitted, 0x4000Cu);
  EXPECT_EQ(read_board_file(BRICK_SOURCE_DIR "/boards/all-ics.toml").fitted, 0x3FFFFFu);
  EXPECT_EQ(fitted_ic_names(0x40403), (std::vector<std::string>{"servo IC 0", "servo IC 1", "servo IC 2*", "MACRO IC 0"}));
}

TEST(BoardFile, GoodFileHasNoError) { EXPECT_EQ(error_of(kGood), "no error"); }

TEST(BoardFile, ErrorsSayWhereWhatAndWhatWasExpected) {
  const std::string good = kGood;
  EXPECT_THAT(error_of(good + "colour = 1\n"), AllOf(HasSubstr(":5: unknown key colour"), HasSubstr("expected title, card")));
  EXPECT_THAT(error_of("card = 603382\nservo_ics = [0]\ndpram_words = 8192\n"), HasSubstr("key title is missing"));
  EXPECT_THAT(error_of("title = 1\ncard = 603382\nservo_ics = [0]\ndpram_words = 8192\n"),
              AllOf(HasSubstr(":1: title"), HasSubstr("expected")));
  EXPECT_THAT(error_of("title = \"T\"\ncard = \"603382\"\nservo_ics = [0]\ndpram_words = 8192\n"),
              AllOf(HasSubstr(":2: card"), HasSubstr("expected")));
  EXPECT_THAT(error_of("title = \"T\"\ncard = 603382\nservo_ics = [10]\ndpram_words = 8192\n"),
              AllOf(HasSubstr(":3:"), HasSubstr("expected servo IC numbers 0 to 9")));
  for (const char* item : {"\"1*\"", "\"2\"", "\"2**\"", "-1", "1.0"})
    EXPECT_THAT(error_of(std::string("title = \"T\"\ncard = 603382\nservo_ics = [") + item + "]\ndpram_words = 8192\n"),
                AllOf(HasSubstr(":3:"), HasSubstr("or \"2*\" to \"9*\"")))
        << item;
  EXPECT_THAT(error_of(good + "macro_ics = [4]\n"), AllOf(HasSubstr(":5:"), HasSubstr("expected MACRO IC numbers 0 to 3")));
  EXPECT_THAT(error_of(good + "macro_ics = [0]\nmacro_gates = [1]\n"), AllOf(HasSubstr(":6:"), HasSubstr("that macro_ics lists")));
  EXPECT_THAT(error_of("title = \"T\"\ncard = 603382\nservo_ics = [0, 0]\ndpram_words = 8192\n"), HasSubstr("twice"));
  EXPECT_THAT(error_of("title = \"T\"\ncard = 603382\nservo_ics = []\ndpram_words = 8192\n"), HasSubstr("expected a list"));
  EXPECT_THAT(error_of("title = \"T\"\ncard = 603382\nservo_ics = [0]\ndpram_words = 100\n"), HasSubstr("expected 8192 or 32768"));
  EXPECT_THAT(error_of("title = \n"), AllOf(HasSubstr(":1:"), HasSubstr("expected TOML")));
}

TEST(BoardFile, StarredIcsMacroIcsAndTheirKind) {
  const auto file = std::filesystem::path(::testing::TempDir()) / ("board_ics_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << "title = \"T\"\ncard = 603382\nservo_ics = [9, \"2*\", \"9*\"]\nmacro_ics = [0, 3]\nmacro_gates = [3]\n"
                         "dpram_words = 8192\n";
  const BoardConfig board = read_board_file(file.string());
  std::filesystem::remove(file);
  EXPECT_EQ(board.fitted, 1u << 9 | 1u << 10 | 1u << 17 | 1u << 18 | 1u << 21);
  EXPECT_EQ(board.macro_gate, 8u);
}

TEST(BoardFile, MissingFile) {
  EXPECT_THROW(read_board_file("/nonexistent/board.toml"), BoardFileError);
  EXPECT_THROW(read_board_file("/tmp"), BoardFileError);
}

}  // namespace
}  // namespace brick
