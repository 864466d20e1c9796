// What the Ethernet server does when the system refuses it something: a port for datagrams, a descriptor for a client,
// a port that has just been in use (docs/ethernet.md, limits).
#include <gtest/gtest.h>

#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>

#include <asio.hpp>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/ethernet_server.h"
#include "systemc/core/usage_error.h"
#include "testbench/unit/app/receive_some.h"

namespace {

// Calls of the system that are yet to be refused, and when those came that were.
struct Refused {
  std::atomic<int> datagram_binds{0}, accepts{0};
  std::atomic<bool> ipv6_alone{false};  // as a system does whose net.ipv6.bindv6only is 1
  std::mutex mutex;
  std::vector<std::chrono::steady_clock::time_point> at;

  bool take(std::atomic<int>& count, int error) {
    if (count <= 0) return false;
    --count;
    const std::lock_guard<std::mutex> lock(mutex);
    at.push_back(std::chrono::steady_clock::now());
    errno = error;
    return true;
  }
  std::vector<std::chrono::steady_clock::time_point> times() {
    const std::lock_guard<std::mutex> lock(mutex);
    return at;
  }
} refused;

}  // namespace

// In the place of the system's.
extern "C" int socket(int domain, int type, int protocol) noexcept {
  static const auto real = reinterpret_cast<int (*)(int, int, int)>(::dlsym(RTLD_NEXT, "socket"));
  const int made = real(domain, type, protocol), on = 1;
  if (domain == AF_INET6 && made >= 0 && refused.ipv6_alone)
    ::setsockopt(made, IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
  return made;
}

extern "C" int bind(int socket, const sockaddr* address, socklen_t length) noexcept {
  static const auto real = reinterpret_cast<int (*)(int, const sockaddr*, socklen_t)>(::dlsym(RTLD_NEXT, "bind"));
  int type = 0;
  socklen_t size = sizeof type;
  ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size);
  if (type == SOCK_DGRAM && refused.take(refused.datagram_binds, EADDRINUSE)) return -1;
  return real(socket, address, length);
}

extern "C" int accept(int socket, sockaddr* address, socklen_t* length) {
  static const auto real = reinterpret_cast<int (*)(int, sockaddr*, socklen_t*)>(::dlsym(RTLD_NEXT, "accept"));
  if (refused.take(refused.accepts, EMFILE)) return -1;
  return real(socket, address, length);
}

namespace brick {
namespace {

using asio::ip::tcp;
using asio::ip::udp;

class EthernetRefused : public ::testing::Test {
 protected:
  ~EthernetRefused() override {
    refused.accepts = refused.datagram_binds = 0;
    refused.ipv6_alone = false;
  }

  static void start(EthernetServer& server) {
    server.on_request = [&server](EthernetServer::Client client, const EthernetPacket&) { server.reply(client, "ok"); };
    server.on_close = [](EthernetServer::Client) {};
    server.on_trouble = [](const std::string&) {};
    server.start();
  }
  static std::uint16_t port_of(const EthernetServer& server) {
    const std::string place = server.place();
    return static_cast<std::uint16_t>(std::stoul(place.substr(place.rfind(':') + 1)));
  }
  tcp::socket answered(std::uint16_t port) {
    tcp::socket client(io_);
    client.connect({asio::ip::address_v4::loopback(), port});
    asio::write(client, asio::buffer(kReady));
    char reply[4];
    EXPECT_EQ(receive_some(client, reply, sizeof reply), 2);
    return client;
  }
  void answers_a_datagram(std::uint16_t port) {
    udp::socket sender(io_, udp::endpoint(udp::v4(), 0));
    sender.send_to(asio::buffer(kReady), {asio::ip::address_v4::loopback(), port});
    char reply[4];
    EXPECT_EQ(receive_some(sender, reply, sizeof reply), 2);
  }
  static std::string error_of(const std::string& place) {
    try {
      const EthernetServer server(place);
    } catch (const UsageError& e) { return e.what(); }
    return "no error";
  }
  static std::size_t times_refused() {
    const std::lock_guard<std::mutex> lock(refused.mutex);
    return std::exchange(refused.at, {}).size();
  }

  static constexpr std::string_view kReady{"\xC0\xC2\0\0\0\0\0\2", 8};
  asio::io_context io_;
};

// A free port is one of both protocols: sixteen are tried. One that the user names is the one or none.
TEST_F(EthernetRefused, APortThatBothProtocolsHaveIsLookedFor) {
  refused.datagram_binds = 15;
  {
    EthernetServer server("127.0.0.1:0");
    EXPECT_EQ(times_refused(), 15u);
    start(server);
    answered(port_of(server));
    answers_a_datagram(port_of(server));
  }
  refused.datagram_binds = 100;
  EXPECT_EQ(error_of("127.0.0.1:0"),
            "--listen 127.0.0.1:0: Address already in use; expected a free port of this machine");
  EXPECT_EQ(times_refused(), 16u);
  std::string place;
  refused.datagram_binds = 0;
  place = EthernetServer("127.0.0.1:0").place();
  refused.datagram_binds = 100;
  EXPECT_EQ(error_of(place), "--listen " + place + ": Address already in use; expected a free port of this machine");
  EXPECT_EQ(times_refused(), 1u);
}

// Whoever connects while there is none is taken a tenth of a second later, or two.
TEST_F(EthernetRefused, AClientWaitsForADescriptor) {
  EthernetServer server("127.0.0.1:0");
  start(server);
  refused.accepts = 2;
  answered(port_of(server));
  const auto times = refused.times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_GE(times[1] - times[0], std::chrono::milliseconds(100));
  EXPECT_GE(std::chrono::steady_clock::now() - times[1], std::chrono::milliseconds(100));
  times_refused();
  answered(port_of(server));
}

// The port of a server that has closed on its clients is free for the next one.
TEST_F(EthernetRefused, APortThatHasBeenInUseIsTakenAgain) {
  std::string place;
  tcp::socket client(io_);  // there when the server goes
  {
    EthernetServer server("127.0.0.1:0");
    start(server);
    place = server.place();
    client = answered(port_of(server));
    server.stop();
  }
  EXPECT_EQ(error_of(place), "no error");
}

// An asterisk is IPv4 too, whatever the system's habit is.
TEST_F(EthernetRefused, AnAsteriskIsIpv4WhereIpv6AloneIsTheHabit) {
  refused.ipv6_alone = true;
  EthernetServer server("*:0");
  start(server);
  answered(port_of(server));
  answers_a_datagram(port_of(server));
}

}  // namespace
}  // namespace brick
