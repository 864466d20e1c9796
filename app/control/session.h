// The methods of the control channel (docs/control.md) on a running controller. Called from the simulation's thread.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "app/control/json_rpc.h"
#include "app/simulation.h"

namespace brick {

class ControlSession {
 public:
  static constexpr const char* kProtocol = "1.0";

  // `about`: what `hello` answers beside the protocol.
  ControlSession(Simulation& simulation, nlohmann::json about) : simulation_(simulation), about_(std::move(about)) {}

  // The result, with the instant at which it is there as `tick` and `ns`. Throws RpcError, and what the simulation ends
  // with.
  nlohmann::json call(RpcRequest& request);
  void heartbeat() const;  // throws RpcError where the call that is under way has passed its limit of wall time

 private:
  using Json = nlohmann::json;
  struct Method {
    const char* name;
    Json (ControlSession::*run)(RpcParams&);
    bool talks = false;  // with the controller, by its host port
  };
  static const Method kMethods[];

  Json hello(RpcParams& params);
  Json command(RpcParams& params);
  Json script(RpcParams& params);
  Json texts(RpcParams& params);
  Json run(RpcParams& params);
  Json until(RpcParams& params);
  Json signal(RpcParams& params);
  Json signals(RpcParams& params);
  Json input(RpcParams& params);
  Json trip(RpcParams& params);
  Json cut(RpcParams& params);
  Json load(RpcParams& params);
  Json wave_start(RpcParams& params);
  Json wave_stop(RpcParams& params);
  Json record_start(RpcParams& params);
  Json record_stop(RpcParams& params);
  Json check(RpcParams& params);

  Json perform(const Method& method, RpcParams& params);
  plant::Axis& axis(RpcParams& params);
  void drive(const std::string& name, std::optional<bool> level);
  void forget_dialogue();
  Json stamped(Json result) const;

  Simulation& simulation_;
  const Json about_;
  std::optional<std::chrono::steady_clock::time_point> wall_limit_;
};

}  // namespace brick
