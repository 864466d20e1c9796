// The interrupt controller on an ISA bus of one's own: a decoder turns I/O cycles at $218 to $21B into accesses to the
// registers, a host on the bus serves an interrupt. The engine is the argument: model, rtl.
#include <brick/interrupt_controller.h>
#ifdef WITH_RTL
#include <brick/rtl.h>
#endif
#include <tlm_utils/simple_initiator_socket.h>

#include <iostream>
#include <string>

using namespace brick::component;
using namespace sc_core;

struct Bus {
  sc_signal<bool> ior_n{"ior_n", true}, iow_n{"iow_n", true};
  sc_signal<sc_dt::sc_uint<16>> sa{"sa"};
  sc_signal<sc_dt::sc_uint<8>, SC_MANY_WRITERS> sd{"sd", 0xFF};  // pulled up
};

struct Decoder : sc_module {
  tlm_utils::simple_initiator_socket<Decoder> registers{"registers"};
  Decoder(sc_module_name name, Bus& bus) : sc_module(name), bus_(bus) {
    SC_HAS_PROCESS(Decoder);
    SC_THREAD(run);
  }

 private:
  void run() {
    for (;;) {
      wait(bus_.ior_n.negedge_event() | bus_.iow_n.posedge_event());  // a write takes the data as its command ends
      if ((bus_.sa.read() & 0xFFFC) != 0x218) continue;
      const bool read = !bus_.ior_n;
      unsigned char data = static_cast<unsigned char>(bus_.sd.read());
      tlm::tlm_generic_payload payload;
      payload.set_command(read ? tlm::TLM_READ_COMMAND : tlm::TLM_WRITE_COMMAND);
      payload.set_address(bus_.sa.read() & 3);
      payload.set_data_ptr(&data);
      payload.set_data_length(1);
      payload.set_streaming_width(1);
      sc_time delay;
      registers->b_transport(payload, delay);  // at the next edge of clk_ref, 25.4 ns at most
      if (!read) continue;
      bus_.sd = data;
      wait(bus_.ior_n.posedge_event());
      bus_.sd = 0xFF;
    }
  }
  Bus& bus_;
};

struct Host : sc_module {
  sc_in<bool> irq{"irq"};
  sc_out<bool> ir1{"ir1"};
  bool passed = false;
  Host(sc_module_name name, Bus& bus) : sc_module(name), bus_(bus) {
    SC_HAS_PROCESS(Host);
    SC_THREAD(run);
  }

 private:
  // A cycle of 8 bits: the address 120 ns before the command, which takes 540 ns.
  unsigned cycle(bool write, unsigned port, unsigned data = 0xFF) {
    bus_.sa = port;
    if (write) bus_.sd = data;
    wait(120, SC_NS);
    (write ? bus_.iow_n : bus_.ior_n) = false;
    wait(540, SC_NS);
    const unsigned value = bus_.sd.read();
    (write ? bus_.iow_n : bus_.ior_n) = true;
    wait(60, SC_NS);
    if (write) bus_.sd = 0xFF;
    wait(120, SC_NS);
    return value;
  }
  void run() {
    wait(1, SC_US);
    cycle(true, 0x21A, 0x02);  // mask: line 1 may interrupt, by its edge
    ir1 = true;
    const sc_time before = sc_time_stamp();
    wait(1, SC_US, irq.posedge_event());
    const double after = (sc_time_stamp() - before).to_seconds() * 1e9;
    const unsigned status = cycle(false, 0x218), nobody = cycle(false, 0x300);
    cycle(true, 0x218, 0);  // served
    std::cout << "IRQ " << after << " ns after the line, status " << status << ", nobody at $300: " << nobody << "\n";
    passed = after < 76.3 && status == 0x02 && nobody == 0xFF && !irq && cycle(false, 0x219) == 0x02;
    sc_stop();
  }
  Bus& bus_;
};

int sc_main(int count, char* arguments[]) {
  Engine engine = model_engine();
#ifdef WITH_RTL
  if (count > 1 && arguments[1] == std::string("rtl")) engine = rtl_engine();
#endif
  TimeBase time("time");
  InterruptController pic("pic", time, engine);
  Bus bus;
  Decoder decoder("decoder", bus);
  Host host("host", bus);
  sc_signal<bool> irq("irq"), ir1("ir1");
  decoder.registers.bind(pic.registers);
  pic.irq(irq), pic.ir[1](ir1), host.irq(irq), host.ir1(ir1);
  sc_start(100, SC_US);
  return host.passed ? 0 : 1;
}
