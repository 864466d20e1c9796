// TCP clients of the Ethernet port: who is answered what, how much of one may wait, and how a connection ends
// (ethernet:1/5, ethernet:1/8, ethernet:1/9, ethernet:2/5).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include <asio.hpp>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/ethernet_server.h"
#include "systemc/core/usage_error.h"
#include "testbench/unit/app/receive_some.h"

namespace brick {
namespace {

using namespace std::chrono_literals;
using asio::ip::tcp;

class EthernetClients : public ::testing::Test {
 protected:
  using Id = EthernetServer::Client;
  struct Asked {
    Id client;
    std::uint16_t value;
  };

  EthernetClients() {
    server_->on_request = [this](Id client, const EthernetPacket& packet) {
      note([&] { asked_.push_back({client, packet.value}); });
      if (!answer_.empty()) server_->reply(client, answer_);
    };
    server_->on_close = [this](Id client) { note([&] { closed_.push_back(client); }); };
    server_->on_trouble = [this](const std::string& text) { note([&] { troubles_.push_back(text); }); };
    server_->start();
    const std::string place = server_->place();
    port_ = static_cast<std::uint16_t>(std::stoul(place.substr(place.rfind(':') + 1)));
  }

  template <class What>
  void note(const What& what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    what();
    heard_.notify_all();
  }
  // In time: at once if all is well.
  bool comes(const std::function<bool()>& what, std::chrono::milliseconds longest = 20s) {
    std::unique_lock<std::mutex> lock(mutex_);
    return heard_.wait_for(lock, longest, what);
  }
  bool are_asked(std::size_t count) {
    return comes([&] { return asked_.size() >= count; });
  }
  std::size_t asked_within(std::chrono::milliseconds time, std::size_t count) {
    comes([&] { return asked_.size() > count; }, time);
    const std::lock_guard<std::mutex> lock(mutex_);
    return asked_.size();
  }

  tcp::socket client() {
    tcp::socket socket(io_);
    socket.connect({asio::ip::address_v4::loopback(), port_});
    return socket;
  }
  // READREADY, with a number of ours in wValue, which nobody looks at.
  static std::string request(unsigned number, unsigned code = 0xC2) {
    return {'\xC0', static_cast<char>(code), static_cast<char>(number >> 8), static_cast<char>(number), 0, 0, 0, 2};
  }
  static void send(tcp::socket& socket, const std::string& bytes) { asio::write(socket, asio::buffer(bytes)); }
  static std::string receive(tcp::socket& socket, std::size_t count) {
    std::string bytes(count, '\0');
    std::size_t at = 0;
    for (ssize_t more = 1; at < count && more > 0; at += more > 0 ? static_cast<std::size_t>(more) : 0)
      more = receive_some(socket, &bytes[at], count - at);
    bytes.resize(at);
    return bytes;
  }
  static bool is_closed(tcp::socket& socket) {
    char byte;
    const ssize_t more = receive_some(socket, &byte, 1);
    return more == 0 || (more < 0 && errno == ECONNRESET);
  }

  std::mutex mutex_;
  std::condition_variable heard_;
  std::vector<Asked> asked_;
  std::vector<Id> closed_;
  std::vector<std::string> troubles_;
  std::string answer_;  // of each request, at once; else they wait
  std::unique_ptr<EthernetServer> server_ = std::make_unique<EthernetServer>("127.0.0.1:0");
  std::uint16_t port_ = 0;
  asio::io_context io_;
};

TEST_F(EthernetClients, RepliesGoToWhoeverHasAskedInTheirOrder) {
  EXPECT_EQ(server_->clients(), 0u);
  tcp::socket one = client(), two = client();
  send(one, request(1) + request(2));
  ASSERT_TRUE(are_asked(2));
  send(two, request(3));
  ASSERT_TRUE(are_asked(3));
  EXPECT_EQ(server_->clients(), 2u);
  EXPECT_EQ(asked_[0].value, 1);
  EXPECT_EQ(asked_[1].value, 2);
  const Id first = asked_[0].client, second = asked_[2].client;
  EXPECT_EQ(asked_[1].client, first);
  EXPECT_NE(first, second);
  server_->reply(second, "two");
  server_->reply(first, "one,");
  server_->reply(first, "and more");
  EXPECT_EQ(receive(two, 3), "two");
  EXPECT_EQ(receive(one, 12), "one,and more");
}

// ethernet:1/9: of 40 requests 16 are taken; a reply makes room for one.
TEST_F(EthernetClients, SixteenRequestsOfOneMayWait) {
  constexpr std::size_t kMost = 16;
  static_assert(kMost == EthernetServer::kMostRequests);
  tcp::socket one = client();
  std::string requests;
  for (unsigned n = 0; n < 40; ++n) requests += request(n);
  send(one, requests);
  ASSERT_TRUE(are_asked(kMost));
  EXPECT_EQ(asked_within(50ms, kMost), kMost);
  const Id id = asked_[0].client;
  for (std::size_t n = kMost; n < 40; ++n) {
    server_->reply(id, "r");
    ASSERT_TRUE(are_asked(n + 1));
  }
  EXPECT_EQ(asked_within(20ms, 40), 40u);
  for (std::size_t n = 0; n < kMost; ++n) server_->reply(id, "r");
  EXPECT_EQ(receive(one, 40), std::string(40, 'r'));
  for (unsigned n = 0; n < 40; ++n) EXPECT_EQ(asked_[n].value, n);
  send(one, request(40));
  EXPECT_TRUE(are_asked(41)) << "it is read from again";
}

// ethernet:1/9: what is under way may come in, one read ahead, and no more until the reply has gone.
TEST_F(EthernetClients, OneThatDoesNotTakeItsReplyIsNotReadFrom) {
  tcp::socket one = client();
  for (unsigned n = 1; n <= 3; ++n) {  // however many it has taken before
    send(one, request(n));
    ASSERT_TRUE(are_asked(n));
    if (n == 3) break;
    server_->reply(asked_[0].client, "ok");
    EXPECT_EQ(receive(one, 2), "ok");
  }
  const std::string large(64 << 20, 'x');
  server_->reply(asked_[0].client, large);
  send(one, request(4));
  ASSERT_TRUE(are_asked(4));
  send(one, request(5));
  EXPECT_EQ(asked_within(50ms, 4), 4u);
  EXPECT_EQ(receive(one, large.size()), large);
  EXPECT_TRUE(are_asked(5));
}

// A client that has sent all it has may still listen: it is answered, then the connection goes.
TEST_F(EthernetClients, OneThatHasEndedIsAnsweredWhatItHasAsked) {
  tcp::socket one = client();
  send(one, request(1) + request(2));
  one.shutdown(tcp::socket::shutdown_send);
  ASSERT_TRUE(are_asked(2));
  EXPECT_FALSE(comes([this] { return !closed_.empty(); }, 30ms)) << "it waits for its replies";
  server_->reply(asked_[0].client, "a");
  EXPECT_EQ(receive(one, 1), "a");
  EXPECT_FALSE(comes([this] { return !closed_.empty(); }, 30ms));
  server_->reply(asked_[0].client, "b");
  EXPECT_EQ(receive(one, 2), "b");
  EXPECT_TRUE(comes([this] { return closed_.size() == 1; }));
  EXPECT_EQ(closed_, std::vector<Id>{asked_[0].client});
  EXPECT_TRUE(comes([this] { return server_->clients() == 0; }));
  EXPECT_TRUE(troubles_.empty());
  tcp::socket idle = client();
  idle.shutdown(tcp::socket::shutdown_send);
  EXPECT_TRUE(is_closed(idle));
}

// One that is gone is told of once; what it is answered then goes nowhere, to no sender of datagrams either.
TEST_F(EthernetClients, OneThatIsGoneIsForgotten) {
  asio::ip::udp::socket sender(io_, asio::ip::udp::endpoint(asio::ip::udp::v4(), 0));
  sender.send_to(asio::buffer(request(1)), {asio::ip::address_v4::loopback(), port_});
  ASSERT_TRUE(are_asked(1));
  tcp::socket one = client(), two = client();
  send(one, request(2));
  ASSERT_TRUE(are_asked(2));
  send(two, request(3));
  ASSERT_TRUE(are_asked(3));
  one.set_option(asio::socket_base::linger(true, 0));  // reset
  one.close();
  EXPECT_TRUE(comes([this] { return !closed_.empty(); }));
  EXPECT_EQ(server_->clients(), 1u);
  server_->reply(asked_[1].client, "late");
  server_->reply(asked_[2].client, "two");
  EXPECT_EQ(receive(two, 3), "two");
  EXPECT_EQ(sender.available(), 0u);
  EXPECT_EQ(closed_, std::vector<Id>{asked_[1].client});
  EXPECT_TRUE(troubles_.empty());
}

// ethernet:2/5: nobody knows where the next packet begins. What came before is answered first.
TEST_F(EthernetClients, OneThatSendsWhatIsNoRequestIsCutOff) {
  tcp::socket one = client();
  send(one, request(1) + request(2, 0x99) + request(3));
  ASSERT_TRUE(are_asked(1));
  EXPECT_FALSE(comes([this] { return !closed_.empty(); }, 30ms)) << "it waits for its reply";
  server_->reply(asked_[0].client, "a");
  EXPECT_EQ(receive(one, 2), "a");
  EXPECT_TRUE(is_closed(one));
  EXPECT_TRUE(comes([this] { return closed_.size() == 1; }));
  EXPECT_EQ(troubles_, std::vector<std::string>{"client 1 is cut off: request 99 is not known"});
  EXPECT_EQ(asked_.size(), 1u);
  tcp::socket two = client();
  send(two, std::string("\x40\xBF\0\0\0\0\x05\xD5", 8));  // 1493 bytes of data
  EXPECT_TRUE(is_closed(two));
  EXPECT_TRUE(comes([this] { return closed_.size() == 2; }));
  EXPECT_EQ(troubles_.size(), 1u) << "what goes wrong again is said the tenth time";
}

// ethernet:1/8.
TEST_F(EthernetClients, SixtyFourMayBeConnected) {
  constexpr std::size_t kMost = 64;
  static_assert(kMost == EthernetServer::kMostClients);
  answer_ = "ok";
  std::vector<tcp::socket> all;
  for (std::size_t n = 0; n < kMost; ++n) {
    all.push_back(client());
    send(all.back(), request(1));
    EXPECT_EQ(receive(all.back(), 2), "ok");
  }
  EXPECT_EQ(server_->clients(), kMost);
  tcp::socket refused = client();
  EXPECT_TRUE(is_closed(refused));
  EXPECT_TRUE(comes([this] { return !troubles_.empty(); }));
  EXPECT_EQ(troubles_, std::vector<std::string>{"a client is refused: 64 are connected"});
  EXPECT_EQ(server_->clients(), kMost);
  EXPECT_TRUE(closed_.empty());
  all.pop_back();
  EXPECT_TRUE(comes([this] { return closed_.size() == 1; }));
  tcp::socket next = client();
  send(next, request(1));
  EXPECT_EQ(receive(next, 2), "ok");
}

TEST_F(EthernetClients, StoppingClosesAll) {
  tcp::socket one = client();
  send(one, request(1));
  ASSERT_TRUE(are_asked(1));
  server_->stop();
  server_.reset();
  EXPECT_TRUE(is_closed(one));
  tcp::socket other(io_);
  asio::error_code error;
  other.connect({asio::ip::address_v4::loopback(), port_}, error);
  EXPECT_TRUE(error);
}

// ethernet:1/1: TCP and UDP have one port. A datagram that is no request is lost, and so is a second request in it.
TEST_F(EthernetClients, DatagramsAreRequestsOfTheirSender) {
  answer_ = "ok";
  asio::ip::udp::socket sender(io_, asio::ip::udp::endpoint(asio::ip::udp::v4(), 0));
  const asio::ip::udp::endpoint to(asio::ip::address_v4::loopback(), port_);
  for (const std::string& bytes :
       {request(1, 0x99), std::string("\xC0\xC2\0", 3), std::string(), request(2) + request(3)})
    sender.send_to(asio::buffer(bytes), to);
  char reply[8];
  EXPECT_EQ(receive_some(sender, reply, sizeof reply), 2);
  for (unsigned n = 4; n < 40; ++n) {  // each is answered: none is too many
    sender.send_to(asio::buffer(request(n)), to);
    EXPECT_EQ(receive_some(sender, reply, sizeof reply), 2);
  }
  ASSERT_EQ(asked_.size(), 37u);
  EXPECT_EQ(asked_[0].value, 2);
  for (const Asked& asked : asked_) EXPECT_EQ(asked.client, asked_[0].client);
  EXPECT_EQ(server_->clients(), 0u) << "of TCP alone";
  EXPECT_TRUE(troubles_.empty());
}

// ------------------------------------------------------------------------------------------------------------- places

// Every address of IPv4 is none of IPv6.
TEST(EthernetPlaces, AllOfIpv4CanBeListenedAt) {
  EXPECT_EQ(EthernetServer("0.0.0.0:0").place().rfind("0.0.0.0:", 0), 0u);
  EXPECT_EQ(EthernetServer("127.0.0.1:0").place().rfind("127.0.0.1:", 0), 0u);
}

TEST(EthernetPlaces, WhatCannotBeListenedAtIsSaid) {
  const auto error_of = [](const std::string& place) {
    try {
      const EthernetServer server(place);
    } catch (const UsageError& e) { return std::string(e.what()); }
    return std::string("no error");
  };
  EXPECT_EQ(error_of("127.0.0.1"), "--listen 127.0.0.1: is no place; expected HOST:PORT, for example 127.0.0.1:1025");
  const EthernetServer server("127.0.0.1:0");
  EXPECT_THAT(server.place(), ::testing::MatchesRegex("127\\.0\\.0\\.1:[0-9]+"));
  EXPECT_EQ(error_of(server.place()),
            "--listen " + server.place() + ": Address already in use; expected a free port of this machine");
  EXPECT_EQ(error_of("192.0.2.1:0"),
            "--listen 192.0.2.1:0: Cannot assign requested address; expected a free port of this machine");
  EXPECT_THAT(error_of("[::1::2]:0"), ::testing::MatchesRegex("--listen \\[::1::2\\]:0: .+; expected a name or address "
                                                              "of this machine"));
  EXPECT_THAT(EthernetServer("*:0").place(), ::testing::MatchesRegex("(\\[::\\]|0\\.0\\.0\\.0):[0-9]+"));
}

}  // namespace
}  // namespace brick
