// The controller board with a CPU of one's own in place of the real one: a sequencer with an initiator on Port A. It
// starts PHASE and SERVO, and at each fall of PHASE reads a register of the servo IC and counts in the dual-ported RAM,
// where a host on ISA looks. Each access is a bus cycle with real edges. The engine is the argument: model, rtl.
#include <brick/board.h>
#ifdef WITH_RTL
#include <brick/rtl.h>
#endif
#include <tlm_utils/simple_initiator_socket.h>

#include <iostream>
#include <string>

using namespace brick::component;
using sc_core::sc_time;

struct Initiator : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Initiator> socket{"socket"};
  sc_time local;  // of this process ahead of the kernel; an access comes back with none
  using sc_module::sc_module;

  std::uint32_t access(tlm::tlm_command command, std::uint64_t address, unsigned bytes, std::uint32_t value = 0) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
    payload.set_data_length(bytes);
    payload.set_streaming_width(bytes);
    socket->b_transport(payload, local);
    if (payload.is_response_error()) SC_REPORT_ERROR(name(), payload.get_response_string().c_str());
    return value;
  }
};

constexpr unsigned kTimes = 8;

struct Cpu : Initiator {
  sc_core::sc_in<bool> phase{"phase"};
  explicit Cpu(sc_core::sc_module_name name) : Initiator(name) {
    SC_HAS_PROCESS(Cpu);
    SC_THREAD(run);
  }
  unsigned good = 0;

 private:
  enum Operation { kMove, kAwaitPhase, kCheck, kCount };
  struct Instruction {
    Operation operation;
    std::uint64_t address;  // 8 a + 4 for X:a, 8 a for Y:a
    std::uint32_t value;
  };
  static constexpr std::uint64_t kBcr = 8 * 0xFFFFFB + 4, kClocks = 8 * 0x78004 + 4, kCounter = 8 * 0x60000;
  static constexpr Instruction kStart[] = {{kMove, kBcr, 0x1F1D20}, {kMove, kClocks, 0x3008D2}};  // AA1: 9 wait states
  static constexpr Instruction kLoop[] = {{kAwaitPhase, 0, 0}, {kCheck, kClocks, 0x3008D2}, {kCount, kCounter, 1}};

  void execute(const Instruction& i) {
    local += sc_time(12.7, sc_core::SC_NS);  // a clock of 78.6 MHz
    if (i.operation == kAwaitPhase)
      wait(phase.negedge_event());
    else if (i.operation == kMove)
      access(tlm::TLM_WRITE_COMMAND, i.address, 4, i.value);
    else if (i.operation == kCheck)
      good += access(tlm::TLM_READ_COMMAND, i.address, 4) == i.value;
    else
      access(tlm::TLM_WRITE_COMMAND, i.address, 4, access(tlm::TLM_READ_COMMAND, i.address, 4) + i.value);
  }
  void run() {
    wait(200, sc_core::SC_NS);  // the board leaves its reset
    for (const Instruction& i : kStart) execute(i);
    for (unsigned n = 0; n < kTimes; ++n)
      for (const Instruction& i : kLoop) execute(i);
  }
};

struct Host : Initiator {
  explicit Host(sc_core::sc_module_name name) : Initiator(name) {
    SC_HAS_PROCESS(Host);
    SC_THREAD(run);
  }
  bool done = false;

 private:
  void run() {
    while (access(tlm::TLM_READ_COMMAND, 0xD0000, 2) != kTimes) local += sc_time(10, sc_core::SC_US);
    std::cout << "Host: the CPU has counted to " << kTimes << " at " << sc_core::sc_time_stamp() << "\n";
    done = true;
    sc_core::sc_stop();
  }
};

int sc_main(int count, char* arguments[]) {
  Engine engine = model_engine();
#ifdef WITH_RTL
  if (count > 1 && arguments[1] == std::string("rtl")) engine = rtl_engine();
#endif
  TimeBase time("time");
  Board board("board", time, {}, engine);
  Cpu cpu("cpu");
  Host host("host");
  sc_core::sc_signal<bool> phase("phase");
  cpu.socket.bind(board.port_a), host.socket.bind(board.isa_memory);
  cpu.phase(phase), board.phase(phase);
  sc_core::sc_start(2, sc_core::SC_MS);  // PHASE is 9.035 kHz
  return host.done && cpu.good == kTimes ? 0 : 1;
}
