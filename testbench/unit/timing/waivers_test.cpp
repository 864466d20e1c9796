// Waivers of timing violations: what they cover, that one not needed is told, and every mistake as one line.
#include "app/timing_waivers.h"

#include <gmock/gmock.h>

#include <fstream>

#include "systemc/core/usage_error.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string written(const std::string& text) {
  std::string path = ::testing::TempDir() + "waivers.toml";
  std::ofstream(path) << text;
  return path;
}

std::string problem(const std::string& text, const std::vector<TimingLedger*>& ledgers = {}) {
  try {
    TimingWaivers(written(text)).check(ledgers);
  } catch (const UsageError& e) { return e.what(); }
  return "none";
}

TimingViolation at(unsigned rule, char space, std::uint32_t address) {
  TimingViolation v;
  v.rule = rule;
  v.where.space = space;
  v.where.address = address;
  return v;
}

TEST(TimingWaivers, OneRuleAtItsAddressesAndNothingElse) {
  BRICK_COVERS("CARD-5");
  const PortATiming port_a;
  const TimingLedger& ledger = port_a.ledger();
  TimingWaivers waivers(written(R"([[waive]]
rule = "104"
address = "X:$078000..$07801F"
reason = "read twice"
[[waive]]
rule = "106"
address = "Y:$060000"
reason = "never used"
)"));
  constexpr unsigned k104 = PortATiming::k104, k105 = PortATiming::k105;
  EXPECT_EQ(waivers.reason(ledger, at(k105, 'X', 0x078000)), "");
  EXPECT_EQ(waivers.reason(ledger, at(k104, 'Y', 0x078000)), "");
  EXPECT_EQ(waivers.reason(ledger, at(k104, 'X', 0x077FFF)), "");
  EXPECT_EQ(waivers.reason(ledger, at(k104, 'X', 0x078020)), "");
  EXPECT_EQ(waivers.unused().size(), 2u);
  EXPECT_EQ(waivers.reason(ledger, at(k104, 'X', 0x078000)), "read twice");
  EXPECT_EQ(waivers.reason(ledger, at(k104, 'X', 0x07801F)), "read twice");
  EXPECT_THAT(waivers.unused(),
              ElementsAre(HasSubstr("waivers.toml:5: waiver of rule 106 at Y:$060000 was not needed")));
}

TEST(TimingWaivers, EveryMistakeIsOneLineWithItsPlace) {
  PortATiming port_a;
  const std::vector<TimingLedger*> ledgers{&port_a.ledger()};
  const std::string good = "[[waive]]\nrule = \"104\"\naddress = \"X:$078000\"\n";
  EXPECT_EQ(problem(good + "reason = \"r\"\n", ledgers), "none");
  EXPECT_THAT(problem(good), HasSubstr("key reason is missing"));
  EXPECT_THAT(problem(good + "reason = \"\"\n"), HasSubstr(":4: reason: found \"\"; expected why"));
  EXPECT_THAT(problem(good + "reason = \"r\"\nwhy = 1\n"), HasSubstr(":5: unknown key why"));
  EXPECT_THAT(problem("[[waive]]\nrule = \"99\"\naddress = \"X:$078000\"\nreason = \"r\"\n", ledgers),
              HasSubstr(":2: rule: no rule \"99\"; expected one of 100, 101"));
  for (const char* address : {"078000", "X:078000", "Z:$078000", "X:$0780000", "X:$078000..", ""})
    EXPECT_THAT(problem(std::string("[[waive]]\nrule = \"104\"\naddress = \"") + address + "\"\nreason = \"r\"\n"),
                HasSubstr(":3: address: found \"" + std::string(address) + "\"; expected an address such as"));
  EXPECT_THAT(problem("[[waive]]\nrule = \"104\"\naddress = \"X:$2..$1\"\nreason = \"r\"\n"),
              HasSubstr("expected the lower address first"));
  EXPECT_THAT(problem("[[waive]]\nrule = \"104\"\naddress = \"X:$1..Y:$2\"\nreason = \"r\"\n"),
              HasSubstr(":3: address: found \"X:$1..Y:$2\"; expected both ends in one space"));
  EXPECT_THAT(problem("[[waive]]\nrule = \"104\"\naddress = \"X:$1..X:$2\"\nreason = \"r\"\n", ledgers), "none");
  for (const char* address : {"I/O 0x213", "memory 0x0D0000..0x0D1000"})
    EXPECT_THAT(
        problem(std::string("[[waive]]\nrule = \"104\"\naddress = \"") + address + "\"\nreason = \"r\"\n", ledgers),
        HasSubstr(":3: address: \"" + std::string(address) +
                  "\" is on another bus than rule 104; expected an address of Port A"));
  EXPECT_THAT(problem("[[waive]\n"), HasSubstr("expected TOML"));
  EXPECT_THAT(problem("waive = 3\n"), HasSubstr("a list in brackets"));
  try {
    const TimingWaivers none("/nowhere/waivers.toml");
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_THAT(e.what(), HasSubstr("--waive \"/nowhere/waivers.toml\": cannot be read"));
  }
}

}  // namespace
}  // namespace brick
