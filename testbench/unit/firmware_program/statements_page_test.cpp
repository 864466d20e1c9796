// The table of statements in docs/language.md against the one that compiler and lister go by.
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "testbench/unit/firmware_program/platform.h"

namespace {

std::string where_text(unsigned where) {
  std::string text;
  const auto add = [&](unsigned bit, const char* name) {
    if ((where & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(WHERE_PROG, "motion");
  add(WHERE_ROTARY, "rotary");
  add(WHERE_PLC, "PLC");
  add(WHERE_KINEMATIC, "kinematic");
  add(WHERE_BEGUN, "not first");
  add(WHERE_CALLED, "behind a call");
  return text;
}

std::string plain_name(const char* name) { return std::regex_replace(std::string(name), std::regex("_"), ""); }

TEST(StatementsPage, AgreesWithTheTable) {
  std::ifstream page("docs/language.md");
  ASSERT_TRUE(page) << "run from the root of the tree";
  const std::regex row(R"(\| ([^|]*) \| ([^|]*) \| (`[A-Z].*) \|)");
  std::map<std::string, std::string> where_of;  // names of a statement, as the page has them
  std::string line;
  while (std::getline(page, line)) {
    std::smatch part;
    if (!std::regex_match(line, part, row)) continue;
    std::string names = part[3];
    for (std::size_t begin = 0; begin < names.size();) {
      const std::size_t end = std::min(names.find(", ", begin), names.size());
      where_of[names.substr(begin, end - begin)] = part[1];
      begin = end + 2;
    }
  }
  for (std::uint32_t i = 0; i < statement_row_count; ++i) {
    const statement_row& statement = statement_rows[i];
    std::string names = "`" + plain_name(statement.name) + "`";
    if (statement.brief != nullptr) names += " `" + plain_name(statement.brief) + "`";
    ASSERT_EQ(where_of.count(names), 1u) << names << " is not on the page";
    EXPECT_EQ(where_of[names], where_text(statement.where)) << names;
    where_of.erase(names);
  }
  for (const auto& left : where_of) ADD_FAILURE() << left.first << " is on the page but no statement";
}

}  // namespace
