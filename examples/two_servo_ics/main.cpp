// Two servo ICs on one PHASE and one SERVO net, as on a board: IC 0 drives them, lets go, and a little later IC 1 takes
// over. No clock of the net comes early on the way, and none is short. The engine is the argument: model, rtl,
// lockstep.
#include <brick/servo_ic.h>
#ifdef WITH_RTL
#include <brick/rtl.h>
#endif
#include <tlm_utils/simple_initiator_socket.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <string>

using namespace brick::component;

// A net with a pull-up: an IC that does not drive it shows 1.
struct Net : sc_core::sc_module {
  std::array<sc_core::sc_signal<bool>, 2> driver{sc_core::sc_signal<bool>("driver0", true),
                                                 sc_core::sc_signal<bool>("driver1", true)};
  sc_core::sc_signal<bool> level{"level", true};

  explicit Net(sc_core::sc_module_name name) : sc_module(name) {
    SC_HAS_PROCESS(Net);
    SC_METHOD(join);
    sensitive << driver[0] << driver[1];
  }
  void join() { level = driver[0] && driver[1]; }
};

// What has been seen of a net, in ticks.
struct Clock {
  int falls = 0;
  double fall = 0;
  double shortest = 1e9, longest = 0;  // low level
  double gap = 0;                      // between two falls

  void edge(bool level) {
    const double now = sc_core::sc_time_stamp().to_seconds() * 117'964'800;
    if (level) {
      shortest = std::min(shortest, now - fall);
      longest = std::max(longest, now - fall);
    } else {
      if (falls++ > 0) gap = std::max(gap, now - fall);
      fall = now;
    }
  }
};
std::ostream& operator<<(std::ostream& out, const Clock& c) {
  return out << c.falls << " falls, low for " << c.shortest << " to " << c.longest << " ticks, at most " << c.gap
             << " apart";
}

struct Test : sc_core::sc_module {
  std::array<tlm_utils::simple_initiator_socket<Test>, 2> ic;
  sc_core::sc_in<bool> phase{"phase"}, servo{"servo"};
  Clock phases, servos;

  explicit Test(sc_core::sc_module_name name) : sc_module(name) {
    SC_HAS_PROCESS(Test);
    SC_THREAD(program);
    SC_METHOD(phase_edge);
    sensitive << phase;
    dont_initialize();
    SC_METHOD(servo_edge);
    sensitive << servo;
    dont_initialize();
  }

  void write(int which, unsigned address, std::uint32_t value) {
    tlm::tlm_generic_payload payload;
    payload.set_write();
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
    payload.set_data_length(4);
    payload.set_streaming_width(4);
    sc_core::sc_time delay;
    ic[which]->b_transport(payload, delay);
    if (payload.is_response_error()) SC_REPORT_ERROR("test", payload.get_response_string().c_str());
  }
  void program() {
    constexpr unsigned kClockControl = 8 * 0x04 + 4;
    write(0, kClockControl, 0x3008D2);  // factory setting of the source: PHASE and SERVO are outputs
    wait(3.3, sc_core::SC_MS);
    write(0, kClockControl, 0x3038D2);  // inputs
    wait(168, sc_core::SC_US);
    write(1, kClockControl, 0x3008D2);
  }
  void phase_edge() { phases.edge(phase); }
  void servo_edge() { servos.edge(servo); }
};

Engine engine_named(const std::string& name) {
#ifdef WITH_RTL
  if (name == "rtl") return rtl_engine();
  if (name == "lockstep") return lockstep_engine();
#endif
  if (name != "model") SC_REPORT_ERROR("two_servo_ics", ("no engine " + name).c_str());
  return model_engine();
}

int sc_main(int count, char* arguments[]) {
  const Engine engine = engine_named(count > 1 ? arguments[1] : "model");
  TimeBase time("time");
  ServoIc ic0("ic0", time, engine), ic1("ic1", time, engine);
  Net phase("phase"), servo("servo");
  Test test("test");
  sc_core::sc_signal<bool> driven[2];
  ServoIc* ics[] = {&ic0, &ic1};
  for (int i = 0; i < 2; ++i) {
    test.ic[i].bind(ics[i]->registers);
    ics[i]->phase_o(phase.driver[i]), ics[i]->phase_i(phase.level);
    ics[i]->servo_o(servo.driver[i]), ics[i]->servo_i(servo.level);
    ics[i]->phase_oe(driven[i]);
  }
  test.phase(phase.level), test.servo(servo.level);
  sc_core::sc_start(6.6, sc_core::SC_MS);
  std::cout << "PHASE: " << test.phases << "\nSERVO: " << test.servos << "\ndriven by " << (driven[0] ? "IC 0" : "")
            << (driven[1] ? "IC 1" : "") << "\n";
  // A period of PHASE is 13057 ticks, 6528 high, 6529 low; 445 us without a fall are the most. SERVO falls with every
  // fourth of its falls and is low for one period. A period before the old source lets go, 168 us, two periods of PHASE
  // until the new one is on the net and seven of its falls are the most between two falls of SERVO.
  const auto low = [](const Clock& clock, double ticks) {
    return clock.shortest > ticks - 0.1 && clock.longest < ticks + 0.1;
  };
  const bool passed = test.phases.falls > 50 && low(test.phases, 6529) && test.phases.gap < 52'494 &&
                      test.servos.falls > 8 && low(test.servos, 13057) &&
                      test.servos.gap < 4 * 13'057 + 19'819 + 9 * 13'057 && !driven[0] && driven[1];
  return passed ? 0 : 1;
}
