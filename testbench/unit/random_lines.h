// Host lines by chance, for tests that nothing a host sends stops the controller: nine tenths from the grammar, one
// tenth garbage. Left out is what stops the real one too: clock, watchdog and wait-state settings (I19, I37, I40, I52,
// the clock variables of an IC), writes to device registers, directly or by an M-variable, and a PLC 0 that takes long.
// Programs are entered whole, run and stopped, PLCs enabled, settings saved and reset.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <string>
#include <vector>

namespace brick {

class RandomLines {
 public:
  explicit RandomLines(unsigned seed) : random_(seed) {}
  std::string next();      // without its CR; control characters may be inside
  std::string settings();  // a line that writes eight I-variables

 private:
  unsigned below(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(random_); }
  bool one_in(unsigned n) { return below(n) == 0; }
  std::string pick(const std::vector<std::string>& texts) { return texts[below(static_cast<unsigned>(texts.size()))]; }
  std::string integer(unsigned below_it);
  std::string constant();
  std::string expression(unsigned depth);
  std::string i_variable();    // one that may be written
  std::string pqm_variable();  // by number or by expression
  std::string assignment();
  std::string statement();
  std::string logic();
  std::string report();
  std::string definition();
  std::string memory();
  std::string buffer();
  std::string fixed_buffer();
  std::string program_statement();
  void plc0();
  void whole_program();
  std::string run_control();
  std::string grammar();
  std::string garbage();

  std::mt19937 random_;
  std::deque<std::string> program_;  // lines of a whole program that are still to come
  bool alone_ = false;               // nothing comes between them
};

}  // namespace brick
