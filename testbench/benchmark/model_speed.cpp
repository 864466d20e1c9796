// Speed of the model of the board alone: what the servo ICs cost when nobody looks at them, and when somebody does.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "systemc/board/model_board.h"
#include "testbench/benchmark/measure.h"

namespace brick {
namespace {

struct Case {
  const char* name;
  std::uint32_t ics;
  bool pwm;  // all channels of the first two ICs run their PWM at 50 %
  std::uint32_t watched;
  bool polls;        // the host reads a status register without a pause
  double simulated;  // seconds
};

void write(Board& board, BoardInputs& in, bool x, std::uint32_t address, std::uint32_t value) {
  in.pa_addr = address;
  in.pa_x = x;
  in.pa_aa = address >= 0x78000 ? 2 : 0;
  in.pa_wdata = value;
  board.set_inputs(in);
  board.run_until(board.now() + 2);
  in.pa_wr_n = false;
  board.set_inputs(in);
  board.run_until(board.now() + 12);
  in.pa_wr_n = true;
  board.set_inputs(in);
  board.run_until(board.now() + 3);
  in.pa_aa = 0;
  board.set_inputs(in);
  board.run_until(board.now() + 9);
}

// A read of the host port's status takes six periods of the 8.33 MHz bus clock, the command four of them.
void poll(Board& board, BoardInputs& in) {
  in.set_address(0x212);
  board.set_inputs(in);
  board.run_until(board.now() + 14);
  in.isa_ior_n = false;
  board.set_inputs(in);
  board.run_until(board.now() + 57);
  in.isa_ior_n = true;
  board.set_inputs(in);
  board.run_until(board.now() + 14);
}

double rate(const Case& c) {
  auto board = make_model_board(c.ics);
  BoardInputs in;
  in.fitted = c.ics;
  board->set_inputs(in);
  board->run_until(30);
  in.rst_n = true;
  board->set_inputs(in);
  board->run_until(60);
  write(*board, in, true, 0x78004, 0x3008D2);
  for (std::uint32_t at = 0x78000; c.pwm && at < 0x78200; at += 0x100) {
    for (std::uint32_t channel = 0; channel < 32; channel += 8) {
      write(*board, in, true, at + channel + 5, 0x4007);
      for (std::uint32_t out = 2; out < 5; ++out) write(*board, in, false, at + channel + out, 0x100 * out);
    }
  }
  board->watch_motors(c.watched);
  board->run_until(board->now() + 2'000'000);
  return c.simulated / seconds([&] {
           const Tick end = board->now() + static_cast<Tick>(c.simulated * kTicksPerSecond);
           while (board->now() < end) {
             const Tick strobe = std::min(end, board->now() + 2'000'000);  // the watchdog waits for 25 ms
             while (c.polls && board->now() < strobe) poll(*board, in);
             board->run_until(strobe);
             write(*board, in, true, 0x70011, 0);
           }
         });
}

}  // namespace

// One case by its number, or all of them.
void model_speed(int only) {
  constexpr Case kCases[] = {
      {"two servo ICs", 0x3, false, 0, false, 20},
      {"all 22 ICs", 0x3FFFFF, false, 0, false, 20},
      {"two servo ICs, 8 channels of PWM that nobody watches", 0x3, true, 0, false, 20},
      {"two servo ICs, 8 channels of PWM, watched", 0x3, true, 0x3, false, 0.5},
      {"two servo ICs, the host polls", 0x3, false, 0, true, 0.5},
  };
  std::vector<double> rates[std::size(kCases)];
  for (int round = 0; round < 5; ++round)
    for (std::size_t i = 0; i < std::size(kCases); ++i)
      if (only < 0 || only == static_cast<int>(i)) rates[i].push_back(rate(kCases[i]));
  for (std::size_t i = 0; i < std::size(kCases); ++i) {
    if (rates[i].empty()) continue;
    fmt::print("{:<58} {:>10.2f} sim s/s\n", kCases[i].name, median(rates[i]));
  }
}

}  // namespace brick

int main(int argc, char** argv) {
  brick::model_speed(argc > 1 ? std::atoi(argv[1]) : -1);
  return 0;
}
