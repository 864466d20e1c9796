// Command files: what of them is sent, and that every error says file and line, what, and what was expected.
#include "app/command_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> lines(const std::string& text, const std::string& file = "job.pmc") {
  std::istringstream in(text);
  std::vector<std::string> found;
  for (const SourceLine& line : read_command_file(in, file)) found.push_back(line.place + " " + line.text);
  return found;
}

std::string error_of(const std::string& text, const std::string& file = "job.pmc") {
  try {
    lines(text, file);
  } catch (const UsageError& e) { return e.what(); }
  return "no error";
}

TEST(CommandFile, LeavesCommentsOut) {
  EXPECT_THAT(
      lines("; all\nP1=1 ; rest\n\tP2=2// rest\r\n//\nP3=/* in */3/**/\n\n/* over\n; P9=9 // \"\nlines */ P4=4\n"),
      ElementsAre("job.pmc:2 P1=1", "job.pmc:3 P2=2", "job.pmc:5 P3= 3", "job.pmc:9 P4=4"));
  EXPECT_THAT(lines("SEND\"a;b//c/*d\";x\n;; \\file /* no comment\nP1=1\n#1J/ ;\n"),
              ElementsAre("job.pmc:1 SEND\"a;b//c/*d\"", "job.pmc:3 P1=1", "job.pmc:4 #1J/"));
  EXPECT_THAT(lines("P1=1\tP2=2\nSEND\"a\tb\"\n"), ElementsAre("job.pmc:1 P1=1 P2=2", "job.pmc:2 SEND\"a b\""));
  EXPECT_THAT(lines("\xEF\xBB\xBFI16"), ElementsAre("job.pmc:1 I16"));
}

TEST(CommandFile, MotorsAreNoDirectives) {
  const char* text = "#1->1000X\n#1j+\n#3p\n#\n##1\n#5?\n#4->I\n# 2 J/\n#1HOME\n#defined\n";
  EXPECT_EQ(lines(text).size(), 10u);
  EXPECT_EQ(lines(text)[0], "job.pmc:1 #1->1000X");
}

TEST(CommandFile, ChoosesByConditions) {
  const std::string text =
      "#ifdef BRICK\n A1\n#ifndef OTHER\n A2\n#else\n A3\n#endif\n#else\n B1\n#define X 1\n#ifdef X\n B2\n#endif\n"
      "#frob is no directive here\n#endif\n";
  EXPECT_THAT(lines(text), ElementsAre("job.pmc:9 B1", "job.pmc:12 B2", "job.pmc:14 #frob is no directive here"));
  EXPECT_THAT(lines("#DEFINE BRICK\n" + text), ElementsAre("job.pmc:3 A1", "job.pmc:5 A2"));
  EXPECT_THAT(lines("#define BRICK ; yes\n# Define OTHER\n" + text), ElementsAre("job.pmc:4 A1", "job.pmc:8 A3"));
  EXPECT_THAT(lines("#define A 1\n#undef A\n#ifdef A\nX\n#else\n#ifdef A\nX\n#else\nY\n#endif\n#endif"),
              ElementsAre("job.pmc:9 Y"));
  EXPECT_THAT(lines("#ifdef A\n#include \"none\"\n#if 0\n#define 1\n@expect x\nX /* \n#endif\n*/\n#endif\nY"),
              ElementsAre("job.pmc:10 Y"));
}

TEST(CommandFile, ExpectedTextsStayAsTheyAre) {
  EXPECT_THAT(
      lines("#define P1 P2\nP1\n@expect P1;1 // 2\n@expect\n@wait P1 ; so long\n/*\n@expect 1\n*/\n@expected P1"),
      ElementsAre("job.pmc:2 P2", "job.pmc:3 @expect P1;1 // 2", "job.pmc:4 @expect", "job.pmc:5 @wait P2",
                  "job.pmc:9 @expected P2"));
}

TEST(CommandFile, NeverLengthensALineBeyondTheControllersLine) {
  const std::string l100(100, 'X'), define = "#define L " + l100 + "\n";
  EXPECT_EQ(lines(define + "L" + std::string(155, ' ') + "\nL=" + std::string(154, '1')).size(), 2u);
  EXPECT_THAT(error_of(define + "L=" + std::string(155, '1')),
              AllOf(StartsWith("job.pmc:2: `L="), HasSubstr("expands to 256 characters; expected at most 255")));
  EXPECT_EQ(lines(std::string(300, 'X')).size(), 1u) << "what the user wrote himself is the controller's to refuse";
}

TEST(CommandFile, ErrorsSayWhereWhatAndWhatWasExpected) {
  for (const char* bad : {"#include", "#include none.pmc", "#include \"/\"", "#include \"a\"b\"", "#define",
                          "#define 1 2", "#undef", "#undef A B", "#ifdef", "#ifdef A B", "#else", "#endif", "#if 1",
                          "#elif A", "#error no", "#pragma once", "/* never\n ends", "#ifdef A\nX", "#define A\x01 1"})
    EXPECT_THAT(error_of(std::string("VERSION\n") + bad), AllOf(StartsWith("job.pmc:2: "), HasSubstr("expected")))
        << bad;
  EXPECT_THAT(error_of(std::string("I16\n\0I\0", 7)), StartsWith("job.pmc:2: a NUL byte")) << "UTF-16, for example";
  EXPECT_THAT(error_of("#ifdef A\n#else\n#else\n#endif"),
              StartsWith("job.pmc:3: a second #else; expected #endif of the condition in line 1"));
  EXPECT_THAT(error_of("#ifdef A\n#endif B"), StartsWith("job.pmc:2: `B` behind #endif"));
  EXPECT_THAT(error_of("#define A(x) x\nP1=A"), StartsWith("job.pmc:2: macro `A` without arguments; expected A(x)"));
}

class Includes : public ::testing::Test {
 protected:
  Includes() { std::filesystem::create_directories(folder + "lib"); }
  ~Includes() override { std::filesystem::remove_all(folder); }
  void write(const std::string& file, const std::string& text) { std::ofstream(folder + file) << text; }

  std::string folder =
      ::testing::TempDir() + "brick_includes_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
  std::string job = folder + "job.pmc";
};

TEST_F(Includes, AreFoundFromTheFileThatNamesThem) {
  write("lib/axes.pmc", "#include \"names.pmc\"\nHEIGHT=1\n");
  write("lib/names.pmc", "#define HEIGHT Q7\n#include ..\\last.pmc\n");
  write("last.pmc", "&1\n");
  EXPECT_THAT(lines("#include \"lib\\axes.pmc\" ; with the names\nHEIGHT\n", job),
              ElementsAre(folder + "last.pmc:1 &1", folder + "lib/axes.pmc:2 Q7=1", job + ":2 Q7"));
}

TEST_F(Includes, ErrorsSayWhichFileAndWhoIncludedIt) {
  write("lib/bad.pmc", "P1=1\n#include \"worse.pmc\"\n");
  write("lib/worse.pmc", "\n\n#endif\n");
  EXPECT_EQ(error_of("\n#include \"lib/bad.pmc\"", job),
            folder + "lib/worse.pmc:3: #endif without a beginning; expected #ifdef or #ifndef before it (included at " +
                folder + "lib/bad.pmc:2)");
  write("lib/open.pmc", "#ifdef A\n");
  EXPECT_THAT(error_of("#include \"lib/open.pmc\"\n#endif", job),
              HasSubstr("lib/open.pmc:1: a condition without its end"));
}

TEST_F(Includes, AreBounded) {
  write("self.pmc", "#include \"self.pmc\"\n");
  EXPECT_THAT(error_of("#include \"self.pmc\"", job),
              AllOf(StartsWith(folder + "self.pmc:1: "), HasSubstr("expected no file that includes itself")));
  write("f0.pmc", "");
  for (int i = 1; i <= 12; ++i) {
    const std::string one = "#include \"f" + std::to_string(i - 1) + ".pmc\"\n";
    write("f" + std::to_string(i) + ".pmc", one + one);
  }
  EXPECT_THAT(error_of("#include \"f12.pmc\"", job), HasSubstr("is one file too many; expected at most 1000"));
  EXPECT_EQ(error_of("#include \"f8.pmc\"", job), "no error");
}

}  // namespace
}  // namespace brick
