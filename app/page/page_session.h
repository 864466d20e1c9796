// One connection of the page: a request of HTTP, answered and closed, or upgraded to a websocket. Lives on the
// server's thread; includes Boost.Asio and so stands with page_server.cpp alone.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "app/page/page_message.h"
#include "app/page/page_rules.h"

namespace brick {

// What all connections have in common.
struct PageSite {
  const PageRules& rules;
  std::string html, policy;  // the page, and its Content-Security-Policy
  std::string about;         // first message on a websocket
  bool read_only;
  std::size_t most_commands;
};

class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(boost::asio::ip::tcp::socket socket, const PageSite& site);

  std::function<bool()> on_open;  // it is a websocket now; false: one too many
  std::function<void()> on_close;
  std::function<void(const PageCommand&)> on_command;
  std::function<void(const PageWatch&)> on_watch;

  void start();
  void close();
  void state(std::shared_ptr<const std::string> newest);
  void answer(std::string text);  // to a command

 private:
  using Error = boost::beast::error_code;
  void requested(Error error);
  void refuse(unsigned status, const std::string& why);
  void respond(unsigned status, const std::string& type, std::string body);
  void upgrade();
  void read();
  void take_message();
  void say(std::string text);
  void write();

  const PageSite& site_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
  std::deque<std::string> texts_;                    // to be sent, in order
  std::shared_ptr<const std::string> state_, sent_;  // the newest that is not sent yet; the one under way
  std::string sending_;
  std::size_t commands_ = 0;                                                // not answered yet
  bool open_ = false, reading_ = false, writing_ = false, closed_ = false;  // open: as a websocket
};

}  // namespace brick
