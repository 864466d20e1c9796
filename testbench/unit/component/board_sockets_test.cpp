// The board's component with random traffic at both of its buses at once, through their sockets, against the same board
// and bus masters driven through their C++ faces: pin for pin and time for time.
#include <gtest/gtest.h>

#include <brick/board.h>
#include <brick/rtl.h>

#include "systemc/board/model_board.h"
#include "testbench/unit/component/bus_traffic.h"
#include "testbench/unit/component/engines.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr std::uint32_t kSmallBoard = 0x3;

// A process that makes the accesses of one bus; its own time runs ahead of the kernel's by the quantum at most.
class BusUser : public sc_core::sc_module {
 public:
  BusUser(const sc_core::sc_module_name& name, const std::vector<BusAccess>& program, const sc_core::sc_time& quantum)
      : sc_module(name), program_(program), quantum_(quantum) {
    SC_HAS_PROCESS(BusUser);
    SC_THREAD(run);
  }
  tlm_utils::simple_initiator_socket_optional<BusUser> port_a{"port_a"}, isa_io{"isa_io"}, isa_memory{"isa_memory"};
  std::vector<Answer> answers;

 private:
  void run() {
    sc_core::sc_time local;
    for (const BusAccess& access : program_) {
      local += sc_core::sc_time::from_value(access.idle);
      if (local > quantum_) {
        wait(local);
        local = sc_core::SC_ZERO_TIME;
      }
      unsigned char data[4], enables[4];
      for (unsigned i = 0; i < 4; ++i) {
        data[i] = static_cast<unsigned char>(access.value >> 8 * i);
        enables[i] = (access.enables >> i & 1) != 0 ? TLM_BYTE_ENABLED : TLM_BYTE_DISABLED;
      }
      tlm::tlm_generic_payload payload;
      payload.set_command(access.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
      payload.set_address(access.address);
      payload.set_data_ptr(data);
      payload.set_data_length(access.length);
      payload.set_streaming_width(access.length);
      if (access.enables != 0xF) {
        payload.set_byte_enable_ptr(enables);
        payload.set_byte_enable_length(4);
      }
      (access.socket == BusAccess::kPortA ? port_a
       : access.socket == BusAccess::kIo  ? isa_io
                                          : isa_memory)
          ->b_transport(payload, local);
      std::uint32_t value = 0;
      for (unsigned i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(data[i]) << 8 * i;
      if (payload.get_response_status() == tlm::TLM_ADDRESS_ERROR_RESPONSE) value = kNotMapped;
      if (payload.get_response_status() == tlm::TLM_GENERIC_ERROR_RESPONSE) value = kNotMade;
      answers.emplace_back((sc_core::sc_time_stamp() + local).value(), value);
    }
  }
  const std::vector<BusAccess>& program_;
  sc_core::sc_time quantum_;
};

// Pins that traffic moves, and all outputs of the buses and connectors.
bool bound_pin(const std::string& pin) {
  static const std::vector<std::string> kInputs{"rst_n", "mi1", "mi2", "axexp0", "axexp1"};
  for (const PinInfo& info : Board::pin_table(kSmallBoard))
    if (info.name == pin)
      return info.direction == PinDirection::kOut ? info.word < kBoardOutputWords
                                                  : std::find(kInputs.begin(), kInputs.end(), pin) != kInputs.end();
  return false;
}
bool few_pins(const std::string& pin) { return bound_pin(pin) && (pin == "isa_irq" || pin.find("_o") == pin.npos); }
bool no_outputs(const std::string& pin) {
  static const std::vector<std::string> kInputs{"rst_n", "mi1", "mi2", "axexp0", "axexp1"};
  return std::find(kInputs.begin(), kInputs.end(), pin) != kInputs.end();
}

std::string differences(const Engine& engine, const BusTraffic& buses, const BusSeen& expected, unsigned quantum_us,
                        const Binds& binds) {
  const sc_core::sc_time quantum(quantum_us, sc_core::SC_US);
  Traffic pins;
  pins.pins = buses.pins;
  TimeBase time("time");
  Board board("board", time, {kSmallBoard, 0}, engine);
  Rig rig("rig", board, pins, 0, quantum, binds);
  BusUser cpu("cpu", buses.port_a, quantum), host("host", buses.isa, quantum);
  cpu.port_a.bind(board.port_a);
  host.isa_io.bind(board.isa_io);
  host.isa_memory.bind(board.isa_memory);
  sc_core::sc_start(sc_core::sc_time::from_value(buses.end - 1));
  const Picoseconds end = edge_time(kTicks - 2);  // what acts between the last edges is seen by one of them alone
  const auto answers = [&](const std::vector<Answer>& component, const std::vector<Answer>& block) {
    return difference({{}, component, {}}, {{}, block, {}}, end, binds);
  };
  std::string changes = difference(rig.seen, {expected.changes, {}, {}}, end, binds);
  const std::string at_port_a = answers(cpu.answers, expected.port_a), at_isa = answers(host.answers, expected.isa);
  if (!changes.empty()) return changes;
  return !at_port_a.empty() ? "Port A: " + at_port_a : at_isa.empty() ? "" : "ISA: " + at_isa;
}

unsigned moves(const BusSeen& seen, const std::string& pin, std::uint32_t level) {
  return static_cast<unsigned>(std::count_if(seen.changes.begin(), seen.changes.end(), [&](const Change& c) {
    return std::get<1>(c) == pin && std::get<2>(c) == level;
  }));
}

struct Expected {
  BusTraffic traffic;
  BusSeen seen;
};
const Expected& expected_of_the_board() {
  static const Expected all = [] {
    Expected e{bus_traffic(21, kTicks), {}};
    e.seen = run(*make_model_board(kSmallBoard), kSmallBoard, e.traffic);
    return e;
  }();
  return all;
}

TEST(BoardSockets, TrafficReachesEverything) {
  const BusSeen& seen = expected_of_the_board().seen;
  EXPECT_GE(seen.reads, 3'000u);
  EXPECT_GE(seen.writes, 3'000u);
  EXPECT_GE(moves(seen, "busy_host", 1), 50u) << "the host waits for a word of the RAM";
  EXPECT_GE(moves(seen, "busy_cpu", 1), 50u);
  EXPECT_GE(moves(seen, "isa_iochrdy", 0), 50u) << "a stretched cycle of ISA";
  EXPECT_GE(moves(seen, "pa_ta_n", 1), 1'000u) << "of Port A";
  EXPECT_GE(moves(seen, "isa_irq", 1), 20u);
  EXPECT_GE(moves(seen, "phase", 0), 10u);
  EXPECT_GE(moves(seen, "irq_host", 1), 10u);
  const auto answered = [&seen](std::uint32_t value) {
    return std::count_if(seen.port_a.begin(), seen.port_a.end(),
                         [value](const Answer& a) { return a.second == value; });
  };
  EXPECT_GE(answered(kNotMapped), 100);
  EXPECT_GE(answered(kNotMade), 1) << "a reset in the middle of a cycle";
}

class BoardSocketsOn : public ::testing::TestWithParam<std::tuple<const char*, unsigned>> {};
TEST_P(BoardSocketsOn, AgreeWithTheBoardAndItsMasters) {
  BRICK_COVERS("CARD-1 CARD-2");
  const auto& [engine, quantum] = GetParam();
  const Expected& e = expected_of_the_board();
  in_own_process([&, engine = engine_named(engine), us = quantum] {
    EXPECT_EQ(differences(engine, e.traffic, e.seen, us, bound_pin), "");
  });
}
INSTANTIATE_TEST_SUITE_P(All, BoardSocketsOn,
                         ::testing::Combine(::testing::Values("model", "rtl", "lockstep"),
                                            ::testing::Values(0u, 3u, 10u)));

TEST(BoardSockets, UnboundPinsChangeNothing) {
  BRICK_COVERS("CARD-1");
  const Expected& e = expected_of_the_board();
  for (const char* engine : {"model", "rtl"})
    for (const Binds& binds : {Binds(few_pins), Binds(no_outputs)})
      in_own_process([&] { EXPECT_EQ(differences(engine_named(engine), e.traffic, e.seen, 3, binds), ""); });
}

TEST(BoardSockets, AStrobeThatIsLateByATickIsFound) {
  const Expected& e = expected_of_the_board();
  for (const BusFault fault : {BusFault::kLateStrobe, BusFault::kLateAddress}) {
    const BusSeen wrong = run(*make_model_board(kSmallBoard), kSmallBoard, e.traffic, fault);
    in_own_process(
        [&] { EXPECT_NE(differences(model_engine(), e.traffic, wrong, 0, bound_pin), "") << static_cast<int>(fault); });
  }
}

}  // namespace
}  // namespace brick::component
