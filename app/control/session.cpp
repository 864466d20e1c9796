#include "app/control/session.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/hand_encoder.h"
#include "app/plant_file.h"
#include "app/refused_lines.h"
#include "app/script_player.h"
#include "app/signal_watch.h"
#include "systemc/core/usage_error.h"

namespace brick {

using nlohmann::json;

namespace {

constexpr std::int64_t kLongestRun = std::int64_t{3600} * 1'000'000'000;  // ns of one call
constexpr double kLongestWait = 1e6;                                      // s of the wall
constexpr std::size_t kLongestLine = 1000;                                // the controller refuses shorter ones already
constexpr double kLargestLoad = 1e6;                                      // N m
constexpr unsigned kMostMotors = 80;

json texts_of(const std::vector<std::string>& lines) {
  json list = json::array();
  for (const auto& line : lines) list.push_back(utf8_text(line));
  return list;
}

// The controller takes bytes of seven bits; CR would be a second line.
void check_line(const std::string& line) {
  const bool plain = std::all_of(line.begin(), line.end(),
                                 [](unsigned char c) { return c < 0x80 && c != '\r' && c != '\n' && c != 0; });
  if (!plain || line.size() > kLongestLine)
    throw RpcError(
        rpc::kBadParameters,
        fmt::format("parameter line: expected one line of ASCII, up to {} characters, without CR", kLongestLine));
}

// Of ^X in the line (I63): a byte without an end of a line, which stands in front of what is answered then.
void drop_echo(std::vector<std::string>& lines) {
  if (lines.empty() || lines.front().find('\x18') != 0) return;
  lines.front().erase(0, lines.front().find_first_not_of('\x18'));
  if (lines.front().empty()) lines.erase(lines.begin());
}

unsigned error_number(const std::string& text) {
  const std::string digits = text.rfind("ERR", 0) == 0 ? text.substr(3) : "";
  return digits.empty() ? 0 : static_cast<unsigned>(std::strtoul(digits.c_str(), nullptr, 10));
}

}  // namespace

const ControlSession::Method ControlSession::kMethods[] = {
    {"hello", &ControlSession::hello},
    {"command", &ControlSession::command, true},
    {"script", &ControlSession::script, true},
    {"texts", &ControlSession::texts, true},
    {"run", &ControlSession::run},
    {"until", &ControlSession::until},
    {"signal", &ControlSession::signal},
    {"signals", &ControlSession::signals},
    {"input", &ControlSession::input},
    {"plant.trip", &ControlSession::trip},
    {"plant.cut", &ControlSession::cut},
    {"plant.load", &ControlSession::load},
    {"wave.start", &ControlSession::wave_start},
    {"wave.stop", &ControlSession::wave_stop},
    {"record.start", &ControlSession::record_start},
    {"record.stop", &ControlSession::record_stop},
    {"check", &ControlSession::check},
};

json ControlSession::stamped(json result) const {
  result["tick"] = simulation_.machine().now();
  result["ns"] = fs_to_ns(simulation_.machine().now_fs());
  return result;
}

void ControlSession::heartbeat() const {
  if (wall_limit_ && std::chrono::steady_clock::now() > *wall_limit_)
    throw RpcError(rpc::kWallLimit, "the limit of wall time has passed");
}

json ControlSession::call(RpcRequest& request) {
  const auto* method =
      std::find_if(std::begin(kMethods), std::end(kMethods), [&](const Method& m) { return request.method == m.name; });
  if (method == std::end(kMethods))
    throw RpcError(rpc::kNoMethod,
                   fmt::format("no method {}; expected one of docs/control.md", beginning_of(request.method)));
  if (request.params.has("wall_s")) {
    const std::chrono::duration<double> wall(request.params.number("wall_s", 0, kLongestWait));
    wall_limit_ = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(wall);
  }
  try {
    json result = stamped(perform(*method, request.params));
    wall_limit_.reset();
    return result;
  } catch (const RpcError& e) {
    wall_limit_.reset();
    if (e.code() == rpc::kWallLimit && method->talks) forget_dialogue();
    throw RpcError(e.code(), e.what(), stamped(e.data()));
  }
}

json ControlSession::perform(const Method& method, RpcParams& params) {
  try {
    return (this->*method.run)(params);
  } catch (const UsageError& e) {
    throw RpcError(rpc::kBadParameters, utf8_text(e.what()));
  } catch (const ScriptFailure& e) { throw RpcError(rpc::kNoAnswer, utf8_text(e.what())); }
}

// Half a line may stand in the controller, and half an answer here: ^X drops both, and types nothing into a buffer. The
// framing is asked for anew. What does not answer even now will say so in the next call.
void ControlSession::forget_dialogue() {
  constexpr std::uint8_t kControlX = 0x18;
  (void)simulation_.link().control(kControlX);
  (void)simulation_.link().take_unsolicited();
}

json ControlSession::hello(RpcParams& params) {
  const std::string wanted = params.text("protocol");
  params.end();
  const std::string own = kProtocol, major = own.substr(0, own.find('.'));
  if (wanted.substr(0, wanted.find('.')) != major)
    throw RpcError(rpc::kBadParameters,
                   fmt::format("protocol {} is not spoken here; expected {}.x", beginning_of(wanted), major));
  json result = about_;
  result["protocol"] = own;
  return result;
}

json ControlSession::command(RpcParams& params) {
  const std::string line = params.text("line");
  params.end();
  check_line(line);
  HostLink& link = simulation_.link();
  Reply reply =
      line.size() == 1 && line[0] < ' ' ? link.control(static_cast<std::uint8_t>(line[0])) : link.command(line);
  drop_echo(reply.lines);
  json result{{"lines", texts_of(reply.lines)}, {"texts", texts_of(link.take_unsolicited())}};
  if (reply.error) {
    const std::string last = reply.lines.empty() ? "ERR" : reply.lines.back();
    result["number"] = error_number(last);
    result["line"] = line;
    throw RpcError(rpc::kRefused, fmt::format("{}: {}: {}", beginning_of(line), utf8_text(last), error_meaning(last)),
                   result);
  }
  if (!reply.doubt.empty()) throw RpcError(rpc::kNoAnswer, reply.doubt, result);
  if (!reply.complete)
    throw RpcError(rpc::kNoAnswer,
                   fmt::format("{}: no answer{}; expected an acknowledge or an error", beginning_of(line),
                               simulation_.bus().tripped() ? ": the watchdog has tripped, the CPU stands at " +
                                                                 simulation_.machine().cpu_place()
                                                           : ""),
                   result);
  return result;
}

// Lines of a host script, @ lines too. A refused line is an answer here. Names of files are the client's, whose folder
// may be another.
json ControlSession::script(RpcParams& params) {
  std::istringstream in(params.text("text"));
  const std::string folder = params.text("folder", "");
  params.end();
  const auto lines = read_script(in, folder.empty() ? "script" : folder + "/script");
  std::ostringstream out;
  ScriptPlayer player(simulation_.link(), out, false);
  player.check(lines);
  const auto played = [&] {
    std::vector<std::string> printed;
    std::istringstream text(out.str());
    for (std::string line; std::getline(text, line);) printed.push_back(line);
    return json{{"lines", texts_of(printed)}, {"refused", player.refused().count()}};
  };
  try {
    player.play(lines);
  } catch (const ScriptFailure& e) { throw RpcError(rpc::kNoAnswer, utf8_text(e.what()), played()); }
  return played();
}

json ControlSession::texts(RpcParams& params) {
  params.end();
  simulation_.link().poll();
  return {{"texts", texts_of(simulation_.link().take_unsolicited())}};
}

json ControlSession::run(RpcParams& params) {
  const std::int64_t ns = params.integer("ns", 0, kLongestRun);
  params.end();
  simulation_.bus().wait(ns_to_ticks(static_cast<std::uint64_t>(ns)));
  return json::object();
}

json ControlSession::until(RpcParams& params) {
  const std::string name = params.text("name"), wanted = params.text("value");
  const std::int64_t ns = params.integer("ns", 0, kLongestRun);
  params.end();
  const Signals& signals = simulation_.machine().signals();
  const auto id = find_signal(signals, name);
  const std::string value = signal_value_text(signals, id, wanted);
  if (!wait_signal(simulation_.bus(), id, value, ns_to_ticks(static_cast<std::uint64_t>(ns))))
    throw RpcError(rpc::kLimit, fmt::format("still {}={} at the limit; expected {}", signals.info(id).name,
                                            signal_text(signals, id), value));
  return {{"value", signal_text(signals, id)}};
}

json ControlSession::signal(RpcParams& params) {
  const std::string name = params.text("name");
  params.end();
  const Signals& signals = simulation_.machine().signals();
  const auto id = find_signal(signals, name);
  return {{"name", signals.info(id).name}, {"value", utf8_text(signal_text(signals, id))}};
}

json ControlSession::signals(RpcParams& params) {
  const std::string pattern = params.text("pattern", "all");
  params.end();
  const TraceGroups groups({pattern});
  const Signals& signals = simulation_.machine().signals();
  json names = json::array();
  for (Signals::Id id = 0; id < signals.size(); ++id)
    if (groups.select(signals.info(id).name)) names.push_back(signals.info(id).name);
  return {{"names", names}};
}

json ControlSession::input(RpcParams& params) {
  const std::string name = params.text("name");
  std::optional<bool> level;
  if (params.has("level")) level = params.integer("level", 0, 1) == 1;
  params.end();
  drive(name, level);
  return json::object();
}

// A pin that the plant drives is held against it; without a level the plant has it back, and a free pin idles.
void ControlSession::drive(const std::string& name, std::optional<bool> level) {
  Machine& machine = simulation_.machine();
  if (const auto connector = find_connector_pin(machine.signals(), name)) {
    machine.inputs().** connector = level.value_or(HostInputs().**connector);
    return machine.apply();
  }
  const ChannelPinPlace place = find_channel_pin(machine.signals(), name);
  const auto bit = static_cast<std::uint16_t>(1u << place.pin);
  const auto with = [bit](std::uint16_t pins, bool on) {
    return static_cast<std::uint16_t>(on ? pins | bit : pins & ~bit);
  };
  if ((machine.driven_motor_inputs(place.ic, place.channel) & bit) == 0) {
    std::uint16_t& pins = machine.motor_inputs()[place.ic].pins[place.channel];
    pins = with(pins, level.value_or((machine.idle_channel_pins() & bit) != 0));
    return machine.apply_motor_inputs();
  }
  plant::Plant& plant = *simulation_.plant();
  for (std::size_t i = 0; i < plant.axes(); ++i) {
    plant::Axis& axis = plant.axis(i);
    if (axis.ic() == place.ic && axis.channel() == place.channel)
      axis.hold(with(axis.held(), level.has_value()), with(axis.held_levels(), level.value_or(false)));
  }
}

plant::Axis& ControlSession::axis(RpcParams& params) {
  const auto motor = static_cast<unsigned>(params.integer("motor", 1, kMostMotors));
  const auto place = motor_place(simulation_.machine().fitted(), motor);
  plant::Plant* plant = simulation_.plant();
  for (std::size_t i = 0; plant != nullptr && place && i < plant->axes(); ++i)
    if (plant->axis(i).ic() == place->ic && plant->axis(i).channel() == place->channel) return plant->axis(i);
  throw UsageError(fmt::format("parameter motor: no axis of a plant at motor {}; expected one, see --plant", motor));
}

json ControlSession::trip(RpcParams& params) {
  const std::string cause = params.text("cause");
  plant::Axis& one = axis(params);
  params.end();
  one.trip(amplifier_fault(cause));
  return json::object();
}

json ControlSession::cut(RpcParams& params) {
  const std::uint16_t pins = channel_pins(params.texts("pins"));
  plant::Axis& one = axis(params);
  params.end();
  one.cut(pins);
  return json::object();
}

json ControlSession::load(RpcParams& params) {
  const double torque = params.number("torque", -kLargestLoad, kLargestLoad);
  plant::Axis& one = axis(params);
  params.end();
  one.set_load(torque);
  return json::object();
}

json ControlSession::wave_start(RpcParams& params) {
  RunOptions options;
  options.wave = params.text("file");
  if (params.has("trace")) options.trace = {params.text("trace")};
  params.end();
  simulation_.open_wave(options.wave, wave_window(options), trace_groups(options));
  return json::object();
}

json ControlSession::wave_stop(RpcParams& params) {
  params.end();
  simulation_.close_wave();
  return json::object();
}

json ControlSession::record_start(RpcParams& params) {
  const std::string file = params.text("file"), of = params.text("of", "");
  params.end();
  Recorder::check_name(file);
  simulation_.open_record(file, of);
  return json::object();
}

json ControlSession::record_stop(RpcParams& params) {
  params.end();
  simulation_.close_record();
  return json::object();
}

// What no sound run does, so far: the same would fail `brick exec` at its end.
json ControlSession::check(RpcParams& params) {
  params.end();
  std::vector<std::string> failures = simulation_.machine().run_errors();
  for (const std::string& failure : simulation_.timing_verdict().failures) failures.push_back(failure);
  return {{"failures", texts_of(failures)}};
}

}  // namespace brick
