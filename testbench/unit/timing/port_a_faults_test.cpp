// A bus master that drives wrong, on a real board: each wrong edge is found by the rule that forbids it, from the lines
// alone. The cycles are those of a gate IC with seven wait states at I52 = 7, TC = 12.7157 ns, edges on quarters of TC
// as docs/port_a.md draws them: read, write, write, read, read, at once after each other.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "systemc/machine/machine.h"
#include "testbench/checkers/timing_traffic.h"
#include "testbench/unit/cosim/distorted_board.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr TimeFs kNs = kFsPerNs, kBit = 1000;  // what is more than a limit allows: a picosecond

constexpr TimeFs quarters(std::int64_t count) { return count * 1'220'703'125 / (48 * 8); }

struct CycleTimes {
  bool write;
  TimeFs address, low, high, away, data_on, data_off;
};
struct Move {
  TimeFs time;
  std::function<void(PortALevels&)> edit;
};
struct Script {
  std::array<CycleTimes, 5> cycles{};
  std::vector<Move> more;  // in the middle of these

  explicit Script(TimeFs begin) {
    constexpr std::array<bool, 5> kWrites{false, true, true, false, false};
    for (unsigned i = 0; i < cycles.size(); ++i) {
      const auto at = [&](unsigned quarter) { return begin + quarters(36 * i + quarter); };
      cycles[i] = {kWrites[i], at(0), at(kWrites[i] ? 5 : 2), at(31), at(36), at(4), at(36)};
    }
  }
  CycleTimes &read = cycles[0], &write = cycles[1], &write2 = cycles[2], &read2 = cycles[3], &read3 = cycles[4];

  std::vector<Move> moves() const {
    std::vector<Move> all;
    for (const CycleTimes& c : cycles) {
      all.push_back({c.address, [](PortALevels& l) {
                       l.addr = 0x078006;
                       l.x = true;
                       l.aa = 2;
                       l.addr_oe = true;
                     }});
      all.push_back({c.low, [&c](PortALevels& l) { (c.write ? l.wr_n : l.rd_n) = false; }});
      all.push_back({c.high, [&c](PortALevels& l) { (c.write ? l.wr_n : l.rd_n) = true; }});
      all.push_back({c.away, [](PortALevels& l) {
                       l.aa = 0;
                       l.addr_oe = false;
                     }});
      if (!c.write) continue;
      all.push_back({c.data_on, [&c](PortALevels& l) {
                       l.data = static_cast<std::uint32_t>(c.low) & 0xFFFFFF;
                       l.data_oe = true;
                     }});
      all.push_back({c.data_off, [](PortALevels& l) { l.data_oe = false; }});
    }
    all.insert(all.end(), more.begin(), more.end());
    // At one time: what ends comes before what begins.
    std::stable_sort(all.begin(), all.end(), [](const Move& a, const Move& b) { return a.time < b.time; });
    return all;
  }
};

using Rules = std::set<std::string>;

// What the script breaks, played on the pins of a board.
Rules broken(Engine engine, const std::function<void(Script&)>& fault) {
  MachineConfig config;
  config.engine = engine;
  Machine machine(sc_core::sc_gen_unique_name("brick"), config);
  machine.run_until(600);  // reset is over
  PinWatch watch;
  PortATiming timing;
  watch.on_cycle = [&](const PinCycle& c) { timing.cycle(c); };
  machine.attach_port_a_watch(&watch);
  Script script(machine.now_fs() + 100 * kNs);
  fault(script);
  PortALevels levels;
  levels.multiplier = 8;
  levels.wait_states = 7;
  for (const Move& move : script.moves()) {
    machine.run_until(std::max(machine.now(), fs_to_tick(move.time) - 1));
    move.edit(levels);
    PortAPins& pins = machine.port_a();
    pins.pa_addr = levels.addr;
    pins.pa_x = levels.x;
    pins.pa_aa = levels.aa;
    pins.pa_rd_n = levels.rd_n;
    pins.pa_wr_n = levels.wr_n;
    pins.pa_wdata = levels.data;
    watch.cpu_moved(move.time, levels);
    machine.apply(move.time);
  }
  machine.attach_port_a_watch(nullptr);
  EXPECT_EQ(timing.ledger().row(PortATiming::k100, PortATiming::kGateIcs).evaluations, 5u);
  EXPECT_EQ(timing.ledger().row(PortATiming::kBoardLetsGo, PortATiming::kGateIcs).evaluations, 2u) << "two writes";
  EXPECT_EQ(timing.ledger().row(PortATiming::kCpuLetsGo, PortATiming::kGateIcs).evaluations, 2u) << "two reads behind";
  Rules rules;
  for (const TimingViolation& v : timing.ledger().violations()) {
    rules.insert(timing.ledger().rules()[v.rule].id);
    EXPECT_EQ(timing_address(v.where), "X:$078006");
  }
  return rules;
}

struct Fault {
  const char* what;
  Rules rules;  // all that are broken by it: limits add up
  std::function<void(Script&)> seed;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> list{
      {"none", {}, [](Script&) {}},
      {"address late for a write", {"101"}, [](Script& s) { s.write.address += 2 * kNs + kBit; }},
      {"address later still", {"100", "101", "107"}, [](Script& s) { s.write.address += 4 * kNs + kBit; }},
      {"/WR too short",
       {"102"},
       [](Script& s) {
         s.write.low += 4 * kNs + kBit;
         s.write.data_on += kNs;
       }},
      {"address of a write gone early", {"103"}, [](Script& s) { s.write.away -= 2 * kNs + kBit; }},
      {"write data late", {"108"}, [](Script& s) { s.write.data_on += 3 * kNs + kBit; }},
      {"write data gone early", {"109"}, [](Script& s) { s.write.data_off -= 2 * kNs + kBit; }},
      {"write data change early",
       {"109"},
       [](Script& s) {
         s.more.push_back({s.write.away - 2 * kNs - kBit, [](PortALevels& l) { l.data ^= 1; }});
       }},
      {"write data driven early", {"110"}, [](Script& s) { s.write.data_on -= 37 * kNs / 10 + kBit; }},
      {"write data off late", {"111"}, [](Script& s) { s.write.data_off += kNs / 5 + kBit; }},
      {"no turnaround", {"110", "112"}, [](Script& s) { s.write.data_on -= 4 * kNs + kBit; }},
      {"/RD high too short",
       {"113", "115"},
       [](Script& s) {
         s.read2.away = s.read3.address -= 2 * kNs - kBit;
         s.read3.low -= 4 * kNs + kBit;
       }},
      {"/WR high too short",
       {"101", "114"},
       [](Script& s) {
         s.write.away = s.write2.address -= 2 * kNs - kBit;
         s.write2.low -= 4 * kNs + kBit;
       }},
      {"address late for a read", {"115"}, [](Script& s) { s.read2.address += 2 * kNs + kBit; }},
      {"/RD too short", {"116"}, [](Script& s) { s.read2.high -= 4 * kNs + kBit; }},
      {"address of a read gone early", {"117"}, [](Script& s) { s.read2.away -= 2 * kNs + kBit; }},
      {"both strobes",
       {"a"},
       [](Script& s) {
         s.more.push_back({s.write.low + 10 * kNs, [](PortALevels& l) { l.rd_n = false; }});
         s.more.push_back({s.write.low + 20 * kNs, [](PortALevels& l) { l.rd_n = true; }});
       }},
      {"address moves in a read",
       {"100", "106", "117", "119", "b"},  // the board follows the address
       [](Script& s) {
         s.more.push_back({s.read2.low + 20 * kNs, [](PortALevels& l) { l.addr ^= 1; }});
         s.more.push_back({s.read2.low + 40 * kNs, [](PortALevels& l) { l.addr ^= 1; }});
       }},
      {"AA moves in a write",
       {"100", "103", "119", "b", "w2"},
       [](Script& s) {
         s.more.push_back({s.write.low + 20 * kNs, [](PortALevels& l) { l.aa ^= 8; }});
         s.more.push_back({s.write.low + 40 * kNs, [](PortALevels& l) { l.aa ^= 8; }});
       }},
      {"the CPU drives D while the board does",
       {"110", "112", "c"},
       [](Script& s) { s.write.data_on = s.read.high - 5 * kNs; }},
      {"the CPU still drives D as the board begins", {"111", "d"}, [](Script& s) {
         s.write2.data_off = s.read2.low + 80 * kNs;
       }}};
  return list;
}

TEST(PortAFaults, EachIsFoundByItsRuleOnBothEngines) {
  BRICK_COVERS("CARD-5");
  for (const Engine engine : {Engine::kSystemC, Engine::kRtl})
    for (const Fault& fault : faults()) EXPECT_EQ(broken(engine, fault.seed), fault.rules) << fault.what;
}

// Traffic in one region, at every phase, of a board whose enable of D ends at once or, a fault, with a flip-flop of
// clk_pwm.
Rules broken_by_enable(MachineConfig config, bool waits, unsigned multiplier, PortATiming::Region region,
                       unsigned wait_states) {
  config.rewire = [waits](std::unique_ptr<Board> board) {
    auto distorted = std::make_unique<DistortedBoard>(std::move(board));
    distorted->at_once = !waits;
    return distorted;
  };
  Machine machine(sc_core::sc_gen_unique_name("brick"), config);
  BusTraffic traffic(machine, 1);
  PinWatch watch;
  watch.set_pin_delay(machine.skew().of_strobe(false));
  PortATiming timing;
  watch.on_cycle = [&](const PinCycle& c) { timing.cycle(c); };
  machine.attach_port_a_watch(&watch);
  traffic.set_clock(multiplier);
  traffic.set_wait_states(region, wait_states);
  traffic.every_phase(region);
  machine.attach_port_a_watch(nullptr);
  Rules rules;
  for (const TimingViolation& v : timing.ledger().violations()) rules.insert(timing.ledger().rules()[v.rule].id);
  EXPECT_GT(timing.ledger().row(PortATiming::kDrivesInside, region).evaluations, 100u);
  return rules;
}

// I52 = 31: the CPU drives D 9 / 4 TC = 7.15 ns after the /RD of a read with seven wait states. An enable that ends
// with a flip-flop of clk_pwm is up to 8.48 ns late.
TEST(PortAFaults, AnEnableThatWaitsForAClockIsFoundOnBothEngines) {
  BRICK_COVERS("CARD-5");
  for (const Engine engine : {Engine::kSystemC, Engine::kRtl})
    for (const bool waits : {false, true}) {
      MachineConfig config;
      config.engine = engine;
      EXPECT_EQ(broken_by_enable(config, waits, 32, PortATiming::kDpram, 7), waits ? (Rules{"c", "e"}) : Rules{})
          << (engine == Engine::kRtl ? "RTL" : "SystemC");
    }
}

// Above I52 = 15 with --skew, host-bus:2.5: gate ICs hold up to 25 with I52 + 1 wait states. At 22 and 25 the next /RD
// may fall before one that comes 8.477 ns late has ended D (row 113: 11 / 4 TC - 4 ns = 8.2 and 6.8 ns).
TEST(PortAFaults, ALateEnableIsFoundBehindTheLatestPadAboveTheClocksOfTheSheet) {
  BRICK_COVERS("CARD-5");
  MachineConfig config;
  config.skew = true;
  while (PinSkew(config.seed).of_strobe(false) != PinSkew::kMost) ++config.seed;
  for (const Engine engine : {Engine::kSystemC, Engine::kRtl})
    for (const unsigned i52 : {16, 19, 22, 25})
      for (const bool waits : {false, true}) {
        SCOPED_TRACE(::testing::Message() << (engine == Engine::kRtl ? "RTL" : "SystemC") << ", I52 = " << i52);
        config.engine = engine;
        const Rules rules = broken_by_enable(config, waits, i52 + 1, PortATiming::kGateIcs, i52 + 1);
        EXPECT_EQ(rules.count("e") != 0, waits);
        EXPECT_TRUE(waits || rules.empty()) << ::testing::PrintToString(rules);
      }
}

// A board that drives D in a write, or while nobody asks.
TEST(PortAFaults, ABoardThatDrivesUnaskedIsFound) {
  for (const bool in_a_write : {true, false}) {
    PinWatch watch;
    PortATiming timing;
    watch.on_cycle = [&](const PinCycle& c) { timing.cycle(c); };
    const Script script(1000 * kNs);
    const TimeFs begin = in_a_write ? script.cycles[1].low + 20 * kNs : script.cycles[0].address - 50 * kNs;
    BoardOutputs drives;
    drives.set(pin::kPaDataOe, 1);
    std::vector<std::pair<TimeFs, BoardOutputs>> board{{begin + 10 * kNs, {}}, {begin, drives}};
    PortALevels levels;
    levels.wait_states = 7;
    for (const Move& move : script.moves()) {
      for (; !board.empty() && board.back().first < move.time; board.pop_back())
        watch.board_moved(board.back().first, board.back().second);
      move.edit(levels);
      watch.cpu_moved(move.time, levels);
    }
    EXPECT_EQ(timing.ledger().row(PortATiming::kDrivesInside, PortATiming::kGateIcs).violations, 1u);
  }
}

// Lines of a board that is made up: it lets go of D 40 ns after /RD, and the CPU drives 28.6 ns after it.
TEST(PortAFaults, ABoardThatDoesNotLetGoIsFound) {
  for (const bool late : {false, true}) {
    PinWatch watch;
    PortATiming timing;
    watch.on_cycle = [&](const PinCycle& c) { timing.cycle(c); };
    const Script script(1000 * kNs);
    BoardOutputs drives;
    drives.set(pin::kPaDataOe, 1);
    std::vector<std::pair<TimeFs, BoardOutputs>> board{{script.cycles[0].high + (late ? 40 : 20) * kNs, {}},
                                                       {script.cycles[0].low + 50 * kNs, drives}};
    PortALevels levels;
    levels.wait_states = 7;
    for (const Move& move : script.moves()) {
      for (; !board.empty() && board.back().first < move.time; board.pop_back())
        watch.board_moved(board.back().first, board.back().second);
      move.edit(levels);
      watch.cpu_moved(move.time, levels);
    }
    const TimingRow& row = timing.ledger().row(PortATiming::kBoardLetsGo, PortATiming::kGateIcs);
    EXPECT_EQ(row.violations, late ? 1u : 0u);
    EXPECT_NEAR(static_cast<double>(row.margin) / kNs, late ? -11.39 : 8.61, 0.01);  // 9/4 TC = 28.61 ns
  }
}

}  // namespace
}  // namespace brick
