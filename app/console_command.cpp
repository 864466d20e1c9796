// `brick console`: an interactive terminal to the controller. What is typed goes the way of a host script; simulated
// time goes with the wall's while nobody types.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/commands.h"
#include "app/line_editor.h"
#include "app/pacing.h"
#include "app/refused_lines.h"
#include "app/script_player.h"
#include "app/session_end.h"
#include "app/set_up.h"
#include "app/signal_watch.h"
#include "app/simulation.h"
#include "app/status_line.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {
constexpr const char* kPrompt = "> ";
constexpr const char* kFile = "console";
constexpr const char* kQuit = "@quit";
constexpr const char* kWelcome =
    "Control keys are the controller's: ^A aborts, ^P asks for positions, ^X forgets the line. @ lines as in host "
    "scripts. ^] or @quit ends.\n";
constexpr std::chrono::milliseconds kRepaint{200}, kNap{10};
constexpr Tick kPiece = ns_to_ticks(500'000);  // between two looks at the keys

// How often PHASE and SERVO rise.
class ClockMeter {
 public:
  explicit ClockMeter(HostBus& bus) : bus_(bus), since_(bus.now()) {
    bus.watch(select_pins(pin::kPhase, pin::kServo),
              [this](Tick, const BoardOutputs& before, const BoardOutputs& after) {
                phases_ += after.get(pin::kPhase) & ~before.get(pin::kPhase);
                servos_ += after.get(pin::kServo) & ~before.get(pin::kServo);
              });
  }
  ~ClockMeter() { bus_.watch({}, nullptr); }
  ClockMeter(const ClockMeter&) = delete;
  ClockMeter& operator=(const ClockMeter&) = delete;

  // In kHz, since the last call that had edges to count.
  std::pair<double, double> take() {
    const double ms = static_cast<double>(tick_to_fs(bus_.now() - since_)) * 1e-12;
    if (ms < kLeast) return last_;
    last_ = {phases_ / ms, servos_ / ms};
    phases_ = servos_ = 0;
    since_ = bus_.now();
    return last_;
  }

 private:
  static constexpr double kLeast = 20;  // ms: whole periods count
  HostBus& bus_;
  Tick since_;
  unsigned phases_ = 0, servos_ = 0;
  std::pair<double, double> last_{0, 0};
};

std::string clock_source(Machine& machine) {
  const Signals& signals = machine.signals();
  const std::string number = signal_text(signals, find_signal(signals, "clock.source"));
  return number == "0" ? "no source" : "I" + number;
}

// What belongs to a session with somebody at a terminal.
struct Terminal {
  explicit Terminal(HostBus& bus) : meter(bus), pacing(bus.now()) {}
  StatusLine status;
  LineEditor editor{kPrompt};
  ClockMeter meter;
  Pacing pacing;
  std::chrono::steady_clock::time_point painted;
};

class Console {
 public:
  Console(Simulation& simulation, std::string history)
      : simulation_(simulation), player_(simulation.link(), std::cout, false), history_(std::move(history)) {}
  ~Console() { leave(); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void talk();    // with somebody at a terminal
  void listen();  // to lines from a pipe
  void leave();   // the terminal is as it was, the lines typed are kept
  const ScriptPlayer& player() const { return player_; }
  std::string failure() const;  // of lines from a pipe, whose sender may not read what is told; else ""

 private:
  bool play(const std::string& line);  // false: it ends the session
  bool next_line(std::string& line);   // of the pipe; false: there is none
  void tell(const std::string& text);
  void fail(const std::string& text);
  void explain();
  void connect_again();  // after a stop
  void paint();
  std::chrono::milliseconds wait();  // lets time pass; for how long there is nothing to do then
  void wait_anew();                  // from now on, whatever a command took

  Simulation& simulation_;
  ScriptPlayer player_;
  const std::string history_;  // its file
  std::string came_;           // through the pipe
  std::unique_ptr<Terminal> terminal_;
  std::size_t explained_ = 0;  // exchanges
  std::size_t failed_ = 0;     // lines of the pipe
  std::string first_failure_;
};

void Console::leave() {
  simulation_.show_progress = nullptr;
  if (terminal_ && !history_.empty() && !terminal_->editor.save_history(history_))
    tell(fmt::format("--history {}: cannot be written; expected a writable place", history_));
  player_.before_output = nullptr;
  terminal_.reset();
}

void Console::tell(const std::string& text) {
  if (terminal_) terminal_->editor.make_room();
  simulation_.tell(text);
}

void Console::fail(const std::string& text) {
  tell(text);
  if (!terminal_ && failed_++ == 0) first_failure_ = text;
}

std::string Console::failure() const {
  return failed_ == 0 ? "" : fmt::format("{} of the lines failed, the first: {}", failed_, first_failure_);
}

void Console::explain() {
  const auto& exchanges = player_.exchanges();
  for (; explained_ < exchanges.size(); ++explained_) {
    const ScriptPlayer::Exchange& exchange = exchanges[explained_];
    if (exchange.error && !exchange.reply.empty())
      tell(fmt::format("  {}: {}", exchange.line, error_meaning(exchange.reply.back())));
  }
}

// A key that is held down begins it anew: nothing is answered without it.
void Console::connect_again() {
  for (;;) {
    try {
      if (!simulation_.link().connect(HostLink::kBootTime))
        tell("the controller does not answer; see @reset and @power");
      return;
    } catch (const Interrupted&) {
      if (!simulation_.go_on()) throw;
    }
  }
}

bool Console::play(const std::string& line) {
  if (line.substr(0, line.find_last_not_of(" \t\r") + 1) == kQuit) return false;
  try {
    std::istringstream in(line);
    const auto script = read_script(in, kFile);
    player_.check(script);
    player_.play(script);
  } catch (const UsageError& e) { fail(e.what()); } catch (const ScriptFailure& e) {
    fail(e.what());
  } catch (const Interrupted& e) {
    if (!terminal_ || !simulation_.go_on()) throw;
    tell(e.what());
    connect_again();
  }
  explain();
  return true;
}

// While none comes the signals are looked at.
bool Console::next_line(std::string& line) {
  for (std::size_t looked = 0;;) {
    if (const std::size_t end = came_.find('\n', looked); end != std::string::npos) {
      line = came_.substr(0, end);
      came_.erase(0, end + 1);
      return true;
    }
    pollfd pipe{STDIN_FILENO, POLLIN, 0};
    while (poll(&pipe, 1, static_cast<int>(kNap.count())) <= 0) simulation_.bus().heartbeat();
    std::array<char, 4096> piece;
    looked = came_.size();
    const ssize_t count = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (count > 0) {
      came_.append(piece.data(), static_cast<std::size_t>(count));
      continue;
    }
    line = std::exchange(came_, "");
    return !line.empty();
  }
}

void Console::listen() {
  if (isatty(STDIN_FILENO) == 1) simulation_.show_progress = [] {};  // it would stand in what is typed
  for (std::string line; next_line(line) && play(line);) {}
}

void Console::paint() {
  const auto now = std::chrono::steady_clock::now();
  if (now - terminal_->painted < kRepaint) return;
  terminal_->painted = now;
  Machine& machine = simulation_.machine();
  const auto [phase, servo] = terminal_->meter.take();
  const BoardOutputs& pins = machine.outputs();
  terminal_->status.show(fmt::format(" {:.1f} s | {}: PHASE {:.3f} kHz, SERVO {:.3f} kHz | BREQ {}{}",
                                     static_cast<double>(machine.now_fs()) * 1e-15, clock_source(machine), phase, servo,
                                     pins.get(pin::kBreq), pins.get(pin::kWdo) != 0 ? " | WATCHDOG TRIPPED" : ""));
}

std::chrono::milliseconds Console::wait() {
  HostBus& bus = simulation_.bus();
  const Tick due = terminal_->pacing.due(bus.now());
  try {
    bus.advance_to(std::min(due, bus.now() + kPiece));
    player_.print_unsolicited();
  } catch (const Interrupted&) {  // meant for a command that has just ended
    if (!simulation_.go_on()) throw;
  }
  return bus.now() < due ? std::chrono::milliseconds(0) : kNap;
}

void Console::wait_anew() { terminal_->pacing = Pacing(simulation_.bus().now()); }

void Console::talk() {
  terminal_ = std::make_unique<Terminal>(simulation_.bus());
  LineEditor& editor = terminal_->editor;
  simulation_.show_progress = [this] { paint(); };
  simulation_.bear_with_keys();
  player_.before_output = [&editor] { editor.make_room(); };
  editor.while_waiting = [this] { return wait(); };
  editor.on_control = [this](char key) {
    play({'^', static_cast<char>(key + '@')});
    wait_anew();
  };
  if (!history_.empty()) editor.load_history(history_);
  std::fputs(kWelcome, stdout);
  for (auto line = editor.read(); line && play(*line); line = editor.read()) wait_anew();
}

}  // namespace

int console_command(const RunOptions& options, const std::string& history) {
  const MachineConfig config = machine_config(options);
  if (!history.empty()) need_folder("--history", history);
  if (!LineEditor::may_be_history(history))
    throw UsageError(
        fmt::format("--history {}: is no history; expected a file that brick console has written", history));
  const SetUp set_up(options);
  Simulation simulation(options, config, "console");
  set_up.check(simulation);
  Console console(simulation, history);
  std::string failure;
  try {
    simulation.run([&] {
      connect_at_start(simulation);
      set_up.send(simulation);
      if (isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1)
        console.talk();
      else
        console.listen();
    });
  } catch (const std::exception& e) { failure = e.what(); }
  if (failure.empty()) failure = console.failure();
  console.leave();
  const auto tell = [&simulation](const std::string& text) { simulation.tell("brick console: " + text); };
  return end_session(simulation, console.player(), options, config, failure, tell);
}

}  // namespace brick
