// A servo IC in a design of one's own: registers through a TLM socket, pins through signals, a waveform by sc_trace.
// The IC drives PHASE, its channel 1 counts an encoder; the program ends with 1 when either is not as computed.
#include <brick/servo_ic.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <iostream>

using namespace brick::component;

struct Master : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Master> socket{"socket"};
  sc_core::sc_out<bool> a{"a"}, b{"b"};
  sc_core::sc_in<bool> phase{"phase"};
  bool passed = false;

  explicit Master(sc_core::sc_module_name name) : sc_module(name) {
    SC_HAS_PROCESS(Master);
    SC_THREAD(run);
  }

  std::uint32_t access(tlm::tlm_command command, unsigned address, std::uint32_t value = 0) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
    payload.set_data_length(4);
    payload.set_streaming_width(4);
    sc_core::sc_time delay;
    socket->b_transport(payload, delay);  // comes back at the edge that made it
    if (payload.is_response_error()) SC_REPORT_ERROR("master", payload.get_response_string().c_str());
    return value;
  }

  void run() {
    access(tlm::TLM_WRITE_COMMAND, 8 * 0x04 + 4, 0x0008D2);  // X:+$04: both clocks are outputs, dividers 0
    access(tlm::TLM_WRITE_COMMAND, 8 * 0x05 + 4, 0x000003);  // X:+$05: times 4, A before B counts up
    wait(1, sc_core::SC_US);                                 // the input filter has seen where the encoder stands
    for (int quarter = 0; quarter < 40; ++quarter) {         // ten lines of the encoder, A leads
      (quarter % 2 == 0 ? a : b)->write(quarter % 4 < 2);
      wait(1, sc_core::SC_US);
    }
    wait(phase.posedge_event());
    const sc_core::sc_time before = sc_core::sc_time_stamp();
    wait(phase.posedge_event());
    const double period = (sc_core::sc_time_stamp() - before).to_seconds() * 117'964'800;  // in ticks
    const std::uint32_t count = access(tlm::TLM_READ_COMMAND, 8 * 0x01 + 4) & 0xFFFFFF;    // X:+$01: phase position
    std::cout << "PHASE every " << period << " ticks, encoder at " << count << "\n";
    passed = period > 13056.9 && period < 13057.1 && count == 40;  // 2 x 6527 + 3
    sc_core::sc_stop();
  }
};

int sc_main(int, char*[]) {
  TimeBase time("time");
  ServoIc ic("ic", time);  // all other pins stay unbound
  Master master("master");
  sc_core::sc_signal<bool> a("a"), b("b"), phase("phase");
  master.socket.bind(ic.registers);
  master.a(a), master.b(b), master.phase(phase);
  ic.ch[0].enc_a(a), ic.ch[0].enc_b(b), ic.phase_o(phase);
  sc_core::sc_trace_file* file = sc_core::sc_create_vcd_trace_file("servo_ic");
  sc_trace(file, ic, "ic");  // all pins, the unbound ones too
  sc_core::sc_start();
  sc_core::sc_close_vcd_trace_file(file);
  return master.passed ? 0 : 1;
}
