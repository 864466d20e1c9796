// The dual-ported RAM's component, both sides at once, against the block inside driven through its C++ face.
#include <gtest/gtest.h>

#include <brick/dpram.h>

#include "testbench/unit/component/dpram_sides.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

std::size_t rises(const Seen& seen, const std::string& pin) {
  std::size_t count = 0;
  for (const Change& c : seen.changes) count += std::get<1>(c) == pin && std::get<2>(c) == 1 ? 1 : 0;
  return count;
}

TEST(DpramComponent, AgreesWithTheBlockOnBothSidesAtOnce) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    const Traffic traffic = dpram_traffic(seed, kTicks);
    DpramSides block(seed);
    const Seen expected = run(block, traffic);
    EXPECT_GE(expected.answers.size(), 20'000u);
    EXPECT_GE(expected.others.size(), 20'000u);
    EXPECT_GE(rises(expected, "busy_host"), 1'000u);
    EXPECT_GE(rises(expected, "busy_cpu"), 1'000u);
    const auto connect = [](Rig& rig, Dpram& ram) {
      rig.socket().bind(ram.host);
      rig.other_socket().bind(ram.cpu);
    };
    TimeBase time("time");
    Dpram ram("ram", time, {seed}, engine);
    does(expected, traffic, ram, quantum, 2, 2, all, connect);
  });
}

// The comparison sees one unit of the kernel's time and one bit, on either side and on BUSY.
TEST(DpramComponent, OneWrongAnswerOfEitherSideIsFound) {
  const Traffic traffic = dpram_traffic(1, 20'000);
  DpramSides block(1);
  const Seen right = run(block, traffic);
  ASSERT_GT(right.answers.size(), 100u);
  ASSERT_GT(right.others.size(), 100u);
  ASSERT_GT(right.changes.size(), 20u);
  EXPECT_EQ(difference(right, right, traffic.end, all), "");
  Seen bit = right, late = right, lost = right;
  bit.answers[70].second ^= 1;
  ++late.others[70].first;
  lost.changes.pop_back();
  EXPECT_EQ(difference(bit, right, traffic.end, all).rfind("access 70: ", 0), 0u);
  EXPECT_EQ(difference(late, right, traffic.end, all).rfind("other access 70: ", 0), 0u);
  EXPECT_NE(difference(lost, right, traffic.end, all), "");
}

}  // namespace
}  // namespace brick::component
