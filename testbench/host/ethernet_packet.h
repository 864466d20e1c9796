// Packets of the controller's Ethernet port: a header of eight bytes and what follows it (ethernet:2), told apart in a
// stream that comes in pieces of any size. Bytes in, packets out; neither sockets nor time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace brick {

struct EthernetPacket {
  static constexpr std::uint8_t kDownload = 0x40, kUpload = 0xC0;  // type: to the controller, from it
  static constexpr std::size_t kHeader = 8, kMostData = 1492, kMostReply = 1400;

  enum Request : std::uint8_t {
    kSendLine = 0xB0,
    kGetLine = 0xB1,
    kFlush = 0xB3,
    kGetMemory = 0xB4,
    kSetMemory = 0xB5,
    kSendControl = 0xB6,
    kSetBit = 0xBA,
    kSetBits = 0xBB,
    kPort = 0xBE,
    kGetResponse = 0xBF,
    kReadReady = 0xC2,
    kControlResponse = 0xC4,
    kGetBuffer = 0xC5,
    kWriteBuffer = 0xC6,
    kWriteError = 0xC7,
    kDownloadFirmware = 0xCB,
    kAddress = 0xE0,
    kHardwareAddress = 0xE1,
    kDate = 0xE2,
    kTime = 0xE3,
    kVersion = 0xE4,
  };

  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
  std::uint16_t length = 0;  // of the data, or as many bytes as are wanted
  std::string data;
};

class PacketReader {
 public:
  // A piece as it came from the network. What is no packet ends with the piece: the next begins at a header.
  void take(std::string_view piece);
  std::optional<EthernetPacket> next();                  // none: more bytes are needed, or it is broken
  const std::string& broken() const { return broken_; }  // why nobody can tell where the next packet begins; "" if so
  std::size_t waiting() const { return bytes_.size() - at_; }

 private:
  void skip_to_header();

  std::string bytes_;
  std::size_t at_ = 0;       // of the next packet
  bool bare_ = false;        // behind a packet without data
  bool same_piece_ = false;  // as its header came in
  std::string broken_;
};

}  // namespace brick
