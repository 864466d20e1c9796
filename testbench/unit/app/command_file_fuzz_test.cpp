// Random text through everything that reads what others wrote, under the sanitizers: command files and replies. It must
// end, in order or with an error that says what was expected; what is sent never exceeds the controller's line by a
// macro.
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "app/script.h"
#include "systemc/core/usage_error.h"
#include "testbench/fuzz/target.h"
#include "testbench/host/framing_probe.h"
#include "testbench/host/reply_parser.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

template <std::size_t N>
std::string random_text(std::mt19937& random, const char* const (&pieces)[N], std::size_t most) {
  std::string text;
  for (std::size_t count = random() % most; count > 0; --count)
    text += random() % 16 == 0 ? std::string(1, static_cast<char>(random())) : std::string(pieces[random() % N]);
  return text;
}

TEST(CommandFileFuzz, EndsInOrderOrWithAnErrorThatSaysWhatWasExpected) {
  static const char* const kPieces[] = {"#define ",    "#define A",   "#define B(x,y) ",
                                        "#undef ",     "#ifdef ",     "#ifndef ",
                                        "#else\n",     "#endif\n",    "#include \"job.txt\"\n",
                                        "#include ",   "A",           "B",
                                        "B(",          "x",           "y",
                                        ")",           "(",           ",",
                                        "\"",          " ",           "\n",
                                        "\n",          "\n",          ";",
                                        "//",          "/*",          "*/",
                                        "#1->",        "1000X",       "@expect ",
                                        "@wait 1ms\n", "@dpram ",     "@until a=",
                                        "@pic MSK=",   "@jpan FPD=",  "^A",
                                        "^",           "$",           "=",
                                        "I16",         "A B A(A,B) ", "#define A B B\n#define B A\n"};
  std::mt19937 random(random_seed(12));
  unsigned read = 0, refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = random_text(random, kPieces, 60);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    std::istringstream in(text);
    try {
      read += static_cast<unsigned>(read_script(in, "fuzz.pmc").size());
    } catch (const UsageError&) { ++refused; }
  }
  EXPECT_GT(read, 5'000u);
  EXPECT_GT(refused, 5'000u);
}

TEST(ReplyFuzz, EndsWhateverTheControllerSends) {
  static const char* const kPieces[] = {"\x06", "\x07", "\n", "\r", "\x02", "ERR003\r", "25\r",
                                        // NOLINTNEXTLINE(bugprone-suspicious-missing-comma): one line of eight words
                                        "850000000000 050000000000 050000000000 050000000000 "
                                        "050000000000 050000000000 050000000000 050000000000\r",
                                        "\x07"
                                        "ERR",
                                        "t", "u"};
  std::mt19937 random(random_seed(13));
  unsigned complete = 0, asked = 0;
  for (int i = 0; i < 50'000; ++i) {
    const Framing framing{static_cast<unsigned>(random() % 4), static_cast<unsigned>(random() % 2)};
    ReplyParser parser(framing, static_cast<std::uint8_t>(random() % 3 == 0 ? 'u' : random()),
                       static_cast<ReplyParser::Mixed>(random() % 4));
    const std::string text = random_text(random, kPieces, 12);
    asked += framing_answers(text, random() % 4).size();
    (void)may_change_framing(text);
    for (const char c : text) {
      if (parser.complete()) break;
      parser.take(static_cast<std::uint8_t>(c));
    }
    complete += parser.quiet() ? 1 : 0;
    EXPECT_LE(parser.reply().raw.size(), text.size());
    EXPECT_EQ(parser.reply().complete, parser.complete());
  }
  EXPECT_GT(complete, 20'000u);
  EXPECT_GT(asked, 500u);
}

}  // namespace
}  // namespace brick
