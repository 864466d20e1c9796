// Packets of the Ethernet port: whatever comes, in whatever pieces. First byte: how the rest is cut. What is found is
// the same however it is cut, nothing is kept that can be no packet, and each packet is what its header says.
#include <string>
#include <vector>

#include "testbench/fuzz/target.h"
#include "testbench/host/controller_answer.h"
#include "testbench/host/ethernet_packet.h"
#include "testbench/host/output_queue.h"

namespace brick {
namespace {

using Packet = EthernetPacket;

bool takes_data(const Packet& packet) {
  const std::string with_data = "\xB0\xB5\xBA\xBB\xBF\xC6\xCB";
  return with_data.find(static_cast<char>(packet.request)) != std::string::npos ||
         (packet.request == 0xE0 && packet.type == 0x40);
}

void check(const Packet& packet) {
  require(packet.type == Packet::kDownload || packet.type == Packet::kUpload, "a packet of no type");
  require(packet.data.size() == (takes_data(packet) ? packet.length : 0u), "data of another length");
  require(packet.data.size() <= Packet::kMostData, "too much data");
}

// All packets as bytes, one behind the other.
std::string read(PacketReader& reader) {
  std::string found;
  while (const auto packet = reader.next()) {
    check(*packet);
    found += {static_cast<char>(packet->type), static_cast<char>(packet->request)};
    for (const unsigned word : {packet->value, packet->index, packet->length})
      found += {static_cast<char>(word >> 8), static_cast<char>(word)};
    found += packet->data;
  }
  require(reader.waiting() < Packet::kHeader + Packet::kMostData, "more is kept than a packet");
  require(reader.broken().empty() || reader.waiting() == 0, "bytes are kept that are none of a packet");
  return found;
}

// What is no packet ends with its piece. Where there is no such thing, the pieces make no difference.
void packets(const std::string& bytes, std::size_t step) {
  PacketReader whole, pieces;
  whole.take(bytes);
  const std::string expected = read(whole);
  require(expected.size() + whole.waiting() <= bytes.size(), "bytes are invented");
  std::string found;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    pieces.take(std::string_view(bytes).substr(at, step));
    found += read(pieces);
  }
  require(found.size() + pieces.waiting() <= bytes.size(), "bytes are invented in pieces");
  if (expected.size() + whole.waiting() == bytes.size())
    require(found == expected && bytes.compare(0, found.size(), found) == 0, "cut, it is something else");
}

// The answer of a controller out of its mind: no byte is invented, and what is released stays.
void answer(const std::string& bytes, bool sums) {
  ControllerAnswer reader(0, sums);
  OutputQueue queue;
  std::size_t released = 0, fetched = 0;
  for (const char c : bytes) {
    if (reader.ended()) break;
    reader.take(static_cast<std::uint8_t>(c));
    const std::string more = reader.release();
    released += more.size();
    queue.add(more);
  }
  reader.quiet();
  require(reader.ended(), "no end");
  const std::string rest = reader.release();
  queue.add(rest);
  require(released + rest.size() <= bytes.size(), "more than was said");
  while (const auto piece = queue.take_answer(100)) {
    require(!piece->empty() && piece->size() <= 100, "a piece of another size");
    fetched += piece->size();
  }
  require(fetched + queue.size() == released + rest.size(), "bytes are lost");
}

}  // namespace
}  // namespace brick

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  brick::packets(bytes, 1u + data[0] % 64u);
  brick::answer(bytes, data[0] >= 128);
  return 0;
}
