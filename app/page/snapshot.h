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

  // Items of the watch list, as `--record-of` takes them (docs/record.md). What is none has a text instead of a value.
  // What is watched already stays as it is.
  void watch(const std::set<std::string>& items);

  nlohmann::json take();

 private:
  struct Samples {
    RecordColumn actual, error;
    std::vector<double> actuals, errors;
  };
  struct Pins {
    Signals::Id plus_limit, minus_limit, home, fault, enable;
  };
  struct Watched {
    std::string mistake;
    std::vector<RecordColumn> columns;
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
  nlohmann::json program_line(unsigned system);
  std::string words_text(std::uint32_t count);
  nlohmann::json request();
  nlohmann::json clocks();
  nlohmann::json tasks();
  nlohmann::json watchdog();
  nlohmann::json watched() const;
  void measure();

  Simulation& simulation_;
  Machine& machine_;
  ImageCalls image_;
  std::map<unsigned, Samples> samples_;
  std::map<unsigned, Pins> pins_;
  std::vector<double> sample_times_;
  std::map<std::string, Watched> watched_;
  std::optional<Tick> sampled_;
  struct Measure {
    double ms = 0;
    std::uint32_t servo_count = 0;
    Cycle cycle = 0, slept = 0;
  } last_;
  double servo_khz_ = 0, asleep_ = 0;
  std::uint32_t phase_cycles_ = 0, servo_cycles_ = 0, real_time_cycles_ = 0;  // periods, of the CPU clock
};

}  // namespace brick
