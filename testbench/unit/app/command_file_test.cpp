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

// It is all up to the line's end, as the controller takes it: no comment, no macro.
TEST(CommandFile, PasswordsStayAsTheyAre) {
  EXPECT_THAT(lines("#define X 7\nPASSWORD=a;b\nP1=X Password =a//X/*\t; \n/* a */ PASSWORD=\"X;\nP2=X ; rest\n"),
              ElementsAre("job.pmc:2 PASSWORD=a;b", "job.pmc:3 P1=7 Password =a//X/* ;", "job.pmc:4 PASSWORD=\"X;",
                          "job.pmc:5 P2=7"));
  EXPECT_THAT(lines("#define X 7\nPASSWORD=X\nX\n"), ElementsAre("job.pmc:2 PASSWORD=X", "job.pmc:3 7"));
  EXPECT_THAT(lines("#define X 7\nSEND\"PASSWORD=\" P1=X ; rest\nPASSWORD X ;\n; PASSWORD=\n/* PASSWORD= */X// a\n"),
              ElementsAre("job.pmc:2 SEND\"PASSWORD=\" P1=7", "job.pmc:3 PASSWORD 7", "job.pmc:5 7"));
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
  EXPECT_THAT(lines("#ifdef A\n#include \"none\"\n#pragma\n#define 1\n@expect x\nX /* \n#endif\n*/\n#endif\nY"),
              ElementsAre("job.pmc:10 Y"));
  EXPECT_THAT(
      lines("#ifdef A\n#if 0\nX\n#elif defined(B)\nX\n#else 1\nX\n#endif B\nX\n#ifdef 1\nX\n#endif\n#else\nY\n#endif"),
      ElementsAre("job.pmc:14 Y"))
      << "where nothing is chosen, conditions are counted";
}

TEST(CommandFile, ExpectedTextsStayAsTheyAre) {
  EXPECT_THAT(
      lines("#define P1 P2\nP1\n  @expect P1;1 // 2 \r\n@expect\n@wait P1 ; so long\n/*\n@expect 1\n*/\n@expected P1"),
      ElementsAre("job.pmc:2 P2", "job.pmc:3 @expect P1;1 // 2 ", "job.pmc:4 @expect", "job.pmc:5 @wait P2",
                  "job.pmc:9 @expected P2"));
}

TEST(CommandFile, ExpectedTextsMayStandBehindComments) {
  EXPECT_THAT(lines("/* so */ @expect 1;2\n/* over\nlines *//**/ @expect /* 3 */\n/* @expect 4\n*/@wait 1ms ; 5"),
              ElementsAre("job.pmc:1 @expect 1;2", "job.pmc:3 @expect /* 3 */", "job.pmc:5 @wait 1ms"));
  EXPECT_THAT(error_of("/* @expect 4"), StartsWith("job.pmc:1: a comment without its end"));
}

TEST(CommandFile, LinesEndAsOnEverySystem) {
  EXPECT_THAT(lines("I16\r\rI17\r\nI18\n\n\rI19\r"),
              ElementsAre("job.pmc:1 I16", "job.pmc:3 I17", "job.pmc:4 I18", "job.pmc:7 I19"));
  EXPECT_THAT(lines("I16\r;all\rI17;rest\r#ifdef A\rX\r#endif"), ElementsAre("job.pmc:1 I16", "job.pmc:3 I17"));
  EXPECT_THAT(lines("I16\r\n\x1A"), ElementsAre("job.pmc:1 I16")) << "the end of a text of DOS";
  EXPECT_THAT(lines("P1=1\fP2=2\vP3=3"), ElementsAre("job.pmc:1 P1=1 P2=2 P3=3"))
      << "the controller would take them for ^L and ^K";
}

TEST(CommandFile, MessagesAreShortAndReadable) {
  const std::string endless(1 << 16, 'X');
  for (const std::string& bad :
       {"#include " + endless, "#include \"" + endless + "\"", "#define 1" + endless, "#define " + endless + "(",
        "#define A(" + endless + ",B)\nA(1)", "#define A(" + endless + ")\nA", "#undef A " + endless,
        "#ifdef A " + endless, "#ifdef A\n#endif " + endless, "#define " + endless + " " + endless + "\n" + endless,
        "#define A B\nA" + endless + " A"})
    EXPECT_LT(error_of(bad).size(), 700u) << bad.substr(0, 20);
  EXPECT_THAT(error_of("#ifdef \x1B[2J\xFF"), HasSubstr("`<1B>[2J<FF>`"));
}

TEST(CommandFile, NeverLengthensALineBeyondTheControllersLine) {
  const std::string l100(100, 'X'), define = "#define L " + l100 + "\n";
  EXPECT_EQ(lines(define + "L" + std::string(155, ' ') + "\nL=" + std::string(154, '1')).size(), 2u);
  EXPECT_THAT(error_of(define + "L=" + std::string(155, '1')),
              AllOf(StartsWith("job.pmc:2: `L="), HasSubstr("expands to 256 characters; expected at most 255")));
  std::string words = "#define L 1234\n@dpram 0 =";
  for (int i = 0; i < 60; ++i) words += " L";
  EXPECT_EQ(lines(words).size(), 1u) << "@ lines are not the controller's";
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
  EXPECT_EQ(error_of("#if 1\n#endif"), "job.pmc:1: `#if` is not known; expected #ifdef or #ifndef");
  for (const char* define : {"", "#define A"})
    EXPECT_EQ(
        error_of(std::string(define) + "\n#ifdef A\n#ifdef B\n#elif 1\n#endif\n#elif 1\n#endif"),
        std::string("job.pmc:") + (*define == 0 ? "6" : "4") + ": `#elif` is not known; expected #ifdef or #ifndef");
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
  write("guarded.pmc", "#ifndef G\n#define G\n#include \"guarded.pmc\"\nI16\n#endif\n");
  EXPECT_EQ(lines("#include \"guarded.pmc\"", job).size(), 1u);
  write("d0.pmc", "I16");
  for (int i = 1; i <= 16; ++i)
    write("d" + std::to_string(i) + ".pmc", "#include \"d" + std::to_string(i - 1) + ".pmc\"\n");
  EXPECT_EQ(lines("#include \"d15.pmc\"", job).size(), 1u);
  EXPECT_THAT(error_of("#include \"d16.pmc\"", job),
              HasSubstr("`" + folder + "d0.pmc` is included 17 deep; expected at most 16"));
  write("f0.pmc", "");
  for (int i = 1; i <= 12; ++i) {
    const std::string one = "#include \"f" + std::to_string(i - 1) + ".pmc\"\n";
    write("f" + std::to_string(i) + ".pmc", one + one);
  }
  EXPECT_THAT(error_of("#include \"f12.pmc\"", job), HasSubstr("is one file too many; expected at most 1000"));
  EXPECT_EQ(error_of("#include \"f8.pmc\"", job), "no error");
}

// Lines that remain are counted, in each file as often as it is included: 999 times 1001 lines are 999,999.
TEST_F(Includes, BringAMillionLinesAtMost) {
  std::string many, includes = "\n";
  for (int i = 0; i < 1001; ++i) many += "I1\n;\n";
  for (int i = 0; i < 999; ++i) includes += "#include \"many.pmc\"\n";
  write("many.pmc", many);
  std::istringstream most(includes + "@expect 1\n");
  EXPECT_EQ(read_command_file(most, job).size(), 1'000'000u);
  EXPECT_EQ(error_of("I1\nI1" + includes, job),
            folder +
                "many.pmc:2001: `I1` is one line too many; expected at most 1000000, those of included files each "
                "time (included at " +
                job + ":1001)");
}

// `..` behind a link is the folder above the one that the link leads to; a file is itself under every name.
TEST_F(Includes, FollowSymbolicLinks) {
  namespace fs = std::filesystem;
  fs::create_directories(folder + "far/deep");
  write("far/names.pmc", "#define HEIGHT Q7\n");
  write("names.pmc", "#define HEIGHT Q8\n");
  fs::create_directory_symlink("far/deep", folder + "link");
  EXPECT_THAT(lines("#include \"link/../names.pmc\"\nHEIGHT", job), ElementsAre(job + ":2 Q7"));
  EXPECT_THAT(lines("#include \"lib/../names.pmc\"\nHEIGHT", job), ElementsAre(job + ":2 Q8"));
  write("far/bad.pmc", "#endif\n");
  EXPECT_THAT(error_of("#include \"link/../bad.pmc\"", job), StartsWith(folder + "link/../bad.pmc:1: "));
  write("one.pmc", "#include \"two.pmc\"\n");
  fs::create_symlink("one.pmc", folder + "two.pmc");
  EXPECT_THAT(error_of("#include \"one.pmc\"", job), HasSubstr("includes itself again and again"));
  fs::create_symlink("three.pmc", folder + "three.pmc");
  EXPECT_THAT(error_of("#include \"three.pmc\"", job), HasSubstr("three.pmc` cannot be read; expected"));
}

TEST_F(Includes, AreFilesWithAnEnd) {
  std::ifstream endless("/dev/zero");
  std::string error;
  try {
    read_command_file(endless, "zero");
  } catch (const UsageError& e) { error = e.what(); }
  EXPECT_EQ(error, "zero:1: the text is too long; expected at most 64 MiB in all files");
  std::ifstream broken("/proc/self/mem");  // whose first page cannot be read
  try {
    read_command_file(broken, "mem");
  } catch (const UsageError& e) { error = e.what(); }
  EXPECT_EQ(error, "mem:1: the file cannot be read to its end; expected a readable command file");
  EXPECT_THAT(error_of("#include \"/dev/zero\"", job), HasSubstr("cannot be read")) << "no regular file";
}

}  // namespace
}  // namespace brick
