// Which block an address selects in the model, and no other with it: the places of host-bus:2.1 and servo-ic:1.2.
#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "systemc/board/address_decode.h"

namespace brick {
namespace {

constexpr std::uint32_t kAllIcs = (1u << 22) - 1;
constexpr unsigned kNoSsi = 0, kGeo = 1, kBrick = 2, kGeoWithout = 3;  // Straps::ssi_kind

// What is selected, by name; "-" in a register region that nobody answers in, "" outside of them all.
std::string selected(const BusSync::Where& at, bool jpan = true, unsigned ssi = kNoSsi, std::uint32_t ics = kAllIcs) {
  const AddressSelect s = AddressDecode::decode(at, ics, jpan, ssi);
  std::string names = s.any ? "-" : "";
  for (const auto& [name, is] : {std::pair{" internal", s.internal},
                                 {" port", s.port},
                                 {" signals", s.signals},
                                 {" strobe", s.strobe},
                                 {" ctrl", s.ctrl},
                                 {" panel", s.panel},
                                 {" ssi", s.ssi}})
    if (is) names += name;
  return s.ic < 0 ? names : names + " IC " + std::to_string(s.ic);
}

constexpr BusSync::Where latch(std::uint32_t addr, bool x) { return {addr, 0, x, false}; }
constexpr BusSync::Where ic(std::uint32_t addr, bool x) { return {addr, 2, x, false}; }

TEST(AddressDecodeModel, OnChipPageIsTheHostPortsAndNobodyElses) {
  EXPECT_EQ(selected({0x7FFC2, 0, true, true}), "- internal port");
  EXPECT_EQ(selected({0x7FF82, 0, true, true}), "- internal");
  EXPECT_EQ(selected({0x70011, 0, true, true}).find("strobe"), std::string::npos);
}

TEST(AddressDecodeModel, LatchesAreXWordsOfTheirPage) {
  EXPECT_EQ(selected(latch(0x70010, true)), "- signals");
  EXPECT_EQ(selected(latch(0x70011, true)), "- strobe");
  EXPECT_EQ(selected(latch(0x70012, true)), "- ctrl");
  for (const std::uint32_t address : {0x70010u, 0x70011u, 0x70012u}) EXPECT_EQ(selected(latch(address, false)), "-");
  EXPECT_EQ(selected(latch(0x70013, true)), "-");
  EXPECT_EQ(selected({0x70011, 1, true, false}), "") << "with another select";
}

TEST(AddressDecodeModel, RegionsEndWithTheirLastAddresses) {
  for (const auto& [first, last, select, kind] :
       {std::tuple{0x70000u, 0x700FFu, 0, kNoSsi}, std::tuple{0x78000u, 0x7BFFFu, 2, kNoSsi},
        std::tuple{0x0FF00u, 0x0FFFFu, 2, kGeoWithout}})
    for (const std::uint8_t aa : {0, 1, 2, 3, 4, 8}) {
      const auto any = [&, of_aa = aa, of_kind = kind](std::uint32_t address) {
        return !selected({address, of_aa, false, false}, false, of_kind).empty();
      };
      const bool region = select == 0 ? aa == 0 : (aa & 2) != 0;
      for (const std::uint32_t address : {first, last}) EXPECT_EQ(any(address), region) << std::hex << address;
      for (const std::uint32_t address : {first - 1, last + 1}) EXPECT_FALSE(any(address)) << std::hex << address;
    }
}

TEST(AddressDecodeModel, EachIcHasItsPlace) {
  std::vector<std::uint32_t> places{0x78000, 0x78100};
  for (const std::uint32_t star : {0x00u, 0x20u})
    for (std::uint32_t page = 0; page < 4; ++page)
      for (const std::uint32_t block : {0x200u, 0x300u}) places.push_back(0x78000 + 0x1000 * page + block + star);
  for (std::uint32_t page = 0; page < 4; ++page) places.push_back(0x78400 + 0x1000 * page);
  ASSERT_EQ(places.size(), 22u);
  for (unsigned n = 0; n < places.size(); ++n) {
    const unsigned words = n < 18 ? 32 : 64;
    for (const unsigned word : {0u, words - 1})
      for (const bool x : {false, true}) {
        EXPECT_EQ(selected(ic(places[n] + word, x)), "- IC " + std::to_string(n));
        EXPECT_EQ(selected(ic(places[n] + word, x), true, kNoSsi, kAllIcs & ~(1u << n)), "-") << "not fitted";
        EXPECT_EQ(selected({places[n] + word, 0, x, false}), "") << "with another select";
      }
  }
  for (const std::uint32_t address : {0x78020u, 0x78120u, 0x79000u, 0x79100u, 0x78500u})
    EXPECT_EQ(selected(ic(address, true)), "-") << std::hex << address;
}

TEST(AddressDecodeModel, PanelAndSerialEncodersAreWhereTheyAreFitted) {
  EXPECT_EQ(selected(ic(0x78800, false)), "- panel");
  EXPECT_EQ(selected(ic(0x78800, true)), "-");
  EXPECT_EQ(selected(ic(0x78800, false), false), "-");
  constexpr std::uint32_t brick = 0x78B20, geo = 0x0FF40;
  for (const std::uint32_t word : {0u, 31u}) {
    EXPECT_EQ(selected(ic(brick + word, true), false, kBrick), "- ssi");
    for (const unsigned other : {kNoSsi, kGeo, kGeoWithout})
      EXPECT_EQ(selected(ic(brick + word, true), false, other).find("ssi"), std::string::npos);
  }
  for (const std::uint32_t word : {0u, 63u}) {
    EXPECT_EQ(selected(ic(geo + word, true), false, kGeo), "- ssi");
    EXPECT_EQ(selected(ic(geo + word, true), false, kGeoWithout), "-") << "its page is there";
    for (const unsigned other : {kNoSsi, kBrick}) EXPECT_EQ(selected(ic(geo + word, true), false, other), "");
  }
}

}  // namespace
}  // namespace brick
