// The controller's Ethernet connector: TCP and UDP sockets on one port, on a thread of their own. A connection is read
// from only as far as its requests can be taken and its replies go out, so that nobody can make it grow.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "testbench/host/ethernet_packet.h"

namespace brick {

class EthernetServer {
 public:
  using Client = std::uint64_t;
  static constexpr std::size_t kMostClients = 64;   // TCP; and as many that come by UDP
  static constexpr std::size_t kMostRequests = 16;  // of one client that are not replied to yet

  // `place` is HOST:PORT; port 0 takes a free one. Throws UsageError.
  explicit EthernetServer(const std::string& place);
  ~EthernetServer();
  std::string place() const;  // where it listens

  // On the server's thread.
  std::function<void(Client, const EthernetPacket&)> on_request;
  std::function<void(Client)> on_close;
  std::function<void(const std::string&)> on_trouble;

  void start();
  void stop();                                   // and close all
  void reply(Client client, std::string bytes);  // from any thread
  std::size_t clients() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
