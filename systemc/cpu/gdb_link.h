// One debugger's connection: listens on 127.0.0.1, frames and checks the packets of the GDB remote serial protocol, and
// looks for the break byte (0x03) while the program runs. What the packets mean is not known here.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace brick {

class GdbLink {
 public:
  static constexpr std::size_t kMaxPacket = 0x4000;  // bytes between $ and #, as sent; qSupported tells it

  explicit GdbLink(std::uint16_t port);  // 0 = any free port; std::runtime_error when it cannot listen
  ~GdbLink();

  std::uint16_t port() const;
  bool connected() const;

  // All of them end quietly with the connection closed when the other side has gone.
  void accept();      // waits for a debugger
  bool try_accept();  // does not wait
  void close();

  // Waits for the next sound packet; damaged ones are asked for again. Empty: the connection has gone. A packet longer
  // than kMaxPacket comes as its first kMaxPacket bytes and `too_long`.
  struct Packet {
    std::string data;  // escapes resolved
    bool too_long;
  };
  std::optional<Packet> receive();
  void send(const std::string& data);

  bool interrupted();  // takes a break byte that has come; does not wait
  void stop_acks();    // QStartNoAckMode: from the next packet on nothing is acknowledged or checked

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
