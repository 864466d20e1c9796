// One TCP client of the Ethernet server.
#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include <asio.hpp>

#include "testbench/host/ethernet_packet.h"

namespace brick {

class EthernetConnection : public std::enable_shared_from_this<EthernetConnection> {
 public:
  // A client that says nothing is asked whether it is still there; one that does not answer is gone.
  static constexpr std::chrono::seconds kIdle{60}, kAskAgain{10};
  static constexpr int kTimesAsked = 6;

  EthernetConnection(asio::ip::tcp::socket socket, std::size_t most_requests);

  std::function<void(const EthernetPacket&)> on_request;
  std::function<void(const std::string& why)> on_close;  // once; "" when the client has gone

  void start() { read(); }
  void reply(std::string bytes);
  void close(const std::string& why);

 private:
  void read();
  void take_packets();
  void write();
  void close_when_done();

  asio::ip::tcp::socket socket_;
  const std::size_t most_requests_;
  std::array<char, 4096> piece_{};
  PacketReader packets_;
  std::size_t under_way_ = 0;        // requests without a reply yet
  std::deque<std::string> replies_;  // the first is being sent
  bool reading_ = false, ended_ = false, closed_ = false;
};

}  // namespace brick
