// What ports, sockets and the kernel cost: components against the same blocks driven through their C++ face, on the
// same traffic. `brick_component_speed`; not a test. Each run is a process, for SystemC elaborates once in each.
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

// One change of the inputs: that of the board's reset line, its write strobe, an ISA command, an encoder.
struct Step {
  Tick tick;
  enum What { kRelease, kSelect, kWrite, kWriteEnd, kIsaAddress, kIsaRead, kIsaEnd } what;
};

// Clocks on, then the host polls a status byte: six periods of the 8.33 MHz bus, the command four of them.
std::vector<Step> bus_steps(Tick end) {
  std::vector<Step> steps{{30, Step::kRelease}, {60, Step::kSelect}, {62, Step::kWrite}, {74, Step::kWriteEnd}};
  for (Tick at = 100; at + 90 < end; at += 85) {
    steps.push_back({at, Step::kIsaAddress});
    steps.push_back({at + 14, Step::kIsaRead});
    steps.push_back({at + 71, Step::kIsaEnd});
  }
  return steps;
}

constexpr std::uint32_t kClockWord = 0x3008D2, kStatusPort = 0x212;

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
      if (s.what == Step::kIsaAddress) in.set_address(kStatusPort);
      if (s.what == Step::kIsaRead) in.isa_ior_n = false;
      if (s.what == Step::kIsaEnd) in.isa_ior_n = true;
      board.set_inputs(in);
    }
    board.run_until(end);
  });
}

// Plays a list of steps at the instants of their edges.
class Player : public sc_core::sc_module {
 public:
  Player(const sc_core::sc_module_name& name, c::TimeBase& time, std::function<void()> play)
      : sc_module(name), time_(time), play_(std::move(play)) {
    SC_HAS_PROCESS(Player);
    SC_THREAD(run);
  }
  void until(Tick tick) { wait(time_.time_of(tick) - sc_core::sc_time_stamp()); }

 private:
  void run() { play_(); }
  c::TimeBase& time_;
  std::function<void()> play_;
};

double board_component(const c::Engine& engine, const std::vector<Step>& steps, Tick end) {
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
  Player* me = nullptr;
  Player player("player", time, [&] {
    for (const Step& s : steps) {
      me->until(s.tick);
      if (s.what == Step::kRelease) rst_n = true;
      if (s.what == Step::kSelect) addr = 0x78004, x = true, aa = 2, data = kClockWord;
      if (s.what == Step::kWrite) wr_n = false;
      if (s.what == Step::kWriteEnd) wr_n = true;
      if (s.what == Step::kIsaAddress) sa = kStatusPort;
      if (s.what == Step::kIsaRead) ior_n = false;
      if (s.what == Step::kIsaEnd) ior_n = true;
    }
  });
  me = &player;
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

// A chip with one line that turns every `every` ticks, through its C++ face.
double chip_face(c::Chip& chip, std::vector<std::uint32_t> inputs, unsigned word, std::uint32_t line, Tick every,
                 Tick end) {
  c::PinWords watch(chip.outputs().size());
  watch.back() = ~0u;
  chip.watch(watch);
  return seconds([&] {
    for (Tick at = every; at < end; at += every) {
      while (chip.now() < at) chip.run_until(at);
      inputs[word] ^= line;
      chip.set_inputs(inputs);
    }
  });
}

template <class C>
double chip_component(const c::Engine& engine, c::In<>& (*in)(C&), c::Out<>& (*out)(C&), Tick every, Tick end) {
  c::TimeBase time("time");
  C component("component", time, engine);
  sc_core::sc_signal<bool> line("line"), output("output");
  in(component).bind(line);
  if (out != nullptr) out(component).bind(output);
  Player* me = nullptr;
  Player player("player", time, [&] {
    for (Tick at = every; at < end; at += every) {
      me->until(at);
      line = !line.read();
    }
  });
  me = &player;
  return seconds([&] { sc_core::sc_start(time.time_of(end)); });
}

// The median of some runs, each in a process of its own.
double measured(const std::function<double()>& run) {
  std::vector<double> all;
  for (int round = 0; round < kRounds; ++round) {
    int ends[2];
    if (pipe(ends) != 0) return 0;
    if (fork() == 0) {
      const double value = run();
      if (write(ends[1], &value, sizeof value) != sizeof value) _exit(1);
      _exit(0);
    }
    double value = 0;
    if (read(ends[0], &value, sizeof value) == sizeof value) all.push_back(value);
    wait(nullptr);
    close(ends[0]), close(ends[1]);
  }
  return median(all);
}

void compare(const std::string& name, Tick ticks, std::size_t changes, double face, double shell, double goal) {
  const double extra = (shell - face) / face * 100;
  row(name,
      fmt::format("{:.2f} M ticks/s, face {:.2f}; {:+.0f} %, {:.0f} ns a pin change",
                  static_cast<double>(ticks) / shell / 1e6, static_cast<double>(ticks) / face / 1e6, extra,
                  (shell - face) * 1e9 / static_cast<double>(changes)),
      goal > 0 ? fmt::format("<= {:.0f} %", goal) : "", goal <= 0 || extra <= goal);
}

void boards() {
  for (const bool rtl : {false, true}) {
    const Tick ticks = rtl ? 2'000'000 : 10'000'000;
    const auto steps = bus_steps(ticks);
    const double face = measured([&] {
      const auto board = rtl ? make_rtl_board(3) : make_model_board(3);
      return board_face(*board, steps, ticks);
    });
    const double shell =
        measured([&] { return board_component(rtl ? c::rtl_engine() : c::model_engine(), steps, ticks); });
    compare(rtl ? "board, RTL, host polls" : "board, model, host polls", ticks, steps.size(), face, shell, 20);
  }
}

void chips() {
  for (const bool rtl : {false, true}) {
    const auto engine = [rtl] { return rtl ? c::rtl_engine() : c::model_engine(); };
    const Tick ticks = rtl ? 2'000'000 : 20'000'000, every = 118;  // a pin a microsecond
    const auto changes = static_cast<std::size_t>(ticks / every);
    const double face = measured([&] {
      const auto chip = engine().factory().servo_ic();
      return chip_face(*chip, {0xF90, 0xF90, 0xF90, 0xF90, 0xD}, 0, 1, every, ticks);
    });
    const auto enc_a = [](c::ServoIc& ic) -> c::In<>& { return ic.ch[0].enc_a; };
    const auto phase = [](c::ServoIc& ic) -> c::Out<>& { return ic.phase_o; };
    const double shell = measured([&] { return chip_component<c::ServoIc>(engine(), enc_a, phase, every, ticks); });
    compare(fmt::format("servo IC, {}, encoder", rtl ? "RTL" : "model"), ticks, changes, face, shell, rtl ? 20 : 0);
    const double pic_face = measured([&] {
      const auto chip = engine().factory().interrupt_controller();
      return chip_face(*chip, {1u << 9}, 0, 1, every, ticks);
    });
    const auto line = [](c::InterruptController& pic) -> c::In<>& { return pic.ir[0]; };
    const auto irq = [](c::InterruptController& pic) -> c::Out<>& { return pic.irq; };
    const double pic_shell =
        measured([&] { return chip_component<c::InterruptController>(engine(), line, irq, every, ticks); });
    compare(fmt::format("interrupt controller, {}, a line", rtl ? "RTL" : "model"), ticks, changes, pic_face, pic_shell,
            0);
  }
}

}  // namespace
}  // namespace brick

int main() {
  brick::boards();
  brick::chips();
}
