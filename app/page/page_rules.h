// Who may have the page: a web site in the user's browser, or a stranger on the network, must not press J+. Every
// request names this server as its host, comes from no other site, and carries the token that only the printed address
// has (docs/page.md).
#pragma once

#include <string>
#include <vector>

namespace brick {

struct PageRequest {
  std::string method, target;
  std::vector<std::string> hosts, origins;  // of these header fields, all there are
  bool upgrade = false;                     // to a websocket
};

struct PageVerdict {
  unsigned status = 200;  // of HTTP
  std::string why;        // for whoever reads it, "" where it is granted
};

std::string random_token();  // 128 bits of the system's random source, in hexadecimal

class PageRules {
 public:
  static constexpr const char* kPath = "/";
  static constexpr const char* kSocketPath = "/socket";

  // `host`: what the user has called this machine; `address`: what that is; both without brackets.
  PageRules(const std::string& host, const std::string& address, unsigned port, std::string token);

  PageVerdict judge(const PageRequest& request) const;
  bool beyond_loopback() const { return beyond_loopback_; }
  std::string address() const;  // to be opened, with the token

 private:
  bool is_ours(const std::string& host) const;
  bool has_token(const std::string& query) const;

  std::vector<std::string> names_;
  std::string port_, token_;
  bool beyond_loopback_ = false;
};

}  // namespace brick
