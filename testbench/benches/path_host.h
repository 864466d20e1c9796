// What the benches of paths share: programs in several coordinate systems at once, each with motors of its own, and
// what their samples are held against: a path in program time, a path as geometry, limits as differences over servo
// interrupts (motion:7.4/4).
#pragma once

#include <string>
#include <vector>

#include "testbench/benches/motor_host.h"
#include "testbench/checkers/spline_path.h"

namespace brick {

// Samples `from` to `to`, all by default.
struct SampleSpan {
  std::size_t from = 0, to = ~std::size_t{0};
};

class PathHost : public MotorHost {
 public:
  static constexpr double kNear = 1.0 / 16;  // counts beside a path

  using MotorHost::MotorHost;

  using Span = SampleSpan;
  struct System {
    unsigned number = 0;           // &n
    std::vector<unsigned> motors;  // one an axis
    std::string name;              // of its case
  };

  // Of two motors each; of a Geo PMAC one, since one has the lookahead buffer there (firmware:3.8).
  unsigned systems();
  MotorPoint at(const System& s, std::size_t sample) const;  // counts from the first sample
  std::size_t last_of(const System& s, Span span) const;
  std::size_t begins(const System& s, std::size_t from = 0) const;  // first sample behind `from` that differs
  double lasts(const System& s, Span span = {}) const;              // ms from the first to the last change

  // All motors at their path in program time, at a rate of 1: where it begins is found, within a few servo cycles.
  struct Fitted {
    double worst = 1e9, at = 0, begin = 0;  // counts; ms of the path; ms of the samples
    std::size_t moving = 0;
  };
  Fitted fitted(const System& s, const SplinePath& path) const;
  void report_fitted(const System& s, const SplinePath& path, const Fitted& fit);

  // Sample by sample to the nearest place of the path, as much of program time away as a servo cycle may take, either
  // way. Time of each sample. The path begins at `origin`, where the motors are at the first sample if that is empty.
  struct Followed {
    double worst = 0;
    std::size_t at = 0;
    std::vector<double> times;
  };
  Followed followed(const System& s, const SplinePath& path, Span span = {}, const MotorPoint& origin = {}) const;
  void report_followed(const System& s, const Followed& f, std::size_t least);

  // Ixx16 and Ixx17 of a motor: largest first and second difference, as parts of what motion:7.4/4 allows.
  struct Limits {
    double velocity, acceleration;  // counts a ms, ms^2; 0: none
  };
  struct Use {
    double velocity = 0, acceleration = 0;
    std::size_t fastest = 0, sharpest = 0;
  };
  Use use(unsigned motor, Limits limits, Span span = {}) const;
  // At most all of it, and at least `least` of one of them by some motor.
  void report_limits(const System& s, const std::vector<Limits>& limits, double least, Span span = {});

  // Words Y of the main memory, one at each sample since watch().
  void watch(const std::vector<std::uint32_t>& addresses);
  const std::vector<std::uint32_t>& watched(std::size_t word) const { return watched_.at(word); }

  // Commanded to the unit of a position word; the motor within a count of it, 10 ms behind that at most.
  void report_end(const System& s, const MotorPoint& way);
  unsigned run_time_error(const System& s);
  std::uint32_t status_word(const System& s, unsigned word);  // of `??`, 1 to 3

 private:
  void looked() override;

  std::vector<std::uint32_t> addresses_;
  std::vector<std::vector<std::uint32_t>> watched_;
};

}  // namespace brick
