// The sockets of the Ethernet port: whom of the senders of datagrams it forgets, and what it does about a client that
// has been switched off (ethernet:1/8, ethernet:1/10).
#include <gtest/gtest.h>

#include <netinet/tcp.h>
#include <sys/ioctl.h>

#include <asio.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/ethernet_connection.h"
#include "app/ethernet_server.h"
#include "testbench/unit/app/receive_some.h"

namespace brick {
namespace {

using asio::ip::tcp;
using asio::ip::udp;
using Client = EthernetServer::Client;

class SendersOfDatagrams : public ::testing::Test {
 protected:
  static constexpr std::size_t kMost = EthernetServer::kMostClients;

  SendersOfDatagrams() {
    server_.on_request = [this](Client client, const EthernetPacket&) {
      if (replies_) server_.reply(client, "ok");
      const std::lock_guard<std::mutex> lock(mutex_);
      asked_.push_back(client);
      ++requests_;
      heard_.notify_one();
    };
    server_.on_close = [this](Client client) {
      const std::lock_guard<std::mutex> lock(mutex_);
      forgotten_.push_back(client);
    };
    server_.start();
    const std::string place = server_.place();
    to_ = udp::endpoint(asio::ip::address_v4::loopback(),
                        static_cast<std::uint16_t>(std::stoul(place.substr(place.rfind(':') + 1))));
    for (std::size_t n = 0; n < kMost + 2; ++n) senders_.emplace_back(io_, udp::endpoint(udp::v4(), 0));
  }
  ~SendersOfDatagrams() override { server_.stop(); }

  void send(std::size_t sender) { senders_[sender].send_to(asio::buffer("\xC0\xC2\0\0\0\0\0\2", 8), to_); }
  // As which client the server takes it.
  Client ask(std::size_t sender) {
    send(sender);
    std::unique_lock<std::mutex> lock(mutex_);
    if (!heard_.wait_for(lock, std::chrono::seconds(20), [this] { return !asked_.empty(); })) {
      ADD_FAILURE() << "a datagram of sender " << sender << " is lost";
      return 0;
    }
    const Client client = asked_.back();
    EXPECT_EQ(asked_.size(), 1u) << "a request that nobody has sent";
    asked_.clear();
    lock.unlock();
    char reply[4];
    if (replies_) { EXPECT_EQ(receive_some(senders_[sender], reply, sizeof reply), 2); }
    return client;
  }
  std::vector<Client> forgotten() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return forgotten_;
  }

  EthernetServer server_{"127.0.0.1:0"};
  asio::io_context io_;
  udp::endpoint to_;
  std::vector<udp::socket> senders_;
  std::mutex mutex_;
  std::condition_variable heard_;
  std::vector<Client> asked_, forgotten_;
  std::size_t requests_ = 0;
  std::atomic<bool> replies_{true};
};

// ethernet:1/8
TEST_F(SendersOfDatagrams, TheOneNotHeardOfForLongestGivesItsPlace) {
  std::vector<Client> clients;
  for (std::size_t n = 0; n < kMost; ++n) clients.push_back(ask(n));
  EXPECT_EQ(forgotten(), std::vector<Client>{}) << "there is room for as many";
  for (const std::size_t n : {0, 2, 1}) EXPECT_EQ(ask(n), clients[n]) << "each is known";
  ask(kMost);  // 3 to 63, 0, 2, 1 in the order of their last words
  EXPECT_EQ(forgotten(), std::vector<Client>{clients[3]});
  ask(kMost + 1);
  EXPECT_EQ(forgotten(), (std::vector<Client>{clients[3], clients[4]}));
  for (const std::size_t n : {0, 1, 2, 5, 63}) EXPECT_EQ(ask(n), clients[n]) << n << " keeps its place";
  const Client again = ask(3);
  EXPECT_GT(again, clients.back()) << "who was forgotten is a new one";
  EXPECT_EQ(forgotten(), (std::vector<Client>{clients[3], clients[4], clients[6]}));
}

// One whose request is under way is waited for, however long ago it came; of too many the last is lost.
TEST_F(SendersOfDatagrams, WhoeverIsWaitedForKeepsItsPlace) {
  const Client first = ask(1);
  replies_ = false;
  const Client waits = ask(0);
  replies_ = true;
  for (std::size_t n = 2; n < kMost; ++n) ask(n);
  ask(kMost);
  EXPECT_EQ(forgotten(), std::vector<Client>{first});
  replies_ = false;
  for (std::size_t n = 2; n <= kMost; ++n) ask(n);
  send(1);  // all 64 are waited for: lost
  EXPECT_EQ(ask(0), waits) << "nobody else was heard";
  EXPECT_EQ(forgotten(), std::vector<Client>{first});
}

// 16 requests of one may wait; one more is lost.
TEST_F(SendersOfDatagrams, ADatagramTooManyIsLost) {
  replies_ = false;
  const Client first = ask(0);
  for (std::size_t n = 1; n < EthernetServer::kMostRequests; ++n) EXPECT_EQ(ask(0), first);
  send(0);
  EXPECT_NE(ask(1), first);
  const std::lock_guard<std::mutex> lock(mutex_);
  EXPECT_EQ(requests_, EthernetServer::kMostRequests + 1);
}

// Of both protocols, TCP and UDP.
TEST(EthernetPlaces, AnAsteriskIsEveryAddress) {
  EthernetServer server("*:0");
  server.on_request = [&server](EthernetServer::Client client, const EthernetPacket&) { server.reply(client, "ok"); };
  server.on_close = [](EthernetServer::Client) {};
  server.start();
  const std::string place = server.place();
  const auto port = static_cast<std::uint16_t>(std::stoul(place.substr(place.rfind(':') + 1)));
  std::vector<asio::ip::address> addresses{asio::ip::address_v4::loopback(), asio::ip::make_address("127.0.0.2")};
  asio::io_context io;
  asio::error_code none;
  if (tcp::socket other(io);
      !other.open(tcp::v6(), none) && !other.bind(tcp::endpoint(asio::ip::address_v6::loopback(), 0), none))
    addresses.emplace_back(asio::ip::address_v6::loopback());
  const std::string_view ready("\xC0\xC2\0\0\0\0\0\2", 8);
  for (const asio::ip::address& address : addresses) {
    char reply[4] = {};
    tcp::socket client(io);
    client.connect({address, port});
    asio::write(client, asio::buffer(ready));
    EXPECT_EQ(receive_some(client, reply, sizeof reply), 2) << address;
    udp::socket datagrams(io, udp::endpoint(address.is_v4() ? udp::v4() : udp::v6(), 0));
    datagrams.send_to(asio::buffer(ready), {address, port});
    EXPECT_EQ(receive_some(datagrams, reply, sizeof reply), 2) << address;
  }
  server.stop();
}

// A client and the server's end of its connection.
class EthernetConnections : public ::testing::Test {
 protected:
  EthernetConnections() {
    client.connect(acceptor.local_endpoint());
    acceptor.accept(socket);
  }
  void ask() { asio::write(client, asio::buffer("\xC0\xC2\0\0\0\0\0\2", 8)); }
  void run_until_asked(int times) {
    while (asked < times && io.run_one_for(std::chrono::seconds(10)) > 0) {}
    ASSERT_EQ(asked, times);
  }

  asio::io_context io;
  tcp::acceptor acceptor{io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  tcp::socket client{io}, socket{io};
  int asked = 0;
};

// ethernet:1/10
TEST_F(EthernetConnections, AClientThatSaysNothingIsAskedWhetherItIsThere) {
  const int descriptor = socket.native_handle();
  const auto option = [descriptor](int level, int name) {
    int value = -1;
    socklen_t size = sizeof value;
    EXPECT_EQ(::getsockopt(descriptor, level, name, &value, &size), 0);
    return value;
  };
  const auto connection = std::make_shared<EthernetConnection>(std::move(socket), 16);
  EXPECT_EQ(option(SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPIDLE), 60);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPINTVL), 10);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPCNT), 6);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_USER_TIMEOUT), 120'000) << "ms, of a reply that it does not take";
  EXPECT_EQ(option(IPPROTO_TCP, TCP_NODELAY), 1);
}

// ethernet:1/9: what may not be asked yet stays with the system, which stops the client.
TEST_F(EthernetConnections, NothingIsReadWhileAsManyAreUnderWayAsMayBe) {
  const int descriptor = socket.native_handle();
  const auto unread = [descriptor] {
    int bytes = -1;
    ::ioctl(descriptor, FIONREAD, &bytes);
    return bytes;
  };
  const auto connection = std::make_shared<EthernetConnection>(std::move(socket), 1);
  connection->on_request = [&](const EthernetPacket&) { ++asked; };
  connection->on_close = [](const std::string&) {};
  connection->start();
  ask();
  ASSERT_NO_FATAL_FAILURE(run_until_asked(1));
  ask();
  io.poll();
  io.restart();  // nothing was left for it to wait for
  for (int ms = 0; ms < 10'000 && unread() < 8; ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(unread(), 8);
  connection->reply("ok");
  ASSERT_NO_FATAL_FAILURE(run_until_asked(2));
  EXPECT_EQ(unread(), 0);
  connection->close("");
  io.run();
}

// One that is gone, with a request behind the one whose reply it did not take: it is gone at once, whatever else of it
// is under way, and nothing of it is begun behind that.
TEST_F(EthernetConnections, NothingIsAskedByOneThatIsGone) {
  const auto connection = std::make_shared<EthernetConnection>(std::move(socket), 16);
  int closed = 0, late = 0;
  connection->on_request = [&](const EthernetPacket&) { ++(closed != 0 ? late : asked); };
  connection->on_close = [&](const std::string&) { ++closed; };
  connection->start();
  for (int n = 0; n < 2; ++n) ask();
  ASSERT_NO_FATAL_FAILURE(run_until_asked(2));
  connection->reply(std::string(64 << 20, 'x'));
  io.poll();  // as much of it as the system takes
  ask();
  client.set_option(asio::socket_base::linger(true, 0));  // reset
  client.close();
  io.run();
  EXPECT_EQ(closed, 1);
  EXPECT_EQ(late, 0);
}

// A reply that is on its way ends with an error then, which is told no second time.
TEST_F(EthernetConnections, OneThatIsClosedIsClosedOnce) {
  const auto connection = std::make_shared<EthernetConnection>(std::move(socket), 16);
  std::vector<std::string> closed;
  connection->on_request = [&](const EthernetPacket&) { ++asked; };
  connection->on_close = [&](const std::string& why) { closed.push_back(why); };
  connection->start();
  ask();
  ASSERT_NO_FATAL_FAILURE(run_until_asked(1));
  connection->reply(std::string(64 << 20, 'x'));
  io.poll();  // as much of it as the system takes
  connection->close("enough");
  io.run();
  EXPECT_EQ(closed, std::vector<std::string>{"enough"});
}

}  // namespace
}  // namespace brick
