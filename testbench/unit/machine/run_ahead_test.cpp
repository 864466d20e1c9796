// Nothing depends on who runs ahead how far: the same host traffic gives the same bus cycles, at the same femtosecond,
// on every engine, at every batch size, and however the host cuts its waits.
#include <fmt/format.h>

#include <random>

#include "testbench/unit/covers.h"
#include "testbench/unit/machine/machine_rig.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr Tick kEnd = 150'000;  // 1.27 ms

struct Story {
  std::vector<std::string> lines;
};

// Characters to the host port and reads of everything, at times that depend on the seed alone.
class Host {
 public:
  Host(MachineRig& rig, std::vector<std::string>& lines, Tick cut) : rig_(rig), lines_(lines), cut_(cut) {}

  void play() {
    std::mt19937_64 random(random_seed(5));
    wait(5000);
    rig_.set_y(0x100, 1);  // the background counts and uses the bus
    while (rig_.machine.now() < kEnd) {
      wait(1 + static_cast<Tick>(random() % 900));
      switch (random() % 5) {
        case 0:
          command(false, true, 0x215, 0);
          command(false, true, 0x216, 0);
          command(false, true, 0x217, static_cast<std::uint16_t>(random() & 0xFF));
          break;
        case 1:
          command(false, false, 0x217, 0);
          break;
        case 2:
          command(false, false, 0x210 + random() % 12, 0);
          break;
        case 3:
          command(true, false, 0xD0000 + 2 * (random() % 12), 0);
          break;
        default:
          command(true, true, 0xD0000 + 2 * (random() % 12), static_cast<std::uint16_t>(random()));
          break;
      }
    }
  }

 private:
  void wait(Tick ticks) {
    const Tick end = rig_.machine.now() + ticks;
    while (rig_.machine.now() < end) rig_.machine.run_until(cut_ == 0 ? end : std::min(end, rig_.machine.now() + cut_));
  }
  void command(bool memory, bool write, std::uint64_t address, std::uint16_t data) {
    HostInputs& in = rig_.machine.inputs();
    in.set_address(static_cast<std::uint32_t>(address));
    in.isa_sd = data;
    in.isa_sbhe_n = !memory;
    rig_.machine.apply();
    wait(12);
    bool& strobe = memory ? (write ? in.isa_memw_n : in.isa_memr_n) : (write ? in.isa_iow_n : in.isa_ior_n);
    strobe = false;
    rig_.machine.apply();
    wait(40);
    while (rig_.machine.outputs().get(pin::kIsaIochrdy) == 0)
      rig_.machine.run_until(kEnd, select_pins(pin::kIsaIochrdy));
    wait(8);
    if (!write)
      lines_.push_back(fmt::format("{} host reads {:05X} = {:04X}", rig_.machine.now(), address,
                                   rig_.machine.outputs().get(pin::kIsaSd)));
    strobe = true;
    rig_.machine.apply();
    wait(12);
  }
  MachineRig& rig_;
  std::vector<std::string>& lines_;
  Tick cut_;
};

std::vector<std::string> story(Engine engine, Tick batch, Tick cut) {
  MachineConfig config;
  config.engine = engine;
  config.batch = batch;
  MachineRig rig("probe", config);
  std::vector<std::string> lines;
  rig.machine.on_bus_cycle = [&](const PortACycle& c) {
    lines.push_back(fmt::format("{} {}{:06X} {} {:06X} end {} stretched {} pc {:X}", c.start, c.x ? 'X' : 'Y',
                                c.address, c.write ? 'W' : 'R', c.data, c.end, c.stretched, c.pc));
  };
  Host(rig, lines, cut).play();
  rig.machine.run_until(kEnd + 10'000);
  lines.push_back(fmt::format("loops {} instructions {} pc {:X}", rig.y(0x102), rig.machine.instructions(),
                              rig.machine.cpu().pc()));
  return lines;
}

// The lines of host and CPU interleave by when they are reported, which may differ; each side's own order may not.
std::vector<std::string> sorted(std::vector<std::string> lines) {
  std::stable_partition(lines.begin(), lines.end(),
                        [](const std::string& s) { return s.find("host") != std::string::npos; });
  return lines;
}

const std::vector<std::string>& reference() {
  static const std::vector<std::string> lines = sorted(story(Engine::kSystemC, 0, 0));
  return lines;
}

void expect_same(const std::vector<std::string>& lines) {
  const auto& expected = reference();
  ASSERT_GT(expected.size(), 1000u);
  for (std::size_t i = 0; i < std::min(expected.size(), lines.size()); ++i)
    ASSERT_EQ(lines[i], expected[i]) << "line " << i;
  EXPECT_EQ(lines.size(), expected.size());
}

TEST(RunAhead, BatchSizeChangesNothing) {
  BRICK_COVERS("CARD-6");
  for (const Tick batch : {1, 3, 17, 1000}) {
    SCOPED_TRACE(::testing::Message() << "batch " << batch);
    expect_same(sorted(story(Engine::kSystemC, batch, 0)));
  }
}

TEST(RunAhead, HowTheHostCutsItsWaitsChangesNothing) {
  BRICK_COVERS("CARD-6");
  for (const Tick cut : {1, 5, 333}) {
    SCOPED_TRACE(::testing::Message() << "cut " << cut);
    expect_same(sorted(story(Engine::kSystemC, 0, cut)));
  }
}

TEST(RunAhead, EnginesAgreeInEveryBusCycleAndHostRead) {
  BRICK_COVERS("CARD-2 CARD-6");
  expect_same(sorted(story(Engine::kRtl, 0, 0)));
  expect_same(sorted(story(Engine::kLockstep, 0, 0)));
  expect_same(sorted(story(Engine::kRtl, 7, 13)));
}

TEST(RunAhead, ProbeUsesEverything) {
  const auto& lines = reference();
  const auto count = [&](const char* part) {
    return std::count_if(lines.begin(), lines.end(),
                         [&](const std::string& s) { return s.find(part) != std::string::npos; });
  };
  EXPECT_GT(count("X070010 W"), 200) << "phase interrupts";
  EXPECT_GT(count("X070011 W"), 50) << "servo interrupts";
  EXPECT_GT(count("XFFFFC6 R"), 10) << "host interrupts";
  EXPECT_GT(count("Y060005 R"), 50) << "background bus cycles";
  EXPECT_GT(count("host reads D"), 10);
}

}  // namespace
}  // namespace brick
