#include "app/control/command.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/build_info.h"
#include "app/byte_text.h"
#include "app/control/channel.h"
#include "app/control/session.h"
#include "app/pacing.h"
#include "app/session_end.h"
#include "app/set_up.h"

namespace brick {

namespace {

constexpr std::chrono::milliseconds kNap{50}, kShortNap{5};  // between two looks at the signals, at the wall's clock
constexpr Tick kPiece = ns_to_ticks(500'000);

nlohmann::json about(const RunOptions& options, const MachineConfig& config) {
  nlohmann::json about = build_info();
  about["image"] = file_hash(config.firmware);
  about["board"] = config.board.name;
  about["engine"] = options.engine;
  about["plant"] = options.plant;
  about["seed"] = config.seed;
  return about;
}

// Answers requests in their order until the client has gone or the simulation has failed.
class ControlServer {
 public:
  ControlServer(Simulation& simulation, ControlChannel& channel, ControlSession& session, bool realtime)
      : simulation_(simulation), channel_(channel), session_(session), realtime_(realtime) {}

  void serve() {
    simulation_.show_progress = [this] { heartbeat(); };
    channel_.accept([this] { return idle(); });
    for (;;) {
      const std::string line = channel_.read([this] { return idle(); });
      const std::string answered = answer(line);
      if (!answered.empty()) channel_.write(answered, [this] { return idle(); });
      if (!broken_.empty()) throw std::runtime_error(broken_);
    }
  }

 private:
  std::string answer(const std::string& line) {
    RpcRequest request;
    try {
      request = read_request(line);
    } catch (const RpcError& e) { return error_line(e.id, e); }
    const auto wanted = [&request](std::string text) { return request.wants_answer ? std::move(text) : ""; };
    try {
      busy_ = true;
      const nlohmann::json result = session_.call(request);
      busy_ = false;
      return wanted(result_line(request.id, result));
    } catch (const RpcError& e) {
      busy_ = false;
      return wanted(error_line(request.id, e));
    } catch (const Interrupted&) { throw; } catch (const ChannelClosed&) {
      throw;
    } catch (const std::exception& e) {  // the engines differ, a bus hangs: nothing after it can be believed
      busy_ = false;
      broken_ = utf8_text(e.what());
      return error_line(request.id, RpcError(rpc::kBroken, broken_));
    }
  }

  // Often, while time passes.
  void heartbeat() {
    const auto now = std::chrono::steady_clock::now();
    if (!busy_ || now - looked_ < kShortNap) return;
    looked_ = now;
    if (channel_.closed()) throw ChannelClosed("the client has gone in the middle of a call");
    session_.heartbeat();
  }

  // Between calls.
  std::chrono::milliseconds idle() {
    HostBus& bus = simulation_.bus();
    bus.heartbeat();
    if (!realtime_) return kNap;
    const Tick due = pacing_.due(bus.now());
    if (bus.now() >= due) return kShortNap;
    bus.advance_to(std::min(due, bus.now() + kPiece));
    return std::chrono::milliseconds(bus.now() < due ? 0 : kShortNap.count());
  }

  Simulation& simulation_;
  ControlChannel& channel_;
  ControlSession& session_;
  const bool realtime_;
  Pacing pacing_{simulation_.bus().now()};
  std::chrono::steady_clock::time_point looked_{};
  bool busy_ = false;
  std::string broken_;
};

}  // namespace

int control_command(const ControlOptions& options) {
  // A controller that stands in a debugger would not see that its client has gone; results are the client's.
  for (const auto& [option, value] : {std::pair{"--gdb", options.run.gdb}, {"--json", options.run.json}})
    if (!value.empty()) throw UsageError(fmt::format("{}: not with brick control; expected brick exec for it", option));
  const MachineConfig config = machine_config(options.run);
  const SetUp set_up(options.run);
  ControlChannel channel(options.place);
  Simulation simulation(options.run, config, "control");
  simulation.end_with(options.end_with);
  set_up.check(simulation);
  ControlSession session(simulation, about(options.run, config));
  std::string failure;
  try {
    simulation.run([&] {
      connect_at_start(simulation);
      set_up.send(simulation);
      try {
        ControlServer(simulation, channel, session, options.realtime).serve();
      } catch (const ChannelClosed&) {}  // as it should
    });
  } catch (const std::exception& e) { failure = e.what(); }
  std::vector<std::string> failures;
  if (!failure.empty()) failures.push_back(failure);
  const Simulation::TimingVerdict timing = simulation.timing_verdict();
  for (const auto& list : {simulation.machine().take_run_errors(), timing.failures})
    failures.insert(failures.end(), list.begin(), list.end());
  for (const auto* list : {&std::as_const(failures), &timing.waived, &timing.unused})
    for (const std::string& text : *list) simulation.tell("brick control: " + text);
  return failures.empty() ? 0 : 1;
}

}  // namespace brick
