// Board files: the boards of the tree, and every way of getting one wrong.
#include "systemc/machine/board_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::path(::testing::TempDir()) / ("board_" + std::to_string(::getpid()) + ".toml")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string error_of(const std::string& text) {
  const TemporaryFile file(text);
  try {
    read_board_file(file.path());
  } catch (const UsageError& e) { return e.what(); }
  return "no error";
}

// A good file with one line taken out (`key`) and another put in at its place.
std::string with(const std::string& key, const std::string& line, const std::string& family = "any") {
  std::string text;
  for (const std::string& good :
       {std::string("title = \"T\""), "family = \"" + family + "\"", std::string("bus = \"isa\""),
        std::string("card = 603382"), std::string("servo_ics = [0]"), std::string("dpram_words = 8192")})
    text += (good.substr(0, good.find(' ')) == key ? line : good) + "\n";
  return text;
}

std::string tree(const std::string& name) { return BRICK_SOURCE_DIR "/boards/" + name + ".toml"; }

TEST(BoardFile, BoardsOfTheTree) {
  const BoardConfig four = read_board_file(tree("geobrick-lv-4"));
  EXPECT_EQ(four.fitted, 0x1u);
  EXPECT_EQ(four.name, "geobrick-lv-4");
  EXPECT_EQ(four.card, 603382u);
  EXPECT_EQ(four.axes, 4u);
  EXPECT_EQ(four.product, 0u);
  const BoardConfig eight = read_board_file(tree("geobrick-lv-8"));
  EXPECT_EQ(eight.fitted, 0x3u);
  EXPECT_EQ(eight.dpram_words, 32768u);
  EXPECT_EQ(eight.line_select, 0x951u) << "EQU1, EQU5, WDO";
  EXPECT_EQ(read_board_file(tree("turbo-pmac2-pci-lite")).line_select, 0x921u) << "EQU1, EQU2, WDO";
  const BoardConfig ultralite = read_board_file(tree("turbo-pmac2-ultralite"));
  EXPECT_EQ(ultralite.fitted, 1u << 18);
  EXPECT_EQ(ultralite.product, kProductUltralite);
  EXPECT_EQ(ultralite.line_select, 0x9BAu) << "CTRL0, CTRL1, WDO";
  const BoardConfig umac = read_board_file(tree("umac-turbo"));
  EXPECT_EQ(umac.fitted, 0x4000Cu);
  EXPECT_EQ(umac.product, kProductUmac);
  EXPECT_EQ(read_board_file(tree("all-ics")).fitted, 0x3FFFFFu);
}

TEST(BoardFile, TurboPmacHasTheControlPanelAndTheSmallDualPortedRam) {
  const BoardConfig board = read_board_file(tree("turbo-pmac-pci"));
  EXPECT_TRUE(board.jpan);
  EXPECT_EQ(board.dpram_words, 8192u);
  EXPECT_EQ(board.product, kProductTurboPmac1);
  EXPECT_FALSE(board.notes.empty()) << "its DSPGATEs are not modelled";
}

// What the key says when it is left out are outputs that are there.
TEST(BoardFile, DefaultInterruptsAreOfServoIcsThatAreFitted) {
  const std::pair<const char*, std::uint32_t> kBoards[] = {{"servo_ics = [0, 1]", 0x951},
                                                           {"servo_ics = [0]", 0x901},
                                                           {"servo_ics = [1]", 0x950},
                                                           {"servo_ics = [2]", 0x900}};
  for (const auto& [ics, select] : kBoards) {
    const TemporaryFile file(with("servo_ics", ics));
    EXPECT_EQ(read_board_file(file.path()).line_select, select) << ics;
  }
}

// host-bus:4.2, the lines that jumpers do not choose; codes as BoardInputs::line_select.
TEST(BoardFile, InterruptLinesAreThoseOfTheProduct) {
  constexpr unsigned kEqu1 = 1, kEqu2 = 2, kEqu3 = 3, kEqu5 = 5, kWdo = 9, kCtrl0 = 10, kCtrl1 = 11;
  const struct {
    const char* board;
    unsigned ir5, ir6, ir7;
  } table[] = {{"turbo-pmac2-pc", kEqu1, kEqu5, kWdo},       {"turbo-pmac2-pci", kEqu1, kEqu5, kWdo},
               {"turbo-pmac2-pci-lite", kEqu1, kEqu2, kWdo}, {"turbo-pmac2-ultralite", kCtrl0, kCtrl1, kWdo},
               {"turbo-pmac-pci", kEqu1, kEqu2, kEqu3},      {"pmac-pc", kEqu1, kEqu2, kEqu3}};
  for (const auto& row : table)
    EXPECT_EQ(read_board_file(tree(row.board)).line_select, row.ir5 | row.ir6 << 4 | row.ir7 << 8) << row.board;
}

// host-bus:4.2, last row: each jumper's choices.
TEST(BoardFile, JumpersOfATurboPmacChooseAmongItsSources) {
  const char* choices[3][4] = {
      {"EQU1", "EQU5", "AXEXP1", "MI1"}, {"EQU2", "EQU6", "AXEXP0", "MI2"}, {"EQU3", "EQU7", "EQU4", "EQU8"}};
  constexpr unsigned codes[3][4] = {{1, 5, 15, 12}, {2, 6, 14, 13}, {3, 7, 4, 8}};
  for (unsigned i = 0; i < 4; ++i) {
    const TemporaryFile file(with("servo_ics",
                                  fmt::format("servo_ics = [0, 1]\ninterrupts = [\"{}\", \"{}\", \"{}\"]",
                                              choices[0][i], choices[1][i], choices[2][i]),
                                  "turbo-pmac"));
    EXPECT_EQ(read_board_file(file.path()).line_select, codes[0][i] | codes[1][i] << 4 | codes[2][i] << 8);
  }
}

TEST(BoardFile, OneWithAnIsaBusCanHaveAn8259) {
  EXPECT_TRUE(read_board_file(tree("pmac-pc")).pic_8259);
  EXPECT_FALSE(read_board_file(tree("turbo-pmac-pci")).pic_8259);
  for (const char* bus : {"isa", "pc104"})
    EXPECT_EQ(error_of(with("bus", fmt::format("bus = \"{}\"\npic = \"8259\"", bus))), "no error");
  EXPECT_EQ(error_of(with("bus", "bus = \"pci\"\npic = \"pic\"")), "no error");
}

// host-bus:3.1, host-bus:3.7: the default of each key, what else it can be, and how one depends on another.
TEST(BoardFile, SwitchesAndWindowOfACard) {
  const auto card = [](const std::string& keys) {
    const TemporaryFile file(with("bus", "bus = \"pc104\"\n" + keys));
    return read_board_file(file.path());
  };
  const BoardConfig usual = card("");
  EXPECT_EQ(usual.io_base, 0x210u);
  EXPECT_TRUE(usual.io_decode16);
  EXPECT_EQ(usual.window, 0xD4000u);
  EXPECT_FALSE(usual.window_flat);
  EXPECT_FALSE(usual.slot8);
  EXPECT_FALSE(usual.pic_8259);
  for (const std::uint32_t base : {0x000u, 0x330u, 0xFF0u})
    EXPECT_EQ(card(fmt::format("io_base = {}", base)).io_base, base);
  EXPECT_EQ(card("io_base = 0x3F0\nio_decode = 10").io_base, 0x3F0u);
  EXPECT_FALSE(card("io_decode = 10").io_decode16);
  EXPECT_TRUE(card("io_decode = 16").io_decode16);
  EXPECT_EQ(card("dpram_window_kib = 64").window, 0xD0000u) << "the flat one has a place of its own";
  EXPECT_TRUE(card("dpram_window_kib = 64").window_flat);
  EXPECT_EQ(card("dpram_window_kib = 64\ndpram_window = 0xE0000").window, 0xE0000u);
  EXPECT_EQ(card("dpram_window = 0xFFC000").window, 0xFFC000u);
  EXPECT_EQ(card("dpram_window = 0xFC000\nslot = 8").window, 0xFC000u);
  EXPECT_TRUE(card("slot = 8").slot8);
  EXPECT_FALSE(card("slot = 16").slot8);
  const BoardConfig brick = read_board_file(tree("geobrick-lv-8"));
  EXPECT_EQ(brick.window, 0xD0000u);
  EXPECT_TRUE(brick.window_flat);
}

TEST(BoardFile, GeoPmacHasTwoAxesOnOneServoIc) {
  const BoardConfig board = read_board_file(tree("geo-pmac"));
  EXPECT_EQ(board.fitted, 1u);
  EXPECT_EQ(board.axes, 2u);
  EXPECT_TRUE(board.feedback_option_2);
  EXPECT_EQ(board.product, kProductFeedback2 | kProductGeoPmac);
  EXPECT_EQ(board.ssi_kind, kSsiGeoPmac);
  EXPECT_FALSE(board.jpan);
}

// servo-ic:11.3, servo-ic:11.4: which serial encoder inputs there are follows from the family; a Geo PMAC without the
// option has their page.
TEST(BoardFile, SerialEncoderInputsAreThoseOfTheFamily) {
  const auto kind = [](const std::string& family, const std::string& more = "") {
    const TemporaryFile file(with("bus", "bus = \"internal\"\n" + more, family));
    return read_board_file(file.path()).ssi_kind;
  };
  EXPECT_EQ(kind("geo-brick-lv"), kSsiGeoBrick);
  EXPECT_EQ(kind("geo-pmac", "feedback_option_2 = true"), kSsiGeoPmac);
  EXPECT_EQ(kind("geo-pmac"), kSsiGeoPmac | kSsiGeoBrick);
  EXPECT_EQ(kind("turbo-pmac2"), 0);
}

TEST(BoardFile, AmplifiersOfABrickAndOfAGeoPmacHoldFaultLow) {
  for (const auto& entry : std::filesystem::directory_iterator(BRICK_SOURCE_DIR "/boards")) {
    const std::string name = entry.path().stem();
    const bool low = name.rfind("geo", 0) == 0;
    EXPECT_EQ(idle_channel_pins(read_board_file(tree(name))), low ? 0xF82 & ~8 : 0xF82 | 8) << name;
  }
}

// Every file of the folder can be read and its ICs can make the clocks.
TEST(BoardFile, EveryFileOfTheTreeIsGood) {
  unsigned files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRICK_SOURCE_DIR "/boards")) {
    SCOPED_TRACE(entry.path());
    const BoardConfig board = read_board_file(entry.path().string());
    EXPECT_NE(default_clock_source(board.fitted, board.macro_gate), 0u);
    ++files;
  }
  EXPECT_GE(files, 11u);
}

TEST(BoardFile, GoodFileHasNoError) {
  EXPECT_EQ(error_of(with("", "")), "no error");
  for (const std::string& family : board_family_names()) {
    const std::string ics = family == "umac-turbo"              ? "servo_ics = [2]"
                            : family == "turbo-pmac2-ultralite" ? "servo_ics = []\nmacro_ics = [0]"
                                                                : "servo_ics = [0]";
    EXPECT_EQ(error_of(with("servo_ics", ics, family)), "no error") << family;
  }
}

TEST(BoardFile, ErrorsSayWhereWhatWasFoundAndWhatWasExpected) {
  const struct {
    const char *key, *line, *place, *found, *expected;
  } cases[] = {
      {"title", "title = 1", ":1: title:", "found 1;", "expected a text in quotes"},
      {"title", "title = \"a\\u0000b\"", ":1: title:", "found \"a\\u0000b\";", "expected a text without NUL"},
      {"title", "\"a\\u0000b\" = 1", ":1: unknown key", "a\\u0000b;", "expected title, family"},
      {"family", "family = \"vme\"", ":2: family:", "\"vme\"", "expected one of geo-brick-lv, turbo-pmac2"},
      {"bus", "bus = \"usb\"", ":3: bus:", "\"usb\"", "expected one of isa, pci, pc104, internal"},
      {"card", "card = \"603382\"", ":4: card:", "\"603382\"", "expected a card number of six digits"},
      {"card", "card = 99999", ":4: card:", "found 99999;", "expected a card number of six digits"},
      {"servo_ics", "servo_ics = 0", ":5: servo_ics:", "found 0;", "expected a list"},
      {"servo_ics", "servo_ics = [10]", ":5: servo_ics:", "found 10;", "expected servo IC numbers 0 to 9"},
      {"servo_ics", "servo_ics = [\"1*\"]", ":5: servo_ics:", "\"1*\"", "\"2*\" to \"9*\""},
      {"servo_ics", "servo_ics = [\"2\"]", ":5: servo_ics:", "\"2\"", "\"2*\" to \"9*\""},
      {"servo_ics", "servo_ics = [\"2**\"]", ":5: servo_ics:", "\"2**\"", "\"2*\" to \"9*\""},
      {"servo_ics", "servo_ics = [-1]", ":5: servo_ics:", "found -1;", "\"2*\" to \"9*\""},
      {"servo_ics", "servo_ics = [1.0]", ":5: servo_ics:", "found 1.0;", "\"2*\" to \"9*\""},
      {"servo_ics", "servo_ics = [0, 0]", ":5: servo_ics:", "found 0;", "servo IC 0 is there twice"},
      {"servo_ics", "servo_ics = [\"3*\", \"3*\"]", ":5: servo_ics:", "\"3*\"", "servo IC 3* is there twice"},
      {"servo_ics", "servo_ics = []", ":5: servo_ics:", "found []", "expected a list of one IC or more"},
      {"servo_ics", "servo_ics = [0]\nmacro_ics = [4]", ":6: macro_ics:", "found 4;",
       "expected MACRO IC numbers 0 to 3"},
      {"servo_ics", "servo_ics = [0]\nmacro_ics = [1, 1]", ":6: macro_ics:", "found 1;", "MACRO IC 1 is there twice"},
      {"servo_ics", "servo_ics = [0]\nmacro_ics = [0]\nmacro_gates = [1]", ":7: macro_gates:", "[",
       "that macro_ics lists too"},
      {"servo_ics", "servo_ics = [0]\nmacro_ics = [1]\nmacro_gates = [1, 1]", ":7: macro_gates:", "found 1;", "twice"},
      {"servo_ics", "servo_ics = []\nmacro_ics = [1]\nmacro_gates = [1]", ":7: macro_gates:", "[",
       "cannot make the servo clock"},
      {"dpram_words", "dpram_words = 100", ":6: dpram_words:", "found 100;", "expected 8192 or 32768"},
      {"dpram_words", "dpram_words = 65536", ":6: dpram_words:", "found 65536;", "expected 8192 or 32768"},
      {"dpram_words", "dpram_words = 8192.0", ":6: dpram_words:", "found 8192.0;", "expected 8192 or 32768"},
      {"bus", "bus = \"isa\"\naxes = 5", ":4: axes:", "found 5;", "expected 1 to 4"},
      {"bus", "bus = \"isa\"\naxes = 0", ":4: axes:", "found 0;", "expected 1 to 4"},
      {"bus", "bus = \"isa\"\njpan = 1", ":4: jpan:", "found 1;", "expected true or false"},
      {"bus", "bus = \"isa\"\nnotes = \"x\"", ":4: notes:", "\"x\"", "expected a list"},
      {"bus", "bus = \"isa\"\nnotes = [1]", ":4: notes:", "found 1;", "expected a text in quotes"},
      {"bus", "bus = \"isa\"\ninterrupts = [\"EQU1\"]", ":4: interrupts:", "EQU1", "expected three sources"},
      {"bus", "bus = \"isa\"\ninterrupts = [\"EQU9\", \"none\", \"WDO\"]", ":4: interrupts:", "\"EQU9\"",
       "expected none, EQU1,"},
      {"bus", "bus = \"isa\"\ninterrupts = [\"EQU1\", \"EQU5\", \"WDO\"]", ":4: interrupts:", "\"EQU5\"",
       "servo IC 1 is not fitted"},
      {"bus", "bus = \"isa\"\npic = \"8258\"", ":4: pic:", "\"8258\"", "expected one of pic, 8259"},
      {"bus", "bus = \"pci\"\npic = \"8259\"", ":4: pic:", "\"8259\"", "only a board for the isa or pc104 bus"},
      {"bus", "bus = \"isa\"\npic = 8259", ":4: pic:", "found 8259;", "expected a text in quotes"},
      {"bus", "bus = \"isa\"\nio_base = 0x218", ":4: io_base:", "found 0x218;",
       "expected a multiple of 0x10 from 0 to 0xFF0"},
      {"bus", "bus = \"isa\"\nio_base = 0x1000", ":4: io_base:", "found 0x1000;", "the eight switches"},
      {"bus", "bus = \"isa\"\nio_base = -16", ":4: io_base:", "found -16;", "from 0 to 0xFF0"},
      {"bus", "bus = \"isa\"\nio_base = \"0x210\"", ":4: io_base:", "found \"0x210\";", "a multiple of 0x10"},
      {"bus", "bus = \"isa\"\nio_decode = 10\nio_base = 0x400", ":5: io_base:", "found 0x400;",
       "expected a multiple of 0x10 from 0 to 0x3F0, as io_decode = 10 can tell apart"},
      {"bus", "bus = \"isa\"\nio_decode = 12", ":4: io_decode:", "found 12;", "expected 10 or 16"},
      {"bus", "bus = \"isa\"\ndpram_window = 0xD2000", ":4: dpram_window:", "found 0xD2000;",
       "expected a multiple of 0x4000 from 0 to 0xFFC000"},
      {"bus", "bus = \"isa\"\ndpram_window_kib = 64\ndpram_window = 0xD4000", ":5: dpram_window:", "found 0xD4000;",
       "expected a multiple of 0x10000 from 0 to 0xFF0000"},
      {"bus", "bus = \"isa\"\ndpram_window = 0x1000000", ":4: dpram_window:", "found 0x1000000;", "below 16 MiB"},
      {"bus", "bus = \"isa\"\nslot = 8\ndpram_window = 0x1D4000", ":5: dpram_window:", "found 0x1D4000;",
       "expected a multiple of 0x4000 from 0 to 0xFC000, below 1 MiB, as a slot of 8 bits has no LA"},
      {"bus", "bus = \"isa\"\ndpram_window_kib = 32", ":4: dpram_window_kib:", "found 32;", "expected 16 or 64"},
      {"bus", "bus = \"isa\"\nslot = 32", ":4: slot:", "found 32;", "expected 8 or 16"},
      {"bus", "bus = \"isa\"\nslot = true", ":4: slot:", "found true;", "expected 8 or 16"},
      {"bus", "bus = \"pci\"\nio_base = 0x210", ":4: io_base:", "found 0x210;", "only isa and pc104 boards have it"},
      {"bus", "bus = \"pci\"\nio_decode = 16", ":4: io_decode:", "found 16;", "only isa and pc104 boards have it"},
      {"bus", "bus = \"internal\"\ndpram_window = 0xD0000", ":4: dpram_window:", "found 0xD0000;",
       "only isa and pc104 boards have it"},
      {"bus", "bus = \"internal\"\ndpram_window_kib = 64", ":4: dpram_window_kib:", "found 64;",
       "only isa and pc104 boards have it"},
      {"bus", "bus = \"internal\"\nslot = 16", ":4: slot:", "found 16;", "only isa and pc104 boards have it"},
      {"title", "title = ", ":1:", "", "expected TOML"},
  };
  for (const auto& k : cases)
    EXPECT_THAT(error_of(with(k.key, k.line)),
                AllOf(HasSubstr(k.place), HasSubstr(k.found), HasSubstr(k.expected), Not(HasSubstr("\n"))))
        << k.line;
  EXPECT_THAT(error_of(with("title", "title = \"T\"\ncolour = 1")),
              AllOf(HasSubstr(":2: unknown key colour"), HasSubstr("expected title, family")));
  for (const char* key : {"title", "family", "bus", "card", "servo_ics", "dpram_words"})
    EXPECT_THAT(error_of(with(key, "")),
                AllOf(HasSubstr(std::string("key ") + key + " is missing"), HasSubstr("expected")));
}

// Boards that no product is: each breaks one rule of its family.
// Of text that people or programs have made: a stack has an end.
TEST(BoardFile, KeysHaveAnEnd) {
  const auto parts = [](unsigned count, const std::string& part) {
    std::string text = "a";
    for (unsigned i = 1; i < count; ++i) text += part;
    return text;
  };
  for (const std::string& text :
       {parts(100'000, ".a") + " = 1", "[" + parts(100'000, ".a") + "]", parts(66, " . \"b.c\"") + " = 1",
        "x = { " + parts(66, ".'a'") + " = 1 }", "x = [\"\"\"a\"\"\"\", {" + parts(66, ".a") + " = 1}]",
        "x = 'it\\'\n" + parts(66, ".a") + " = 1"})
    EXPECT_THAT(error_of(text), AllOf(HasSubstr(": a key of more than 64 parts"), HasSubstr("expected")));
  const std::string dots(100, '.');
  EXPECT_EQ(error_of(with("title", "title = \"" + dots + "\\\"\" # it's " + dots)), "no error");
  EXPECT_THAT(error_of(parts(65, ".a") + " = 1"), HasSubstr("unknown key a"));
}

TEST(BoardFile, ImpossibleBoardsAreRefused) {
  const struct {
    const char *family, *key, *line, *expected;
  } cases[] = {
      {"geo-brick-lv", "servo_ics", "servo_ics = [0, 2]",
       "found 2; expected what a geo-brick-lv can have: servo ICs 0, 1 and MACRO IC 0"},
      {"geo-brick-lv", "servo_ics", "servo_ics = [0, \"2*\"]", "expected what a geo-brick-lv can have"},
      {"geo-brick-lv", "servo_ics", "servo_ics = [0]\nmacro_ics = [1]",
       "macro_ics: found 1; expected what a geo-brick-lv can have"},
      {"geo-brick-lv", "bus", "bus = \"internal\"\njpan = true",
       "jpan: found true; expected false: a geo-brick-lv has no control panel port"},
      {"turbo-pmac2", "bus", "bus = \"isa\"\njpan = true", "a turbo-pmac2 has no control panel port"},
      {"turbo-pmac2", "servo_ics", "servo_ics = [0, \"2*\"]", "servo ICs 0 to 9 and MACRO IC 0"},
      {"turbo-pmac2", "bus", "bus = \"isa\"\nfeedback_option_2 = true", "an option of a geo-pmac only"},
      {"turbo-pmac2", "bus", "bus = \"isa\"\ninterrupts = [\"CTRL0\", \"none\", \"WDO\"]", "has no CTRL outputs"},
      {"turbo-pmac2", "bus", "bus = \"isa\"\ninterrupts = [\"MI1\", \"none\", \"WDO\"]", "has no MI or AXEXP lines"},
      {"turbo-pmac", "bus", "bus = \"isa\"\ninterrupts = [\"CTRL0\", \"none\", \"WDO\"]", "has no CTRL outputs"},
      {"turbo-pmac2-ultralite", "servo_ics", "servo_ics = [0]\nmacro_ics = [0]",
       "expected what a turbo-pmac2-ultralite can have: MACRO ICs"},
      {"umac-turbo", "servo_ics", "servo_ics = [0, 2]",
       "found 0; expected what a umac-turbo can have: servo ICs 2 to 9"},
      {"turbo-pmac", "servo_ics", "servo_ics = [0]\nmacro_ics = [0]",
       "expected what a turbo-pmac can have: servo ICs 0 to 9"},
      {"geo-pmac", "servo_ics", "servo_ics = [0, 1]", "found 1; expected what a geo-pmac can have: servo IC 0"},
  };
  for (const auto& k : cases)
    EXPECT_THAT(error_of(with(k.key, k.line, k.family)), HasSubstr(k.expected)) << k.family << " " << k.line;
}

TEST(BoardFile, StarredIcsMacroIcsAndTheirKind) {
  const TemporaryFile file(
      with("servo_ics", "servo_ics = [9, \"2*\", \"9*\"]\nmacro_ics = [0, 3]\nmacro_gates = [3]", "umac-turbo"));
  const BoardConfig board = read_board_file(file.path());
  EXPECT_EQ(board.fitted, 1u << 9 | 1u << 10 | 1u << 17 | 1u << 18 | 1u << 21);
  EXPECT_EQ(board.macro_gate, 8u);
}

TEST(BoardFile, NamesOfIcs) {
  EXPECT_EQ(fitted_ic_names(0x40403),
            (std::vector<std::string>{"servo IC 0", "servo IC 1", "servo IC 2*", "MACRO IC 0"}));
  EXPECT_EQ(servo_ic_numbers(0x40403), "0 1 2*");
  EXPECT_EQ(servo_ic_numbers(0x3FFFFF), "0-9 2*-9*");
  EXPECT_EQ(servo_ic_numbers(0x40000), "-");
  EXPECT_EQ(macro_ic_numbers(0x3FFFFF), "0-3");
  EXPECT_EQ(macro_ic_numbers(0x3), "-");
}

// servo-ic:7.1/3: servo IC 0, MACRO IC 0, servo ICs 1 to 9, 2* to 9*, MACRO ICs 1 to 3; no MACROGATE.
TEST(BoardFile, ClockSourceAfterReInitialisation) {
  constexpr std::uint32_t kMacro0 = 1u << 18, kMacro1 = 1u << 19, kStar2 = 1u << 10;
  EXPECT_EQ(default_clock_source(0x3 | kMacro0, 0), 7007u);
  EXPECT_EQ(default_clock_source(0x2 | kMacro0, 0), 6807u);
  EXPECT_EQ(default_clock_source(0x2 | kMacro0, 1), 7107u);
  EXPECT_EQ(default_clock_source(kStar2 | kMacro1, 0), 7257u);
  EXPECT_EQ(default_clock_source(kMacro1, 0), 6857u);
  EXPECT_EQ(default_clock_source(kMacro1, 2), 0u);
}

TEST(BoardFile, MissingFile) {
  EXPECT_THROW(read_board_file("/nonexistent/board.toml"), UsageError);
  EXPECT_THROW(read_board_file("/tmp"), UsageError);
}

}  // namespace
}  // namespace brick
