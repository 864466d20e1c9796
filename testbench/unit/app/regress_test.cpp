// Kinds of failure of `brick regress`: what runs that failed have in common.
#include <gtest/gtest.h>

#include "app/regress/result.h"

namespace brick::regress {
namespace {

struct Kinds : ::testing::Test {
  void add(const std::string& bench, const std::string& engine, unsigned seed, const std::string& verdict,
           const std::string& step = "", const std::string& says = "") {
    regress::Run run;
    run.name = bench + engine + std::to_string(seed);
    run.group = bench;
    run.engine = engine;
    run.seed = seed;
    run.choice = bench + " " + std::to_string(seed);
    runs.push_back(run);
    results.emplace_back(Result{verdict, step, says});
  }
  std::vector<Bucket> buckets() const { return buckets_of(runs, results); }
  std::vector<regress::Run> runs;
  std::vector<std::optional<Result>> results;
};

TEST_F(Kinds, NumbersMakeNoDifferenceWordsDo) {
  add("a", "rtl", 1, "failed", "turn 3", "67 edges of ch3.enc_a at 1.25 ms, $3F, 0x1f, -4 and 1e-3, expected 70");
  add("a", "rtl", 2, "failed", "turn 12", "1 edges of ch12.enc_a at 0 ms, $0, 0xFFE, -12 and 2.5e+7, expected 70");
  add("a", "rtl", 3, "failed", "turn 3", "67 falls at 1.25 ms");
  add("b", "rtl", 1, "failed", "turn 3", "67 falls at 1.25 ms");
  add("b", "rtl", 2, "passed");
  const auto found = buckets();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].runs, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(found[0].step, "turn #");
  EXPECT_EQ(found[0].says, "# edges of ch#.enc_a at # ms, #, #, -# and #, expected #");
}

TEST_F(Kinds, AVerdictThatDiffersBetweenEnginesIsOneOfItsOwn) {
  add("a", "systemc", 1, "passed");
  add("a", "rtl", 1, "failed", "turn", "no edge");
  add("a", "systemc", 2, "failed", "turn", "no edge");
  add("a", "rtl", 2, "failed", "turn", "no edge");
  add("b", "systemc", 1, "passed");
  add("b", "rtl", 2, "failed", "other", "no edge");  // another seed
  const auto found = buckets();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].runs.size(), 3u);
  const auto differ =
      std::find_if(found.begin(), found.end(), [](const Bucket& bucket) { return bucket.verdict == "engines differ"; });
  ASSERT_NE(differ, found.end());
  EXPECT_EQ(differ->group, "a");
  EXPECT_EQ(differ->runs, (std::vector<std::size_t>{1}));
}

TEST_F(Kinds, RunsThatWereNotMadeAreNone) {
  add("a", "systemc", 1, "failed", "turn");
  add("a", "rtl", 1, "passed");
  results[1].reset();
  ASSERT_EQ(buckets().size(), 1u);
}

TEST(CommandText, IsTakenByAShellAsItWas) {
  EXPECT_EQ(command_text({"brick", "run", "a b", "it's", "", "x=1,2"}), "brick run 'a b' 'it'\\''s' '' x=1,2");
}

}  // namespace
}  // namespace brick::regress
