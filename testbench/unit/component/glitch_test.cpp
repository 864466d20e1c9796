// What an input shows within an instant does not count, on no engine: it is taken in the last delta cycle.
#include <gtest/gtest.h>

#include <brick/board.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/engines.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::SC_NS;
using sc_core::SC_US;

constexpr std::uint32_t kAfterReset = 0x3038D2, kWritten = 0x3008D2;

// Low for some delta cycles of one instant, then high again; 0: low until the next tick at least.
void pulse(sc_core::sc_signal<bool>& line, unsigned deltas) {
  line = false;
  if (deltas == 0) sc_core::wait(100, SC_NS);
  for (unsigned i = 0; i < deltas; ++i) sc_core::wait(sc_core::SC_ZERO_TIME);
  line = true;
}

std::uint32_t after_reset_pulse(const Engine& engine, unsigned deltas) {
  TimeBase time("time");
  ServoIc ic("ic", time, engine);
  sc_core::sc_signal<bool> rst_n("rst_n", true), phase("phase");
  std::uint32_t value = 0;
  Initiator initiator("initiator", [&](Initiator& i) {
    sc_core::wait(1, SC_US);
    i.write(kClockControl, kWritten);
    sc_core::wait(1, SC_US);
    pulse(rst_n, deltas);
    sc_core::wait(1, SC_US);
    value = i.read(kClockControl);
  });
  initiator.socket.bind(ic.registers);
  ic.rst_n(rst_n);
  ic.phase_o(phase);
  sc_core::sc_start(10, SC_US);
  EXPECT_TRUE(initiator.ended);
  return value;
}

class Cpu : public sc_core::sc_module {
 public:
  Cpu(const sc_core::sc_module_name& name, Board& board, unsigned deltas) : sc_module(name), deltas_(deltas) {
    board.rst_n(rst_n_), board.pa_x(x_), board.pa_rd_n(rd_n_), board.pa_wr_n(wr_n_), board.pa_addr(addr_);
    board.pa_aa(aa_), board.pa_data_i(out_), board.pa_data_o(in_);
    SC_HAS_PROCESS(Cpu);
    SC_THREAD(run);
  }
  std::uint32_t before = 0, after = 0;

 private:
  void address() {
    addr_ = 0x78004;  // clock control of servo IC 0
    x_ = true;
    aa_ = 2;
    sc_core::wait(20, SC_NS);
  }
  std::uint32_t read() {
    address();
    rd_n_ = false;
    sc_core::wait(300, SC_NS);
    const std::uint32_t value = in_.read();
    rd_n_ = true;
    sc_core::wait(300, SC_NS);
    return value;
  }
  void run() {
    sc_core::wait(1, SC_US);
    rst_n_ = true;
    sc_core::wait(300, SC_NS);
    before = read();
    address();
    out_ = kWritten;
    pulse(wr_n_, deltas_);
    sc_core::wait(300, SC_NS);
    after = read();
  }

  sc_core::sc_signal<bool> rst_n_{"rst_n"}, x_{"x"}, rd_n_{"rd_n", true}, wr_n_{"wr_n", true};
  sc_core::sc_signal<sc_dt::sc_uint<19>> addr_{"addr"};
  sc_core::sc_signal<sc_dt::sc_uint<4>> aa_{"aa"};
  sc_core::sc_signal<sc_dt::sc_uint<24>> out_{"out"}, in_{"in"};
  unsigned deltas_;
};

class Glitch : public testing::TestWithParam<const char*> {};

TEST_P(Glitch, OfTheResetIsNone) {
  BRICK_COVERS("CARD-1 CARD-2");
  for (const unsigned deltas : {1u, 2u, 3u})
    in_own_process([&] { EXPECT_EQ(after_reset_pulse(engine_named(GetParam()), deltas), kWritten) << deltas; });
  in_own_process([] { EXPECT_EQ(after_reset_pulse(engine_named(GetParam()), 0), kAfterReset) << "a real one"; });
}

TEST_P(Glitch, OfAStrobeIsNone) {
  BRICK_COVERS("CARD-1 CARD-2");
  for (const unsigned deltas : {0u, 1u, 2u, 3u})
    in_own_process([deltas] {
      TimeBase time("time");
      Board board("board", time, {}, engine_named(GetParam()));
      Cpu cpu("cpu", board, deltas);
      sc_core::sc_start(5, SC_US);
      EXPECT_EQ(cpu.before, kAfterReset);
      EXPECT_EQ(cpu.after, deltas == 0 ? kWritten : kAfterReset) << deltas;
    });
}

INSTANTIATE_TEST_SUITE_P(Engines, Glitch, testing::Values("model", "rtl", "lockstep"),
                         [](const auto& engine) { return std::string(engine.param); });

}  // namespace
}  // namespace brick::component
