// Requests of the control channel: whatever comes, in whatever pieces, each line is a request or one error that is a
// line of JSON itself. First byte: how the rest is cut.
#include <string>
#include <vector>

#include "app/byte_text.h"
#include "app/control/json_rpc.h"
#include "testbench/fuzz/target.h"

namespace brick {
namespace {

constexpr std::size_t kLongestMessage = 500;

std::vector<std::string> lines_of(const std::string& bytes, std::size_t step) {
  RpcLines reader;
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    reader.add(std::string_view(bytes).substr(at, step));
    while (const auto line = reader.next()) lines.push_back(*line);
    require(reader.waiting() <= RpcLines::kLongest + 1, "more is kept than a line");
  }
  return lines;
}

void check(const std::string& line, bool is_error) {
  require(line.find('\n') == line.size() - 1, "an answer of more than one line");
  const auto answer = nlohmann::json::parse(line, nullptr, false);
  require(answer.is_object() && answer.value("jsonrpc", "") == "2.0" && answer.contains("id"), "no answer");
  require(answer.contains(is_error ? "error" : "result"), "an answer without what it says");
  if (!is_error) return;
  const auto message = answer.at("error").at("message").get<std::string>();
  require(message.find("expected") != std::string::npos, "an error that says nothing");
  require(message.size() < kLongestMessage && readable_text(message) == message, "an error that acts on a terminal");
}

// As methods ask for them, whatever they are.
void ask(RpcParams& params) {
  if (params.has("line")) (void)params.text("line");
  if (params.has("ns")) {
    const std::int64_t ns = params.integer("ns", 0, 1000);
    require(ns >= 0 && ns <= 1000, "a number out of its range");
  }
  if (params.has("torque")) require(params.number("torque", -1, 1) <= 1, "a number out of its range");
  if (params.has("pins")) (void)params.texts("pins");
  params.end();
}

void read(const std::string& line) {
  RpcRequest request;
  try {
    request = read_request(line);
    ask(request.params);
    check(result_line(request.id, nlohmann::json::object()), false);
  } catch (const RpcError& e) { check(error_line(e.id, e), true); }
}

}  // namespace
}  // namespace brick

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto whole = brick::lines_of(bytes, bytes.size() + 1);
  require(brick::lines_of(bytes, 1u + data[0] % 64u) == whole, "cut, it is something else");
  for (const std::string& line : whole) brick::read(line);
  return 0;
}
