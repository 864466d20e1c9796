#include "app/page/page_rules.h"

#include <arpa/inet.h>
#include <sys/random.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace brick {

namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr const char* kTokenField = "token=";

bool is_address(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> ignored{};
  return inet_pton(AF_INET, host.c_str(), ignored.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), ignored.data()) == 1;
}

bool is_loopback(const std::string& address) { return address == "::1" || address.compare(0, 4, "127.") == 0; }
bool is_any(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

std::string bracketed(const std::string& host) { return host.find(':') == std::string::npos ? host : '[' + host + ']'; }

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system's random source gives nothing; expected 16 bytes");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

PageRules::PageRules(const std::string& host, const std::string& address, unsigned port, std::string token)
    : names_{lower(host), address},
      port_(std::to_string(port)),
      token_(std::move(token)),
      beyond_loopback_(!is_loopback(address)) {
  if (!beyond_loopback_ || is_any(address)) names_.insert(names_.end(), {"localhost", "127.0.0.1", "::1"});
}

std::string PageRules::address() const {
  const std::string& host = is_any(names_[1]) ? names_[3] : names_[0];
  return fmt::format("http://{}:{}{}?{}{}", bracketed(host), port_, kPath, kTokenField, token_);
}

// A name that a stranger has made point here is none of ours; an address is what it is, so where all are listened at
// any will do.
bool PageRules::is_ours(const std::string& field) const {
  const std::size_t colon = field.rfind(':');
  if (colon == std::string::npos || field.substr(colon + 1) != port_) return port_ == "80" && is_ours(field + ":80");
  std::string host = lower(field.substr(0, colon));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (std::find(names_.begin(), names_.end(), host) != names_.end()) return true;
  return is_any(names_[1]) && is_address(host);
}

// All of it is compared, so that the time does not tell how much was right.
bool PageRules::has_token(const std::string& query) const {
  const std::string wanted = kTokenField + token_;
  unsigned difference = query.size() == wanted.size() ? 0 : 1;
  for (std::size_t i = 0; i < query.size() && i < wanted.size(); ++i)
    difference |= static_cast<unsigned>(query[i] ^ wanted[i]);
  return difference == 0;
}

PageVerdict PageRules::judge(const PageRequest& request) const {
  if (request.hosts.size() != 1 || !is_ours(request.hosts[0]))
    return {403, "Host is not this server; expected the address that brick serve has printed"};
  if (request.origins.size() > 1 || (request.upgrade && request.origins.empty()))
    return {403, "Origin is missing or there are several; expected one"};
  if (!request.origins.empty() && lower(request.origins[0]) != "http://" + lower(request.hosts[0]))
    return {403, "Origin is another site; expected the page itself"};
  if (request.method != "GET") return {405, "expected GET"};
  const std::size_t mark = request.target.find('?');
  const std::string path = request.target.substr(0, mark);
  if (!has_token(mark == std::string::npos ? "" : request.target.substr(mark + 1)))
    return {403, "the token is missing or wrong; expected the address that brick serve has printed, all of it"};
  if (path != (request.upgrade ? kSocketPath : kPath)) return {404, "there is nothing here; expected /"};
  return {};
}

}  // namespace brick
