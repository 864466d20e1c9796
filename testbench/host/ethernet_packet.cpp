#include "testbench/host/ethernet_packet.h"

#include <fmt/format.h>

namespace brick {

namespace {

enum class RequestKind { kUnknown, kBare, kWithData };

// By the request, whatever its type says: clients mark a download as an upload.
RequestKind kind(std::uint8_t type, std::uint8_t request) {
  switch (request) {
    case EthernetPacket::kSendLine:
    case EthernetPacket::kSetMemory:
    case EthernetPacket::kSetBit:
    case EthernetPacket::kSetBits:
    case EthernetPacket::kGetResponse:
    case EthernetPacket::kWriteBuffer:
    case EthernetPacket::kDownloadFirmware:
      return RequestKind::kWithData;
    case EthernetPacket::kAddress:
      return type == EthernetPacket::kDownload ? RequestKind::kWithData : RequestKind::kBare;
    case EthernetPacket::kGetLine:
    case EthernetPacket::kFlush:
    case EthernetPacket::kGetMemory:
    case EthernetPacket::kSendControl:
    case EthernetPacket::kPort:
    case EthernetPacket::kReadReady:
    case EthernetPacket::kControlResponse:
    case EthernetPacket::kGetBuffer:
    case EthernetPacket::kWriteError:
    case EthernetPacket::kHardwareAddress:
    case EthernetPacket::kDate:
    case EthernetPacket::kTime:
    case EthernetPacket::kVersion:
      return RequestKind::kBare;
    default:
      return RequestKind::kUnknown;
  }
}

bool may_begin(char c) {
  const auto byte = static_cast<std::uint8_t>(c);
  return byte == EthernetPacket::kDownload || byte == EthernetPacket::kUpload;
}

}  // namespace

void PacketReader::take(std::string_view piece) {
  if (!broken_.empty()) return;
  skip_to_header();  // of the piece before
  same_piece_ = false;
  bytes_.erase(0, at_);
  at_ = 0;
  bytes_ += piece;
}

// A client sends a buffer of zeros behind a header without data, which the network may cut anywhere. Anywhere else
// nothing that follows can be trusted.
void PacketReader::skip_to_header() {
  const auto is_tail = [this](char c) { return bare_ && (c == '\0' || (same_piece_ && !may_begin(c))); };
  while (waiting() > 0 && is_tail(bytes_[at_])) ++at_;
  if (waiting() > 0 && !may_begin(bytes_[at_])) at_ = bytes_.size();
}

std::optional<EthernetPacket> PacketReader::next() {
  if (!broken_.empty()) return std::nullopt;
  skip_to_header();
  if (waiting() < EthernetPacket::kHeader) return std::nullopt;
  const auto byte = [this](std::size_t n) { return static_cast<std::uint8_t>(bytes_[at_ + n]); };
  const auto word = [&](std::size_t n) { return static_cast<std::uint16_t>(byte(n) << 8 | byte(n + 1)); };
  EthernetPacket packet{byte(0), byte(1), word(2), word(4), word(6), ""};
  const RequestKind what = kind(packet.type, packet.request);
  const bool with_data = what == RequestKind::kWithData;
  if (what == RequestKind::kUnknown)
    broken_ = fmt::format("request {:02X} is not known", packet.request);
  else if (with_data && packet.length > EthernetPacket::kMostData)
    broken_ = fmt::format("{} bytes of data; expected {} or fewer", packet.length, EthernetPacket::kMostData);
  if (!broken_.empty()) {
    bytes_.clear();
    at_ = 0;
    return std::nullopt;
  }
  const std::size_t size = EthernetPacket::kHeader + (with_data ? packet.length : 0);
  if (waiting() < size) return std::nullopt;
  packet.data = bytes_.substr(at_ + EthernetPacket::kHeader, size - EthernetPacket::kHeader);
  at_ += size;
  bare_ = same_piece_ = !with_data;
  return packet;
}

}  // namespace brick
