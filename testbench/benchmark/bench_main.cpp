// How fast the engines are: a table on stdout. Each ratio compares runs that were made in turn, in the same minute, and
// every number is the median of five, because the machine under us is never quiet.
//   brick_benchmark FIRMWARE.elf [--quick] [PART...], PART one of boards, cpu, machine, bus, moving
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "systemc/core/trace.h"
#include "systemc/cosim/engines.h"
#include "testbench/benchmark/benchmark.h"
#include "testbench/benchmark/measure.h"

namespace brick {

void start_clocks(Board& board, std::uint32_t fitted) {
  BoardInputs in;
  in.fitted = fitted;
  board.set_inputs(in);
  board.run_until(30);
  in.rst_n = true;
  board.set_inputs(in);
  board.run_until(40);  // the reset has ended after tick 38
  in.pa_addr = 0x78004;
  in.pa_x = true;
  in.pa_aa = 2;
  in.pa_wdata = 0x3008D2;
  in.pa_wr_n = false;
  board.set_inputs(in);
  board.run_until(60);
  in.pa_wr_n = true;
  board.set_inputs(in);
}

namespace {

// Waveform of a board alone: its pins.
class PinTrace {
 public:
  PinTrace(Board& board, const std::string& file) : writer_(TraceWriter::open(file)) {
    for (const PinField& f : pin::kAll) ids_.push_back(signals_.add(std::string(f.name), f.width, Radix::kHex));
    signals_.attach(writer_.get());
    board.on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      for (std::size_t i = 0; i < ids_.size(); ++i)
        if (before.w[pin::kAll[i].word] != after.w[pin::kAll[i].word])
          signals_.set(ids_[i], tick_to_fs(t), after.get(pin::kAll[i]));
      signals_.flush_until(tick_to_fs(t));
    };
  }

 private:
  Signals signals_;
  std::unique_ptr<TraceWriter> writer_;
  std::vector<Signals::Id> ids_;
};

void boards(Tick ticks, const std::string& vcd) {
  auto rtl = make_rtl_board(3);
  auto rtl_vcd = make_rtl_board(3);
  auto lock = make_lockstep_board(make_rtl_board(3), make_model_board(3));
  auto lock_vcd = make_lockstep_board(make_rtl_board(3), make_model_board(3));
  BareLoop bare;
  for (Board* b : {rtl.get(), rtl_vcd.get(), lock.get(), lock_vcd.get()}) start_clocks(*b);
  PinTrace trace1(*rtl_vcd, vcd + ".1.vcd"), trace2(*lock_vcd, vcd + ".2.vcd");

  std::vector<double> bare_rate, rate[4], ratio[4];
  Board* const board[] = {rtl.get(), rtl_vcd.get(), lock.get(), lock_vcd.get()};
  for (int round = 0; round < kRounds; ++round) {
    const double yardstick = static_cast<double>(ticks) / seconds([&] { bare.run(ticks); });
    bare_rate.push_back(yardstick);
    for (int i = 0; i < 4; ++i) {
      rate[i].push_back(static_cast<double>(ticks) / seconds([&] { board[i]->run_until(board[i]->now() + ticks); }));
      ratio[i].push_back(i < 2 ? rate[i].back() / yardstick : rate[i].back() / rate[0].back());
    }
  }
  row("bare Verilated loop, two servo ICs, clocks running", fmt::format("{:.2f} M ticks/s", median(bare_rate) / 1e6),
      "", true);
  row("RTL engine", fmt::format("{:.2f} M ticks/s", median(rate[0]) / 1e6), "", true);
  row("  ratio to the bare loop", fmt::format("{:.2f}", median(ratio[0])), ">= 0.90", median(ratio[0]) >= 0.9);
  row("RTL engine, VCD of the pins", fmt::format("{:.2f} M ticks/s", median(rate[1]) / 1e6), "", true);
  row("  ratio to the bare loop", fmt::format("{:.2f}", median(ratio[1])), "", true);
  row("lock-step", fmt::format("{:.2f} M ticks/s", median(rate[2]) / 1e6), "", true);
  row("  ratio to the RTL engine", fmt::format("{:.2f}", median(ratio[2])), ">= 0.60", median(ratio[2]) >= 0.6);
  row("lock-step, VCD of the pins", fmt::format("{:.2f} M ticks/s", median(rate[3]) / 1e6), "", true);
  row("  ratio to the RTL engine", fmt::format("{:.2f}", median(ratio[3])), "", true);
}

// What one IC more costs, in time a tick: the same from 2 to 5 ICs as from 5 to 22, within 20 %. Of a board's own cost,
// which all of them share, nothing is said. A MACRO IC, of which the larger boards have some, costs less than a servo
// IC.
void scaling(Tick ticks) {
  struct Size {
    std::uint32_t fitted;
    int ics;
    std::unique_ptr<Board> board;
    std::vector<double> cost;  // ns a tick
  };
  Size sizes[] = {{0x000003, 2, nullptr, {}}, {0x04000F, 5, nullptr, {}}, {0x3FFFFF, 22, nullptr, {}}};
  for (Size& s : sizes) {
    s.board = make_rtl_board(s.fitted);
    start_clocks(*s.board, s.fitted);
  }
  std::vector<double> few, many, ratio;  // ns a tick and IC from 2 to 5, from 5 to 22, and the one over the other
  for (int round = 0; round < kRounds; ++round) {
    for (Size& s : sizes) {
      const Tick run = ticks / s.ics;
      s.cost.push_back(seconds([&] { s.board->run_until(s.board->now() + run); }) / static_cast<double>(run) * 1e9);
    }
    few.push_back((sizes[1].cost.back() - sizes[0].cost.back()) / (sizes[1].ics - sizes[0].ics));
    many.push_back((sizes[2].cost.back() - sizes[1].cost.back()) / (sizes[2].ics - sizes[1].ics));
    ratio.push_back(many.back() / few.back());
  }
  for (const Size& s : sizes)
    row(fmt::format("RTL engine, {} ICs", s.ics), fmt::format("{:.2f} M ticks/s", 1e3 / median(s.cost)), "", true);
  row("  one IC more, from 2 to 5", fmt::format("{:.1f} ns a tick", median(few)), "", true);
  row("  one IC more, from 5 to 22", fmt::format("{:.1f} ns a tick", median(many)), "", true);
  row("  the second over the first", fmt::format("{:.2f}", median(ratio)), "0.80 .. 1.20",
      median(ratio) >= 0.8 && median(ratio) <= 1.2);
}

void cpu(std::uint64_t instructions) {
  std::vector<double> rate;
  for (int round = 0; round < kRounds; ++round) {
    std::uint64_t done = 0;
    const double s = seconds([&] { done = run_cpu_alone(instructions); });
    rate.push_back(static_cast<double>(done) / s);
  }
  row("CPU model alone", fmt::format("{:.0f} M instructions/s", median(rate) / 1e6), ">= 100 M instr/s",
      median(rate) >= 100e6);
}

}  // namespace
}  // namespace brick

int main(int argc, char** argv) {
  const std::set<std::string> known{"boards", "cpu", "machine", "bus", "moving"};
  std::set<std::string> parts;
  bool quick = false, usage = argc < 2;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick")
      quick = true;
    else if (known.count(word) != 0)
      parts.insert(word);
    else
      usage = true;
  }
  if (usage) {
    fmt::print(stderr, "usage: brick_benchmark FIRMWARE.elf [--quick] [boards|cpu|machine|bus|moving ...]\n");
    return 2;
  }
  if (parts.empty()) parts = known;
  const std::string waves = (std::filesystem::temp_directory_path() / "brick_benchmark").string();
  try {
    fmt::print("{:<58} {:>22}   {:<22}\n", "what", "median of 5", "goal");
    if (parts.count("boards") != 0) {
      brick::boards(quick ? 1'000'000 : 4'000'000, waves);
      brick::scaling(quick ? 2'000'000 : 8'000'000);
    }
    if (parts.count("cpu") != 0) brick::cpu(quick ? 50'000'000 : 200'000'000);
    if (parts.count("machine") != 0) {
      brick::measure_machine(brick::Engine::kSystemC, "SystemC", argv[1], quick ? 1 : 5, waves);
      brick::measure_machine(brick::Engine::kRtl, "RTL", argv[1], quick ? 0.01 : 0.05, waves);
      brick::measure_machine(brick::Engine::kLockstep, "lock-step", argv[1], quick ? 0.01 : 0.05, waves);
    }
    if (parts.count("bus") != 0) brick::measure_bus(argv[1], quick ? 0.05 : 0.5);
    if (parts.count("moving") != 0) {
      const double simulated = quick ? 0.1 : 0.5;
      brick::measure_moving("dac8", "eight DAC axes at 32 counts/ms", argv[1], simulated, 2, 0.02);
      brick::measure_moving("servo8", "eight PWM axes with current loops", argv[1], simulated, 1, 0.01);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "brick_benchmark: {}\n", e.what());
    return 2;
  }
  for (const char* n : {".1.vcd", ".2.vcd", ".3.vcd"}) std::filesystem::remove(waves + n);
  return 0;
}
