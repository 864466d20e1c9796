// What ports, sockets and the kernel cost: components against the same blocks driven through their C++ face, on the
// same traffic. `brick_component_speed [ROW]`, the rows whose names hold the word; not a test. A row has three runs in
// turn, each a process, for SystemC elaborates once in each: the face; the kernel alone, with a process that waits and
// writes a signal for each change of an input, one that hears it, and one that waits and writes for each instant in
// which an output changes; the component, between the same signals.
#include <brick/board.h>
#include <brick/clock_select.h>
#include <brick/dpram.h>
#include <brick/host_port.h>
#include <brick/host_signals.h>
#include <brick/interrupt_controller.h>
#include <brick/macro_ic.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>
#include <brick/watchdog.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <sysc/kernel/sc_dynamic_processes.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <vector>

#include "systemc/board/model_board.h"
#include "systemc/component/chip.h"
#include "systemc/cosim/engines.h"
#include "testbench/benchmark/measure.h"

namespace brick {
namespace {

namespace c = component;
using Ticks = std::vector<Tick>;

// Plays a list of changes at the instants of their edges.
template <class Changes, class Play>
void play(const c::TimeBase& time, const Changes& changes, const Play& change) {
  for (const auto& at : changes) {
    if constexpr (std::is_same_v<Changes, Ticks>)
      sc_core::wait(time.time_of(at) - sc_core::sc_time_stamp());
    else
      sc_core::wait(time.time_of(at.tick) - sc_core::sc_time_stamp());
    change(at);
  }
}

double kernel(const Ticks& inputs, const Ticks& outputs, Tick end) {
  const c::TimeBase time("time");
  sc_core::sc_signal<bool> in("in"), out("out");
  const auto toggle = [&time](const Ticks& at, sc_core::sc_signal<bool>& line) {
    sc_core::sc_spawn([&time, &at, &line] { play(time, at, [&line](Tick) { line = !line.read(); }); });
  };
  toggle(inputs, in);
  toggle(outputs, out);
  sc_core::sc_spawn_options hears;
  hears.spawn_method();
  hears.set_sensitivity(&in.value_changed_event());
  sc_core::sc_spawn([] {}, "hears", &hears);
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

struct Row {
  std::string name;
  Tick end;
  std::function<double()> face, kernel, shell;
  std::size_t changes;
  double goal = 0;  // percent more than the face; 0: none
};

double in_own_process(const std::function<double()>& run) {
  int ends[2];
  if (pipe(ends) != 0) return 0;
  if (fork() == 0) {
    const double value = run();
    _exit(write(ends[1], &value, sizeof value) == sizeof value ? 0 : 1);
  }
  double value = 0;
  if (read(ends[0], &value, sizeof value) != sizeof value) value = 0;
  wait(nullptr);
  close(ends[0]), close(ends[1]);
  return value;
}

void measure(const Row& r) {
  std::vector<double> faces, kernels, shells;
  for (int round = 0; round < kRounds; ++round) {
    faces.push_back(in_own_process(r.face));
    kernels.push_back(in_own_process(r.kernel));
    shells.push_back(in_own_process(r.shell));
  }
  const double face = median(faces), bare = median(kernels), shell = median(shells), more = (shell - face) / face * 100;
  const auto rate = [&r](double s) { return static_cast<double>(r.end) / s / 1e6; };
  const auto change = [&r](double s) { return s * 1e9 / static_cast<double>(r.changes); };
  row(r.name,
      fmt::format("{:7.2f} M ticks/s, face {:7.2f}: {:+5.0f} %; a change {:5.0f} ns, of it the kernel {:4.0f}",
                  rate(shell), rate(face), more, change(shell - face), change(bare)),
      r.goal > 0 ? fmt::format("<= {:.0f} %", r.goal) : "", r.goal <= 0 || more <= r.goal);
}

// The board: clocks on, then the host polls a status byte: six periods of the 8.33 MHz bus, the command four of them.
struct Step {
  Tick tick;
  enum What { kRelease, kSelect, kWrite, kWriteEnd, kIsaAddress, kIsaRead, kIsaEnd } what;
};
std::vector<Step> bus_steps(Tick end) {
  std::vector<Step> steps{{30, Step::kRelease}, {60, Step::kSelect}, {62, Step::kWrite}, {74, Step::kWriteEnd}};
  for (Tick at = 100; at + 90 < end; at += 85) {
    steps.push_back({at, Step::kIsaAddress});
    steps.push_back({at + 14, Step::kIsaRead});
    steps.push_back({at + 71, Step::kIsaEnd});
  }
  return steps;
}

constexpr std::uint32_t kClockWord = 0x3008D2;
// Interrupt status of the host port and its vector, in turn.
std::uint32_t port(const Step& s) { return 0x212 + (s.tick & 1); }

double board_face(brick::Board& board, const std::vector<Step>& steps, Tick end) {
  BoardInputs in;
  board.set_inputs(in);
  return seconds([&] {
    for (const Step& s : steps) {
      board.run_until(s.tick);
      if (s.what == Step::kRelease) in.rst_n = true;
      if (s.what == Step::kSelect) in.pa_addr = 0x78004, in.pa_x = true, in.pa_aa = 2, in.pa_wdata = kClockWord;
      if (s.what == Step::kWrite) in.pa_wr_n = false;
      if (s.what == Step::kWriteEnd) in.pa_wr_n = true;
      if (s.what == Step::kIsaAddress) in.set_address(port(s));
      if (s.what == Step::kIsaRead) in.isa_ior_n = false;
      if (s.what == Step::kIsaEnd) in.isa_ior_n = true;
      board.set_inputs(in);
    }
    board.run_until(end);
  });
}

double board_kernel(const std::vector<Step>& steps, Tick end) {
  Ticks inputs, outputs;
  for (const Step& s : steps) inputs.push_back(s.tick);
  const auto board = make_model_board(3);
  board->on_change = [&outputs](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    static constexpr BoardOutputs kBound =
        select_pins(pin::kPhase, pin::kServo, pin::kIsaIrq, pin::kBreq, pin::kIsaIochrdy, pin::kIsaSd);
    if (before.differs(after, kBound)) outputs.push_back(t);
  };
  board_face(*board, steps, end);
  return kernel(inputs, outputs, end);
}

double board_shell(const c::Engine& engine, const std::vector<Step>& steps, Tick end) {
  c::TimeBase time("time");
  c::Board board("board", time, {}, engine);
  sc_core::sc_signal<bool> rst_n("rst_n"), x("x"), wr_n("wr_n", true), ior_n("ior_n", true), phase("phase"),
      servo("servo"), irq("irq"), breq("breq"), ready("ready");
  sc_core::sc_signal<sc_dt::sc_uint<19>> addr("addr");
  sc_core::sc_signal<sc_dt::sc_uint<4>> aa("aa");
  sc_core::sc_signal<sc_dt::sc_uint<24>> data("data");
  sc_core::sc_signal<sc_dt::sc_uint<20>> sa("sa");
  sc_core::sc_signal<sc_dt::sc_uint<16>> sd("sd");
  board.rst_n(rst_n), board.pa_x(x), board.pa_wr_n(wr_n), board.isa_ior_n(ior_n), board.phase(phase);
  board.servo(servo), board.isa_irq(irq), board.breq(breq), board.isa_iochrdy(ready), board.isa_sd_o(sd);
  board.pa_addr(addr), board.pa_aa(aa), board.pa_data_i(data), board.isa_sa(sa);
  sc_core::sc_spawn([&] {
    play(time, steps, [&](const Step& s) {
      if (s.what == Step::kRelease) rst_n = true;
      if (s.what == Step::kSelect) addr = 0x78004, x = true, aa = 2, data = kClockWord;
      if (s.what == Step::kWrite) wr_n = false;
      if (s.what == Step::kWriteEnd) wr_n = true;
      if (s.what == Step::kIsaAddress) sa = port(s);
      if (s.what == Step::kIsaRead) ior_n = false;
      if (s.what == Step::kIsaEnd) ior_n = true;
    });
  });
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

Row board(bool rtl) {
  const Tick end = rtl ? 2'000'000 : 10'000'000;
  const auto steps = bus_steps(end);
  const auto face = [=] {
    const auto board = rtl ? make_rtl_board(3) : make_model_board(3);
    return board_face(*board, steps, end);
  };
  const auto shell = [=] { return board_shell(rtl ? c::rtl_engine() : c::model_engine(), steps, end); };
  return {"board, host polls", end, face, [=] { return board_kernel(steps, end); }, shell, steps.size(), 20};
}

// A chip with one line that turns every microsecond; it is behind the ports too, so what it costs is in both.
struct Line {
  c::PinWords inputs;  // at first
  unsigned word;
  std::uint32_t mask;
  c::PinWords watched;
};

const c::PinInfo& pin_of(const std::vector<c::PinInfo>& table, const std::string& name) {
  return *std::find_if(table.begin(), table.end(), [&name](const c::PinInfo& pin) { return pin.name == name; });
}

template <class Words>
void put(Words& words, const c::PinInfo& pin, std::uint32_t value) {
  if (words.size() <= pin.word) words.resize(pin.word + 1);
  words[pin.word] |= value << pin.lsb;
}

// `high`: an input of one bit that is tied high.
Line line_of(const std::vector<c::PinInfo>& table, const std::string& in, const std::string& out,
             const std::string& high) {
  Line line;
  for (const c::PinInfo& pin : table) {
    if (pin.direction == c::PinDirection::kIn) put(line.inputs, pin, pin.name == high ? 1 : pin.idle);
    if (pin.direction != c::PinDirection::kIn) put(line.watched, pin, pin.name == out ? 1 : 0);
  }
  line.word = pin_of(table, in).word;
  line.mask = 1u << pin_of(table, in).lsb;
  return line;
}

double chip_face(c::Chip& chip, const Line& line, const Ticks& changes, Tick end, Ticks* seen = nullptr) {
  chip.watch(line.watched);
  auto inputs = line.inputs;
  const auto run = [&](Tick to) {
    while (chip.now() < to)
      if (chip.run_until(to) && seen != nullptr) seen->push_back(chip.now());
  };
  return seconds([&] {
    chip.set_inputs(inputs);
    for (const Tick at : changes) {
      run(at);
      inputs[line.word] ^= line.mask;
      chip.set_inputs(inputs);
    }
    run(end);
  });
}

template <class C>
std::unique_ptr<C> component(c::TimeBase& time, const c::Engine& engine) {
  if constexpr (std::is_same_v<C, c::Dpram>)
    return std::make_unique<C>("component", time, c::DpramOptions{}, engine);
  else
    return std::make_unique<C>("component", time, engine);
}

c::Pin& pin_of(const c::Component& component, const std::string& name) {
  return **std::find_if(component.pins().begin(), component.pins().end(),
                        [&name](const c::Pin* pin) { return pin->info().name == name; });
}

struct Names {
  std::string in, out, high;
};

template <class C>
double chip_shell(const c::Engine& engine, const Names& names, const Ticks& changes, Tick end) {
  c::TimeBase time("time");
  const auto block = component<C>(time, engine);
  const auto input = [&](const std::string& name) -> c::In<>& { return dynamic_cast<c::In<>&>(pin_of(*block, name)); };
  sc_core::sc_signal<bool> line("line", pin_of(*block, names.in).info().idle != 0), output("output"),
      high("high", true);
  input(names.in).bind(line);
  if (!names.high.empty()) input(names.high).bind(high);
  dynamic_cast<c::Out<>&>(pin_of(*block, names.out)).bind(output);
  sc_core::sc_spawn([&] { play(time, changes, [&line](Tick) { line = !line.read(); }); });
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

using Make = std::unique_ptr<c::Chip> (*)(const c::ChipFactory&);
c::Engine engine_of(bool rtl) { return rtl ? c::rtl_engine() : c::model_engine(); }
Tick length(bool rtl) { return rtl ? 2'000'000 : 20'000'000; }
Ticks every(Tick period, Tick end) {
  Ticks changes;
  for (Tick at = period; at < end; at += period) changes.push_back(at);
  return changes;
}

template <class C>
Row chip(const std::string& name, bool rtl, Make make, const Names& names, double goal = 0) {
  const Tick end = length(rtl);
  const Ticks changes = every(118, end);
  const Line line = line_of(C::pin_table(), names.in, names.out, names.high);
  const auto face = [=] {
    const auto block = make(engine_of(rtl).factory());
    return chip_face(*block, line, changes, end);
  };
  const auto bare = [=] {
    Ticks seen;
    const auto block = make(c::model_engine().factory());
    chip_face(*block, line, changes, end, &seen);
    return kernel(changes, seen, end);
  };
  const auto shell = [=] { return chip_shell<C>(engine_of(rtl), names, changes, end); };
  return {name, end, face, bare, shell, changes.size(), rtl ? goal : 0};
}

// A read through a socket every two microseconds, nothing bound: its call and its end are two waits of the kernel.
constexpr Tick kReadPeriod = 236;
struct Read {
  unsigned face, address, width;
};

double socket_face(c::Chip& chip, const Read& read, const Ticks& calls, Tick end, Ticks* ends = nullptr) {
  const auto run = [&chip](Tick to) {
    while (chip.now() < to) chip.run_until(to);
  };
  return seconds([&] {
    for (const Tick at : calls) {
      run(at);
      chip.begin(read.face, {false, read.address, 0, ~0u, tick_to_fs(at)});
      while (chip.busy(read.face)) chip.run_until(at + kReadPeriod - 1);
      if (ends != nullptr) ends->push_back(chip.now());
    }
    run(end);
  });
}

struct Master : sc_core::sc_module {
  explicit Master(const sc_core::sc_module_name& name) : sc_module(name) {}
  tlm_utils::simple_initiator_socket<Master> socket{"socket"};
};

template <class Socket>
double socket_shell(c::TimeBase& time, Socket& socket, unsigned address, unsigned width, const Ticks& calls, Tick end) {
  Master master("master");
  master.socket.bind(socket);
  sc_core::sc_spawn([&] {
    play(time, calls, [&](Tick) {
      unsigned char data[4];
      tlm::tlm_generic_payload payload;
      payload.set_read();
      payload.set_address(address);
      payload.set_data_ptr(data);
      payload.set_data_length(width);
      payload.set_streaming_width(width);
      sc_core::sc_time delay;
      master.socket->b_transport(payload, delay);
      if (!payload.is_response_ok()) throw std::logic_error(payload.get_response_string());
    });
  });
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

template <class Shell>
Row socket(const std::string& name, bool rtl, Make make, const Read& read, const Shell& shell, double goal = 0) {
  const Tick end = length(rtl);
  const Ticks calls = every(kReadPeriod, end);
  const auto face = [=] {
    const auto block = make(engine_of(rtl).factory());
    return socket_face(*block, read, calls, end);
  };
  const auto bare = [=] {
    Ticks ends;
    const auto block = make(c::model_engine().factory());
    socket_face(*block, read, calls, end, &ends);
    return kernel(calls, ends, end);
  };
  return {name, end, face, bare, [=] { return shell(rtl, calls, end); }, calls.size(), goal};
}

double servo_ic_reads(bool rtl, const Ticks& calls, Tick end) {
  c::TimeBase time("time");
  c::ServoIc ic("ic", time, engine_of(rtl));
  return socket_shell(time, ic.registers, 4, 4, calls, end);
}
double dpram_reads(bool rtl, const Ticks& calls, Tick end) {
  c::TimeBase time("time");
  c::Dpram ram("ram", time, {}, engine_of(rtl));
  return socket_shell(time, ram.cpu, 0, 2, calls, end);
}
constexpr unsigned kDpramOnPortA = 8 * 0x60000, kStatusPort = 0x212;
double port_a_reads(bool rtl, const Ticks& calls, Tick end) {
  c::TimeBase time("time");
  c::Board board("board", time, {}, engine_of(rtl));
  sc_core::sc_signal<bool> rst_n("rst_n", true);
  board.rst_n(rst_n);
  return socket_shell(time, board.port_a, kDpramOnPortA, 4, calls, end);
}
double isa_reads(bool rtl, const Ticks& calls, Tick end) {
  c::TimeBase time("time");
  c::Board board("board", time, {}, engine_of(rtl));
  sc_core::sc_signal<bool> rst_n("rst_n", true);
  board.rst_n(rst_n);
  return socket_shell(time, board.isa_io, kStatusPort, 1, calls, end);
}

std::unique_ptr<c::Chip> board_chip(const c::ChipFactory& factory) {
  auto chip = factory.board(3, 1);
  c::PinWords inputs;
  for (const c::PinInfo& pin : c::Board::pin_table(3))
    if (pin.direction == c::PinDirection::kIn) put(inputs, pin, pin.name == "rst_n" ? 1 : pin.idle);
  chip->set_inputs(inputs);
  return chip;
}

std::vector<Row> rows(bool rtl) {
  using F = c::ChipFactory;
  return {
      board(rtl),
      chip<c::ServoIc>(
          "servo IC, encoder", rtl, [](const F& f) { return f.servo_ic(); }, {"ch1_enc_a", "phase_o", ""}, 20),
      chip<c::MacroIc>("MACRO IC, PHASE", rtl, [](const F& f) { return f.macro_ic(); }, {"phase_i", "phase_o", ""}),
      chip<c::ClockSelect>("clock selection, PHASE", rtl, [](const F& f) { return f.clock_select(); },
                           {"phase_i0", "phase", "phase_oe_i0"}),
      chip<c::InterruptController>("interrupt controller, a line", rtl,
                                   [](const F& f) { return f.interrupt_controller(); }, {"ir0", "irq", ""}),
      chip<c::HostPort>("host port, RESETDRV", rtl, [](const F& f) { return f.host_port(); }, {"resetdrv", "hreq", ""}),
      chip<c::Dpram>("dual-ported RAM, strap", rtl, [](const F& f) { return f.dpram(1); }, {"small", "busy_cpu", ""}),
      chip<c::HostSignals>("host signals, reset", rtl, [](const F& f) { return f.host_signals(); },
                           {"rst_n", "breq", ""}),
      chip<c::Watchdog>("watchdog, SERVO", rtl, [](const F& f) { return f.watchdog(); }, {"servo", "trip", ""}),
      socket(
          "servo IC, register", rtl, [](const F& f) { return f.servo_ic(); }, {0, 4, 4}, servo_ic_reads),
      socket(
          "dual-ported RAM, CPU", rtl, [](const F& f) { return f.dpram(1); }, {1, 0, 2}, dpram_reads),
      socket("board, Port A", rtl, board_chip, {0, kDpramOnPortA, 4}, port_a_reads, 20),
      socket("board, ISA", rtl, board_chip, {1, kStatusPort, 1}, isa_reads, 20)};
}

}  // namespace
}  // namespace brick

int main(int argc, char** argv) {
  for (const bool rtl : {true, false})
    for (brick::Row row : brick::rows(rtl)) {
      row.name = (rtl ? "RTL, " : "model, ") + row.name;
      if (argc < 2 || row.name.find(argv[1]) != std::string::npos) measure(row);
    }
}
