// What memories and flip-flops hold before anything writes them is random by the seed, and no reply and no time of the
// controller depends on it. What the host reads from a DPRAM that nobody has written is the seed's, on every engine.
#include <set>
#include <utility>

#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

struct Story {
  std::string replies;  // with the tick of each
  std::uint16_t unwritten;
};

Story tell(Engine engine, std::uint64_t seed) {
  MachineConfig config;
  config.engine = engine;
  config.seed = seed;
  config.firmware = BRICK_FIRMWARE;
  Machine machine(sc_core::sc_gen_unique_name("machine"), config);
  HostBus bus(machine);
  HostLink link(bus);
  Story story;
  EXPECT_TRUE(link.connect(ms_to_ticks(50)));
  for (const char* command :
       {"VERSION", "I7000..7007", "P1=3 P1", "&1DEFINE ROT 100", "&1B0", "OPEN ROT", "X1", "DWELL2", "PR", "??"}) {
    for (const std::string& line : link.command(command).lines) story.replies += line + '|';
    story.replies += std::to_string(machine.now()) + '\n';
  }
  bus.dpram_write(0x100, 0x5AA5);
  story.replies += std::to_string(bus.dpram_read(0x100)) + ' ' + std::to_string(machine.now());
  story.unwritten = bus.dpram_read(0x2000);
  EXPECT_TRUE(machine.take_run_errors().empty());
  return story;
}

TEST(StartValues, ReachEveryEngineAlikeAndNoReply) {
  BRICK_COVERS("CARD-2 CARD-6");
  const Story usual = tell(Engine::kSystemC, 1);
  EXPECT_EQ(usual.unwritten, 0) << "the default";
  constexpr std::pair<Engine, std::uint64_t> kTold[]{{Engine::kSystemC, 2}, {Engine::kRtl, 3}, {Engine::kLockstep, 4}};
  std::set<std::uint16_t> unwritten;
  for (const auto& [engine, seed] : kTold) {
    const Story model = tell(Engine::kSystemC, seed), story = tell(engine, seed);
    EXPECT_TRUE(unwritten.insert(model.unwritten).second) << "seed " << seed;
    EXPECT_NE(model.unwritten, 0) << "seed " << seed;
    EXPECT_EQ(story.unwritten, model.unwritten) << "seed " << seed;
    EXPECT_EQ(model.replies, usual.replies) << "seed " << seed;
    EXPECT_EQ(story.replies, usual.replies) << "seed " << seed;
  }
}

}  // namespace
}  // namespace brick
