// What ports, sockets and the kernel cost: components against the same blocks driven through their C++ face, on the
// same traffic. `brick_component_speed [ROW]`, the rows whose names hold the word; not a test. A row has three runs:
// the face; the kernel alone, with a process that waits and writes a signal for each change of an input, one that hears
// it, and one that waits and writes for each instant in which an output changes; the component, between the same
// signals.
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
#include <sysc/kernel/sc_dynamic_processes.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "systemc/board/model_board.h"
#include "systemc/component/board/board_words.h"
#include "systemc/component/chip.h"
#include "systemc/cosim/engines.h"
#include "systemc/servo_ic/servo_ic.h"
#include "testbench/benchmark/bare_servo_ic.h"
#include "testbench/benchmark/traffic.h"
#include "testbench/benchmark/turns.h"

namespace brick {
namespace {

namespace c = component;

// In the kernel: a process that waits for the instant of each step.
template <class Act>
void play(const c::TimeBase& time, const Traffic& traffic, Act act) {
  sc_core::sc_spawn([&time, &traffic, act]() mutable {
    for (Cursor cursor(traffic);; cursor.next()) {
      sc_core::wait(time.time_of(cursor.tick()) - sc_core::sc_time_stamp());
      act(cursor.what());
    }
  });
}
void simulate(const c::TimeBase& time) {
  take_turns([&time](Tick end) { sc_core::sc_start(time.time_of(end) - sc_core::sc_time_stamp()); });
}

void kernel(const Traffic& inputs, const Traffic& outputs) {
  const c::TimeBase time("time");
  sc_core::sc_signal<bool> in("in"), out("out");
  play(time, inputs, [&in](unsigned) { in = !in.read(); });
  if (!outputs.loop.empty()) play(time, outputs, [&out](unsigned) { out = !out.read(); });
  sc_core::sc_spawn_options hears;
  hears.spawn_method();
  hears.set_sensitivity(&in.value_changed_event());
  sc_core::sc_spawn([] {}, "hears", &hears);
  simulate(time);
}

c::Engine engine_of(bool rtl) { return rtl ? c::rtl_engine() : c::model_engine(); }

// Which outputs are bound.
using Bound = std::function<bool(const std::string&)>;
bool none(const std::string&) { return false; }
bool all(const std::string&) { return true; }
bool no_serial_clocks(const std::string& pin) {
  return pin.find("dac_clk") == std::string::npos && pin.find("adc_clk") == std::string::npos;
}
Bound only(const std::string& name) {
  return [name](const std::string& pin) { return pin == name; };
}

template <class Words>
void put(Words& words, const c::PinInfo& pin, std::uint32_t value) {
  if (words.size() <= pin.word) words.resize(pin.word + 1);
  words[pin.word] |= value << pin.lsb;
}
c::PinWords watched(const std::vector<c::PinInfo>& table, const Bound& bound) {
  c::PinWords words;
  for (const c::PinInfo& pin : table) {
    const bool is_bound = pin.direction == c::PinDirection::kOut && bound(pin.name);
    if (pin.direction != c::PinDirection::kIn) put(words, pin, is_bound ? (1u << pin.width) - 1 : 0);
  }
  return words;
}

// Signals of all widths at the outputs of a component.
class Signals {
 public:
  Signals(const c::Component& component, const Bound& bound) {
    for (c::Pin* pin : component.pins())
      if (pin->info().direction == c::PinDirection::kOut && bound(pin->info().name))
        bind(*pin, std::make_integer_sequence<unsigned, 32>());
  }

 private:
  template <unsigned... kWidth>
  void bind(c::Pin& pin, std::integer_sequence<unsigned, kWidth...>) {
    (bind_width<kWidth + 1>(pin), ...);
  }
  template <unsigned kWidth>
  void bind_width(c::Pin& pin) {
    if (pin.info().width != kWidth) return;
    auto signal = std::make_shared<sc_core::sc_signal<c::PinValue<kWidth>>>(("s_" + pin.info().name).c_str());
    dynamic_cast<c::Out<kWidth>&>(pin).bind(*signal);
    signals_.push_back(std::move(signal));
  }
  std::vector<std::shared_ptr<void>> signals_;
};

// The board: clocks on, then the host polls a status byte: six periods of the 8.33 MHz bus, the command four of them.
constexpr std::uint32_t kFitted = 0x3;
enum What : unsigned { kRelease, kSelect, kWrite, kWriteEnd, kIsaAddress, kIsaRead, kIsaEnd };
const Traffic kPolls{{{30, kRelease}, {60, kSelect}, {62, kWrite}, {74, kWriteEnd}},
                     {{100, kIsaAddress}, {114, kIsaRead}, {171, kIsaEnd}},
                     85};
constexpr std::uint32_t kClockWord = 0x3008D2;
// Interrupt status of the host port and its vector, in turn.
std::uint32_t other_port(std::uint32_t port) { return port == 0x212 ? 0x213 : 0x212; }

// `seen`: changes of the outputs that would be bound.
std::function<void(Tick)> board_face(brick::Board& board, const Bound& bound, const std::function<void(Tick)>& seen) {
  const c::PinWords words = watched(c::Board::pin_table(kFitted), bound);
  BoardOutputs pins;
  std::copy_n(words.begin(), kBoardOutputWords, pins.w.begin());
  board.on_change = [pins, seen](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    if (before.differs(after, pins)) seen(t);
  };
  for (unsigned ic = 0; ic < 2; ++ic) {
    const unsigned first = c::board_words::motor_output(ic);
    board.watch_motor(ic, {{words[first], words[first + 1], 0, 0, 0, 0}});
  }
  board.on_motor_change = [seen](Tick t, unsigned, const MotorOutputs&, const MotorOutputs&) { seen(t); };
  board.set_inputs({});
  return played(
      kPolls, [&board](Tick t) { board.run_until(t); },
      [&board, in = BoardInputs(), port = 0u](unsigned what) mutable {
        if (what == kRelease) in.rst_n = true;
        if (what == kSelect) in.pa_addr = 0x78004, in.pa_x = true, in.pa_aa = 2, in.pa_wdata = kClockWord;
        if (what == kWrite) in.pa_wr_n = false;
        if (what == kWriteEnd) in.pa_wr_n = true;
        if (what == kIsaAddress) in.set_address(port = other_port(port));
        if (what == kIsaRead) in.isa_ior_n = false;
        if (what == kIsaEnd) in.isa_ior_n = true;
        board.set_inputs(in);
      });
}

void board_shell(bool rtl, const Bound& bound) {
  c::TimeBase time("time");
  c::Board board("board", time, {}, engine_of(rtl));
  sc_core::sc_signal<bool> rst_n("rst_n"), x("x"), wr_n("wr_n", true), ior_n("ior_n", true);
  sc_core::sc_signal<sc_dt::sc_uint<19>> addr("addr");
  sc_core::sc_signal<sc_dt::sc_uint<4>> aa("aa");
  sc_core::sc_signal<sc_dt::sc_uint<24>> data("data");
  sc_core::sc_signal<sc_dt::sc_uint<20>> sa("sa");
  board.rst_n(rst_n), board.pa_x(x), board.pa_wr_n(wr_n), board.isa_ior_n(ior_n);
  board.pa_addr(addr), board.pa_aa(aa), board.pa_data_i(data), board.isa_sa(sa);
  const Signals outputs(board, bound);
  play(time, kPolls, [&, port = 0u](unsigned what) mutable {
    if (what == kRelease) rst_n = true;
    if (what == kSelect) addr = 0x78004, x = true, aa = 2, data = kClockWord;
    if (what == kWrite) wr_n = false;
    if (what == kWriteEnd) wr_n = true;
    if (what == kIsaAddress) sa = port = other_port(port);
    if (what == kIsaRead) ior_n = false;
    if (what == kIsaEnd) ior_n = true;
  });
  simulate(time);
}

void board_kernel(const Bound& bound) {
  Traffic outputs{{}, {}, kRecorded};
  const auto board = make_model_board(kFitted);
  board_face(*board, bound, [&outputs](Tick t) { record(outputs, t); })(kRecorded);
  kernel(kPolls, outputs);
}

Row board(const std::string& outputs, bool rtl, const Bound& bound) {
  const auto face = [=] {
    const auto board = rtl ? make_rtl_board(kFitted) : make_model_board(kFitted);
    take_turns(board_face(*board, bound, [](Tick) {}));
  };
  return {"board, host polls, " + outputs, face, [=] { board_kernel(bound); }, [=] { board_shell(rtl, bound); },
          kPolls.changes_a_tick(),         true};
}

// A chip with one line that turns every microsecond; it is behind the ports too, so what it costs is in both.
constexpr Tick kLinePeriod = 118;
constexpr unsigned kTurn = ~0u;

const c::PinInfo& pin_of(const std::vector<c::PinInfo>& table, const std::string& name) {
  return *std::find_if(table.begin(), table.end(), [&name](const c::PinInfo& pin) { return pin.name == name; });
}
c::Pin& pin_of(const c::Component& component, const std::string& name) {
  return **std::find_if(component.pins().begin(), component.pins().end(),
                        [&name](const c::Pin* pin) { return pin->info().name == name; });
}

struct Lines {
  std::string in, high;  // that turns; that is tied high
  Bound bound;
  unsigned grid = 1;  // TimeOptions::grid in us
};

template <class C>
constexpr bool kIsServoIc = std::is_same_v<C, c::ServoIc>;

// The servo IC drives PHASE and SERVO as in the factory settings and runs the PWM of its channels by commands of 1024,
// 2048 and 3072 at a maximum count of 6527: its registers are written first.
struct Write {
  unsigned address;
  std::uint32_t value;
};
constexpr unsigned x_of(unsigned offset) { return 8 * offset + 4; }
constexpr unsigned y_of(unsigned offset) { return 8 * offset; }
const std::vector<Write> kServoIcWrites = [] {
  std::vector<Write> writes{{x_of(4), 0x3008D2}};
  for (unsigned channel = 0; channel < 32; channel += 8) {
    writes.push_back({x_of(channel + 5), 0x4007});
    for (unsigned out = 2; out < 5; ++out) writes.push_back({y_of(channel + out), (out - 1) * 0x040000});
  }
  return writes;
}();

template <class C>
const Traffic& line_traffic() {
  static const Traffic traffic = [] {
    Traffic t{{}, {{kLinePeriod, kTurn}}, kLinePeriod};
    for (unsigned i = 0; kIsServoIc<C> && i < kServoIcWrites.size(); ++i) t.first.push_back({9 * (i + 1), i});
    if (!t.first.empty()) t.loop[0].tick += 2 * kLinePeriod;
    return t;
  }();
  return traffic;
}

template <class C>
std::function<void(Tick)> chip_face(c::Chip& chip, const Lines& lines, Traffic* seen = nullptr) {
  c::PinWords inputs;
  for (const c::PinInfo& pin : C::pin_table())
    if (pin.direction == c::PinDirection::kIn) put(inputs, pin, pin.name == lines.high ? 1 : pin.idle);
  chip.watch(watched(C::pin_table(), lines.bound));
  chip.set_inputs(inputs);
  const auto run = [&chip, seen](Tick to) {
    while (chip.now() < to)
      if (chip.run_until(to) && seen != nullptr) record(*seen, chip.now());
  };
  const c::PinInfo& line = pin_of(C::pin_table(), lines.in);
  return played(line_traffic<C>(), run, [&chip, &line, inputs](unsigned what) mutable {
    if (what != kTurn) return chip.begin(0, {true, kServoIcWrites[what].address, kServoIcWrites[what].value, ~0u, 0});
    inputs[line.word] ^= 1u << line.lsb;
    chip.set_inputs(inputs);
  });
}

struct Master : sc_core::sc_module {
  explicit Master(const sc_core::sc_module_name& name) : sc_module(name) {}
  void access(tlm::tlm_command command, unsigned address, std::uint32_t value, unsigned width) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
    payload.set_data_length(width);
    payload.set_streaming_width(width);
    sc_core::sc_time delay;
    socket->b_transport(payload, delay);
    if (!payload.is_response_ok()) throw std::logic_error(payload.get_response_string());
  }
  tlm_utils::simple_initiator_socket<Master> socket{"socket"};
};

template <class C>
std::unique_ptr<C> component(c::TimeBase& time, const c::Engine& engine) {
  if constexpr (std::is_same_v<C, c::Dpram>)
    return std::make_unique<C>("component", time, c::DpramOptions{}, engine);
  else
    return std::make_unique<C>("component", time, engine);
}

template <class C>
void chip_shell(bool rtl, const Lines& lines) {
  c::TimeBase time("time", {sc_core::SC_ZERO_TIME, sc_core::sc_time(lines.grid, sc_core::SC_US)});
  const auto block = component<C>(time, engine_of(rtl));
  std::optional<Master> master;
  if constexpr (kIsServoIc<C>) master.emplace("master").socket.bind(block->registers);
  const auto input = [&](const std::string& name) -> c::In<>& { return dynamic_cast<c::In<>&>(pin_of(*block, name)); };
  sc_core::sc_signal<bool> line("line", pin_of(*block, lines.in).info().idle != 0), high("high", true);
  input(lines.in).bind(line);
  if (!lines.high.empty()) input(lines.high).bind(high);
  const Signals outputs(*block, lines.bound);
  play(time, line_traffic<C>(), [&](unsigned what) {
    if (what == kTurn)
      line = !line.read();
    else
      master->access(tlm::TLM_WRITE_COMMAND, kServoIcWrites[what].address, kServoIcWrites[what].value, 4);
  });
  simulate(time);
}

using Make = std::unique_ptr<c::Chip> (*)(const c::ChipFactory&);

template <class C>
Row chip(const std::string& name, bool rtl, Make make, const Lines& lines, bool judged = true) {
  const auto face = [=] {
    const auto block = make(engine_of(rtl).factory());
    take_turns(chip_face<C>(*block, lines));
  };
  const auto bare = [=] {
    Traffic seen{{}, {}, kRecorded};
    const auto block = make(c::model_engine().factory());
    chip_face<C>(*block, lines, &seen)(kRecorded);
    kernel(line_traffic<C>(), seen);
  };
  const auto shell = [=] { return chip_shell<C>(rtl, lines); };
  return {name, face, bare, shell, line_traffic<C>().changes_a_tick(), rtl && judged};
}

// The servo IC with nothing of ours around it. The model stands still where PHASE or SERVO changes.
class BareModel {
 public:
  void write(unsigned address, std::uint32_t value) {
    run_until(next_ref_edge(now_));
    ic_.write((address & 4) != 0, address / 8, value);
  }
  void turn() { ic_.set_channel_pins(0, pins_ ^= 1u << kEncA); }
  void run_until(Tick end) {
    while (now_ < end) {
      now_ = std::min(end, std::max(now_ + 1, ic_.next_event()));
      ic_.advance(now_);
    }
  }

 private:
  brick::ServoIc ic_{"bare"};
  unsigned pins_ = kIdleChannelPins;
  Tick now_ = 0;
};
template <class Bare>
void bare_servo_ic(Bare& bare) {
  take_turns(played(
      line_traffic<c::ServoIc>(), [&bare](Tick t) { bare.run_until(t); },
      [&bare](unsigned what) {
        if (what == kTurn)
          bare.turn();
        else
          bare.write(kServoIcWrites[what].address, kServoIcWrites[what].value);
      }));
}

// A read through a socket every two microseconds, nothing bound: its call and its end are two waits of the kernel.
constexpr Tick kReadPeriod = 236;
const Traffic kReads{{}, {{kReadPeriod, 0}}, kReadPeriod};
struct Read {
  unsigned face, address, width;
};

std::function<void(Tick)> socket_face(c::Chip& chip, const Read& read, Traffic* ends = nullptr) {
  const auto run = [&chip](Tick to) {
    while (chip.now() < to) chip.run_until(to);
  };
  return played(kReads, run, [&chip, read, ends](unsigned) {
    const Tick at = chip.now();
    chip.begin(read.face, {false, read.address, 0, ~0u, tick_to_fs(at)});
    while (chip.busy(read.face)) chip.run_until(at + kReadPeriod - 1);
    if (ends != nullptr) record(*ends, chip.now());
  });
}

template <class Socket>
void socket_shell(c::TimeBase& time, Socket& socket, const Read& read) {
  Master master("master");
  master.socket.bind(socket);
  play(time, kReads, [&](unsigned) { master.access(tlm::TLM_READ_COMMAND, read.address, 0, read.width); });
  simulate(time);
}

template <class Shell>
Row socket(const std::string& name, bool rtl, Make make, const Read& read, const Shell& shell, bool judged) {
  const auto face = [=] {
    const auto block = make(engine_of(rtl).factory());
    take_turns(socket_face(*block, read));
  };
  const auto bare = [=] {
    Traffic ends{{}, {}, kRecorded};
    const auto block = make(c::model_engine().factory());
    socket_face(*block, read, &ends)(kRecorded);
    kernel(kReads, ends);
  };
  return {name, face, bare, [=] { return shell(rtl, read); }, kReads.changes_a_tick(), judged};
}

void servo_ic_reads(bool rtl, const Read& read) {
  c::TimeBase time("time");
  c::ServoIc ic("ic", time, engine_of(rtl));
  return socket_shell(time, ic.registers, read);
}
void dpram_reads(bool rtl, const Read& read) {
  c::TimeBase time("time");
  c::Dpram ram("ram", time, {}, engine_of(rtl));
  return socket_shell(time, ram.cpu, read);
}
void board_reads(bool rtl, const Read& read) {
  c::TimeBase time("time");
  c::Board board("board", time, {}, engine_of(rtl));
  sc_core::sc_signal<bool> rst_n("rst_n", true);
  board.rst_n(rst_n);
  return read.face == 0 ? socket_shell(time, board.port_a, read) : socket_shell(time, board.isa_io, read);
}

std::unique_ptr<c::Chip> board_chip(const c::ChipFactory& factory) {
  auto chip = factory.board(kFitted, 1);
  c::PinWords inputs;
  for (const c::PinInfo& pin : c::Board::pin_table(kFitted))
    if (pin.direction == c::PinDirection::kIn) put(inputs, pin, pin.name == "rst_n" ? 1 : pin.idle);
  chip->set_inputs(inputs);
  return chip;
}

std::vector<Row> rows(bool rtl) {
  using F = c::ChipFactory;
  const Bound of_host = [](const std::string& pin) {
    static const std::vector<std::string> pins{"phase", "servo", "isa_irq", "breq", "isa_iochrdy", "isa_sd_o"};
    return std::find(pins.begin(), pins.end(), pin) != pins.end();
  };
  const Make servo_ic = [](const F& f) { return f.servo_ic(); };
  const auto encoder = [&](const std::string& outputs, const Bound& bound, bool judged = true) {
    return chip<c::ServoIc>("servo IC, encoder, " + outputs, rtl, servo_ic, {"ch1_enc_a", "", bound}, judged);
  };
  std::vector<Row> all_rows{
      board("no output", rtl, none),
      board("PHASE", rtl, only("phase")),
      board("six outputs", rtl, of_host),
      board("all outputs but the serial clocks", rtl, no_serial_clocks),
      encoder("no output", none),
      encoder("PHASE", only("phase_o")),
      encoder("all outputs but the serial clocks", no_serial_clocks),
      encoder("all outputs", all, false),
      chip<c::MacroIc>("MACRO IC, PHASE", rtl, [](const F& f) { return f.macro_ic(); },
                       {"phase_i", "", only("phase_o")}),
      chip<c::ClockSelect>("clock selection, PHASE", rtl, [](const F& f) { return f.clock_select(); },
                           {"phase_i0", "phase_oe_i0", only("phase")}),
      chip<c::InterruptController>("interrupt controller, a line", rtl,
                                   [](const F& f) { return f.interrupt_controller(); }, {"ir0", "", only("irq")}),
      chip<c::HostPort>("host port, RESETDRV", rtl, [](const F& f) { return f.host_port(); },
                        {"resetdrv", "", only("hreq")}),
      chip<c::Dpram>("dual-ported RAM, strap", rtl, [](const F& f) { return f.dpram(1); },
                     {"small", "", only("busy_cpu")}),
      chip<c::HostSignals>("host signals, reset", rtl, [](const F& f) { return f.host_signals(); },
                           {"rst_n", "", only("breq")}),
      chip<c::Watchdog>("watchdog, SERVO", rtl, [](const F& f) { return f.watchdog(); }, {"servo", "", only("trip")}),
      socket("servo IC, register", rtl, servo_ic, {0, 4, 4}, servo_ic_reads, rtl),
      socket(
          "dual-ported RAM, CPU", rtl, [](const F& f) { return f.dpram(1); }, {1, 0, 2}, dpram_reads, rtl),
      socket("board, Port A", rtl, board_chip, {0, 8 * 0x60000, 4}, board_reads, true),
      socket("board, ISA", rtl, board_chip, {1, 0x212, 1}, board_reads, true)};
  // With PHASE bound: what all of the component costs, and its chip alone, against what is in the chip.
  const Row phase = all_rows[5];
  const auto against = [&](const std::string& what, const std::function<void()>& bare) {
    all_rows.push_back({"servo IC against " + what, bare, {}, phase.shell, phase.changes_a_tick, rtl});
    all_rows.push_back({"its chip against " + what, bare, {}, phase.face, phase.changes_a_tick});
  };
  const auto alone = [](bool twice) {
    return [twice] {
      BareServoIc bare(twice);
      return bare_servo_ic(bare);
    };
  };
  if (rtl) {
    all_rows.push_back(chip<c::HostSignals>("host signals, reset, grid 10 us", true,
                                            [](const F& f) { return f.host_signals(); },
                                            {"rst_n", "", only("breq"), 10}));
    against("Vservo_ic, one evaluation an edge", alone(false));
    against("Vservo_ic, two evaluations an edge", alone(true));
  } else {
    against("its model alone", [] {
      BareModel bare;
      return bare_servo_ic(bare);
    });
  }
  return all_rows;
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
