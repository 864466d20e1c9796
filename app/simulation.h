// One run of a controller: builds the machine, opens the waveform, runs the host program as a SystemC thread, and
// measures.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/options.h"
#include "app/plant_signals.h"
#include "app/profile.h"
#include "app/recorder.h"
#include "app/timing_waivers.h"
#include "systemc/core/trace.h"
#include "systemc/cpu/gdb_server.h"
#include "systemc/machine/machine.h"
#include "testbench/host/host_link.h"
#include "testbench/plant/plant.h"

namespace brick {

// A signal asked the command to stop (SIGINT, SIGTERM): the run ends as one that fails, and the flash file is written.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Simulation {
 public:
  // Throws UsageError for everything that is wrong with board, firmware, flash or waveform file.
  // `motors` stand where no --plant is given.
  Simulation(const RunOptions& options, const MachineConfig& config, std::string title,
             const std::vector<plant::AxisParameters>& motors = {});
  ~Simulation();

  // Runs `host` to its end; what it throws comes out here. Afterwards the waveform is complete.
  void run(const std::function<void()>& host);

  Machine& machine() { return *machine_; }
  HostBus& bus() { return bus_; }
  HostLink& link() { return link_; }
  plant::Plant* plant() { return plant_.get(); }  // of --plant, else the motors; nullptr: none
  TimingBook& timing() { return *timing_; }

  // What broke a rule of the buses, one line each: what fails the run, what a waiver excuses, waivers not needed and
  // wait states that were forced on nobody.
  struct TimingVerdict {
    std::vector<std::string> failures, waived, unused;
  };
  TimingVerdict timing_verdict();

  // From now on, until it is ended or the run has ended; one of each at a time. Throw UsageError.
  void open_wave(const std::string& file, const WaveWindow& window, const TraceGroups& groups);
  void close_wave();
  void open_record(const std::string& file, const std::string& of);  // "" = the usual columns
  void close_record();

  // The run ends as with SIGTERM when this process is no child of process `parent` any more. Throws UsageError when it
  // is none now; 0: there is none.
  void end_with(int parent);

  void bear_with_keys();  // of a session at a terminal: SIGINT asks to stop, and never ends the process at once
  bool go_on();           // after Interrupted: true when a key asked to stop (SIGINT), which may be asked again

  std::function<std::string()> progress_text;  // more for the line that a terminal shows
  std::function<void()> show_progress;         // instead of that line; often
  void tell(const std::string& line);          // on stderr, beside that line
  void before_output();                        // on stdout, which may be the same terminal

  nlohmann::json measures() const;  // simulated and wall time, ticks/s, instructions/s
  std::string measures_text() const;
  std::string aperture_text() const;  // "" without --aperture

 private:
  void open_profile(const std::string& file, const std::string& image);
  void close_profile();
  void wait_for_debugger(std::uint16_t port);
  std::string usual_columns() const;  // of --record
  void progress();
  void clear_progress();
  double wall_seconds() const;

  std::string title_;
  std::unique_ptr<plant::Plant> plant_;  // outlives the machine, which calls it
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<PlantSignals> plant_signals_;
  std::unique_ptr<GdbServer> debugger_;
  std::unique_ptr<TimingBook> timing_;
  std::unique_ptr<Profile> profile_;    // ends before the machine, whose hooks it takes
  std::unique_ptr<Recorder> recorder_;  // ends before timing_, whose callbacks it calls on
  const std::optional<std::string> forced_bcr_;
  TimingWaivers waivers_;
  HostBus bus_;
  HostLink link_;
  std::unique_ptr<TraceWriter> trace_;
  std::string wave_;
  TimeFs wave_from_ = 0;
  bool wave_is_empty_ = false;  // its window begins after the run
  std::chrono::steady_clock::time_point begin_, last_progress_;
  double seconds_ = 0;
  int parent_ = 0;  // 0: whatever it is
  bool terminal_ = false, prints_to_terminal_ = false, shown_ = false;
};

}  // namespace brick
