// Two servo ICs on one net of PHASE and SERVO, the source moved from one to the other: edge t of one is what edge t + 1
// of the other sees, on each pair of engines.
#include <gtest/gtest.h>

#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr Tick kNetTicks = 150'000;
constexpr unsigned kPwmControl = 8 * 28 + 4;                    // byte of X:+$1C
constexpr std::uint32_t kDrive = 0x0008D2, kFollow = 0x0038D2;  // servo-ic:2.6, both dividers 0

// IC 0 drives, then IC 1 as well, then IC 0 lets go; each from its own initiator at its own times.
Traffic net_traffic(unsigned ic) {
  Traffic traffic;
  traffic.end = edge_time(kNetTicks);
  traffic.accesses = {{1'000'000 + ic * 13'000, true, kPwmControl, 200u << 8 | 15}};
  if (ic == 0)
    traffic.accesses.insert(traffic.accesses.end(),
                            {{2'000'000, true, kClockControl, kDrive}, {600'000'000, true, kClockControl, kFollow}});
  else
    traffic.accesses.push_back({550'000'000, true, kClockControl, kDrive});
  return traffic;
}

bool clocks(const std::string& pin) { return pin.rfind("phase_o", 0) == 0 || pin.rfind("servo_o", 0) == 0; }

// Both blocks in turn, the net in between.
std::array<Seen, 2> run_both() {
  std::array<Seen, 2> seen;
  std::array<Traffic, 2> traffic{net_traffic(0), net_traffic(1)};
  std::array<ServoIcBlock, 2> block{ServoIcBlock("a"), ServoIcBlock("b")};
  std::array<std::map<std::string, std::uint32_t>, 2> shown{block[0].outputs(), block[1].outputs()};
  std::array<std::size_t, 2> next{};
  std::array<Tick, 2> at{};
  std::array<std::uint32_t, 2> nets{1, 1};
  const auto edge_of = [](Picoseconds time) {
    return (edge_after(time) + kTicksPerRef - 1) / kTicksPerRef * kTicksPerRef;
  };
  for (unsigned i = 0; i < 2; ++i) at[i] = edge_of(traffic[i].accesses[0].idle);
  for (Tick t = 1; t < kNetTicks; ++t) {
    const auto net = [&shown](const char* pin) { return shown[0][pin] & shown[1][pin]; };
    if (const std::array<std::uint32_t, 2> now{net("phase_o"), net("servo_o")}; now != nets) {
      nets = now;
      for (unsigned i = 0; i < 2; ++i) {
        block[i].set("phase_i", nets[0]);
        block[i].set("servo_i", nets[1]);
      }
    }
    for (unsigned i = 0; i < 2; ++i) {
      block[i].edge(t);
      if (t == at[i]) {
        block[i].accessed(traffic[i].accesses[next[i]]);
        seen[i].answers.emplace_back(edge_time(t), traffic[i].accesses[next[i]].value);
        at[i] = ++next[i] < traffic[i].accesses.size() ? edge_of(edge_time(t) + traffic[i].accesses[next[i]].idle) : 0;
      }
    }
    for (unsigned i = 0; i < 2; ++i) {
      if (!block[i].moved()) continue;
      const auto now = block[i].outputs();
      for (const auto& [name, level] : now)
        if (shown[i][name] != level) seen[i].changes.emplace_back(edge_time(t), name, level);
      shown[i] = now;
    }
  }
  return seen;
}

class Net : public sc_core::sc_module {
 public:
  explicit Net(const sc_core::sc_module_name& name) : sc_module(name) {
    SC_HAS_PROCESS(Net);
    SC_METHOD(join);
    for (auto& pin : pins) sensitive << pin;
  }
  std::array<sc_core::sc_in<bool>, 2> pins;
  sc_core::sc_out<bool> net;

 private:
  void join() { net.write(pins[0].read() && pins[1].read()); }
};

void nets_agree(const Engine& first, const Engine& second) {
  const std::array<Seen, 2> expected = run_both();
  TimeBase time("time");
  const std::array<Traffic, 2> traffic{net_traffic(0), net_traffic(1)};
  ServoIc a("a", time, first), b("b", time, second);
  const sc_core::sc_time quantum;
  Rig rig_a("rig_a", a, traffic[0], 4, quantum, clocks), rig_b("rig_b", b, traffic[1], 4, quantum, clocks);
  rig_a.socket().bind(a.registers);
  rig_b.socket().bind(b.registers);
  Net phase("phase"), servo("servo");
  sc_core::sc_signal<bool> phase_net("phase_net", true), servo_net("servo_net", true);
  phase.net(phase_net);
  servo.net(servo_net);
  for (ServoIc* ic : {&a, &b}) {
    ic->phase_i(phase_net);
    ic->servo_i(servo_net);
  }
  phase.pins[0](rig_a.signal("phase_o"));
  phase.pins[1](rig_b.signal("phase_o"));
  servo.pins[0](rig_a.signal("servo_o"));
  servo.pins[1](rig_b.signal("servo_o"));
  sc_core::sc_start(sc_core::sc_time::from_value(edge_time(kNetTicks) - 1));
  ASSERT_GT(expected[0].changes.size(), 300u);
  ASSERT_GT(expected[1].changes.size(), 100u);
  EXPECT_EQ(difference(rig_a.seen, expected[0], traffic[0].end, clocks), "");
  EXPECT_EQ(difference(rig_b.seen, expected[1], traffic[1].end, clocks), "");
}

TEST(ClockNet, SourceMovesBetweenModels) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { nets_agree(model_engine(), model_engine()); });
}
TEST(ClockNet, SourceMovesBetweenRtl) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { nets_agree(rtl_engine(), rtl_engine()); });
}
TEST(ClockNet, SourceMovesBetweenEngines) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { nets_agree(rtl_engine(), model_engine()); });
  in_own_process([] { nets_agree(model_engine(), lockstep_engine()); });
}

// In a module of the user's, pins go to its own ports, inputs to its outputs too.
class Board : public sc_core::sc_module {
 public:
  Board(const sc_core::sc_module_name& name, TimeBase& time) : sc_module(name), ic("ic", time) {
    ic.ch[0].pwm_a_top(top);
    ic.ch[1].enc_a(top);
    ic.ch[1].enc_b.bind(both);
    ic.ch[1].enc_c(in);
  }
  sc_core::sc_out<bool> top{"top"};
  sc_core::sc_inout<bool> both{"both"};
  sc_core::sc_in<bool> in{"in"};
  ServoIc ic;
};

TEST(ClockNet, InputsBindToPortsOfEveryKind) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    Board board("board", time);
    sc_core::sc_signal<bool> top("top"), both("both"), in("in");
    board.top(top);
    board.both(both);
    board.in(in);
    sc_core::sc_start(1, sc_core::SC_US);
    both = true;
    sc_core::sc_start(1, sc_core::SC_US);
    EXPECT_TRUE(board.ic.ch[1].enc_a.bound());
    EXPECT_EQ(board.ic.ch[1].enc_b.read(), 1u);
    EXPECT_EQ(board.ic.ch[1].enc_c.read(), 0u);
  });
}

}  // namespace
}  // namespace brick::component
