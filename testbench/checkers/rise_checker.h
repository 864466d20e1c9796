// T_RISE of host-bus:5.7/8: a full rotary buffer runs empty while nobody sends, and BREQ has to rise once, within the
// real-time interrupt that calculates the line with which L falls below I16. Told what was seen, in any order; judges
// at the end. Knows nothing of the firmware.
#pragma once

#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class RiseChecker {
 public:
  RiseChecker(unsigned lines, unsigned i16) : lines_(lines), i16_(i16) {}

  void calculated(TimeFs time) { calculated_.push_back(time); }  // a line
  void background(TimeFs time) { background_.push_back(time); }  // what interrupted it is over
  void rose(TimeFs time) { rises_.push_back(time); }

  bool all_calculated() const { return calculated_.size() >= lines_; }
  std::string difference() const;                                      // "" or what is wrong
  TimeFs time() const { return rises_.front() - calculated_[due()]; }  // where nothing is

 private:
  std::size_t due() const { return lines_ - i16_; }  // the line that leaves I16 - 1

  unsigned lines_, i16_;
  std::vector<TimeFs> calculated_, background_, rises_;
};

}  // namespace brick
