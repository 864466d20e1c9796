// Packets of the Ethernet port in a stream of bytes (ethernet:2). Bytes from there.
#include <gtest/gtest.h>

#include "testbench/host/ethernet_packet.h"

namespace brick {
namespace {

using Packet = EthernetPacket;
using Bytes = std::string;

Bytes header(unsigned type, unsigned request, unsigned value, unsigned index, unsigned length) {
  Bytes bytes;
  for (const unsigned byte : {type, request, value >> 8, value, index >> 8, index, length >> 8, length})
    bytes.push_back(static_cast<char>(byte));
  return bytes;
}

std::vector<Packet> packets(PacketReader& reader) {
  std::vector<Packet> found;
  while (const auto packet = reader.next()) found.push_back(*packet);
  return found;
}

std::vector<Packet> packets_of(const std::vector<Bytes>& pieces) {
  PacketReader reader;
  std::vector<Packet> found;
  for (const Bytes& piece : pieces) {
    reader.take(piece);
    for (const Packet& packet : packets(reader)) found.push_back(packet);
  }
  return found;
}

const Bytes kVersion = header(0x40, 0xBF, 0, 0, 3) + "ver";

TEST(EthernetPackets, FieldsHaveTheMostSignificantByteFirst) {
  const auto found = packets_of({header(0xC0, 0xB5, 0x1234, 0x5678, 2) + "ab"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].type, 0xC0);
  EXPECT_EQ(found[0].request, 0xB5);
  EXPECT_EQ(found[0].value, 0x1234);
  EXPECT_EQ(found[0].index, 0x5678);
  EXPECT_EQ(found[0].data, "ab");
}

// ethernet:2/1: the request tells, not the type.
TEST(EthernetPackets, DataFollowsTheseRequestsAndNoOthers) {
  const Bytes with_data = "\xB0\xB5\xBA\xBB\xBF\xC6\xCB", bare = "\xB1\xB3\xB4\xB6\xBE\xC2\xC4\xC5\xC7\xE1\xE2\xE3\xE4";
  for (const unsigned type : {0x40u, 0xC0u}) {
    for (const char code : with_data) {
      const auto found = packets_of({header(type, static_cast<unsigned char>(code), 0, 0, 3) + "abc" + kVersion});
      ASSERT_EQ(found.size(), 2u);
      EXPECT_EQ(found[0].data, "abc");
    }
    for (const char code : bare) {
      const auto found = packets_of({header(type, static_cast<unsigned char>(code), 0, 0, 65535) + kVersion});
      ASSERT_EQ(found.size(), 2u) << std::hex << static_cast<unsigned char>(code);
      EXPECT_EQ(found[0].data, "");
    }
  }
  EXPECT_EQ(packets_of({header(0x40, 0xE0, 0, 0, 4) + "abcd" + kVersion})[0].data, "abcd");
  EXPECT_EQ(packets_of({header(0xC0, 0xE0, 0, 0, 4) + kVersion}).size(), 2u);
}

// ethernet:2/6, at every byte.
TEST(EthernetPackets, ComeInPiecesOfAnySize) {
  const Bytes whole = header(0xC0, 0xB5, 16, 0, 5) + Bytes("\x40\xC0\0\r\n", 5);
  const Bytes all = kVersion + header(0xC0, 0xC5, 0, 0, 0x578) + header(0x40, 0xB0, 0, 0, 0) + whole + kVersion;
  for (std::size_t first = 0; first <= all.size(); ++first)
    for (std::size_t second = first; second <= all.size(); ++second) {
      const auto found = packets_of({all.substr(0, first), all.substr(first, second - first), all.substr(second)});
      ASSERT_EQ(found.size(), 5u) << first << ' ' << second;
      EXPECT_EQ(found[3].data, Bytes("\x40\xC0\0\r\n", 5));
      EXPECT_EQ(found[4].data, "ver");
    }
}

// ethernet:2/3
TEST(EthernetPackets, ZerosBehindARequestWithoutDataAreDropped) {
  const Bytes zeros(1400, '\0'), control = header(0xC0, 0xC4, 2, 0, 1400);
  EXPECT_EQ(packets_of({control + zeros, kVersion}).size(), 2u);
  EXPECT_EQ(packets_of({control + zeros + kVersion}).size(), 2u) << "in the same segment";
  EXPECT_EQ(packets_of({control + zeros.substr(700), zeros, kVersion}).size(), 2u) << "in two";
  EXPECT_EQ(packets_of({control, zeros + kVersion}).size(), 2u) << "in the next one, with the next request";
  EXPECT_EQ(packets_of({control + zeros.substr(700), zeros.substr(700) + control + zeros, kVersion}).size(), 3u);
  for (std::size_t cut = 1; cut < control.size() + zeros.size(); ++cut) {
    const Bytes all = control + zeros + kVersion;
    ASSERT_EQ(packets_of({all.substr(0, cut), all.substr(cut)}).size(), 2u) << "cut at byte " << cut;
  }
  EXPECT_EQ(packets_of({control + "xyz" + kVersion}).size(), 2u) << "whatever they are, in the same segment";
  EXPECT_EQ(packets_of({control, "x" + kVersion, kVersion}).size(), 2u) << "nothing but zeros";
  EXPECT_EQ(packets_of({kVersion, zeros + kVersion, kVersion}).size(), 2u) << "behind data";
}

// ethernet:2/4
TEST(EthernetPackets, WhatBeginsNoHeaderIsDroppedWithAllThatIsThere) {
  EXPECT_EQ(packets_of({"GET / HTTP/1.1\r\n" + kVersion, kVersion}).size(), 1u);
  EXPECT_EQ(packets_of({kVersion + "x" + kVersion, kVersion}).size(), 2u);
}

// ethernet:2/5
TEST(EthernetPackets, AnUnknownRequestAndALengthThatLiesEndTheStream) {
  for (const Bytes& bad : {header(0x40, 0xBF, 0, 0, 1493), header(0x40, 0xB0, 0, 0, 65535), header(0x40, 0xD0, 0, 0, 0),
                           header(0xC0, 0x00, 0, 0, 0)}) {
    PacketReader reader;
    reader.take(kVersion + bad + kVersion);
    EXPECT_EQ(packets(reader).size(), 1u);
    EXPECT_NE(reader.broken(), "");
    reader.take(kVersion);
    EXPECT_EQ(packets(reader).size(), 0u);
    EXPECT_EQ(reader.waiting(), 0u) << "nothing is kept";
  }
  EXPECT_EQ(packets_of({header(0x40, 0xBF, 0, 0, 1492) + Bytes(1492, 'x')}).size(), 1u);
}

// ethernet:3/6
TEST(EthernetPackets, RequestsThatAreKnownByNameOnlyAreUnknown) {
  for (const unsigned code : {0xB7, 0xB8, 0xB9, 0xBC, 0xBD, 0xC0, 0xC1, 0xC3, 0xC8, 0xC9, 0xCA, 0xD0})
    for (const unsigned type : {0x40u, 0xC0u}) {
      PacketReader reader;
      reader.take(header(type, code, 0, 0, 0) + kVersion);
      EXPECT_EQ(packets(reader).size(), 0u) << std::hex << type << ' ' << code;
      EXPECT_NE(reader.broken(), "") << std::hex << type << ' ' << code;
    }
}

TEST(EthernetPackets, AHalfPacketIsAllThatIsKept) {
  PacketReader reader;
  for (int i = 0; i < 1000; ++i) {
    reader.take(header(0x40, 0xBF, 0, 0, 100) + Bytes(100, 'x') + header(0x40, 0xBF, 0, 0, 100));
    (void)packets(reader);
    reader.take(Bytes(100, 'y'));
    (void)packets(reader);
    ASSERT_EQ(reader.waiting(), 0u);
  }
}

}  // namespace
}  // namespace brick
