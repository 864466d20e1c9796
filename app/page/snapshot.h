// What the page shows of a controller, as JSON: read by the back door at one instant of simulated time, between two
// pieces of it. No command is sent and no bus cycle made, so the controller does the same with it and without
// (docs/page.md).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/page/image_calls.h"
#include "app/page/watch_list.h"
#include "app/record_column.h"
#include "app/simulation.h"

namespace brick {

class Snapshot {
 public:
  // `firmware`: the ELF that the machine runs. What belongs to the simulation must live longer.
  Snapshot(Simulation& simulation, const std::string& firmware);

  // Positions for the plots, kept until the next take(). Call it as often as you like: it reads once in ten
  // milliseconds of simulated time.
  void sample();

  void watch(const std::set<std::string>& items) { watch_.set(items); }

  nlohmann::json take();

 private:
  struct Samples {
    RecordColumn actual, error;
    std::vector<double> actuals, errors;
  };
  struct Pins {
    Signals::Id plus_limit, minus_limit, home, fault, enable;
  };

  std::optional<std::uint64_t> call(const std::string& function, std::initializer_list<std::uint32_t> arguments);
  std::int32_t variable(std::uint32_t number);
  struct Word {
    std::uint32_t x = 0, y = 0;
  };
  Word word(std::uint32_t address);
  std::uint64_t signal(const std::string& name) const;
  std::vector<unsigned> shown_motors();
  nlohmann::json motor(unsigned number, double servo_khz);
  nlohmann::json system(unsigned number);
  nlohmann::json request();
  nlohmann::json clocks();
  nlohmann::json tasks();
  nlohmann::json watchdog();
  void measure();

  Simulation& simulation_;
  Machine& machine_;
  ImageCalls image_;
  std::map<unsigned, Samples> samples_;
  std::map<unsigned, Pins> pins_;
  std::vector<double> sample_times_;
  WatchList watch_;
  std::optional<Tick> sampled_;
  struct Measure {
    double ms = 0;
    std::uint32_t servo_count = 0;
    Cycle cycle = 0, slept = 0;
  } last_;
  double servo_khz_ = 0, asleep_ = 0;
  std::uint32_t phase_cycles_ = 0;                         // period, of the CPU clock
  std::uint32_t servo_phases_ = 1, real_time_servos_ = 1;  // periods, of the next shorter one
};

}  // namespace brick
