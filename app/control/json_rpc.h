// JSON-RPC 2.0 as the control channel speaks it (docs/control.md): lines out of a stream of bytes, a line to a request,
// its parameters checked by name, and the lines that answer it. Knows no socket and no machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace brick {

namespace rpc {
// Numbers of errors: the first are JSON-RPC's, the others those of docs/control.md.
constexpr int kNoJson = -32700, kNoRequest = -32600, kNoMethod = -32601, kBadParameters = -32602;
constexpr int kRefused = 1;   // the controller answered with an error, whose number is in the data
constexpr int kNoAnswer = 2;  // the controller did not answer
constexpr int kLimit = 3;     // of simulated time, before what was waited for
constexpr int kWallLimit = 4;
constexpr int kBroken = 5;  // the simulation itself failed, and ends
}  // namespace rpc

class RpcError : public std::runtime_error {
 public:
  RpcError(int code, const std::string& message, nlohmann::json data = nlohmann::json::object())
      : std::runtime_error(message), code_(code), data_(std::move(data)) {}
  int code() const { return code_; }
  const nlohmann::json& data() const { return data_; }
  nlohmann::json id;  // of the request, as far as it could be read

 private:
  int code_;
  nlohmann::json data_;
};

// Lines of a stream. What is longer than a request may be is cut, so that read_request() refuses it.
class RpcLines {
 public:
  static constexpr std::size_t kLongest = 1 << 20;

  void add(std::string_view bytes);
  std::optional<std::string> next();                    // without its LF
  std::size_t waiting() const { return line_.size(); }  // bytes of a line without an end

 private:
  std::deque<std::string> lines_;
  std::string line_;
};

// Parameters by name. Each that a method knows is asked for once; end() refuses all others.
class RpcParams {
 public:
  explicit RpcParams(const nlohmann::json& values = nlohmann::json::object()) : values_(values) {}

  bool has(const std::string& name);  // there, and not null
  std::string text(const std::string& name);
  std::string text(const std::string& name, const std::string& otherwise);
  std::int64_t integer(const std::string& name, std::int64_t low, std::int64_t high);
  double number(const std::string& name, double low, double high);
  std::vector<std::string> texts(const std::string& name);
  void end() const;

 private:
  const nlohmann::json& need(const std::string& name, const std::string& expected);
  nlohmann::json values_;
  std::set<std::string> known_;
};

struct RpcRequest {
  nlohmann::json id;          // text, number or null
  bool wants_answer = false;  // false: a notification
  std::string method;
  RpcParams params;
};

RpcRequest read_request(const std::string& line);  // throws RpcError
std::string result_line(const nlohmann::json& id, const nlohmann::json& result);
std::string error_line(const nlohmann::json& id, const RpcError& error);

}  // namespace brick
