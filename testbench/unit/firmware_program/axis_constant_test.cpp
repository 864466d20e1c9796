// The short way of axis constants makes the words of the general one, and leaves to it what it cannot do.
#include <random>

#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

namespace {

const char* const kLetters = "ABCUVWXYZ";

// The statement by the general compiler, which rounds the double of the constant.
word48_t general(const std::string& text) {
  word48_t words[4] = {};
  word_list list{words, 0, 4};
  lexer lx{text.c_str() + 1};
  const auto axis = static_cast<std::uint32_t>(std::string(kLetters).find(text[0]));
  EXPECT_EQ(statement_compile(&lx, {STATEMENT_ROW, axis}, WHERE_ROTARY, &list), ERR_NONE) << text;
  EXPECT_EQ(list.count, 1u) << text;
  return words[0];
}

std::uint32_t taken(const std::string& text, std::vector<word48_t>* words, std::size_t* length) {
  words->assign(300, 0);
  const char* at = text.c_str();
  const std::uint32_t count = axis_constants(&at, text.c_str() + text.size(), words->data(), 300);
  *length = static_cast<std::size_t>(at - text.c_str());
  words->resize(count);
  return count;
}

void same(const std::string& text) {
  std::vector<word48_t> words;
  std::size_t length = 0;
  ASSERT_EQ(taken(text, &words, &length), 1u) << text;
  ASSERT_EQ(length, text.size()) << text;
  ASSERT_EQ(words[0], general(text)) << text;
}

std::string decimal(std::uint64_t digits, unsigned decimals) {
  std::string text = std::to_string(digits);
  if (text.size() < decimals) text.insert(0, decimals - text.size(), '0');
  return decimals == 0 ? text : text.substr(0, text.size() - decimals) + "." + text.substr(text.size() - decimals);
}

TEST(AxisConstant, EveryShortConstantIsTheGeneralOne) {
  for (std::uint32_t digits = 0; digits < 20000; ++digits)
    for (unsigned decimals = 0; decimals <= 4; ++decimals)
      same(std::string(1, kLetters[digits % 9]) + (digits % 2 == 0 ? "" : "-") + decimal(digits, decimals));
}

TEST(AxisConstant, LongConstantsRoundAsTheGeneralOnes) {
  std::mt19937_64 random(brick::random_seed(7));
  for (int i = 0; i < 300000; ++i) {
    const auto digits = random() % 1'000'000'000u >> random() % 20;
    const unsigned decimals = random() % 5;
    if (std::max<std::size_t>(std::to_string(digits).size(), decimals) > 9) continue;
    same(std::string(1, kLetters[random() % 9]) + (random() % 2 == 0 ? "" : "+") + decimal(digits, decimals));
  }
  // 2^23 and 2^24: where the short word ends; halves of its last bit, which round up.
  for (const char* text :
       {"X8388607", "X8388608", "X8388609", "X16777215", "X16777217", "X33554431", "Y999999999", "Z.0001", "Z-.5", "A0",
        "A-0", "B00.50", "X1.", "X4194303.75", "X1048575.25", "X 1", "X - 1"})
    same(text);
}

TEST(AxisConstant, WhatItCannotDoIsLeft) {
  std::vector<word48_t> words;
  std::size_t length = 0;
  for (const char* text : {"X1234567890", "X0.00001", "X$10", "X(P1)", "P1=5", "X", "X-", "X.", "X1^2", "X1:5", "F100",
                           "X..5", "x1", "", "  ", "DWELL5"})
    EXPECT_EQ(taken(text, &words, &length), 0u) << text;
  EXPECT_EQ(taken("X1 Y2\tZ3F100", &words, &length), 3u);
  EXPECT_EQ(length, 8u) << "behind Z3";
  EXPECT_EQ(taken("X1;Y2", &words, &length), 1u);
  EXPECT_EQ(taken("X1..5", &words, &length), 1u) << "X1 and something else";
  EXPECT_EQ(length, 2u);
}

TEST(AxisConstant, StopsAtTheBoundaryAndWhenTheRoomIsUsed) {
  const std::string text = "X1Y2Z3A4";
  word48_t words[2] = {};
  const char* at = text.c_str();
  EXPECT_EQ(axis_constants(&at, text.c_str() + 2, words, 2), 1u);
  EXPECT_EQ(at, text.c_str() + 2);
  EXPECT_EQ(axis_constants(&at, text.c_str() + 2, words, 2), 0u);
  EXPECT_EQ(axis_constants(&at, text.c_str() + 8, words, 2), 2u);
  EXPECT_EQ(at, text.c_str() + 6);
}

}  // namespace
