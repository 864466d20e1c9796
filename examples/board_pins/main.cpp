// The controller board with a CPU of one's own that makes its bus cycles itself, on the pins of Port A; examples/board
// has one that leaves them to a socket. It starts PHASE and SERVO, reads a register back, writes a word of the
// dual-ported RAM, and is interrupted by each fall of PHASE. The engine is the argument: model, rtl.
#include <brick/board.h>
#ifdef WITH_RTL
#include <brick/rtl.h>
#endif

#include <iostream>
#include <string>

using namespace brick::component;

struct Cpu : sc_core::sc_module {
  sc_core::sc_signal<bool> rst_n{"rst_n"}, x{"x"}, rd_n{"rd_n", true}, wr_n{"wr_n", true}, ta_n{"ta_n"}, phase{"phase"};
  sc_core::sc_signal<sc_dt::sc_uint<19>> addr{"addr"};
  sc_core::sc_signal<sc_dt::sc_uint<4>> aa{"aa"};
  sc_core::sc_signal<sc_dt::sc_uint<24>> out{"out"}, in{"in"};
  unsigned interrupts = 0;
  bool passed = false;

  Cpu(sc_core::sc_module_name name, Board& board) : sc_module(name) {
    board.rst_n(rst_n), board.pa_x(x), board.pa_rd_n(rd_n), board.pa_wr_n(wr_n), board.pa_ta_n(ta_n);
    board.pa_addr(addr), board.pa_aa(aa), board.pa_data_i(out), board.pa_data_o(in), board.phase(phase);
    SC_HAS_PROCESS(Cpu);
    SC_THREAD(run);
    SC_METHOD(interrupt);
    sensitive << phase.negedge_event();
    dont_initialize();
  }

 private:
  static constexpr unsigned kDpram = 4, kGateIcs = 2;  // AA2, AA1

  // One cycle: address and area, 20 ns later the strobe, for 100 ns and as long as /TA is high.
  std::uint32_t cycle(bool write, unsigned area, bool x_space, std::uint32_t address, std::uint32_t data = 0) {
    sc_core::sc_signal<bool>& strobe = write ? wr_n : rd_n;
    addr = address, x = x_space, aa = area, out = data;
    wait(20, sc_core::SC_NS);
    strobe = false;
    wait(100, sc_core::SC_NS);
    while (ta_n) wait(ta_n.negedge_event());
    const std::uint32_t value = in.read();
    strobe = true;
    wait(20, sc_core::SC_NS);
    aa = 0;
    wait(60, sc_core::SC_NS);
    return value;
  }

  void run() {
    wait(1, sc_core::SC_US);
    rst_n = true;
    wait(200, sc_core::SC_NS);
    cycle(true, kGateIcs, true, 0x78004, 0x3008D2);  // servo IC 0 drives PHASE and SERVO
    const std::uint32_t clock_control = cycle(false, kGateIcs, true, 0x78004);
    cycle(true, kDpram, false, 0x60010, 0x001234);
    const std::uint32_t word = cycle(false, kDpram, false, 0x60010) & 0xFFFF;
    wait(1, sc_core::SC_MS);
    std::cout << std::hex << "clock control $" << clock_control << ", dual-ported RAM $" << word << std::dec << ", "
              << interrupts << " interrupts\n";
    passed = clock_control == 0x3008D2 && word == 0x1234 && interrupts >= 8;  // 9.035 kHz
    sc_core::sc_stop();
  }
  void interrupt() { ++interrupts; }
};

int sc_main(int count, char* arguments[]) {
  Engine engine = model_engine();
#ifdef WITH_RTL
  if (count > 1 && arguments[1] == std::string("rtl")) engine = rtl_engine();
#endif
  TimeBase time("time");
  Board board("board", time, {}, engine);
  Cpu cpu("cpu", board);
  sc_core::sc_start(10, sc_core::SC_MS);
  return cpu.passed ? 0 : 1;
}
