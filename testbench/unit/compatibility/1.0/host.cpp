// What a design of 1.0 names of the public headers: compiled, not run.
#include <brick/board.h>
#include <brick/clock_select.h>
#include <brick/dpram.h>
#include <brick/host_port.h>
#include <brick/host_signals.h>
#include <brick/interrupt_controller.h>
#include <brick/macro_ic.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>
#include <brick/ssi.h>
#include <brick/watchdog.h>
#include <tlm_utils/simple_initiator_socket.h>

using namespace brick::component;

struct Design : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Design> cpu{"cpu"}, host{"host"}, registers{"registers"};
  sc_core::sc_signal<bool> phase{"phase"}, a{"a"};
  TimeBase time{"time"};
  Engine engine = lockstep_engine(7);
  Board board{"board", time, {}, rtl_engine()};
  ServoIc ic{"ic", time, model_engine()};
  ClockSelect select{"select", time};
  Dpram dpram{"dpram", time};
  HostPort port{"port", time};
  HostSignals signals{"signals", time};
  InterruptController interrupts{"interrupts", time};
  MacroIc macro{"macro", time};
  Ssi ssi{"ssi", time};
  Watchdog watchdog{"watchdog", time, engine};

  explicit Design(const sc_core::sc_module_name& name) : sc_module(name) {
    cpu.bind(board.port_a), host.bind(board.isa_memory), registers.bind(ic.registers);
    board.phase(phase), ic.phase_o(phase), ic.ch[0].enc_a(a);
  }
};

int sc_main(int, char*[]) {
  Design design("design");
  sc_core::sc_trace_file* file = sc_core::sc_create_vcd_trace_file("wave");
  sc_trace(file, design.ic, "ic");
  sc_core::sc_start(sc_core::sc_time(1, sc_core::SC_MS));
  sc_core::sc_close_vcd_trace_file(file);
  return design.time.tick_at(design.time.time_of(3)) == 3 ? 0 : 1;
}
