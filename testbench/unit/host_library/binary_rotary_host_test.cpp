// A binary rotary buffer as the host keeps it (host-bus:7.2 to host-bus:7.5): what is written into the RAM and in which
// order, how much fits, and what of a file of lines goes on later.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "testbench/host/binary_rotary.h"
#include "testbench/unit/host_library/fake_machine.h"

namespace brick {
namespace {

class BinaryRotaryHostTest : public ::testing::Test {
 protected:
  using Write = std::pair<std::uint32_t, std::uint16_t>;
  using Writes = std::vector<Write>;
  static constexpr std::uint32_t kHeader = 0x1050 + 12 * 2, kOpen = 0x1140;  // of coordinate system 3
  static constexpr std::uint32_t kStatus = kHeader, kEnable = kHeader + 2, kHost = kHeader + 4, kPmac = kHeader + 6;

  static FakeMachine& fake() { return FakeMachine::last(); }

  // What the host has written since the last call, by offset, in its order.
  static Writes take_writes() {
    Writes writes;
    for (const auto& change : fake().changes)
      if (change.before.isa_memw_n && !change.after.isa_memw_n)
        writes.emplace_back(change.after.isa_sa - 0xD0000, change.after.isa_sd);
    fake().changes.clear();
    return writes;
  }
  static int reads_of(std::uint32_t offset) {
    int reads = 0;
    for (const auto& change : fake().changes)
      reads += change.before.isa_memr_n && !change.after.isa_memr_n && change.after.isa_sa == 0xD0000 + offset ? 1 : 0;
    return reads;
  }
  static std::uint32_t item(std::uint32_t index) {
    const std::uint32_t at = kOpen + 4 * index;
    return fake().memory[at] | static_cast<std::uint32_t>(fake().memory[at + 2]) << 16;
  }
  static void expect_end_at(std::uint32_t index) {
    EXPECT_EQ(item(index), 0x00000800u);
    EXPECT_EQ(item(index + 1), 0x0000FFFFu);
  }
  static std::vector<BinaryCommand> commands(std::size_t count) { return {count, BinaryCommand{0x123456, 0x789ABC}}; }

  Machine machine_{"machine", MachineConfig{}};
  HostBus bus_{machine_};
  BinaryRotary rotary_{bus_, 3};
};

// Once the controller's index is the host's.
TEST_F(BinaryRotaryHostTest, IsEmptyWhereTheControllerHasTakenAll) {
  ASSERT_EQ(rotary_.define(0, 40), BinaryResult::kOk);
  EXPECT_TRUE(rotary_.empty());
  ASSERT_EQ(rotary_.put(commands(3)), BinaryResult::kOk);
  EXPECT_FALSE(rotary_.empty());
  const std::uint16_t index = fake().memory[kHost];
  ASSERT_NE(index, 0);
  for (const auto& [taken, empty] : {std::pair{index - 1, false}, {static_cast<int>(index), true}}) {
    fake().memory[kPmac] = static_cast<std::uint16_t>(taken);
    EXPECT_EQ(rotary_.empty(), empty) << taken;
  }
}

// host-bus:7.4/2: off before anything, status 0 the last.
TEST_F(BinaryRotaryHostTest, IsDefinedOffEmptyAndWithoutAnError) {
  EXPECT_EQ(rotary_.recover(), BinaryResult::kError) << "there is none yet";
  EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kError);
  EXPECT_EQ(take_writes(), Writes{});
  fake().memory[kStatus] = 0x8005;
  EXPECT_EQ(rotary_.define(0x10, 20), BinaryResult::kOk);
  const std::uint32_t ring = kOpen + 4 * 0x10;
  EXPECT_EQ(take_writes(), (Writes{{kEnable, 0},
                                   {kHeader + 8, 20},
                                   {kHeader + 10, 0x10},
                                   {kHost, 0},
                                   {kPmac, 0},
                                   {ring, 0x0800},
                                   {ring + 2, 0},
                                   {ring + 4, 0xFFFF},
                                   {ring + 6, 0},
                                   {kStatus, 0}}));
  EXPECT_EQ(rotary_.size(), 20u);
  rotary_.enable();
  rotary_.disable();
  EXPECT_EQ(take_writes(), (Writes{{kEnable, 3}, {kEnable, 0}}));
  fake().memory[kStatus] = 0x4001;
  EXPECT_EQ(rotary_.status(), 0x4001);
}

// Six items or more, an even number, within the 64 KiB: 15,280 items behind 0x1140.
TEST_F(BinaryRotaryHostTest, HasASizeThatTheRamHolds) {
  for (const std::uint32_t size : {0u, 2u, 4u, 5u, 7u, 21u}) {
    EXPECT_EQ(rotary_.define(0, size), BinaryResult::kError) << size;
  }
  EXPECT_EQ(rotary_.define(15'280 - 6 + 1, 6), BinaryResult::kAllocation);
  EXPECT_EQ(rotary_.define(0, 15'282), BinaryResult::kAllocation);
  EXPECT_EQ(rotary_.define(0xFFFFFFFF, 6), BinaryResult::kAllocation);
  EXPECT_EQ(take_writes(), Writes{});
  EXPECT_EQ(rotary_.size(), 0u);
  EXPECT_EQ(rotary_.define(15'280 - 6, 6), BinaryResult::kOk);
  EXPECT_EQ(rotary_.define(0, 6), BinaryResult::kOk);
  EXPECT_EQ(rotary_.define(0, 15'280), BinaryResult::kOk);
}

// The line, the end of the buffer behind it, the host's index at last; words of 24 bits with their sign.
TEST_F(BinaryRotaryHostTest, ALineStandsThereBeforeTheIndexGoesPastIt) {
  ASSERT_EQ(rotary_.define(0, 20), BinaryResult::kOk);
  take_writes();
  EXPECT_EQ(rotary_.put({{0x812345, 0x7ABCDE}}), BinaryResult::kOk);
  EXPECT_EQ(take_writes(), (Writes{{kOpen, 0x2345},
                                   {kOpen + 2, 0xFF81},
                                   {kOpen + 4, 0xBCDE},
                                   {kOpen + 6, 0x007A},
                                   {kOpen + 8, 0x0800},
                                   {kOpen + 10, 0},
                                   {kOpen + 12, 0xFFFF},
                                   {kOpen + 14, 0},
                                   {kHost, 2}}));
  EXPECT_EQ(rotary_.host_index(), 2u);
  EXPECT_FALSE(rotary_.empty());
  fake().memory[kPmac] = 2;
  EXPECT_TRUE(rotary_.empty());
  EXPECT_EQ(rotary_.put("X1Y2"), BinaryResult::kOk);
  EXPECT_EQ(item(2), 0xFF880181u) << "1, of axis 6, at the start of a line";
  EXPECT_EQ(item(3), 0x00400000u);
  EXPECT_EQ(rotary_.host_index(), 6u);
  take_writes();
  EXPECT_EQ(rotary_.put(""), BinaryResult::kOk);
  EXPECT_EQ(rotary_.put("X(P1)"), BinaryResult::kIllegal);
  EXPECT_EQ(rotary_.put(commands(0)), BinaryResult::kOk);
  EXPECT_EQ(take_writes(), Writes{}) << "nothing of these";
}

// host-bus:7.3/3: size / 2 - 2 commands fit. The controller's index is looked at when the last one leaves no room.
TEST_F(BinaryRotaryHostTest, FullIsFourItemsShortOfTheRing) {
  for (const std::uint32_t size : {6u, 8u, 20u}) {
    ASSERT_EQ(rotary_.define(0, size), BinaryResult::kOk);
    const std::uint32_t fit = size / 2 - 2;
    EXPECT_EQ(rotary_.put(commands(fit + 1)), BinaryResult::kError) << "never";
    fake().changes.clear();
    for (std::uint32_t n = 0; n < fit; ++n) EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kOk) << n;
    EXPECT_EQ(reads_of(kPmac), 0);
    EXPECT_EQ(rotary_.host_index(), 2 * fit);
    fake().changes.clear();
    EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kBusy);
    EXPECT_EQ(reads_of(kPmac), 1);
    EXPECT_EQ(take_writes(), Writes{}) << "nothing has been written";
    fake().memory[kStatus] = 0x7FFF;
    EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kBusy);
    fake().memory[kStatus] = 0x8006;
    EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kError) << "it has stopped";
    fake().memory[kStatus] = 0;
    fake().memory[kPmac] = 2;
    EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kOk);
    EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kBusy);
    expect_end_at(rotary_.host_index());
  }
}

// No command wraps: sizes are even. A line may.
TEST_F(BinaryRotaryHostTest, GoesRound) {
  ASSERT_EQ(rotary_.define(0, 10), BinaryResult::kOk);
  std::uint32_t index = 0;
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(rotary_.put(commands(3)), BinaryResult::kOk);
    for (std::uint32_t i = 0; i < 6; ++i)
      EXPECT_EQ(item((index + i) % 10), i % 2 == 0 ? 0x00123456u : 0x00789ABCu) << n << ' ' << i;
    index = (index + 6) % 10;
    EXPECT_EQ(rotary_.host_index(), index);
    EXPECT_EQ(fake().memory[kHost], index);
    expect_end_at(index);
    fake().memory[kPmac] = static_cast<std::uint16_t>(index);
  }
  EXPECT_TRUE(rotary_.empty());
  EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kOk);
  EXPECT_EQ(rotary_.recover(), BinaryResult::kOk);
  EXPECT_EQ(rotary_.host_index(), 0u);
  EXPECT_TRUE(rotary_.empty());
  expect_end_at(0);
  EXPECT_EQ(rotary_.put(commands(3)), BinaryResult::kOk) << "all of it is free again";
}

// An index of the controller's that cannot be is no room beyond the ring.
TEST_F(BinaryRotaryHostTest, ALyingIndexIsTakenWithinTheRing) {
  ASSERT_EQ(rotary_.define(0, 6), BinaryResult::kOk);
  EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kOk);
  fake().memory[kPmac] = 6;
  EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kBusy) << "as 0";
  fake().memory[kPmac] = 8;
  EXPECT_EQ(rotary_.put(commands(1)), BinaryResult::kOk) << "as 2";
}

// As many lines as there is room for, with one end and one index behind all; the line without room comes first next
// time.
TEST_F(BinaryRotaryHostTest, AFileIsFedAsThereIsRoom) {
  ASSERT_EQ(rotary_.define(0, 10), BinaryResult::kOk);
  take_writes();
  std::istringstream lines("X1\n; nothing\n\nX2\nX3\nX4\nX5\n");
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kBusy);
  const Writes writes = take_writes();
  EXPECT_EQ(writes.size(), 3u * 4 + 4 + 1);
  EXPECT_EQ(writes.back(), (Write{kHost, 6}));
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kBusy);
  EXPECT_EQ(take_writes(), Writes{}) << "there is still no room";
  fake().memory[kPmac] = 2;
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kBusy);
  EXPECT_EQ(item(6) & 0x3F, 3u) << "4 is 0.5 x 2^3";
  fake().memory[kPmac] = 8;
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kEndOfFile);
  EXPECT_EQ(fake().memory[kHost], 0);
  EXPECT_EQ(item(9), 0x00500000u) << "5 is 0.625 x 2^3";
  take_writes();
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kEndOfFile);
  EXPECT_EQ(take_writes(), Writes{});
}

// What is wrong is told, the lines before it go out, and it is not asked for again.
TEST_F(BinaryRotaryHostTest, AFileStopsAtALineThatIsRefused) {
  ASSERT_EQ(rotary_.define(0, 20), BinaryResult::kOk);
  std::istringstream lines("X1\nX(P1)\nX0.1\nX2\n");
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kIllegal);
  EXPECT_EQ(fake().memory[kHost], 2);
  take_writes();
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kFloat);
  EXPECT_EQ(take_writes(), Writes{});
  EXPECT_EQ(rotary_.feed(lines), BinaryResult::kEndOfFile);
  EXPECT_EQ(fake().memory[kHost], 4);
}

// Two steps: nobody sees what has not been committed.
TEST_F(BinaryRotaryHostTest, StagedLinesAreSeenTogether) {
  ASSERT_EQ(rotary_.define(0, 20), BinaryResult::kOk);
  EXPECT_EQ(rotary_.stage(commands(1)), BinaryResult::kOk);
  EXPECT_EQ(rotary_.stage(commands(2)), BinaryResult::kOk);
  EXPECT_EQ(fake().memory[kHost], 0);
  rotary_.commit();
  EXPECT_EQ(fake().memory[kHost], 6);
  expect_end_at(6);
}

}  // namespace
}  // namespace brick
