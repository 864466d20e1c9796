// docs/variables.md against the table that the firmware is compiled from.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/variables/i_table.h"
#include "firmware/variables/i_variables.h"
}

namespace brick {
namespace {

std::string range_text(const i_entry& entry) {
  if (entry.kind == I_KIND_F) return "real";
  if (entry.kind == I_KIND_R) return "read-only";
  const long long size = 1ll << entry.bits;
  if (entry.kind == I_KIND_U) return "0.." + std::to_string(size - 1);
  return std::to_string(-size / 2) + ".." + std::to_string(size / 2 - 1);
}

TEST(VariablesPage, AgreesWithTheTable) {
  Controller c;
  std::ifstream page("docs/variables.md");
  ASSERT_TRUE(page) << "run from the root of the tree";
  const std::regex row(R"(\| I(\d+)(?:\.\.(\d+))? \| ([^|]*) \| ([^|]*) \| (hex|decimal) \|.*)");
  std::vector<bool> listed(100, false);
  std::string line;
  while (std::getline(page, line)) {
    std::smatch part;
    if (!std::regex_match(line, part, row)) continue;
    const unsigned first = static_cast<unsigned>(std::stoul(part[1])),
                   last = part[2].matched ? static_cast<unsigned>(std::stoul(part[2])) : first;
    for (unsigned number = first; number <= last; ++number) {
      const i_place place = i_table_place(number);
      const i_entry& entry = *i_table_entry(place);
      ASSERT_LT(number, listed.size());
      listed[number] = true;
      EXPECT_EQ(part[3], range_text(entry)) << line;
      EXPECT_EQ(part[5] == "hex", entry.hex != 0) << line;
      const std::string value = part[4];
      if (value == "found") continue;
      EXPECT_EQ(value[0] == '$' ? std::stod("0x" + value.substr(1)) : std::stod(value), i_variable_default(number))
          << line;
    }
  }
  for (unsigned number = 0; number < listed.size(); ++number) {
    const bool has_row = i_table_entry(i_table_place(number))->count != 0;
    EXPECT_EQ(listed[number], has_row) << "I" << number;
  }
}

}  // namespace
}  // namespace brick
