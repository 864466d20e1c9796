#include "app/page/page_port.h"

#include <utility>

namespace brick {

namespace {

constexpr char kNothing = 0x00, kAck = 0x06, kBell = 0x07, kLineFeed = '\n', kReturn = '\r';

// ethernet:4/4 to ethernet:4/8: a piece that is full and has no end is not all of it; an LF stands before the data too
// with I3 = 1 or 3.
bool goes_on(const std::string& piece, const std::string& answer) {
  if (piece.back() == kAck) return false;
  if (piece.back() == kLineFeed) return true;
  if (piece.size() < EthernetPacket::kMostReply) return false;
  return answer.find(kBell) == std::string::npos || answer.back() != kReturn;
}

EthernetPacket packet(EthernetPacket::Request request, const std::string& data) {
  const bool fetches = request == EthernetPacket::kGetBuffer;
  return {fetches ? EthernetPacket::kUpload : EthernetPacket::kDownload,
          request,
          0,
          0,
          static_cast<std::uint16_t>(fetches ? EthernetPacket::kMostReply : data.size()),
          data};
}

}  // namespace

void PagePort::begin(Client client) {
  processor_.request(client, packet(EthernetPacket::kGetResponse, waiting_[client].front().line));
}

void PagePort::command(Client client, const std::string& line, std::function<void(std::string answer)> done) {
  auto& list = waiting_[client];
  list.push_back({line, "", std::move(done)});
  if (list.size() == 1) begin(client);
}

void PagePort::reply(Client client, const std::string& bytes) {
  const auto found = waiting_.find(client);
  if (found == waiting_.end() || found->second.empty()) return;
  Waiting& first = found->second.front();
  if (!first.flushes) {
    const bool nothing = bytes.empty() || bytes.front() == kNothing;
    if (!nothing) first.answer += bytes;
    if (!nothing && goes_on(bytes, first.answer)) {
      first.flushes = first.answer.size() >= kLongestAnswer;
      return processor_.request(client,
                                packet(first.flushes ? EthernetPacket::kFlush : EthernetPacket::kGetBuffer, ""));
    }
  }
  Waiting done = std::move(first);
  found->second.pop_front();
  if (!found->second.empty()) begin(client);
  done.done(std::move(done.answer));
}

void PagePort::close(Client client) {
  waiting_.erase(client);
  processor_.close(client);
}

}  // namespace brick
