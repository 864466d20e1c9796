#include "app/simulation.h"

#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/byte_text.h"
#include "app/hand_encoder.h"
#include "app/paths.h"
#include "app/plant_file.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr std::size_t kHostStack = 4 << 20;

// The host program as a SystemC process. An exception must not cross the kernel: it is kept and thrown again outside.
class HostThread : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(HostThread);
  HostThread(sc_core::sc_module_name name, const std::function<void()>& host) : sc_module(name), host_(host) {
    SC_THREAD(main);
    set_stack_size(kHostStack);
  }
  std::exception_ptr error() const { return error_; }

 private:
  void main() {
    try {
      host_();
    } catch (...) { error_ = std::current_exception(); }
  }

  const std::function<void()>& host_;
  std::exception_ptr error_;
};

// The signal that asked to stop; the next one ends the process at once.
volatile std::sig_atomic_t asked_to_stop = 0;
bool key_is_patient = false;  // the next SIGINT does not

void stop_when_asked() {
  struct sigaction action {};
  action.sa_handler = [](int signal) {
    if (signal != SIGINT || asked_to_stop == 0) asked_to_stop = signal;  // a key takes nothing back
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    action.sa_flags = static_cast<int>(signal == SIGINT && key_is_patient ? SA_RESTART : SA_RESETHAND | SA_RESTART);
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;  // as of nohup
    sigaction(signal, &action, nullptr);
  }
}

std::string text_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& e) { return e.what(); }
}

// Which is how some runs end; a file that got lost is more.
bool is_interruption(const std::exception_ptr& error) {
  if (!error) return false;
  try {
    std::rethrow_exception(error);
  } catch (const Interrupted&) { return true; } catch (...) {
    return false;
  }
}

std::unique_ptr<Machine> make_machine(const MachineConfig& config) {
  try {
    return std::make_unique<Machine>("brick", config);
  } catch (const std::exception& e) { throw UsageError(e.what()); }
}

std::unique_ptr<plant::Plant> make_plant(const RunOptions& options, const MachineConfig& config,
                                         const std::vector<plant::AxisParameters>& motors) {
  if (options.plant == "none" && motors.empty()) return nullptr;
  if (options.plant == "none") {
    plant::PlantParameters parameters;
    parameters.seed = config.seed;
    parameters.axes = motors;
    return std::make_unique<plant::Plant>(parameters);
  }
  return std::make_unique<plant::Plant>(read_plant_file(plant_path(options.plant), config.board.fitted, config.seed));
}

}  // namespace

Simulation::Simulation(const RunOptions& options, const MachineConfig& config, std::string title,
                       const std::vector<plant::AxisParameters>& motors)
    : title_(std::move(title)),
      plant_(make_plant(options, config, motors)),
      machine_(make_machine(config)),
      timing_(std::make_unique<TimingBook>(*machine_)),
      forced_bcr_(options.bcr),
      waivers_(options.waive ? TimingWaivers(*options.waive) : TimingWaivers()),
      bus_(*machine_),
      link_(bus_),
      terminal_(isatty(STDERR_FILENO) == 1),
      prints_to_terminal_(isatty(STDOUT_FILENO) == 1) {
  if (plant_) {
    machine_->attach(*plant_);
    plant_signals_ = std::make_unique<PlantSignals>(*machine_, *plant_);
  }
  bus_.set_heartbeat([this] { progress(); });
  waivers_.check(timing_->ledgers());
  timing_->on_violation = [this](const TimingLedger& ledger, const TimingViolation& violation) {
    if (debugger_ && waivers_.reason(ledger, violation).empty()) debugger_->bus_error(timing_->text(ledger, violation));
  };
  if (!options.gdb.empty()) wait_for_debugger(gdb_port(options));
  if (!options.profile.empty()) open_profile(options.profile, config.firmware);
  if (!options.record.empty()) open_record(options.record, options.record_of);
  if (!options.wave.empty()) open_wave(options.wave, wave_window(options), trace_groups(options));
}

void Simulation::open_wave(const std::string& file, const WaveWindow& window, const TraceGroups& groups) {
  if (trace_) throw UsageError(fmt::format("--wave {}: there is {} already; expected its end first", file, wave_));
  if (const auto unknown = groups.unmatched(machine_->signals()))
    throw UsageError(
        fmt::format("--trace {}: this board has no such signal; expected names or globs of docs/signals.md", *unknown));
  try {
    const auto folder = std::filesystem::path(file).parent_path();
    std::error_code ignored;  // opening the file says what is wrong
    if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
    trace_ = TraceWriter::open(file, window.from, window.to);
  } catch (const std::exception& e) { throw UsageError(fmt::format("--wave {}; expected a writable place", e.what())); }
  trace_->on_failure = [this](const std::string& why) { tell(fmt::format("brick: {}; the run goes on", why)); };
  wave_ = file;
  wave_from_ = window.from;
  machine_->signals().attach(trace_.get(), groups);
}

void Simulation::close_wave() {
  if (!trace_) return;
  machine_->signals().attach(nullptr);
  const std::unique_ptr<TraceWriter> ended = std::move(trace_);
  try {
    ended->close();
  } catch (const std::exception& e) {
    throw UsageError(fmt::format("--wave {}; expected room for the waveform", e.what()));
  }
  wave_is_empty_ = machine_->now_fs() < wave_from_;
  if (wave_is_empty_)
    tell(
        fmt::format("brick: --wave {}: is empty, because the run has ended at {:.3f} ms; expected --wave-from before, "
                    "not {:.3f} ms",
                    wave_, static_cast<double>(machine_->now_fs()) * 1e-12, static_cast<double>(wave_from_) * 1e-12));
}

void Simulation::open_record(const std::string& file, const std::string& of) {
  if (recorder_) throw UsageError(fmt::format("--record {}: there is one already; expected its end first", file));
  recorder_ = std::make_unique<Recorder>(*machine_, file, of, usual_columns());
  recorder_->on_failure = [this](const std::string& why) { tell(fmt::format("brick: {}; the run goes on", why)); };
}

void Simulation::close_record() {
  if (!recorder_) return;
  const std::unique_ptr<Recorder> ended = std::move(recorder_);
  ended->close();
}

void Simulation::open_profile(const std::string& file, const std::string& image) {
  if (image.empty())
    throw UsageError(fmt::format("--profile {}: no firmware runs in {}; expected no --profile", file, title_));
  profile_ = std::make_unique<Profile>(*machine_, file, image);
}

void Simulation::close_profile() {
  if (!profile_) return;
  profile_->close();
  std::istringstream lines(profile_->text());
  for (std::string line; std::getline(lines, line);) tell(line);
  profile_.reset();
}

void Simulation::wait_for_debugger(std::uint16_t port) {
  try {
    debugger_ = std::make_unique<GdbServer>(machine_->cpu(), port);
  } catch (const std::runtime_error& e) {
    throw UsageError(fmt::format("--gdb {}: {}; expected a free port", port, e.what()));
  }
  machine_->attach_debugger(debugger_.get());
}

// Of each motor of the plant, else of the first eight.
std::string Simulation::usual_columns() const {
  std::string columns;
  const std::size_t motors = plant_ ? plant_->axes() : 8;
  for (std::size_t i = 0; i < motors; ++i) {
    const auto number =
        plant_ ? motor_number(machine_->fitted(), plant_->axis(i).ic(), plant_->axis(i).channel()) : i + 1;
    columns += fmt::format("motor{0}.commanded motor{0}.actual motor{0}.error ", number);
  }
  return columns + "host.breq";
}

Simulation::~Simulation() {
  clear_progress();
  if (machine_) machine_->signals().attach(nullptr);
}

void Simulation::run(const std::function<void()>& host) {
  if (debugger_) fmt::print(stderr, "gdb: waiting on 127.0.0.1:{}\n", debugger_->port());
  HostThread thread("host", host);
  if (!debugger_) stop_when_asked();  // a machine that stands in the debugger would not look
  begin_ = last_progress_ = std::chrono::steady_clock::now();
  sc_core::sc_start();  // returns when the thread has ended: nothing else is scheduled
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  std::exception_ptr error = thread.error();
  for (void (Simulation::*const close)() :
       {&Simulation::close_wave, &Simulation::close_record, &Simulation::close_profile}) {
    try {
      (this->*close)();
    } catch (const std::exception& e) {  // each is closed, and the first error ends the run
      if (is_interruption(error)) tell(fmt::format("brick: {}", text_of(std::exchange(error, nullptr))));
      if (error) tell(fmt::format("brick: {}", e.what()));
      if (!error) error = std::current_exception();
    }
  }
  clear_progress();
  if (error) std::rethrow_exception(error);
}

void Simulation::end_with(int parent) {
  if (parent != 0 && parent != getppid())
    throw UsageError(fmt::format("--end-with {}: has not started this process; expected {}", parent, getppid()));
  parent_ = parent;
}

void Simulation::bear_with_keys() {
  if (debugger_) return;
  key_is_patient = true;
  stop_when_asked();
}

bool Simulation::go_on() {
  if (asked_to_stop != SIGINT) return false;
  asked_to_stop = 0;
  stop_when_asked();
  return true;
}

void Simulation::progress() {
  if (asked_to_stop != 0)
    throw Interrupted(fmt::format("stopped by {} after {:.3f} ms of simulated time",
                                  asked_to_stop == SIGINT    ? "SIGINT"
                                  : asked_to_stop == SIGTERM ? "SIGTERM"
                                                             : "SIGHUP",
                                  static_cast<double>(machine_->now_fs()) * 1e-12));
  if (parent_ != 0 && getppid() != parent_)
    throw Interrupted(fmt::format("process {} has gone, with which it was to end", parent_));
  if (show_progress) return show_progress();
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_progress_ < std::chrono::milliseconds(300)) return;
  last_progress_ = now;
  shown_ = true;
  const double wall = std::chrono::duration<double>(now - begin_).count();
  std::fputs(fmt::format("\r\033[K{}: {:.1f} ms simulated, {:.1f} M ticks/s{}", title_,
                         static_cast<double>(machine_->now_fs()) * 1e-12,
                         static_cast<double>(machine_->now()) / wall * 1e-6, progress_text ? progress_text() : "")
                 .c_str(),
             stderr);
}

void Simulation::clear_progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Simulation::tell(const std::string& line) {
  clear_progress();
  std::fputs((readable_text(line) + '\n').c_str(), stderr);
}

void Simulation::before_output() {
  if (prints_to_terminal_) clear_progress();
}

Simulation::TimingVerdict Simulation::timing_verdict() {
  constexpr std::size_t kViolationsTold = 20;
  TimingVerdict verdict;
  std::size_t more = 0;
  for (const TimingLedger* ledger : timing_->ledgers()) {
    for (const TimingViolation& violation : ledger->violations()) {
      const std::string reason = waivers_.reason(*ledger, violation);
      const std::string text = timing_->text(*ledger, violation);
      if (reason.empty() && verdict.failures.size() < kViolationsTold)
        verdict.failures.push_back(text);
      else if (reason.empty())
        ++more;
      else
        verdict.waived.push_back(fmt::format("{}; waived: {}", text, reason));
    }
  }
  if (more > 0) verdict.failures.push_back(fmt::format("bus timing: {} more, see brick timing --json", more));
  verdict.unused = waivers_.unused();
  if (forced_bcr_ && !machine_->forced_bcr_acted())
    verdict.unused.push_back(fmt::format(
        "--bcr {}: has never acted, because BCR and PCTL stand as a reset leaves them; expected a program that sets "
        "another CPU clock or other wait states of a device",
        *forced_bcr_));
  return verdict;
}

nlohmann::json Simulation::measures() const {
  const double wall = seconds_ > 0 ? seconds_ : 1e-9;
  const Aperture::Counts& moves = machine_->aperture().counts();
  return {{"aperture",
           {{"fs", static_cast<std::int64_t>(machine_->aperture().width())},
            {"moves", moves.moves},
            {"early", moves.early},
            {"late", moves.late},
            {"split", moves.split}}},
          {"simulated_ns", fs_to_ns(machine_->now_fs())},
          {"ticks", machine_->now()},
          {"wall_seconds", seconds_},
          {"ticks_per_second", static_cast<double>(machine_->now()) / wall},
          {"instructions", machine_->instructions()},
          {"instructions_per_second", static_cast<double>(machine_->instructions()) / wall}};
}

std::string Simulation::aperture_text() const {
  const Aperture& aperture = machine_->aperture();
  const Aperture::Counts& c = aperture.counts();
  if (!aperture.on()) return "";
  return fmt::format("aperture {:g} ns: {} moves of pins, {} within it: {} early, {} late, {} of a bus line by line",
                     static_cast<double>(aperture.width()) * 1e-6, c.moves, c.inside(), c.early, c.late, c.split);
}

std::string Simulation::measures_text() const {
  const double wall = seconds_ > 0 ? seconds_ : 1e-9;
  std::string text = fmt::format("simulated {:.3f} ms in {:.2f} s: {:.2f} M ticks/s, {:.2f} M instructions/s",
                                 static_cast<double>(machine_->now_fs()) * 1e-12, seconds_,
                                 static_cast<double>(machine_->now()) / wall * 1e-6,
                                 static_cast<double>(machine_->instructions()) / wall * 1e-6);
  if (const std::string moves = aperture_text(); !moves.empty()) text += '\n' + moves;
  if (!wave_.empty()) text += fmt::format("\nwaveform {}{}", wave_, wave_is_empty_ ? ", empty" : "");
  return text;
}

}  // namespace brick
