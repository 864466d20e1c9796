// The page's sockets under the sanitizers: strangers, noise, frames of any bytes, clients that go at any moment and a
// server that ends while all of that is under way. What the page shows is tested with the command (page_command.py).
#include "app/page/page_server.h"

#include <gtest/gtest.h>

#include <asio.hpp>

#include <atomic>
#include <random>
#include <string>
#include <vector>

namespace brick {
namespace {

using asio::ip::tcp;

class PageServerTest : public ::testing::Test {
 protected:
  PageServerTest() {
    server_.on_open = [this](PageServer::Client) { ++opened_; };
    server_.on_close = [this](PageServer::Client) { ++closed_; };
    server_.on_watch = [](PageServer::Client, const PageWatch&) {};
    server_.on_command = [this](PageServer::Client client, const PageCommand& command) {
      server_.answer(client, R"({"kind":"answer","line":")" + command.line + "\"}");
    };
    server_.start();
    const std::string address = server_.address();  // http://127.0.0.1:PORT/?token=...
    host_ = address.substr(7, address.find('/', 7) - 7);
    token_ = address.substr(address.find("token="));
    to_ = tcp::endpoint(asio::ip::address_v4::loopback(),
                        static_cast<std::uint16_t>(std::stoul(host_.substr(host_.find(':') + 1))));
  }
  ~PageServerTest() override { server_.stop(); }

  tcp::socket connect() {
    tcp::socket socket(io_);
    socket.connect(to_);
    return socket;
  }
  // What is sent may find the connection closed.
  static void send(tcp::socket& socket, const std::string& bytes) {
    asio::error_code ignored;
    asio::write(socket, asio::buffer(bytes), ignored);
  }
  static std::string until(tcp::socket& socket, const std::string& end) {
    std::string text;
    asio::error_code error;
    asio::read_until(socket, asio::dynamic_buffer(text), end, error);
    return text;
  }
  std::string request(const std::string& token, const std::string& more = "") const {
    return "GET /" + std::string(more.empty() ? "" : "socket") + "?" + token + " HTTP/1.1\r\nHost: " + host_ + "\r\n" +
           more + "\r\n";
  }
  std::string upgrade() const {
    return request(token_, "Origin: http://" + host_ +
                               "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                               "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n");
  }
  tcp::socket open() {
    tcp::socket page = connect();
    send(page, upgrade());
    EXPECT_NE(until(page, "about").find(R"({"kind":"about)"), std::string::npos);
    return page;
  }
  std::string answer_to(const std::string& bytes) {
    tcp::socket socket = connect();
    send(socket, bytes);
    return until(socket, "\r\n").substr(0, 12);
  }
  // Of less than 126 bytes, masked with zeros.
  static std::string frame(const std::string& text) {
    return "\x81" + std::string(1, static_cast<char>(0x80 | text.size())) + std::string(4, '\0') + text;
  }
  void expect_that_it_serves() {
    EXPECT_EQ(answer_to(request(token_)), "HTTP/1.1 200");
    tcp::socket page = open();
    send(page, frame(R"({"kind":"command","id":1,"line":"ver"})"));
    EXPECT_NE(until(page, R"("line":"ver")").find(R"("line":"ver")"), std::string::npos);
  }

  std::mt19937 chance_{1};
  std::atomic<unsigned> opened_{0}, closed_{0};
  PageServer server_{{"127.0.0.1:0", false, R"({"kind":"about"})"}};
  asio::io_context io_;
  tcp::endpoint to_;
  std::string host_, token_;
};

TEST_F(PageServerTest, ServesWhoeverHasTheTokenAlone) {
  expect_that_it_serves();
  EXPECT_EQ(answer_to(request("token=0")), "HTTP/1.1 403");
}

TEST_F(PageServerTest, NoiseAndHalfRequestsEndNothing) {
  const std::string whole = upgrade();
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole.substr(0, chance_() % whole.size());
    for (unsigned change = chance_() % 4; change > 0 && !bytes.empty(); --change)
      bytes[chance_() % bytes.size()] = static_cast<char>(chance_());
    tcp::socket socket = connect();
    send(socket, bytes + (chance_() % 2 != 0 ? "\r\n\r\n" : ""));
  }
  expect_that_it_serves();
}

TEST_F(PageServerTest, FramesOfAnyBytesEndTheirOwnConnectionAtMost) {
  for (int i = 0; i < 200; ++i) {
    tcp::socket socket = open();
    std::string bytes = chance_() % 2 != 0 ? frame(R"({"kind":"watch","items":["X:$0"]})") : "";
    for (unsigned count = chance_() % 300; count > 0; --count) bytes.push_back(static_cast<char>(chance_()));
    send(socket, bytes);
    server_.publish(std::string(10'000, '7'));
  }
  expect_that_it_serves();
}

TEST_F(PageServerTest, WhoGoesIsForgottenAndMakesRoom) {
  for (int round = 0; round < 3; ++round) {
    std::vector<tcp::socket> pages;
    for (std::size_t i = 0; i < PageServer::kMostViewers; ++i) { pages.push_back(open()); }
    EXPECT_EQ(answer_to(upgrade()), "HTTP/1.1 503");
    server_.publish("{}");
    pages.clear();
    while (server_.viewers() != 0) std::this_thread::yield();
  }
  EXPECT_EQ(opened_, 3 * PageServer::kMostViewers);
  EXPECT_EQ(closed_, 3 * PageServer::kMostViewers);
}

TEST_F(PageServerTest, EndsWhileItIsBusy) {
  std::vector<tcp::socket> pages;
  for (int i = 0; i < 8; ++i) {
    pages.push_back(open());
    for (unsigned id = 0; id < 20; ++id)
      send(pages.back(), frame(R"({"kind":"command","id":)" + std::to_string(id) + R"(,"line":"P1"})"));
    server_.publish(std::string(1'000'000, '7'));
    pages.push_back(connect());
    send(pages.back(), upgrade().substr(0, 100));
  }
  server_.stop();
}

}  // namespace
}  // namespace brick
