#include "app/control/json_rpc.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/byte_text.h"

namespace brick {

using nlohmann::json;

void RpcLines::add(std::string_view bytes) {
  for (;;) {
    const std::size_t end = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, end);
    line_ += piece.substr(0, kLongest + 1 - line_.size());
    if (end == std::string_view::npos) return;
    lines_.push_back(std::exchange(line_, ""));
    bytes.remove_prefix(end + 1);
  }
}

std::optional<std::string> RpcLines::next() {
  if (lines_.empty()) return std::nullopt;
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

namespace {
constexpr int kDeepest = 8;

[[noreturn]] void wrong(const std::string& name, const std::string& expected) {
  throw RpcError(rpc::kBadParameters, fmt::format("parameter {}: expected {}", beginning_of(name), expected));
}
}  // namespace

bool RpcParams::has(const std::string& name) {
  known_.insert(name);
  const auto found = values_.find(name);
  return found != values_.end() && !found->is_null();
}

const json& RpcParams::need(const std::string& name, const std::string& expected) {
  if (!has(name)) wrong(name, expected);
  return values_.at(name);
}

std::string RpcParams::text(const std::string& name) {
  const json& value = need(name, "a text");
  if (!value.is_string()) wrong(name, "a text");
  auto text = value.get<std::string>();
  if (text.find('\0') != std::string::npos) wrong(name, "a text without NUL");
  return text;
}

std::string RpcParams::text(const std::string& name, const std::string& otherwise) {
  return has(name) ? text(name) : otherwise;
}

std::int64_t RpcParams::integer(const std::string& name, std::int64_t low, std::int64_t high) {
  const std::string expected = fmt::format("an integer, {} to {}", low, high);
  const json& value = need(name, expected);
  const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <= INT64_MAX : value.is_number_integer();
  if (!fits || value.get<std::int64_t>() < low || value.get<std::int64_t>() > high) wrong(name, expected);
  return value.get<std::int64_t>();
}

double RpcParams::number(const std::string& name, double low, double high) {
  const std::string expected = fmt::format("a number, {:g} to {:g}", low, high);
  const json& value = need(name, expected);
  if (!value.is_number()) wrong(name, expected);
  const auto number = value.get<double>();
  if (!(number >= low && number <= high)) wrong(name, expected);
  return number;
}

std::vector<std::string> RpcParams::texts(const std::string& name) {
  const json& value = need(name, "a list of texts");
  if (!value.is_array()) wrong(name, "a list of texts");
  std::vector<std::string> texts;
  for (const json& one : value) {
    if (!one.is_string()) wrong(name, "a list of texts");
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

void RpcParams::end() const {
  for (const auto& item : values_.items())
    if (known_.count(item.key()) == 0)
      throw RpcError(rpc::kBadParameters, fmt::format("parameter {} is not known; expected those of docs/control.md",
                                                      beginning_of(item.key())));
}

RpcRequest read_request(const std::string& line) {
  if (line.size() > RpcLines::kLongest)
    throw RpcError(rpc::kNoRequest,
                   fmt::format("a line of more than {} bytes; expected a shorter one", RpcLines::kLongest));
  bool too_deep = false;  // a value is copied and destroyed by functions that call themselves
  const json value = json::parse(
      line,
      [&too_deep](int depth, json::parse_event_t, const json&) {
        too_deep = too_deep || depth > kDeepest;
        return !too_deep;
      },
      false);
  if (too_deep)
    throw RpcError(rpc::kNoRequest, fmt::format("a value within more than {} others; expected a request", kDeepest));
  if (value.is_discarded())
    throw RpcError(rpc::kNoJson, fmt::format("{} is no JSON; expected an object in one line", beginning_of(line)));
  RpcError wrong(rpc::kNoRequest,
                 "no request; expected {\"jsonrpc\": \"2.0\", \"id\": ..., \"method\": ..., \"params\": {...}}");
  if (!value.is_object()) throw wrong;
  RpcRequest request;
  if (const auto id = value.find("id"); id != value.end()) {
    if (!id->is_string() && !id->is_number() && !id->is_null()) throw wrong;
    request.wants_answer = true;
    wrong.id = request.id = *id;
  }
  const auto version = value.find("jsonrpc"), method = value.find("method"), params = value.find("params");
  if (version == value.end() || *version != "2.0" || method == value.end() || !method->is_string()) throw wrong;
  request.method = method->get<std::string>();
  if (params == value.end()) return request;
  if (!params->is_object()) {
    RpcError by_name(rpc::kBadParameters, "params are no object; expected parameters by name");
    by_name.id = request.id;
    throw by_name;
  }
  request.params = RpcParams(*params);
  return request;
}

namespace {
std::string as_line(const json& answer) { return answer.dump(-1, ' ', true, json::error_handler_t::replace) + '\n'; }
}  // namespace

std::string result_line(const json& id, const json& result) {
  return as_line({{"jsonrpc", "2.0"}, {"id", id}, {"result", result}});
}

std::string error_line(const json& id, const RpcError& error) {
  const json body{{"code", error.code()}, {"message", error.what()}, {"data", error.data()}};
  return as_line({{"jsonrpc", "2.0"}, {"id", id}, {"error", body}});
}

}  // namespace brick
