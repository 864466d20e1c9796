// sc_trace of a component: all its pins are in the waveform, with their widths, and move as the block inside says.
#include <gtest/gtest.h>

#include <brick/board.h>
#include <brick/clock_select.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::SC_US;

// A waveform in units of 1 ps, of signals NAME.PIN.
struct Waveform {
  std::string unit, scope;
  std::map<std::string, unsigned> widths;
  std::map<std::string, std::uint32_t> first;  // levels at the begin
  std::vector<Change> changes;
};

Waveform read_waveform(const std::string& path) {
  Waveform wave;
  std::map<std::string, std::string> names;
  std::ifstream file(path);
  Picoseconds now = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word, code, name;
    words >> word;
    if (word == "$timescale") {
      file >> wave.unit >> word;
      wave.unit += " " + word;
    } else if (word == "$scope") {
      words >> word >> name;
      wave.scope += "." + name;
    } else if (word == "$var") {
      unsigned width = 0;
      words >> word >> width >> code >> name;
      names[code] = name;
      wave.widths[name] = width;
    } else if (word[0] == '#') {
      now = std::stoull(word.substr(1));
    } else if (word[0] == '0' || word[0] == '1' || word[0] == 'b') {
      if (word[0] == 'b')
        words >> code;
      else
        code = word.substr(1);
      const auto value =
          static_cast<std::uint32_t>(std::stoul(word[0] == 'b' ? word.substr(1) : word.substr(0, 1), nullptr, 2));
      if (now == 0)
        wave.first[names.at(code)] = value;
      else
        wave.changes.emplace_back(now, names.at(code), value);
    }
  }
  return wave;
}

// What `simulate`, between the begin and the end of the file, makes of a component.
template <class Simulate>
Waveform traced(const Component& component, const Simulate& simulate) {
  const std::string path = ::testing::TempDir() + "brick_trace_" + std::to_string(getpid());
  sc_core::sc_trace_file* file = sc_core::sc_create_vcd_trace_file(path.c_str());
  sc_trace(file, component, "it");
  simulate();
  sc_core::sc_close_vcd_trace_file(file);
  Waveform wave = read_waveform(path + ".vcd");
  std::filesystem::remove(path + ".vcd");
  return wave;
}

std::map<std::string, unsigned> widths(const std::vector<PinInfo>& table) {
  std::map<std::string, unsigned> widths;
  for (const PinInfo& info : table)
    if (info.direction != PinDirection::kInner) widths[info.name] = info.width;
  return widths;
}

// A pin that turns twice in an instant has not moved.
std::vector<Change> input_changes(const Traffic& traffic, const std::vector<PinInfo>& table) {
  std::map<std::string, std::uint32_t> level;
  for (const PinInfo& info : table) level[info.name] = info.idle;
  std::map<std::pair<Picoseconds, std::string>, std::uint32_t> last;
  for (const PinChange& change : traffic.pins) last[{change.time, change.pin}] = change.value;
  std::vector<Change> changes;
  for (const auto& [at, value] : last) {
    if (std::exchange(level[at.second], value) != value) changes.emplace_back(at.first, at.second, value);
  }
  return changes;
}

TEST(ComponentTrace, PinsMoveAsTheBlockSaysBoundOrNot) {
  BRICK_COVERS("CARD-1");
  constexpr Tick kTraced = 100'000;
  for (const Engine& engine : {model_engine(), rtl_engine(1), lockstep_engine(2)})
    in_own_process([&] {
      const Traffic traffic = servo_ic_traffic(3, kTraced);
      ServoIcBlock block;
      Seen expected = run(block, traffic), seen;
      const std::vector<Change> inputs = input_changes(traffic, ServoIc::pin_table());
      ASSERT_GT(expected.changes.size(), 1000u);
      ASSERT_GT(inputs.size(), 500u);
      TimeBase time("time");
      ServoIc ic("ic", time, engine);
      const Binds binds = [](const std::string& pin) {  // the inputs and one output
        const auto& table = ServoIc::pin_table();
        const auto row = std::find_if(table.begin(), table.end(), [&pin](const PinInfo& i) { return i.name == pin; });
        return row->direction == PinDirection::kIn || pin == "phase_o";
      };
      Rig rig("rig", ic, traffic, 4, sc_core::SC_ZERO_TIME, binds);
      rig.socket().bind(ic.registers);
      const Waveform wave = traced(ic, [&] { sc_core::sc_start(sc_core::sc_time::from_value(traffic.end - 1)); });
      EXPECT_EQ(wave.unit, "1 ps");
      EXPECT_EQ(wave.scope, ".SystemC.it");
      EXPECT_EQ(wave.widths, widths(ServoIc::pin_table()));
      expected.changes.insert(expected.changes.end(), inputs.begin(), inputs.end());
      seen.changes = wave.changes;
      seen.answers = expected.answers;
      EXPECT_EQ(difference(seen, expected, traffic.end, all), "");
    });
}

TEST(ComponentTrace, WidePinsShowTheirValues) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    ClockSelect select("select", time);
    sc_core::sc_signal<bool> drives("drives");
    select.phase_oe_i[18](drives);
    const Waveform wave = traced(select, [&] {
      sc_core::sc_start(1, SC_US);
      drives = true;
      sc_core::sc_start(1, SC_US);
    });
    EXPECT_EQ(wave.widths, widths(ClockSelect::pin_table()));
    EXPECT_EQ(wave.first.at("fitted"), 0x3FFFFFu) << "idle: all ICs";
    EXPECT_EQ(wave.first.at("phase_source"), 31u) << "none";
    ASSERT_EQ(wave.changes.size(), 2u);
    EXPECT_EQ(wave.changes[0], Change(1'000'000, "phase_oe_i18", 1));
    EXPECT_EQ(std::get<1>(wave.changes[1]), "phase_source");
    EXPECT_EQ(std::get<2>(wave.changes[1]), 18u);
  });
}

TEST(ComponentTrace, HasThePinsOfABoardWhoseMasterIsOnTheSockets) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    Board board("board", time);
    Initiator cpu("cpu", [](Initiator&) {});
    cpu.socket.bind(board.port_a);
    const Waveform wave = traced(board, [] { sc_core::sc_start(1, SC_US); });
    EXPECT_EQ(wave.widths, widths(Board::pin_table(BoardOptions{}.fitted)));
    EXPECT_EQ(wave.first.at("line_select"), 0x951u) << "idle";
  });
}

TEST(ComponentTrace, ComesTooLateInARunningSimulation) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    ServoIc ic("ic", time);
    sc_core::sc_start(1, SC_US);
    std::string type;
    try {
      sc_trace(nullptr, ic, "ic");
    } catch (const sc_core::sc_report& report) { type = report.get_msg_type(); }
    EXPECT_EQ(type, "/brick/trace");
  });
}

}  // namespace
}  // namespace brick::component
