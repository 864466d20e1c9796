// What ports, sockets and the kernel cost: components against the same blocks driven through their C++ face, on the
// same traffic. `brick_component_speed [ROW]`, the rows whose names hold the word; not a test. A row has three runs in
// turn, each a process, for SystemC elaborates once in each: the face; the kernel alone, with a process that waits and
// writes a signal for each change of an input, one that hears it, and one that waits and writes for each instant in
// which an output changes; the component, between the same signals.
#include <brick/board.h>
#include <brick/interrupt_controller.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <sysc/kernel/sc_dynamic_processes.h>
#include <unistd.h>

#include <functional>
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

// A chip with one line that turns every microsecond.
struct Line {
  std::vector<std::uint32_t> inputs;  // at first
  unsigned word;
  std::uint32_t mask;
  std::vector<std::uint32_t> watched;
};

double chip_face(c::Chip& chip, const Line& line, const Ticks& changes, Tick end, Ticks* seen = nullptr) {
  chip.watch(line.watched);
  auto inputs = line.inputs;
  const auto run = [&](Tick to) {
    while (chip.now() < to)
      if (chip.run_until(to) && seen != nullptr) seen->push_back(chip.now());
  };
  return seconds([&] {
    for (const Tick at : changes) {
      run(at);
      inputs[line.word] ^= line.mask;
      chip.set_inputs(inputs);
    }
    run(end);
  });
}

template <class C>
double chip_shell(const c::Engine& engine, c::In<>& (*in)(C&), c::Out<>& (*out)(C&), const Ticks& changes, Tick end) {
  c::TimeBase time("time");
  C component("component", time, engine);
  sc_core::sc_signal<bool> line("line"), output("output");
  in(component).bind(line);
  out(component).bind(output);
  sc_core::sc_spawn([&] { play(time, changes, [&line](Tick) { line = !line.read(); }); });
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

template <class C>
Row chip(const std::string& name, bool rtl, std::unique_ptr<c::Chip> (c::ChipFactory::*make)() const, const Line& line,
         c::In<>& (*in)(C&), c::Out<>& (*out)(C&), double goal) {
  const auto engine = [rtl] { return rtl ? c::rtl_engine() : c::model_engine(); };
  const Tick end = rtl ? 2'000'000 : 20'000'000;
  Ticks changes;
  for (Tick at = 118; at < end; at += 118) changes.push_back(at);
  const auto face = [=] {
    const auto block = (engine().factory().*make)();
    return chip_face(*block, line, changes, end);
  };
  const auto bare = [=] {
    Ticks seen;
    const auto block = (c::model_engine().factory().*make)();
    chip_face(*block, line, changes, end, &seen);
    return kernel(changes, seen, end);
  };
  const auto shell = [=] { return chip_shell<C>(engine(), in, out, changes, end); };
  return {name, end, face, bare, shell, changes.size(), rtl ? goal : 0};
}

std::vector<Row> rows(bool rtl) {
  return {board(rtl),
          chip<c::ServoIc>(
              "servo IC, encoder", rtl, &c::ChipFactory::servo_ic, {{0xF90, 0xF90, 0xF90, 0xF90, 0xD}, 0, 1, {0, 0, 1}},
              [](c::ServoIc& ic) -> c::In<>& { return ic.ch[0].enc_a; },
              [](c::ServoIc& ic) -> c::Out<>& { return ic.phase_o; }, 20),
          chip<c::InterruptController>(
              "interrupt controller, a line", rtl, &c::ChipFactory::interrupt_controller, {{1u << 9}, 0, 1, {0, 1}},
              [](c::InterruptController& pic) -> c::In<>& { return pic.ir[0]; },
              [](c::InterruptController& pic) -> c::Out<>& { return pic.irq; }, 0)};
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
