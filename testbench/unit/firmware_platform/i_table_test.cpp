// Every I-variable against the tables of firmware:2, firmware:3 and firmware:1.11, written down here a second time:
// range, factory value, form of the report, lock group, and the full read-out that backup clients make.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/variables/i_table.h"
#include "firmware/variables/i_variables.h"
}

namespace brick {
namespace {

constexpr unsigned kGeoBrick = 0x3, kMacroIc0 = 1u << 18, kCount = 8192;

// Ranges by the number of bits: u8 is 0..255, s16 -32768..32767; real has none.
struct Rule {
  unsigned first, last;
  char kind;
  int bits;
  double value;
};

const std::vector<Rule> kGlobal = {
    {0, 0, 'u', 4, 0},      {1, 1, 'u', 2, 0},      {2, 2, 'u', 2, 1},          {3, 3, 'u', 2, 1},
    {4, 4, 'u', 2, 0},      {5, 5, 'u', 2, 0},      {6, 6, 'u', 2, 3},          {7, 7, 'u', 8, 0},
    {8, 8, 'u', 8, 2},      {9, 9, 'u', 2, 2},      {10, 10, 'u', 23, 3713991}, {11, 11, 'u', 23, 0},
    {12, 15, 'u', 1, 0},    {16, 16, 'u', 23, 5},   {17, 18, 'u', 23, 10},      {30, 30, 'u', 1, 0},
    {35, 36, 'u', 1, 0},    {39, 39, 'u', 3, 0},    {69, 69, 'u', 24, 0},       {37, 37, 'u', 24, 0},
    {40, 40, 'u', 16, 0},   {41, 41, 'u', 4, 0},    {42, 45, 'u', 1, 0},        {46, 46, 'u', 2, 0},
    {47, 47, 'u', 8, 0},    {48, 49, 'u', 1, 0},    {50, 50, 'u', 8, 0},        {51, 51, 'u', 1, 0},
    {52, 52, 'u', 5, 7},    {53, 54, 'u', 4, 12},   {55, 58, 'u', 1, 0},        {59, 59, 'u', 2, 0},
    {60, 60, 'u', 4, 15},   {61, 61, 'u', 8, 8},    {62, 62, 'u', 1, 0},        {63, 63, 'u', 1, 1},
    {64, 64, 'u', 1, 0},    {65, 65, 'u', 24, 0},   {66, 66, 'u', 1, 0},        {67, 67, 'u', 18, 0},
    {68, 68, 'u', 4, 15},   {70, 77, 'u', 16, 0},   {78, 78, 'u', 8, 0},        {79, 79, 'u', 8, 32},
    {80, 82, 'u', 8, 0},    {83, 83, 'u', 4, 0},    {84, 84, 'u', 2, 0},        {85, 85, 'u', 8, 0},
    {90, 90, 'u', 8, 0x39}, {91, 91, 'u', 8, 0x4},  {92, 92, 'u', 8, 0xFF},     {93, 93, 'u', 8, 0x7F},
    {94, 94, 'u', 8, 0xA0}, {95, 95, 'u', 8, 0x7},  {96, 96, 'u', 8, 0xA1},     {97, 97, 'u', 8, 0},
    {98, 98, 'u', 8, 0x60}, {99, 99, 'u', 8, 0x30},
};

// Without those that depend on motor and board: Ixx00, 02 to 04, 24, 25, 83.
const std::vector<Rule> kMotor = {
    {1, 1, 'u', 2, 0},          {5, 5, 'u', 24, 0x35C0},  {6, 6, 'u', 2, 0},        {7, 7, 's', 24, 96},
    {8, 9, 'u', 23, 96},        {10, 10, 'u', 24, 0},     {11, 11, 'u', 23, 32000}, {12, 12, 'u', 23, 16000},
    {13, 14, 'f', 0, 0},        {15, 15, 'f', 0, 0.25},   {16, 16, 'f', 0, 32},     {17, 17, 'f', 0, 0.015625},
    {19, 19, 'f', 0, 0.015625}, {20, 20, 'u', 23, 0},     {21, 21, 'u', 23, 50},    {22, 23, 'f', 0, 32},
    {26, 26, 's', 24, 0},       {27, 27, 'f', 0, 0},      {28, 28, 'u', 23, 160},   {29, 29, 's', 16, 0},
    {30, 30, 's', 24, 2000},    {31, 32, 's', 24, 1280},  {33, 33, 'u', 23, 0},     {34, 34, 'u', 1, 1},
    {35, 35, 's', 24, 0},       {36, 40, 'f', 0, 0},      {41, 41, 'u', 23, 0},     {42, 43, 'u', 24, 0},
    {55, 55, 'u', 24, 0},       {56, 56, 'f', 0, 0},      {57, 57, 's', 16, 0},     {58, 58, 'u', 23, 0},
    {59, 59, 'u', 2, 0},        {60, 60, 'u', 8, 0},      {61, 62, 'f', 0, 0},      {63, 63, 's', 24, 4194304},
    {64, 64, 's', 24, 0},       {65, 65, 's', 24, 16},    {66, 66, 'u', 15, 6527},  {67, 67, 'u', 23, 4194304},
    {68, 68, 'u', 15, 0},       {69, 69, 'u', 15, 20480}, {70, 70, 'u', 8, 1},      {71, 71, 'u', 24, 1000},
    {72, 72, 'u', 11, 1365},    {73, 73, 's', 16, 0},     {74, 74, 'u', 8, 0},      {77, 77, 's', 16, 0},
    {78, 78, 'f', 0, 0},        {79, 79, 's', 16, 0},     {85, 85, 'u', 23, 0},     {75, 75, 'u', 24, 0},
    {76, 76, 'f', 0, 0},        {80, 80, 'u', 3, 0},      {81, 82, 'u', 24, 0},     {84, 84, 'u', 24, 0},
    {86, 86, 's', 24, 0},       {87, 87, 's', 24, 64},    {88, 88, 'u', 8, 0},      {90, 90, 'u', 1, 0},
    {91, 91, 'u', 24, 0},       {92, 92, 'u', 23, 10},    {95, 95, 'u', 24, 0},     {96, 97, 'u', 2, 0},
};

// Without the timers Isx11, Isx12 and without Isx93.
const std::vector<Rule> kSystem = {
    {13, 13, 'u', 8, 0},     {14, 16, 'f', 0, 0},  {20, 20, 'u', 16, 0},
    {21, 21, 'u', 4, 0},     {50, 50, 'u', 1, 0},  {53, 53, 'u', 2, 0},
    {78, 78, 'f', 0, 0},     {79, 79, 'u', 23, 0}, {81, 82, 'u', 23, 0},
    {83, 86, 'f', 0, 0},     {87, 87, 'u', 23, 0}, {88, 88, 'u', 23, 50},
    {89, 90, 'f', 0, 1000},  {91, 91, 'u', 15, 0}, {92, 92, 'u', 1, 0},
    {94, 95, 'u', 23, 1644}, {96, 98, 'f', 0, 0},  {99, 99, 'f', 0, 32763.0 / 32768.0},
};

const std::vector<Rule> kExtendedServo = {{0, 0, 'u', 1, 0}, {1, 49, 'f', 0, 0}};

// Ranges of those whose factory values depend on motor, system or board.
const std::vector<Rule> kFound = {{20, 24, 'u', 24, 0}};
const std::vector<Rule> kMotorFound = {
    {0, 0, 'u', 1, 0}, {2, 4, 'u', 24, 0}, {24, 25, 'u', 24, 0}, {83, 83, 'u', 24, 0}};
const std::vector<Rule> kSystemFound = {{11, 12, 's', 24, 0}, {93, 93, 'u', 24, 0}};

// Data gathering. The ring of ADCs from 61 on belongs to motors on a MACRO IC: 0 on a Geo Brick.
const std::vector<Rule> kGather = {{0, 0, 'u', 2, 0},    {1, 48, 'u', 24, 0},  {49, 49, 'u', 23, 0},
                                   {50, 51, 'u', 24, 0}, {61, 76, 'u', 24, 0}, {81, 96, 'u', 24, 0}};

// Of an IC, firmware:2.3, as wide as the fields of servo-ic:2.5; those of channel 2: the compare of channel 1 is fixed.
const std::vector<Rule> kIc = {{0, 0, 'u', 15, 6527},    {1, 1, 'u', 4, 0},  {2, 2, 'u', 4, 3},
                               {3, 3, 'u', 12, 2258},    {4, 4, 'u', 8, 15}, {5, 5, 'u', 24, 0x7FFFC0},
                               {6, 6, 'u', 24, 0xFFFFFE}};
const std::vector<Rule> kChannel2 = {{20, 20, 'u', 4, 7}, {21, 21, 'u', 1, 0}, {22, 22, 'u', 4, 1}, {23, 23, 'u', 2, 0},
                                     {24, 24, 'u', 1, 0}, {25, 27, 'u', 2, 0}, {28, 29, 'u', 1, 0}};
// A MACRO IC's two channels have fewer fields; no ring is modelled, its control words are stored. firmware:1.11
const std::vector<Rule> kMacroChannel2 = {{20, 20, 'u', 4, 7}, {21, 21, 'u', 1, 0},       {22, 22, 'u', 4, 1},
                                          {23, 23, 'u', 2, 0}, {24, 25, 'u', 1, 0},       {27, 27, 'u', 2, 0},
                                          {28, 28, 'u', 1, 0}, {40, 40, 'u', 24, 0x4000}, {41, 41, 'u', 24, 0}};

bool among(unsigned number, std::initializer_list<std::pair<unsigned, unsigned>> runs) {
  for (const auto& run : runs)
    if (number >= run.first && number <= run.second) return true;
  return false;
}

// firmware:1.6, the set that the factory dump shows in hexadecimal; ICs `macro` and `servo` as fitted.
bool is_address(unsigned number, bool macro, unsigned servo) {
  if (number < 100) return among(number, {{20, 24}, {37, 37}, {67, 67}, {69, 77}, {90, 99}});
  if (number < 3300)
    return among(number % 100, {{2, 5}, {10, 10}, {24, 25}, {42, 43}, {55, 55}, {81, 84}, {91, 91}, {95, 95}});
  if (number >= 5100 && number < 6700) return number % 100 == 93;
  if (number >= 6800 && number < 6850) return macro && among(number, {{6805, 6806}, {6840, 6841}});
  if (number >= 7000 && number < 8000)
    return number % 100 < 50 && (number - 7000) / 100 < servo && among(number % 50, {{5, 6}});
  return among(number,
               {{4900, 4904}, {4908, 4908}, {5001, 5048}, {5050, 5051}, {5061, 5076}, {5081, 5096}, {8000, 8191}});
}

std::vector<std::string> lines_of(const std::string& joined) {
  std::vector<std::string> lines;
  std::size_t from = 0;
  while (from <= joined.size() && !joined.empty()) {
    const std::size_t to = std::min(joined.find('|', from), joined.size());
    lines.push_back(joined.substr(from, to - from));
    from = to + 1;
  }
  return lines;
}

// All of them, by blocks of a hundred as backup clients ask.
std::vector<std::string> read_out(Controller& c, const std::string& letter, const std::string& behind = "") {
  std::vector<std::string> all;
  for (unsigned first = 0; first < kCount; first += 100) {
    const unsigned last = std::min(first + 99, kCount - 1);
    const auto lines = lines_of(c.line(letter + std::to_string(first) + ".." + std::to_string(last) + behind));
    EXPECT_EQ(lines.size(), last - first + 1) << letter << first;
    all.insert(all.end(), lines.begin(), lines.end());
  }
  return all;
}

TEST(ITable, DefaultsAreThoseOfTheDataSheet) {
  BRICK_COVERS("I17-1 I18-1");
  Controller c;
  unsigned checked = 0;
  const auto check = [&checked](unsigned base, const std::vector<Rule>& rules) {
    for (const Rule& rule : rules)
      for (unsigned n = rule.first; n <= rule.last; ++n, ++checked)
        EXPECT_EQ(i_variable_default(base + n), rule.value) << "I" << base + n;
  };
  check(0, kGlobal);
  for (unsigned motor = 1; motor <= 32; ++motor) check(100 * motor, kMotor);
  for (unsigned system = 0; system < 16; ++system) check(5100 + 100 * system, kSystem);
  for (unsigned motor = 0; motor < 32; ++motor) check(3300 + 50 * motor, kExtendedServo);
  check(5000, kGather);
  for (const unsigned ic : {7000u, 7100u}) {
    check(ic, kIc);
    check(ic, kChannel2);
  }
  EXPECT_GT(checked, 32u * 60 + 16 * 20 + 60 + 1600);
  for (unsigned number = 0; number < kCount; ++number) {
    const bool settings = number == 3 || number == 6;  // the fixture is a client
    const bool timer = number >= 5100 && number < 6700 && (number % 100 == 11 || number % 100 == 12);
    if (!settings && !timer) { EXPECT_EQ(i_variable_read(number), i_variable_default(number)) << "I" << number; }
  }
}

TEST(ITable, IntegersWrapAtTheRangesOfTheDataSheet) {
  BRICK_COVERS("I17-1 I18-1");
  const auto check = [](unsigned number, const Rule& rule) {
    if (rule.kind == 'f') {
      i_variable_write(number, -1234.5);
      EXPECT_EQ(i_variable_read(number), -1234.5) << "I" << number;
      return;
    }
    const double size = static_cast<double>(1ll << rule.bits);
    const double lowest = rule.kind == 's' ? -size / 2 : 0;
    for (const double value : {lowest, lowest + size - 1}) {  // both ends, and one too far
      i_variable_write(number, value);
      EXPECT_EQ(i_variable_read(number), value) << "I" << number;
    }
    i_variable_write(number, lowest + size);
    EXPECT_EQ(i_variable_read(number), lowest) << "I" << number;
    i_variable_write(number, lowest - 1);
    EXPECT_EQ(i_variable_read(number), lowest + size - 1) << "I" << number;
  };
  Controller c;
  const auto all = [&check](unsigned base, const std::vector<Rule>& rules) {
    for (const Rule& rule : rules)
      for (unsigned n = rule.first; n <= rule.last; ++n)
        if (base + n != 41) check(base + n, rule);  // the locks, below
  };
  all(0, kGlobal);
  all(0, kFound);
  for (const unsigned motor : {1u, 17u, 32u}) {
    all(100 * motor, kMotor);
    all(100 * motor, kMotorFound);
  }
  for (const unsigned system : {0u, 15u}) {
    all(5100 + 100 * system, kSystem);
    all(5100 + 100 * system, kSystemFound);
  }
  for (unsigned motor = 0; motor < 32; ++motor) all(3300 + 50 * motor, kExtendedServo);
  all(5000, kGather);
  all(7100, kIc);
  all(7100, kChannel2);
  all(8000, {{0, 191, 'u', 24, 0}});
  Controller macro(kMacroIc0);
  all(6800, kIc);
  all(6800, kMacroChannel2);
}

// Every number has a rule here, or is reserved: a new row of the table needs one.
TEST(ITable, NoRowIsWithoutARule) {
  Controller c(kGeoBrick | kMacroIc0);
  std::vector<bool> ruled(kCount, false);
  const auto mark = [&ruled](unsigned base, const std::vector<Rule>& rules) {
    for (const Rule& rule : rules)
      for (unsigned n = rule.first; n <= rule.last; ++n) ruled[base + n] = true;
  };
  for (const auto& rules : {kGlobal, kFound}) mark(0, rules);
  for (const auto& rules : {kMotor, kMotorFound}) mark(100, rules);
  for (const auto& rules : {kSystem, kSystemFound}) mark(5100, rules);
  mark(3300, kExtendedServo);
  mark(5000, kGather);
  for (const auto& rules : {kIc, kChannel2}) mark(7000, rules);
  for (const auto& rules : {kIc, kMacroChannel2}) mark(6800, rules);
  mark(8000, {{0, 191, 'u', 24, 0}});
  // Elsewhere: clock source and directions (variables_test.cpp). Channels are alike; 8 and 9 of an IC are read-only.
  for (const unsigned number : {19u, 6807u, 7007u}) ruled[number] = true;
  unsigned rows = 0;
  for (unsigned number = 0; number < kCount; ++number) {
    const bool first_of_its_kind = number < 200 || (number >= 3300 && number < 3350) ||
                                   (number >= 5000 && number < 5200) || (number >= 6800 && number < 6850) ||
                                   (number >= 7000 && number < 7030) || number >= 8000;
    const bool channel_1 = among(number, {{6810, 6819}, {7010, 7019}});
    const i_entry* entry = i_table_entry(i_table_place(number));
    if (!first_of_its_kind || channel_1 || entry->count == 0 || entry->kind == I_KIND_R) continue;
    ++rows;
    EXPECT_TRUE(ruled[number]) << "I" << number;
  }
  EXPECT_GT(rows, 400u);
}

TEST(ITable, ReadOutOfEverythingHasEachVariableInItsForm) {
  BRICK_COVERS("I9-1 I9-2");
  for (const unsigned fitted : {kGeoBrick, kMacroIc0}) {
    Controller c(fitted);
    const bool macro = fitted == kMacroIc0;
    for (const int style : {0, 1, 2, 3}) {
      c.line("I9=" + std::to_string(style));
      const auto all = read_out(c, "I");
      ASSERT_EQ(all.size(), kCount);
      unsigned hexadecimal = 0;
      for (unsigned number = 0; number < kCount; ++number) {
        const std::string head = "I" + std::to_string(number) + "=";
        const bool named = all[number].rfind(head, 0) == 0;
        EXPECT_EQ(named, (style & 1) != 0) << all[number];
        const std::string value = named ? all[number].substr(head.size()) : all[number];
        const bool hex = value[0] == '$';
        EXPECT_EQ(hex, (style & 2) != 0 && is_address(number, macro, macro ? 0 : 2)) << "I" << number << " " << value;
        hexadecimal += hex ? 1 : 0;
      }
      EXPECT_EQ(hexadecimal > 700, (style & 2) != 0);  // 32 motors x 16 and the conversion table alone
    }
  }
}

TEST(ITable, ReadOutsOfTheOthersAreComplete) {
  Controller c;
  c.line("P8191=1 M8191->Y:$10F0,3,4 M100..102->* M100=-5");
  EXPECT_EQ(read_out(c, "P").back(), "1");
  EXPECT_EQ(read_out(c, "M")[100], "-5");
  const auto definitions = read_out(c, "M", "->");
  EXPECT_EQ(definitions.back(), "Y:$10F0,3,4");
  EXPECT_EQ(definitions.front(), "*");
  EXPECT_EQ(lines_of(c.line("&2Q1..199")).size(), 199u);
  EXPECT_EQ(lines_of(c.line("P0,8192")).size(), kCount);
  EXPECT_EQ(lines_of(c.line("M0,4096,2->")).size(), kCount / 2);
}

// firmware:1.11, the dump of a machine whose motors are on MACRO IC 0.
TEST(ITable, MotorsOnAMacroIcHaveItsAddresses) {
  BRICK_COVERS("I19-3");
  Controller c(kMacroIc0);
  EXPECT_EQ(c.line("I19"), "6807");
  EXPECT_EQ(c.line("I102,8,100"), "$78420|$78424|$78428|$7842C|$78430|$78434|$78438|$7843C");
  EXPECT_EQ(c.line("I183,8,100"), "$78420|$78424|$78428|$7842C|$78430|$78434|$78438|$7843C");
  EXPECT_EQ(c.line("I125,8,100"), "$3440|$3441|$3444|$3445|$3448|$3449|$344C|$344D");
  for (unsigned motor = 9; motor <= 32; ++motor)
    for (const unsigned n : {2u, 25u, 83u}) EXPECT_EQ(i_variable_read(100 * motor + n), 0x35E5) << motor;
  for (unsigned motor = 1; motor <= 32; ++motor) {
    EXPECT_EQ(i_variable_read(100 * motor + 3), motor <= 16 ? 0x3500 + 2 * motor : 0x3521) << motor;
    EXPECT_EQ(i_variable_read(100 * motor + 4), motor <= 16 ? 0x3500 + 2 * motor : 0x3521) << motor;
    EXPECT_EQ(i_variable_read(100 * motor + 24), motor <= 16 ? 0x40001 : 0) << motor;
  }
  for (unsigned line = 0; line < 192; ++line) {
    const unsigned expected = line >= 16 ? 0 : line % 2 == 1 ? 0x18000 : 0x2F8420 + 4 * (line / 2);
    EXPECT_EQ(i_variable_read(8000 + line), expected) << line;
  }
  EXPECT_EQ(c.line("I6800..6806"), "6527|0|3|2258|15|$7FFFC0|$FFFFFE");
  EXPECT_EQ(c.line("I6810 I6820 I6812 I6822 I6840"), "7|7|1|1|$4000");
  for (unsigned number = 5061; number <= 5076; ++number) EXPECT_EQ(i_variable_read(number), 0x78800);
  EXPECT_EQ(c.line("I6855 I7005 I6840"), "0|0|$4000");  // no `$` where there is no IC
  EXPECT_EQ(c.line("I102=0 I124=0 I8000=0 I5061=0 I6840=0"), "");
  EXPECT_EQ(c.line("I102=* I124=* I8000=* I5061=* I6840=*"), "");
  EXPECT_EQ(c.line("I102 I124 I8000 I5061 I6840"), "$78420|$40001|$2F8420|$78800|$4000");
  Controller other(1u << 1 | kMacroIc0);
  EXPECT_EQ(other.line("I102 I124 I8000 I5061 I6840"), "$78102|$1|$78100|$0|$0") << "a servo IC, not the first";
}

TEST(ITable, LockBitsKeepTheirGroupOnly) {
  const std::vector<std::pair<unsigned, unsigned>> groups = {{100, 4899}, {5100, 6699}, {6800, 7999}, {8000, 8191}};
  Controller c;
  for (unsigned bit = 0; bit < 4; ++bit) {
    c.line("I41=0 I41=" + std::to_string(1u << bit));
    for (const unsigned number :
         {18u, 100u, 3299u, 3300u, 4899u, 5000u, 5099u, 5113u, 6699u, 7000u, 7149u, 8000u, 8191u}) {
      const double before = i_variable_read(number), other = before == 1 ? 0 : 1;
      i_variable_write(number, other);
      const bool kept = i_variable_read(number) == before;
      EXPECT_EQ(kept, number >= groups[bit].first && number <= groups[bit].second) << "I" << number;
      if (!kept) i_variable_write(number, before);
    }
  }
}

// Nothing a host sends may index past a table: computed numbers, counts and steps, numbers far outside.
TEST(ITable, IndicesAreCheckedWhereTheyEnter) {
  Controller c;
  c.line("P1=1 P2=8191 P3=8192 P4=-1");
  EXPECT_EQ(c.line("I(P2)"), "$0");
  for (const char* letter : {"I", "P", "Q", "M"})
    for (const char* rest : {"8192",   "(P3)", "(P4)",     "0..8192",    "8191..0", "(P2)..(P3)",     "8190,3",
                             "0,8193", "0,0",  "1,8191,2", "4294967296", "(1/0)",   "(P4*8191)",      "99999999999",
                             "1..",    "1,-1", "1,2,-1",   "16,4,0",     "16,1,0",  "16,4,(P3-8192)", "16,4,(P1/2)"}) {
      EXPECT_EQ(c.line(std::string(letter) + rest), "ERR003") << letter << rest;
      EXPECT_EQ(c.line(std::string(letter) + rest + "=1"), "ERR003") << letter << rest;
    }
  // A comma with no value behind it divides (firmware:1.1/7), but not from an assignment.
  EXPECT_EQ(c.line("P1, P1,2,"), "1|1|8191");
  EXPECT_EQ(c.line("P1,=5"), "1|ERR003");
  EXPECT_EQ(c.line("P1"), "1");
  // Inside an expression a computed number wraps (docs/variables.md): 8192 is 0, -1 is 8191.
  EXPECT_EQ(c.line("P0=77 P8191=78 P10=P(P3) P11=P(P4) P10 P11"), "77|78");
  std::string infinite = "34359738368";  // EXP is 2^47 at most: its 24th power is at the end of a double's range
  for (int i = 0; i < 24; ++i) infinite += "*EXP(40)";
  for (const char* letter : {"I", "P", "Q", "M"})
    for (const std::string& index : {infinite, "-(" + infinite + ")"}) {
      EXPECT_EQ(c.line(letter + ("(" + index) + ")"), "ERR003") << letter << index;
      EXPECT_EQ(c.line(letter + ("(" + index) + ")=1"), "ERR003") << letter << index;
    }
}

}  // namespace
}  // namespace brick
